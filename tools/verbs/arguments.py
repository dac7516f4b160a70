# SPDX-License-Identifier: BSD-3-Clause
"""Checks the arguments that a user gives for a launch file, and adds defaults for missing ones."""
import datetime
import json
import os
import pathlib
import re
import sys

from .workspace import Refused, say

# Arguments whose value is a path. The path is made absolute, because nodes run in ROS_HOME. The
# value of an argument in PATHS_OR_NAMES is a path or the name of a shipped scenario or policy.
PATHS = ("run_dir", "record_dir", "report", "bag", "output", "human")
PATHS_OR_NAMES = ("policy", "init", "scenario")
FLAG = re.compile(r"[Tt]rue|[Ff]alse|0|1")
TRUE = re.compile(r"[Tt]rue|1")
NUMBER = re.compile(r"-?[0-9.]+([eE][-+]?[0-9]+)?")
FRACTION = re.compile(r".*\..*[1-9].*")
RECORD = re.compile(r"[Tt]rue|[Ff]alse|0|1|all|every:[1-9][0-9]*|best|worst|failures")
CHOICES = {"log": ("none", "tensorboard", "wandb"), "style": ("dark", "light")}
FLAGS = ("resume", "viz", "rviz", "headless", "paused", "loop")
COUNTS = re.compile(r"runs|jobs|ranks|farms|seed|start_episode|start_step|.*episodes")
NUMBERS = re.compile(r"speed|.*steps|.*_s|.*_hz")


def split(word):
    """Returns the name and the value of 'name:=value'."""
    name, is_set, value = word.partition(":=")
    if not is_set:
        raise Refused(f"got '{word}', expected name:=value")
    return name, value


def with_full_path(word):
    """Returns an argument, such as 'run_dir:=here', with its path made absolute if it has one."""
    name, value = split(word)
    looks_like_path = name in PATHS or (
        name in PATHS_OR_NAMES and ("/" in value or value.endswith((".yaml", ".py", ".zip")) or
                                    ".py:" in value))
    if looks_like_path and value not in ("", "auto", "none"):
        value = os.path.realpath(value)
    return f"{name}:={value}"


def check_value(launch, name, value):
    """Refuses a value for which roslaunch would print a page of XML or no message."""
    def expect(is_right, expected):
        if not is_right:
            raise Refused(f"{name}: got '{value}', expected {expected}")

    if name == "of":
        expect(value in ("sim", "train", "evaluate"), "sim, train or evaluate")
    elif name == "record":
        expect(RECORD.fullmatch(value), "all, every:N, best, worst, failures or false")
    elif name in CHOICES:
        expect(value in CHOICES[name], f"one of: {', '.join(CHOICES[name])}")
    elif name in FLAGS:
        expect(FLAG.fullmatch(value), "true or false")
    elif name == "bag" and launch == "replay" and not os.path.isfile(value):
        raise Refused(f"bag: there is no file {value}")
    elif COUNTS.fullmatch(name):
        expect(not FRACTION.fullmatch(value), "a whole number")
        expect(NUMBER.fullmatch(value), "a number")
    elif NUMBERS.fullmatch(name):
        expect(NUMBER.fullmatch(value), "a number")


def check_values(launch, words):
    given = dict(map(split, words))
    if launch == "replay" and "bag" not in given:
        raise Refused("replay: got no bag, expected bag:=FILE, for example a bag that "
                      "./aquafarm record wrote")
    for word in words:
        check_value(launch, *split(word))


def policy_of(ranch):
    """Returns the policy that plays a ranch if the user gives none: generalist for one agent (ship
    or self-propelled device), planner for several. Returns generalist for an unreadable file, which
    is refused later."""
    import yaml  # ./aquafarm setup installs it

    try:
        keys = yaml.safe_load(pathlib.Path(ranch).read_text(encoding="utf-8"))
        agents = (keys.get("ships") or {}).get("count", 1)
        devices = (keys.get("layout") or {}).get("devices") or {}
        agents += devices.get("self_propelled", 0)
        agents += sum(bool(site.get("self_propelled")) for site in devices.get("sites") or ())
        return "planner" if agents > 1 else "generalist"
    except (OSError, ValueError, AttributeError, TypeError, yaml.YAMLError):
        return "generalist"


def name_the_ranch(launch, words):
    """Returns the arguments, with names for those that need none: for evaluate and sim, RANCH.yaml
    becomes scenario:=RANCH.yaml; for evaluate, a run folder becomes policy:=FOLDER. If RANCH.yaml
    is given without a policy, adds the policy that policy_of returns."""
    named, ranch = [], None
    for word in words:
        if launch == "evaluate" and os.path.isfile(os.path.join(word, "run.json")):
            word = f"policy:={os.path.join('.', word)}"  # a value with / is a path
        if (launch in ("evaluate", "sim") and word.endswith(".yaml") and ":=" not in word
                and not word.startswith("-")):
            ranch = word
            word = f"scenario:={word}"
        named.append(word)
    if ranch and not any(word.startswith("policy:=") for word in words):
        named.append(f"policy:={policy_of(ranch)}")
    return named


