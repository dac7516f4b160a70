# SPDX-License-Identifier: BSD-3-Clause
"""./aquafarm train with ranks:=N: a training in several processes of this machine, without ROS."""
from . import arguments
from .launch import report_end
from .workspace import WS, Refused, ensure_built, enter_ros, run_child

# For each argument of the verb, the option of aquafarm_train. LEFT_OUT contains the value of an
# argument for which the option is left out.
OPTIONS = {"ranks": "--ranks", "algorithm": "--algorithm", "episodes": "--episodes",
           "steps": "--steps", "farms": "--farms", "seed": "--seed", "credit": "--credit",
           "exploration": "--exploration", "init": "--init", "run_dir": "--run-dir",
           "checkpoint_period_s": "--checkpoint-period", "evaluation_episodes": "--evaluate",
           "random_episodes": "--random"}
LEFT_OUT = {"exploration": "auto", "init": "none"}


def program_arguments(words):
    """Returns the arguments of aquafarm_train, and the folder of the report (None: no report)."""
    scenario, report, options = "paper", None, []
    for word in words:
        name, value = arguments.split(arguments.with_full_path(word))
        if name == "scenario":
            scenario = value
        elif name == "report":
            report = None if value == "none" else value
        elif name == "options":
            options += [part for option in value.split() if value != "none"
                        for part in ("--set", option)]
        elif name == "resume":
            options += ["--resume"] if arguments.TRUE.fullmatch(value) else []
        elif name == "run_dir" and value == "auto":
            continue  # aquafarm_train creates a folder
        elif name in OPTIONS:
            options += [OPTIONS[name], value] if value != LEFT_OUT.get(name) else []
        else:
            raise Refused(
                f"{name}: got this argument with ranks, expected only: scenario, algorithm, "
                "episodes, steps, farms, seed, credit, exploration, options, init, run_dir, resume, report, "
                "checkpoint_period_s, evaluation_episodes, random_episodes; ranks train without ROS")
    return [scenario, *options], report


def train(words):
    given = arguments.with_defaults("train", words, words)
    if not any(word.startswith("algorithm:=") for word in given):
        given.append("algorithm:=ppo")
    arguments.check_values("train", given)
    options, report = program_arguments(given)
    ensure_built()
    code = run_child([WS / "devel/lib/aquafarm_agents/aquafarm_train", *options], goes_on=True)
    if code == 0 and report is not None:
        enter_ros()
        code = run_child(["rosrun", "aquafarm_bringup", "make_report", report])
    return report_end("train", code)
