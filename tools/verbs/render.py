# SPDX-License-Identifier: BSD-3-Clause
"""./aquafarm render: draws pictures and videos of bags, with the choices of a policy if one is
given."""
import argparse
import os
import tempfile

from .workspace import WS, Refused, ensure_built, enter_ros, replace_by, run_child

VIDEOS = (".mp4", ".webm", ".gif")


def maps_of_values(words):
    """Returns the options with which bag_policy computes the maps that render draws."""
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--step", nargs="*", action="extend", default=[])
    parser.add_argument("--end", action="store_true")
    parser.add_argument("--every", default="1")
    parser.add_argument("--layers", default="")
    parser.add_argument("-o", "--output", default="")
    drawn, _ = parser.parse_known_args(words)
    if not {"values", "moves"} & set(drawn.layers.split(",")):
        return ["--values-every", "0"]
    if drawn.end:  # the last step is unknown here, so all steps get a map
        return ["--values-every", "1"]
    if drawn.output.lower().endswith(VIDEOS):
        return ["--values-every", drawn.every]
    return ["--values-at", *(drawn.step or ["0"])]


def without_policy(words):
    """Returns (value of --policy or None if it is not given, other arguments)."""
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--policy", nargs="?", const="")
    known, others = parser.parse_known_args(words)
    if known.policy == "":
        raise Refused("--policy: got nothing, expected a run folder or checkpoint")
    return known.policy, others


def render(words):
    policy, words = without_policy(words)
    if policy is not None and not (words and os.path.isfile(words[0])):
        raise Refused(f"render: got '{words[0] if words else ''}', expected the bag first: "
                      "render BAG -o FILE --policy P")
    ensure_built()
    enter_ros()
    program = WS / "devel/lib/aquafarm_viz/render"
    if policy is None:
        replace_by(program, *words)
    with tempfile.TemporaryDirectory() as folder:
        asked = f"{folder}/asked.bag"
        code = run_child([WS / "devel/lib/aquafarm_agents/bag_policy", words[0], policy, "-o", asked,
                          *maps_of_values(words[1:])])
        if code != 0:
            return code
        return run_child([program, asked, "--asked", *words])
