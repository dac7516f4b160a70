# SPDX-License-Identifier: BSD-3-Clause
"""Farms behind the ROS services of a sim node. Their arrays are bit-identical to those of
LocalFarms."""
from __future__ import annotations

import itertools
import os
import socket
import threading
import time
from typing import Any

import aquafarm_core as core
import numpy as np
import numpy.typing as npt
import rosgraph
import rospy
from aquafarm_msgs.msg import Outcome, StepResult
from aquafarm_msgs.srv import GetState, Reset, Step
from rospy.impl.tcpros_base import TCPROSTransport

from aquafarm_gym.farms import Farms, check_observation

RETRY_PERIOD_S: float = 0.1
MASTER_LIMIT_S: float = 5.0
BITS: dict[str, int] = {
    "index": StepResult.INDEX, "features": StepResult.FEATURES, "planes": StepResult.PLANES}


def check_master(limit_s: float) -> None:
    """Raises ConnectionError if the address of the ROS master accepts no connection within limit_s.
    Without this check, rospy waits forever."""
    uri = rosgraph.get_master_uri()
    try:
        host, port = rosgraph.network.parse_http_host_and_port(uri)
        socket.create_connection((host, port), timeout=limit_s).close()
    except (OSError, ValueError) as error:
        raise ConnectionError(f"no ROS master at {uri}: {error}") from error


class Service(rospy.ServiceProxy):  # type: ignore[misc]
    """A persistent service with a timeout for each call; rospy's ServiceProxy has no timeouts."""

    def __init__(self, name: str, kind: Any, limit_s: float) -> None:
        super().__init__(name, kind, persistent=True)
        self._limit_s = limit_s
        self.transport: Any

    def call(self, request: Any) -> Any:
        """Calls the service. Raises rospy.ServiceException if the call fails, or if the service
        sends nothing for limit_s."""
        try:
            if self.transport is None:
                self._connect(request)
            return super().call(request)
        except (rospy.ServiceException, rospy.exceptions.TransportException, OSError) as error:
            self.close()
            self.transport = None
            raise rospy.ServiceException(str(error)) from error

    def _connect(self, request: Any) -> None:
        uri = self._get_service_uri(request)
        transport = TCPROSTransport(self.protocol, self.resolved_name)
        transport.buff_size = self.buff_size
        # rospy reads the handshake without a timeout. At the limit, another thread shuts the socket
        # down.
        watch = threading.Timer(self._limit_s, lambda: transport.socket.shutdown(socket.SHUT_RDWR))
        watch.daemon = True
        watch.start()
        try:
            transport.connect(*rospy.core.parse_rosrpc_uri(uri), uri, timeout=self._limit_s)
        finally:
            watch.cancel()
        transport.socket.settimeout(self._limit_s)
        self.transport = transport


class RosFarms(Farms):
    """Farms behind the sim node of a namespace.

    The constructor, reset and step call services. They repeat a call if there is no response, or if
    the node is paused or shutting down, or if another node claims the ships. After wait_limit_s,
    they raise ConnectionError. If the node refuses a call for another reason, they raise
    ValueError. A repeated step or reset has the same sequence number, so that no farm steps twice.
    step also raises ConnectionError if the sim node was restarted or another client changed the
    farms.
    """

    yaml: str

    def __init__(self, namespace: str = "/aquafarm", farms: int = 1,
                 observation: str = "features", hashes: bool = False, wait_limit_s: float = 20.0,
                 call_limit_s: float = 30.0) -> None:
        if not rospy.core.is_initialized():
            check_master(min(wait_limit_s, MASTER_LIMIT_S))
            rospy.init_node("aquafarm_gym", anonymous=True, disable_signals=True)
        self._limit_s = wait_limit_s
        self._services = {name: Service(f"{namespace}/{name}", kind, call_limit_s)
                          for name, kind in (("step", Step), ("reset", Reset),
                                             ("get_state", GetState))}
        spec = self._call("get_state", farm=0, with_spec=True).spec
        check_observation(observation, spec.state_count, spec.scenario_name)
        self.yaml = spec.scenario_yaml
        scenario = core.Scenario.parse(self.yaml, spec.scenario_name)
        # This batch never steps. Only its buffers are used; _take fills them.
        arrays = core.FarmBatch(
            scenario, farms,
            write=["rewards", "outcomes", "legal", "active", "end_reasons", "is_first", observation]
            + (["hashes"] if hashes else []))
        super().__init__(scenario, farms, spec.state_count, arrays.feature_names)
        self.buffers: dict[str, npt.NDArray[Any]] = arrays.buffers
        self._observation_types = BITS[observation] | (StepResult.HASHES if hashes else 0)
        # The first sequence number is random, so that the numbers differ from those of earlier
        # clients.
        self._sequence = itertools.count(int.from_bytes(os.urandom(7), "little") + 1)
        self._state_id: int | None = None  # of the last response; None if a reset is needed
        self._finished: list[dict[str, Any]] = []

    def reset(self, seed: int, first_episode: int = 0) -> None:
        """See FarmBatch.reset."""
        self._state_id = None
        answer = self._call("reset", has_seed=True, seed=seed, has_episode=True,
                            episode=first_episode, farms=self.farms,
                            observation_types=self._observation_types,
                            sequence=next(self._sequence))
        self._take(answer.result)

    def step(self, actions: npt.NDArray[np.uint8]) -> None:
        """See FarmBatch.step."""
        if self._state_id is None:
            raise ValueError("step: got no reset before, expected one; call reset first")
        answer = self._call("step", sequence=next(self._sequence), actions=actions.tobytes(),
                            observation_types=self._observation_types, state_id=self._state_id)
        self._take(answer.result)

    def finished(self) -> list[dict[str, Any]]:
        """See FarmBatch.finished."""
        return self._finished

    def close(self) -> None:
        """Closes the connections."""
        for service in self._services.values():
            service.close()

    def _take(self, result: Any) -> None:
        for name, array in self.buffers.items():
            got = getattr(result, name)
            flat = np.frombuffer(got, np.uint8) if isinstance(got, bytes) else got
            array.reshape(-1)[:] = flat
        self._state_id = result.state_id
        self._finished = [
            {**{key: getattr(one, key) for key in core.NO_EPISODE},
             "reason": core.REASONS[one.reason], "success": bool(one.success)}
            for one in result.finished]

    def _call(self, name: str, **fields: Any) -> Any:
        service = self._services[name]
        end = time.monotonic() + self._limit_s
        while True:
            try:
                answer = service.call(service.request_class(**fields))
                if answer.ok:
                    return answer
                why = answer.message
                if answer.code == Outcome.STALE:
                    self._state_id = None
                    raise ConnectionError(f"sim node: its farms changed ({why}); reset to continue")
                if answer.code not in (Outcome.PAUSED, Outcome.CLAIMED, Outcome.SHUTTING_DOWN):
                    raise ValueError(f"sim node: {name} refused: {why}")
            except rospy.ServiceException as error:
                why = str(error)
            if rospy.is_shutdown() or time.monotonic() > end:
                raise ConnectionError(f"sim node: no answer from {service.resolved_name} for "
                                      f"{self._limit_s:g} s: {why}")
            time.sleep(RETRY_PERIOD_S)
