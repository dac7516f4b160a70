# SPDX-License-Identifier: BSD-3-Clause
"""./aquafarm bench: measures speed, and compares it with references measured in the same run."""
import os
import re
import subprocess
import sys

from .workspace import (PYTHON, ROOT, WS, bootstrap, build_core, ensure_built, enter_ros, program,
                        run_child, say)

# The last Stable-Baselines3 that works with Debian 12's python3-torch, and a Gymnasium for it.
WANTED = ("gymnasium==1.0.0", "stable-baselines3==2.4.1", "sb3-contrib==2.4.0",
          "farama-notifications", "cloudpickle")
FIGURE = re.compile(r"[a-z][a-z0-9_]* -?[0-9][0-9.e+-]* ")


def show(command, out=None, env=None):
    """Runs a command, shows its output and returns its lines. If `out` is given, also writes the
    output to this file. Ends this process if the command fails."""
    lines = []
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, text=True,
                          env=env) as child:
        for line in child.stdout:
            print(line, end="", flush=True)
            lines.append(line)
    if out is not None:
        out.write_text("".join(lines), encoding="utf-8")
    if child.returncode != 0:
        sys.exit(child.returncode if child.returncode > 0 else 128 - child.returncode)
    return lines


def reference_python():
    """Returns the Python of a virtual environment that contains the packages WANTED. Makes the
    environment if it does not exist or was made for other packages. Returns None if the packages
    cannot be installed, for example because PyPI is not accessible."""
    venv, log = WS / "bench_venv", WS / "bench_venv.log"
    ready = venv / "ready"
    if not ready.is_file() or ready.read_text(encoding="utf-8") != " ".join(WANTED):
        commands = ([PYTHON, "-m", "venv", "--clear", "--system-site-packages", venv],
                    [venv / "bin/pip", "install", "-q", "--no-deps", "--timeout", "20", *WANTED])
        with open(log, "w", encoding="utf-8") as words:
            if any(run_child(command, stdout=words, stderr=words) != 0 for command in commands):
                say(f"no ratios to references: PyPI cannot provide their packages; see {log}")
                return None
        ready.write_text(" ".join(WANTED), encoding="utf-8")
    return venv / "bin/python"


def compare(script, *words, **variables):
    """Runs a program of tools/ that compares figures with references from PyPI. Returns the lines
    of its output, or an empty list if reference_python returns None."""
    python = reference_python()
    if python is None:
        return []
    return show([python, ROOT / "tools" / script, *words],
                env=dict(os.environ, OMP_NUM_THREADS="1", **variables))


def of_core(core, name, *options, reference=None):
    """Runs the benchmark `name` of a core, then its reference of tools/bench_reference.py, if
    any. reference: name for the output file, and argument of tools/bench_reference.py."""
    build_core(core)
    kind = reference and WS / f"bench_{reference[0]}.txt"
    lines = show([program(name), *options], kind)
    if reference:
        lines += compare("bench_reference.py", reference[1], kind)
    return lines


def ppo():
    """Runs the benchmark of PPO, then references that train on the same ranch with aquafarm_gym."""
    build_core("aquafarm_agents")
    build_core("aquafarm_gym")
    out = WS / "bench_ppo.txt"
    lines = show([program("bench_ppo")], out)
    packages = f"{WS}/core/aquafarm_gym:{ROOT}/aquafarm_gym/python"
    return lines + compare("bench_ppo.py", out, PYTHONPATH=packages)


def ranks():
    """Compares trainings of two and four ranks with a training of one rank and with a model of the
    cost."""
    build_core("aquafarm_agents")
    return show([PYTHON, ROOT / "tools/bench_ranks.py", program("aquafarm_train")])


def through_ros(command):
    ensure_built()
    enter_ros()
    return show(command())


BENCHES = {
    "sim": lambda: of_core("aquafarm_sim", "bench_sim", reference=("sim", "taxi")),
    "import": lambda: of_core("aquafarm_sim", "bench_import"),
    "tabular": lambda: of_core("aquafarm_agents", "bench_tabular", reference=("tabular", "numpy")),
    "planner": lambda: of_core("aquafarm_agents", "bench_planner"),
    "dqn": lambda: of_core("aquafarm_agents", "bench_deep", "--benchmark_filter=^Dqn",
                           reference=("dqn", "sb3")),
    "lstm": lambda: of_core("aquafarm_agents", "bench_deep", "--benchmark_filter=^LstmDqn",
                            reference=("lstm", "torch")),
    "ppo": ppo,
    "ranks": ranks,
    "ros": lambda: through_ros(lambda: [program("ros_bench")]),
    "agents": lambda: through_ros(lambda: [PYTHON, ROOT / "tools/bench_agents.py"]),
    "recording": lambda: through_ros(lambda: [PYTHON, ROOT / "tools/bench_recording.py"]),
}


def bench(name):
    """Runs the benchmark of this name. None: runs all, then prints every figure again."""
    bootstrap("setup")
    if name is not None:
        BENCHES[name]()
        return 0
    lines, out = [], WS / "bench_all.txt"
    for run in BENCHES.values():
        lines += run()
        out.write_text("".join(lines), encoding="utf-8")  # kept if a later benchmark fails
    say(f"all figures, also in {out}:")
    print("".join(line for line in lines if FIGURE.match(line)), end="")
    return 0