def arguments_of_run(run):
    """Returns the arguments of train.launch with which a run was trained, as {name: value}. Leaves
    out arguments that the run folder does not record."""
    folder, values = pathlib.Path(run), {}
    if (folder / "scenario.yaml").is_file():
        values["scenario"] = f"{os.path.realpath(run)}/scenario.yaml"
    record = folder / "run.json"
    if not record.is_file():
        return values
    try:
        made = json.loads(record.read_text(encoding="utf-8"))
        # run.json records the argument `exploration` of train.launch as one of the options.
        options, start = made["options"].split(), "exploration="
        recorded = {name: str(made[name]) for name in ("algorithm", "seed", "farms", "credit")}
        recorded["options"] = " ".join(word for word in options if not word.startswith(start))
        recorded["exploration"] = "".join(
            word[len(start):] for word in options if word.startswith(start))
        # A line break, a quote or a substitution of roslaunch in a value could set other arguments.
        for name, value in recorded.items():
            if not value.isprintable() or "$(" in value or "'" in value:
                raise ValueError(f"{name}: got {value!r}, expected one line without $( and quotes")
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        # The program that reads the checkpoint refuses the run later.
        print(f"aquafarm: {record}: damaged: {error!r}", file=sys.stderr, flush=True)
        return values
    return {**values, **{name: value for name, value in recorded.items() if value}}


def newest_run():
    """Returns the run in ./runs with the newest checkpoint, or None."""
    found = [(path.stat().st_mtime, str(path.parents[1]))
             for path in pathlib.Path.cwd().glob("runs/*/checkpoints/step_*.ckpt")]
    return max(found)[1] if found else None


def defaults_of_training(launch, given, newest, now):
    """Returns defaults for the folders of a training and, if it resumes, the run's arguments."""
    taken = {}
    resumes = bool(TRUE.fullmatch(given.get("resume") or "false"))
    run = given.get("run_dir") or (resumes and newest) or f"{os.getcwd()}/runs/{now}"
    if not given.get("run_dir"):
        taken["run_dir"] = run
    if launch == "train" and resumes:
        of_run = arguments_of_run(run)
        # An algorithm that differs from the run's is refused later. The options of the run are left
        # out here; else the error message would be about them, not about the algorithm.
        is_other = given.get("algorithm") not in (None, "", of_run.get("algorithm"))
        for name, value in of_run.items():
            if given.get(name) or (is_other and name in ("options", "exploration")):
                continue
            if name == "exploration" and "exploration=" in given.get("options", ""):
                continue
            taken[name] = value
    if launch == "train" and not given.get("report") and run != "auto":
        taken["report"] = os.path.realpath(run)
    return taken


def default_arguments(launch, words):
    """Returns defaults for arguments that the user has not given, as {name: value}. Output folders
    are in the current folder, not in ROS_HOME."""
    given = {name: value for name, _, value in (word.partition(":=") for word in words)}
    now = datetime.datetime.now().strftime("%Y%m%d-%H%M%S")
    here, newest, taken = os.getcwd(), newest_run(), {}
    if launch == "train" or given.get("of") == "train":
        taken.update(defaults_of_training(launch, given, newest, now))
    if launch == "evaluate" and given.get("record") and not given.get("record_dir"):
        taken["record_dir"] = f"{here}/episodes"
    if launch == "play" and not given.get("record_dir"):
        taken["record_dir"] = f"{here}/played"
    if launch == "benchmark":
        if not given.get("output"):
            taken["output"] = f"{here}/benchmark"
        if not given.get("report"):
            taken["report"] = os.path.realpath(given.get("output") or "benchmark")
    if launch in ("sim", "replay") and not given.get("headless") and not os.environ.get("DISPLAY"):
        taken["headless"] = "true"  # there is no display
    if launch == "record" and not given.get("bag"):
        taken["bag"] = f"{here}/aquafarm_{now}.bag"
    policy = given.get("policy", "")
    if launch == "evaluate" and not policy:
        policy = taken["policy"] = newest or "generalist"
    # A policy plays on the ranch of its training. The run folder contains the scenario.
    if launch != "replay" and "/" in policy and not given.get("scenario"):
        path = pathlib.Path(policy)
        for folder in (path, path.parent, path.parent.parent):
            if (folder / "scenario.yaml").is_file():
                taken["scenario"] = f"{os.path.realpath(folder)}/scenario.yaml"
                break
    return taken


def with_defaults(launch, words, given_words):
    """Prints the defaults of the arguments that `given_words` lacks. Returns `words` followed by
    these defaults."""
    taken = [f"{name}:={value}" for name, value in default_arguments(launch, given_words).items()]
    for word in taken:
        say(f"taking {word}")
    return [*words, *taken]
