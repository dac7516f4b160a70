#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a Python policy for an aquafarm program, which starts this process.

    serve_policy.py SOCKET POLICY

POLICY is either FILE.zip, a model saved by Stable-Baselines3 or sb3-contrib, or it is FILE.py or
FILE.py:FUNCTION with a function of this form (FUNCTION is `act` by default):

    OBSERVATION = "features"            # or "planes" or "index"; default: "features"

    def act(observations, masks):       # [n, …] and int8 [n, 10]; 1: legal
        return actions                  # [n], each in [0, 9]

The function is called once per step with the observations of all n agents of the farms that step
together. It must not keep a state, because several threads of the program may play different farms
at the same time.

SOCKET is the file descriptor of a socket. Numbers have the byte order of the machine. First this
process writes one line: the kind of observations, or an error. Then it reads, for each request,

    u32 n, shape[3] | n observations (float32, uint8 or uint32) | n masks (u16, bit a: action a)

where shape is the shape of an observation, padded with ones to three numbers. It responds with

    u32 0 | n actions (u8)          or an error:   u32 length in bytes | text

This process ends when the program closes the socket.
"""
import importlib.util
import json
import os
import pathlib
import signal
import socket
import sys
import zipfile

import numpy as np

TYPES = {"features": np.float32, "planes": np.uint8, "index": np.uint32}
ACTIONS = 10
MAX_WORDS = 4000  # bytes of an error; the program reads at most 4,096

# For the module of a saved model's policy class: the package and the class that load the model.
MODELS = {
    "stable_baselines3.common.policies": ("stable_baselines3", "PPO"),  # also A2C
    "stable_baselines3.dqn.policies": ("stable_baselines3", "DQN"),
    "sb3_contrib.common.maskable.policies": ("sb3_contrib", "MaskablePPO"),
    "sb3_contrib.qrdqn.policies": ("sb3_contrib", "QRDQN"),
}


class BadPolicy(Exception):
    """The policy cannot be used. The message is one line."""


def load_function(path, name):
    """Returns the kind of observations and the function `name` of a Python file. Raises
    BadPolicy."""
    if not path.is_file():
        raise BadPolicy(f"got no file {path}, expected a Python file with {name}(observations, masks)")
    sys.path.insert(0, str(path.parent))
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    act = getattr(module, name, None)
    if not callable(act):
        raise BadPolicy(f"has no function {name}, expected {name}(observations, masks)")
    kind = getattr(module, "OBSERVATION", "features")
    if kind not in TYPES:
        raise BadPolicy(f"OBSERVATION: got {kind!r}, expected one of: {', '.join(TYPES)}")
    return kind, act


def load_model(path):
    """Returns the kind of observations and the function of a model that Stable-Baselines3 or
    sb3-contrib saved. Raises BadPolicy."""
    try:
        with zipfile.ZipFile(path) as archive:
            module = json.loads(archive.read("data"))["policy_class"]["__module__"]
    except (OSError, KeyError, TypeError, ValueError, zipfile.BadZipFile) as error:
        raise BadPolicy(f"is not a model of Stable-Baselines3 ({error})") from None
    if module not in MODELS:
        raise BadPolicy(f"got a model with a policy of {module}, expected one of: "
                        f"{', '.join(MODELS)}; write a function act(observations, masks) for others")
    package, name = MODELS[module]
    try:
        model = getattr(importlib.import_module(package), name).load(path, device="cpu")
    except ImportError as error:
        raise BadPolicy(f"needs {package} ({error}); set AQUAFARM_PYTHON to a Python that has it, or "
                        "activate its virtual environment") from None
    shape, masked = getattr(model.observation_space, "shape", None), name == "MaskablePPO"
    kinds = {0: "index", 1: "features", 3: "planes"}
    if shape is None or len(shape) not in kinds:
        raise BadPolicy(f"got a model for observations of {model.observation_space}, expected "
                        "features, planes or index")

    def act(observations, masks):
        if observations.shape[1:] != shape:
            raise BadPolicy(f"got observations of shape {observations.shape[1:]}, expected {shape}: "
                            "the ranch differs from that of its training")
        options = {"action_masks": masks} if masked else {}
        return model.predict(observations, deterministic=True, **options)[0]

    return kinds[len(shape)], act


def load(where):
    """Returns the kind of observations and the function of a policy. Raises BadPolicy."""
    if where.endswith(".zip"):
        return load_model(pathlib.Path(where))
    file, colon, name = where.rpartition(":")
    if not colon or not file.endswith(".py"):
        file, name = where, "act"
    return load_function(pathlib.Path(file), name)


def choose(act, kind, shape, observations, masks):
    """Calls the function and returns the actions as bytes. Raises BadPolicy if the function returns
    anything other than one integer in [0, 9] per observation."""
    shape = {"features": shape[:1], "planes": shape, "index": ()}[kind]
    observations = np.frombuffer(observations, TYPES[kind]).reshape(-1, *shape)
    if kind == "index":
        observations = observations.astype(np.int64)
    bits = np.frombuffer(masks, np.uint16)[:, None] >> np.arange(ACTIONS)
    actions = np.asarray(act(observations, (bits & 1).astype(np.int8)))
    count = len(observations)
    if actions.shape != (count,) or not np.issubdtype(actions.dtype, np.integer):
        raise BadPolicy(f"act: got {actions.dtype} of shape {actions.shape}, expected integers of "
                        f"shape ({count},)")
    if count and not 0 <= actions.min() <= actions.max() < ACTIONS:
        raise BadPolicy(f"act: got actions in [{actions.min()}, {actions.max()}], expected [0, 9]")
    return actions.astype(np.uint8).tobytes()


def words_of(error):
    """Returns the message of an exception as one line of at most MAX_WORDS bytes."""
    text = str(error) if isinstance(error, BadPolicy) else f"{type(error).__name__}: {error}"
    words = " ".join(text.split()).encode(errors="replace")[:MAX_WORDS]
    return words.decode(errors="ignore").encode()  # drops an incomplete last character


def serve(stream, kind, act):
    """Answers requests until the end of the input."""
    while True:
        header = stream.read(16)
        if len(header) < 16:
            return
        count, *shape = (int(number) for number in np.frombuffer(header, np.uint32))
        size = count * int(np.prod(shape)) * np.dtype(TYPES[kind]).itemsize
        observations, masks = stream.read(size), stream.read(2 * count)
        try:
            answer = np.uint32(0).tobytes() + choose(act, kind, shape, observations, masks)
        except Exception as error:  # any error of the policy is reported to the program
            words = words_of(error)
            answer = np.uint32(len(words)).tobytes() + words
        stream.write(answer)
        stream.flush()


def main():
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the program, which closes the socket
    stream = socket.socket(fileno=int(sys.argv[1])).makefile("rwb")
    try:
        kind, act = load(os.path.expanduser(sys.argv[2]))
    except (Exception, SystemExit) as error:
        stream.write(words_of(error) + b"\n")
        stream.flush()
        return 1
    stream.write(kind.encode() + b"\n")
    stream.flush()
    try:
        serve(stream, kind, act)
    except (BrokenPipeError, ConnectionResetError):
        pass
    return 0


if __name__ == "__main__":
    sys.exit(main())
