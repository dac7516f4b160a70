# SPDX-License-Identifier: BSD-3-Clause
"""Disturbs trainings through ROS. Each command must be applied exactly once: the trained policy and
the episodes must equal those of an undisturbed training bit for bit.

proxy         a proxy delays, cuts and repeats service calls. It repeats a call at once or after
              later calls. The trainer uses a second master, which passes calls on to the real
              master but returns the proxy's address for services
stop_sim      the sim node is stopped (SIGSTOP) for --stop-seconds, longer than a call may take
stop_trainer  the trainer is stopped for the same time
master        the master is killed and started again at its port. The new master has no registered
              services, so the trainer must keep its open connections
"""
import contextlib
import pathlib
import signal
import socket
import socketserver
import tempfile
import threading
import time
import urllib.parse
import xmlrpc.client
import xmlrpc.server

from campaigns import ros

STEPS = 96_000       # of a training; each call steps 16 farms
LIMIT_S = 1200
DEADLOCK = "roscpp is in a deadlock"  # part of an error message of train_node
DELAY_S = 0.2
# A value of N means that one in N calls is disturbed in this way.
DELAY, REPEAT, REPEAT_LATE, CUT_BEFORE, CUT_AFTER = 60, 20, 40, 60, 60


class Proxy(socketserver.ThreadingTCPServer):
    """Passes TCPROS service calls on, and delays, cuts or repeats some of them."""

    allow_reuse_address = True
    daemon_threads = True

    def __init__(self, campaign, target):
        super().__init__(("127.0.0.1", 0), Handler)
        self.campaign = campaign
        self.target = target
        self.lock = threading.Lock()
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def one_in(self, number, what):
        """Returns True with probability 1 / `number`, and then counts the call as `what`."""
        with self.lock:
            chosen = self.campaign.rng.randrange(number) == 0
            self.campaign.attempt(what, int(chosen))
        return chosen

    def call_again(self, greeting, request, delay_s):
        """Sends a call again over a new connection after `delay_s` and ignores the answer."""
        time.sleep(delay_s)
        with contextlib.suppress(OSError), socket.create_connection(self.target, timeout=30) as line:
            line.sendall(greeting)
            ros.receive_frame(line)
            line.sendall(request)
            receive_answer(line)


class Handler(socketserver.BaseRequestHandler):
    """Passes on one connection of a client: the header, then requests and their answers."""

    def handle(self):
        proxy = self.server
        with contextlib.suppress(OSError), socket.create_connection(proxy.target) as server:
            greeting = ros.receive_frame(self.request)
            server.sendall(greeting)
            self.request.sendall(ros.receive_frame(server))
            while True:
                request = ros.receive_frame(self.request)
                proxy.campaign.attempt("calls through the proxy")
                if proxy.one_in(CUT_BEFORE, "calls cut before they arrived"):
                    return
                if proxy.one_in(DELAY, f"calls delayed by {DELAY_S} s"):
                    time.sleep(DELAY_S)
                if proxy.one_in(REPEAT, "calls repeated at once"):
                    proxy.call_again(greeting, request, 0.0)
                if proxy.one_in(REPEAT_LATE, "calls repeated after later ones"):
                    threading.Thread(target=proxy.call_again, daemon=True,
                                     args=(greeting, request, DELAY_S)).start()
                server.sendall(request)
                answer = receive_answer(server)
                if proxy.one_in(CUT_AFTER, "answers lost"):
                    return
                self.request.sendall(answer)


def receive_answer(connection):
    """Returns the answer of a service: a byte that states success, then a frame."""
    return ros.receive(connection, 1) + ros.receive_frame(connection)


class Master(xmlrpc.server.SimpleXMLRPCServer):
    """Passes calls on to the real master, but returns addresses of proxies instead of services."""

    daemon_threads = True

    def __init__(self, campaign, uri):
        super().__init__(("127.0.0.1", 0), logRequests=False, allow_none=True)
        self.campaign = campaign
        self.real = uri
        self.proxies = {}
        self.register_instance(self)
        self.uri = f"http://127.0.0.1:{self.server_address[1]}"
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def _dispatch(self, method, arguments):
        answer = getattr(xmlrpc.client.ServerProxy(self.real), method)(*arguments)
        if method != "lookupService" or answer[0] != 1:
            return answer
        place = urllib.parse.urlparse(answer[2])
        target = (place.hostname, place.port)
        if target not in self.proxies:
            self.proxies[target] = Proxy(self.campaign, target)
        return [*answer[:2], f"rosrpc://127.0.0.1:{self.proxies[target].server_address[1]}"]


