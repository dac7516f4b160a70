# SPDX-License-Identifier: BSD-3-Clause
"""Nodes read messages of other nodes only through CheckedStream (docs/security.md)."""
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Calls after which roscpp reads messages by itself.
UNCHECKED = re.compile(r"(?:\.|->)subscribe\s*[<(]|advertiseService\s*[<(]"
                       r"|[cC]lient_?(?:\.|->)call\(|ros::service::call\(|waitForMessage")
# The wrappers, and services whose requests have no arrays.
ALLOWED = {
    "aquafarm_sim/include/aquafarm_sim/checked_topics.h": ("node.subscribe(options)", "client.call("),
    "aquafarm_sim/include/aquafarm_sim/node/checked_service.h": ("node.advertiseService(options)",),
    "aquafarm_viz/src/node/replay_node.cpp": tuple(
        f'advertiseService("{name}"' for name in ("pause", "set_pace", "jump"))}


def unchecked(name, text):
    allowed = ALLOWED.get(name, ())
    return [f"{name}:{number}: {line.strip()}" for number, line in enumerate(text.splitlines(), 1)
            if UNCHECKED.search(line) and not any(call in line for call in allowed)]


def test_no_node_lets_roscpp_allocate_what_an_array_states():
    names = subprocess.run(["git", "-C", ROOT, "ls-files", "aquafarm_*.cpp", "aquafarm_*.h"],
                           capture_output=True, check=True, text=True).stdout.split()
    sources = [name for name in names if not {"test", "bench", "fuzz"} & set(name.split("/"))]
    assert len(sources) > 300
    found = [line for name in sources for line in unchecked(name, (ROOT / name).read_text())]
    assert not found, ("use aquafarm_sim::Subscribe and Call (checked_topics.h) or AdvertiseHelper "
                       "(node/checked_service.h) instead of\n" + "\n".join(found))


def test_requests_of_the_allowed_services_have_no_arrays():
    for service in ("Pause", "SetPace", "Jump"):
        text = (ROOT / "aquafarm_msgs" / "srv" / f"{service}.srv").read_text()
        request = re.sub(r"#.*", "", text.split("\n---")[0])
        assert "]" not in request, service


def test_the_pattern_finds_what_it_should():
    for line in ("node.subscribe<Spec>(", 'node_->subscribe("state", 1, &Node::On, this);',
                 'node.advertiseService("x", &Node::On, this);', "if (!client_.call(service))"):
        assert unchecked("x.cpp", line), line
    for line in ("aquafarm_sim::Subscribe<Spec>(node, name, 1, take);", "caller.Call<Pause>(name)",
                 "aquafarm_sim::Call(client, service);", "callback.call(params)"):
        assert not unchecked("x.cpp", line), line
