#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every launch file parses, documents its arguments and stays on the loopback address. Every node
describes itself. Every field of a message has a comment."""
import http.server
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import unittest
import xml.etree.ElementTree as ElementTree
from unittest import mock

import roslaunch.config
import roslib.packages
import rospkg
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import load_script, program  # noqa: E402

PACKAGE = "aquafarm_bringup"
LAUNCH = pathlib.Path(rospkg.RosPack().get_path(PACKAGE)) / "launch"
LIMIT_S = 60
FILES = sorted(LAUNCH.rglob("*.launch"))
ARGUMENTS = {"replay": ["bag:=/tmp/none.bag"], "evaluate": ["policy:=random"]}
VARIANTS = {
    "train": [["run_dir:=/tmp/run", "resume:=true", "rviz:=true"], ["viz:=false"]],
    "agents": [["scenario:=four_squads", "ships:=4", "pace:=paced"], ["ships:=0"]],
    "agent": [["ship:=3", "episodes:=2"]],
    "sim": [["headless:=true"], ["policy:=random"]],
    "record": [["of:=train"], ["of:=evaluate", "bag:=/tmp/day.bag"], ["policy:=none"]],
    "plan": [["scenario:=two_squads", "bulletin:=in", "devices:=d.csv", "ships_file:=/s.csv"],
             ["sim:=true", "headless:=true", "scenario:=my/ranch.yaml", "policy:=planner",
              "storm:=/s.txt", "storm_name:=0903", "at:=2021-07-24T12:00:00Z"]],
    "replay": [["bag:=/tmp/none.bag", "headless:=true", "loop:=true"],
               ["bag:=/tmp/none.bag", "policy:=random", "start_step:=17"]],
}


def load(path, arguments):
    """Returns roslaunch's configuration of a launch file with the given name:=value arguments."""
    return roslaunch.config.load_config_default([(str(path), list(arguments))], None, verbose=False,
                                                assign_machines=False)


NODES = {"aquafarm_sim": ("sim_node", "bulletin_node"),
         "aquafarm_agents": ("train_node", "policy_node", "plan_node"),
         "aquafarm_viz": ("replay_node", "viz_node")}


class NodesTest(unittest.TestCase):

    def test_every_node_has_a_help_that_needs_no_master(self):
        environment = dict(os.environ, ROS_MASTER_URI="http://127.0.0.1:1")
        for package, names in NODES.items():
            for name in names:
                for option in ("--help", "-h"):
                    done = subprocess.run([program(package, name), "_a:=1", option], text=True,
                                          capture_output=True, env=environment, timeout=LIMIT_S,
                                          check=False)
                    self.assertEqual((0, ""), (done.returncode, done.stderr), name)
                    self.assertTrue(done.stdout.startswith(f"usage: rosrun {package} {name} "))
                for launch in re.findall(r"^(\w+)\.launch", done.stdout, re.MULTILINE):
                    self.assertIn(launch, [path.stem for path in FILES], name)


