# SPDX-License-Identifier: BSD-3-Clause
"""Helpers of the tests of the sim node: its services by name, and topics with a timeout."""
import time

import rospy
from aquafarm_msgs import srv
from aquafarm_msgs.msg import FarmState

LIMIT_S = 60.0
SERVICES = {"command": srv.Command, "step": srv.Step, "reset": srv.Reset,
            "get_state": srv.GetState, "save_state": srv.SaveState, "load_state": srv.LoadState,
            "pause": srv.Pause, "set_disaster": srv.SetDisaster, "set_pace": srv.SetPace}
SHIP_SERVICES = {"move": srv.Move, "pickup": srv.Pickup, "drop_off": srv.DropOff}


def call(name, **fields):
    """Calls a service of the farm, or ship_<id>/…, with the given request fields."""
    service = SERVICES.get(name) or SHIP_SERVICES[name.split("/")[1]]
    rospy.wait_for_service(name, timeout=LIMIT_S)
    return rospy.ServiceProxy(name, service)(**fields)


def state(**fields):
    """Returns the current state of farm 0."""
    answer = call("get_state", **fields)
    assert answer.ok, answer.message
    return answer.state


def message(topic, kind, condition=lambda m: True):
    """Returns the first message on a topic that satisfies a condition; fails after LIMIT_S."""
    end = time.monotonic() + LIMIT_S
    while time.monotonic() < end:
        got = rospy.wait_for_message(topic, kind, timeout=LIMIT_S)
        if condition(got):
            return got
    raise AssertionError(f"nothing fitting came on {topic}")


class Recorder:
    """Collects a topic's messages."""

    def __init__(self, topic, kind):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=10000)

    def wait(self, condition, what):
        """Waits until the messages so far satisfy a condition."""
        end = time.monotonic() + LIMIT_S
        while time.monotonic() < end:
            if condition(self.messages):
                return
            time.sleep(0.02)
        raise AssertionError(f"timed out waiting for {what}; got {len(self.messages)} messages")


def states():
    """Returns a recorder of the topic state after its first message."""
    recorder = Recorder("state", FarmState)
    recorder.wait(len, "a first state")
    return recorder
