#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes networks.json: reference values and gradients for networks_test.

The networks are implemented from their equations in double precision: linear layers, the dueling
head of Wang et al. (2016) and an LSTM with forget gates (Gers et al. 2000) in PyTorch's order of
gates, i, f, g, o. Gradients are complex-step derivatives (Squire and Trapp 1998), which are
independent of back-propagation and exact to machine precision.
"""
import argparse
import json
import pathlib
import sys

import numpy as np

FILE = pathlib.Path(__file__).with_suffix(".json")
ACTIONS = 10
FEATURES, HIDDEN, STEPS, BATCH = 5, 6, 4, 2
STRIDE = 5  # every fifth gradient is written
TINY = 1e-30


def wave(size, step):
    """Values in ±0.4, reproducible in any language."""
    return 0.4 * np.sin(1.0 + step * np.arange(size))


def relu(x):
    return np.where(x.real > 0.0, x, 0.0)


def sigmoid(x):
    return 1.0 / (1.0 + np.exp(-x))


class Weights:
    """Splits a flat vector in the order of PyTorch's parameters, a matrix before its bias."""

    def __init__(self, flat):
        self.flat, self.taken = flat, 0

    def take(self, *shape):
        begin, self.taken = self.taken, self.taken + int(np.prod(shape))
        return self.flat[begin:self.taken].reshape(shape)

    def layer(self, inputs, outputs):
        matrix, bias = self.take(outputs, inputs), self.take(outputs)
        return lambda x: x @ matrix.T + bias

    def head(self, inputs, dueling):
        advantage = self.layer(inputs, ACTIONS)
        if not dueling:
            return advantage
        value = self.layer(inputs, 1)
        return lambda x: value(x) + advantage(x) - advantage(x).mean(-1, keepdims=True)


def mlp(flat, dueling):
    """Values [BATCH, ACTIONS]."""
    weights = Weights(flat)
    first, second = weights.layer(FEATURES, HIDDEN), weights.layer(HIDDEN, HIDDEN)
    head = weights.head(HIDDEN, dueling)
    return head(relu(second(relu(first(wave(BATCH * FEATURES, 0.9).reshape(BATCH, FEATURES))))))


def lstm(flat, dueling):
    """Values [STEPS, BATCH, ACTIONS]; the initial recurrent state is zero."""
    weights = Weights(flat)
    first = weights.layer(FEATURES, HIDDEN)
    from_input, from_memory = weights.take(4 * HIDDEN, HIDDEN), weights.take(4 * HIDDEN, HIDDEN)
    bias = weights.take(4 * HIDDEN) + weights.take(4 * HIDDEN)
    second = weights.layer(2 * HIDDEN, 2 * HIDDEN)
    head = weights.head(2 * HIDDEN, dueling)
    h, c = np.zeros((2, BATCH, HIDDEN))
    values = []
    for seen in wave(STEPS * BATCH * FEATURES, 0.9).reshape(STEPS, BATCH, FEATURES):
        x = relu(first(seen))
        gates = x @ from_input.T + h @ from_memory.T + bias
        i, f, g, o = np.split(gates, 4, axis=1)
        c = sigmoid(f) * c + sigmoid(i) * np.tanh(g)
        h = sigmoid(o) * np.tanh(c)
        values.append(head(relu(second(np.concatenate([h, x], axis=1)))))
    return np.stack(values)


def size_of(network, dueling):
    head = ACTIONS + (1 if dueling else 0)
    if network is mlp:
        return HIDDEN * (FEATURES + 1) + HIDDEN * (HIDDEN + 1) + head * (HIDDEN + 1)
    return (HIDDEN * (FEATURES + 1) + 4 * HIDDEN * (2 * HIDDEN + 2) + 2 * HIDDEN * (2 * HIDDEN + 1)
            + head * (2 * HIDDEN + 1))


def reference(network, dueling):
    """Values and gradient of the loss that is the sum of all squared values."""
    size = size_of(network, dueling)
    values = network(wave(size, 0.7).astype(complex), dueling)
    gradient = []
    for k in range(0, size, STRIDE):
        flat = wave(size, 0.7).astype(complex)
        flat[k] += 1j * TINY
        gradient.append((network(flat, dueling)**2).sum().imag / TINY)
    return {"network": network.__name__, "dueling": dueling, "weights": size,
            "loss": (values**2).sum().real, "last_values": list(values.reshape(-1).real[-ACTIONS:]),
            "gradient": gradient}


def references():
    return {"made_by": "networks.py", "features": FEATURES, "hidden": HIDDEN, "steps": STEPS,
            "batch": BATCH, "stride": STRIDE,
            "references": [reference(network, dueling) for network in (mlp, lstm)
                           for dueling in (False, True)]}


def is_same(one, other):
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(is_same(one[k], other[k]) for k in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(is_same, one, other))
    if isinstance(one, float):
        return abs(one - other) <= 1e-12 * max(1.0, abs(one))
    return one == other


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true",
                        help="write nothing; fail unless it is the file that there is")
    arguments = parser.parse_args()
    made = references()
    if arguments.check:
        if is_same(made, json.loads(FILE.read_text(encoding="utf-8"))):
            return
        sys.exit(f"{FILE}: got other numbers than networks.py makes; run it without --check")
    FILE.write_text(json.dumps(made, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