class LaunchFilesTest(unittest.TestCase):

    def test_the_launch_files_are_there(self):
        names = {path.stem for path in FILES}
        self.assertLessEqual({"train", "evaluate", "benchmark", "plan", "sim", "play", "record",
                              "replay", "agents", "agent", "ranks"}, names)

    def test_every_argument_says_what_it_is_and_has_a_default(self):
        for path in FILES:
            for argument in ElementTree.parse(path).getroot().findall("arg"):
                if argument.get("value"):
                    continue  # derived from others; users cannot set it
                where = f"{path.name}: {argument.get('name')}"
                self.assertGreater(len(argument.get("doc") or ""), 15, where)
                if where not in ("replay.launch: bag", "evaluate.launch: policy"):
                    self.assertTrue(argument.get("default"), where)

    def test_every_file_and_variant_parses(self):
        for path in FILES:
            variants = [ARGUMENTS.get(path.stem, [])] + VARIANTS.get(path.stem, [])
            for arguments in variants:
                with self.subTest(file=path.name, arguments=arguments):
                    config = load(path, arguments)
                    self.assertEqual([], config.config_errors)

    def test_roslaunch_refuses_an_argument_that_does_not_exist(self):
        for name, argument, hint in (("train", "algorthm:=sarsa", "algorithm"),
                                     ("sim", "polcy:=random", "policy"),
                                     ("plan", "buletin:=x", "bulletin")):
            done = subprocess.run(["roslaunch", PACKAGE, f"{name}.launch", argument],
                                  capture_output=True, text=True, timeout=LIMIT_S, check=False)
            self.assertNotEqual(0, done.returncode, done.stdout)
            self.assertIn(f"{name}.launch has no argument '{argument.split(':=')[0]}' "
                          f"(did you mean '{hint}'?); it has: ", done.stderr)
            self.assertNotIn("process[", done.stdout, "a node was started")

    def test_roslaunch_refuses_the_port_of_another_program_than_a_master(self):
        with http.server.HTTPServer(("127.0.0.1", 0), http.server.BaseHTTPRequestHandler) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            self.addCleanup(server.shutdown)
            uri = f"http://127.0.0.1:{server.server_address[1]}"
            for before, by_environment in ((["-p", str(server.server_address[1])], False), ([], True)):
                done = subprocess.run(
                    ["roslaunch", *before, PACKAGE, "sim.launch", "headless:=true"],
                    capture_output=True, text=True, timeout=LIMIT_S, check=False,
                    env=dict(os.environ, ROS_MASTER_URI=uri) if by_environment else None)
                self.assertNotEqual(0, done.returncode, done.stdout)
                self.assertIn(f"aquafarm: ROS_MASTER_URI: got {uri}, where a program that is not a ROS "
                              "master listens; ", done.stderr)

    def test_no_service_takes_the_name_of_a_file(self):
        services = list((pathlib.Path(rospkg.RosPack().get_path("aquafarm_msgs")) / "srv").iterdir())
        self.assertGreater(len(services), 10)
        for path in services:
            for line in path.read_text().split("---")[0].splitlines():
                field = line.partition("#")[0].split()
                if len(field) < 2 or field[0] != "string":
                    continue
                self.assertNotRegex(field[1], "file|path|folder|dir|bag", path.name)

    def test_check_arguments_takes_what_the_file_has(self):
        check = LAUNCH.parent / "scripts" / "check_arguments"
        for words, code in ((["seed:=3", "__name:=x"], 0), (["sed:=3"], 2), ([], 0)):
            done = subprocess.run([check, LAUNCH / "train.launch", *words], capture_output=True,
                                  text=True, timeout=LIMIT_S, check=False)
            self.assertEqual(code, done.returncode, done.stderr)

    def test_the_port_of_roslaunch_is_found_in_each_of_its_forms(self):
        check = load_script("check_arguments")
        with mock.patch.dict("os.environ", ROS_MASTER_URI="http://host:7"):
            for words, expected in (("-p 11312 x.launch", "http://127.0.0.1:11312"),
                                    ("-p11312 x.launch", "http://127.0.0.1:11312"),
                                    ("--port 11312 x.launch", "http://127.0.0.1:11312"),
                                    ("x.launch --port=11312", "http://127.0.0.1:11312"),
                                    ("-p 1 x.launch -p2", "http://127.0.0.1:2"),
                                    ("x.launch port:=3 -pid", "http://host:7")):
                self.assertEqual(expected, check.master_of_roslaunch(
                    ["python3", "roslaunch", *words.split(), ""]), words)

    def test_every_ship_gets_a_node_of_its_own(self):
        nodes = load(LAUNCH / "agents.launch", ["scenario:=four_squads", "ships:=4"]).nodes
        self.assertEqual([f"agent_{ship}" for ship in range(4)],
                         sorted(node.name for node in nodes if node.name.startswith("agent_")))

    def load_on_machine(self, machine, launch, **arguments):
        """Returns the configuration of a launch file whose nodes run on another host."""
        given = "".join(f'<arg name="{name}" value="{value}"/>' for name, value in arguments.items())
        with tempfile.NamedTemporaryFile("w", suffix=".launch") as file:
            file.write(f"""<launch>
              <machine name="{machine}" address="10.0.0.11" env-loader="/opt/ranch/env.sh" user="crew"/>
              <include file="{LAUNCH / launch}">
                {given} <arg name="machine" value="{machine}"/>
              </include>
            </launch>""")
            file.flush()
            config = load(file.name, [])
        self.assertEqual([], config.config_errors)
        return config

    def test_an_agent_can_be_placed_on_another_host(self):
        config = self.load_on_machine("boat", "agent.launch", ship=1)
        self.assertEqual(["boat"], [node.machine_name for node in config.nodes])

    def test_every_rank_gets_a_trainer_and_a_sim_node(self):
        config = load(LAUNCH / "ranks.launch", ["ranks:=4", "farms:=64"])
        self.assertEqual(sorted(f"/aquafarm/rank_{rank}/{name}" for rank in range(4)
                                for name in ("sim", "train")),
                         sorted(node.namespace + node.name for node in config.nodes))
        for node in config.nodes:
            if node.name != "train":
                continue
            rank = int(node.namespace.strip("/")[-1])
            variables = dict(node.env_args)
            self.assertEqual((str(rank), "4", "127.0.0.1"), tuple(
                variables[name] for name in ("RANK", "WORLD_SIZE", "MASTER_ADDR")))
            self.assertEqual(rank == 0, node.required)
        values = {name: parameter.value for name, parameter in config.params.items()}
        self.assertEqual((16, 64), (values["/aquafarm/rank_3/sim/farms"],
                                    values["/aquafarm/rank_3/train/farms"]))

    def test_ranks_can_be_placed_on_another_host(self):
        config = self.load_on_machine("node2", "ranks.launch", ranks=4, first_rank=1, count=2)
        self.assertEqual({"/aquafarm/rank_1/", "/aquafarm/rank_2/"},
                         {node.namespace for node in config.nodes})
        for node in config.nodes:
            self.assertEqual("node2", node.machine_name)
            self.assertNotIn("ROS_IP", dict(node.env_args), "env-loader sets it")

    def test_every_node_is_bound_to_the_loopback_address(self):
        for path in FILES:
            for node in load(path, ARGUMENTS.get(path.stem, [])).nodes:
                with self.subTest(file=path.name, node=node.name):
                    self.assertEqual("127.0.0.1", dict(node.env_args).get("ROS_IP"))

    def test_every_node_has_an_executable(self):
        for path in FILES:
            for arguments in [ARGUMENTS.get(path.stem, [])] + VARIANTS.get(path.stem, []):
                for node in load(path, arguments).nodes:
                    with self.subTest(file=path.name, node=node.name):
                        self.assertTrue(roslib.packages.find_node(node.package, node.type),
                                        f"{node.package}/{node.type}")

    def test_kept_episodes_lie_in_the_folder_of_the_run(self):
        for arguments in (["record:=best"], ["record:=best", "run_dir:=auto"],
                          ["record:=best", "run_dir:=/tmp/a run"]):
            parameters = load(LAUNCH / "train.launch", arguments).params
            value = {name: parameter.value for name, parameter in parameters.items()}
            self.assertEqual(value["/aquafarm/train/run_dir"] + "/episodes",
                             value["/aquafarm/sim/keep_dir"])

    def test_a_run_without_a_folder_gets_a_new_one_under_one_name(self):
        for name, *arguments in (("train",), ("train", "run_dir:=auto"), ("record", "of:=train"),
                                 ("record", "of:=train", "run_dir:=auto")):
            with self.subTest(file=name, arguments=arguments):
                parameters = load(LAUNCH / f"{name}.launch", arguments).params
                run = parameters["/aquafarm/train/run_dir"].value
                self.assertRegex(run, r"^runs/run_\w+$")
                self.assertEqual(run + "/episodes", parameters["/aquafarm/sim/keep_dir"].value)

    def test_trainings_and_benchmarks_end_with_the_report_of_their_own_folder(self):
        def made_of(name, *arguments):
            prefixes = [node.launch_prefix for node in load(LAUNCH / name, arguments).nodes]
            return re.findall("--report='(.*?)'", " ".join(filter(None, prefixes)))

        for arguments in ([], ["run_dir:=auto"]):
            self.assertRegex(made_of("train.launch", *arguments)[0], r"^runs/run_\w+$")
        self.assertEqual(["/tmp/run"], made_of("train.launch", "run_dir:=/tmp/run"))
        recorded = ("record.launch", "of:=train", "run_dir:=/tmp/run")
        self.assertEqual(["none"], made_of(*recorded))
        self.assertEqual(["/tmp/run"], made_of(*recorded, "report:=/tmp/run"))
        self.assertEqual(["none"], made_of("train.launch", "report:=none"))
        self.assertEqual(["benchmark"], made_of("benchmark.launch"))

    def test_plan_takes_files_from_the_folder_of_roslaunch(self):
        def values(*arguments):
            parameters = load(LAUNCH / "plan.launch", arguments).params
            return {name.rsplit("/", 1)[1]: parameter.value
                    for name, parameter in parameters.items() if "/plan/" in name}

        here = os.environ["PWD"]
        plan = values("scenario:=my_ranch.yaml", "bulletin:=in", "storm_name:=0903")
        self.assertEqual((f"{here}/my_ranch.yaml", f"{here}/in", "0903", ""),
                         tuple(plan[name] for name in ("scenario", "bulletin", "storm_name",
                                                       "devices")))
        self.assertEqual("two_squads", values("scenario:=two_squads")["scenario"])
        self.assertEqual("", values("scenario:=two_squads", "sim:=true")["scenario"])
        self.assertEqual("", values()["scenario"])

    def test_curves_are_written_only_if_asked_for(self):
        for arguments, expected in (([], False), (["log:=none"], False), (["log:=tensorboard"], True)):
            nodes = load(LAUNCH / "train.launch", arguments).nodes
            self.assertEqual(expected, "log_curves" in [node.type for node in nodes], arguments)

    def test_replay_runs_no_farm(self):
        nodes = load(LAUNCH / "replay.launch", ["bag:=/tmp/none.bag"]).nodes
        self.assertEqual({("aquafarm_viz", "viz_node"), ("rviz", "rviz"),
                          ("aquafarm_bringup", "replay")},
                         {(node.package, node.type) for node in nodes})

    def test_rviz_is_absent_from_training_and_headless_running(self):
        for name, arguments in (("train", []), ("sim", ["headless:=true"]), ("record", [])):
            nodes = load(LAUNCH / f"{name}.launch", arguments).nodes
            self.assertNotIn("rviz", [node.type for node in nodes], name)


class MessagesTest(unittest.TestCase):

    def test_every_field_says_what_it_is(self):
        folder = pathlib.Path(rospkg.RosPack().get_path("aquafarm_msgs"))
        files = sorted([*folder.glob("msg/*.msg"), *folder.glob("srv/*.srv")])
        self.assertGreater(len(files), 30)
        for path in files:
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                field, _, comment = line.partition("#")
                if field.strip() not in ("", "---") and "=" not in field:  # constants have names
                    self.assertTrue(comment.strip(), f"{path.name}:{number}: {line}")


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "launch_files", "launch_files_test", sys.argv)