def undisturbed(ranch):
    """Disturbs nothing."""


def wait_until_training(ranch):
    """Waits for the end of the first episode."""
    metrics = ranch.folder / "run" / "metrics.csv"
    ranch.wait_for(lambda: metrics.exists() and metrics.read_bytes().count(b"\n") > 1, "an episode")


def stop(ranch, process, what):
    """Stops a process. Returns whether the training was still running; records a failure if not."""
    process.send_signal(signal.SIGSTOP)
    return ranch.campaign.check(ranch.processes[-1].poll() is None,
                                f"{what}: the training ended before; raise STEPS")


def stop_a_process(name):
    """Returns a disturbance that stops a process of a ranch for a while."""
    def disturb(ranch):
        wait_until_training(ranch)
        process = {"stop_sim": ranch.processes[1], "stop_trainer": ranch.processes[-1]}[name]
        if stop(ranch, process, name):
            time.sleep(ranch.campaign.stop_s)
            ranch.campaign.attempt(f"stops of {ranch.campaign.stop_s:g} s: {name}")
        process.send_signal(signal.SIGCONT)
    return disturb


def restart_master(ranch):
    """Restarts the master. The trainer is stopped meanwhile, so that it cannot end before the
    restart."""
    wait_until_training(ranch)
    trainer = ranch.processes[-1]
    if stop(ranch, trainer, "master"):
        ranch.processes[0].kill()
        ranch.processes[0].wait()
        ranch.processes[0] = ranch.start_master()
        ranch.processes.pop()  # start_master appends the master
        ranch.campaign.attempt("restarts of the master")
    trainer.send_signal(signal.SIGCONT)


DISTURBANCES = {"proxy": undisturbed, "stop_sim": stop_a_process("stop_sim"),
                "stop_trainer": stop_a_process("stop_trainer"), "master": restart_master}


def train(campaign, folder, kind):
    """Runs one training with a new sim node; returns its results, or None after a failure."""
    folder.mkdir()
    stop_s = campaign.stop_s if kind in ("stop_sim", "stop_trainer") else 0
    with ros.Ros(campaign, folder) as ranch:
        ranch.sim("aquafarm")
        master = Master(campaign, ranch.uri) if kind == "proxy" else None
        call_limit_s = 30 if kind == "master" else max(2, stop_s / 4)

        def start(*more):
            return ranch.train("aquafarm", "run", STEPS, f"_sim_timeout_s:={60 + 2 * stop_s:g}",
                               f"_call_limit_s:={call_limit_s:g}", *more,
                               uri=master.uri if master else None)

        process = start()
        DISTURBANCES.get(kind, undisturbed)(ranch)
        code = process.wait(timeout=LIMIT_S)
        deadlocks = 0
        # Each deadlock adds a line to the log. The training must then resume.
        while code == ros.SIM_LOST and ranch.log("run").count(DEADLOCK) > deadlocks:
            deadlocks += 1
            campaign.attempt("deadlocks of roscpp")
            code = start("_resume:=true").wait(timeout=LIMIT_S)
        campaign.check(code == 0, f"{kind}: exit code {code}: {ranch.log('run')[-1500:]}")
        return ranch.results("run") if code == 0 else None


def run(campaign):
    """Runs campaign.count disturbed trainings of the kinds in turn. If the count is 0, starts
    trainings for campaign.seconds. Ends early after a training that failed."""
    kinds = campaign.kinds(DISTURBANCES)
    with tempfile.TemporaryDirectory(prefix="aquafarm_network_") as place:
        place = pathlib.Path(place)
        expected = train(campaign, place / "plain", "plain")
        number = 0
        while expected and campaign.more(number):
            kind = kinds[number % len(kinds)]
            got = train(campaign, place / f"{kind}_{number}", kind)
            if got is None:
                return
            campaign.attempt(f"trainings compared: {kind}")
            for file, content in expected.items():
                campaign.check(got[file] == content, f"{kind}: {file} differs, seed {campaign.seed}")
            number += 1
