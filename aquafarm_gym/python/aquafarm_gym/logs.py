# SPDX-License-Identifier: BSD-3-Clause
"""Exports the curves of runs to TensorBoard or Weights & Biases.

    python -m aquafarm_gym.logs RUN … [--to tensorboard | wandb] [--follow] [--window 50]

RUN is a run folder of ./aquafarm train or aquafarm_train; its metrics.csv has one line per episode.
Each point is the mean over --window episodes; the last point may cover fewer. The x value of a
point is the run's total number of farm steps after the last of its episodes.
TensorBoard reads RUN/tensorboard (tensorboard --logdir runs). Weights & Biases receives one run per
folder, offline unless WANDB_MODE is set. --follow waits until all runs have begun. It then logs
them until all have ended or Ctrl-C is pressed. A run counts as ended once its policy.ckpt exists,
even if it was resumed and still trains; --endless follows such a run too. Only --to wandb needs a
package from PyPI. This file can also run without the package aquafarm_gym: python3 logs.py.
"""
from __future__ import annotations

import argparse
import csv
import json
import math
import os
import pathlib
import shutil
import socket
import struct
import sys
import time
from collections.abc import Iterator
from typing import Any, Protocol

# Columns of metrics.csv with their names in the logs.
COLUMNS: dict[str, str] = {
    "return": "episode/return", "success": "episode/success_rate", "steps": "episode/steps",
    "delivered": "episode/delivered", "delivered_health": "episode/delivered_health",
    "crashes": "episode/crashes", "collisions": "episode/collisions",
    "steps_in_disaster": "episode/steps_in_disaster", "energy_kwh": "episode/energy_kwh",
    "distance_km": "episode/distance_km", "loss": "learner/loss",
    "exploration": "learner/exploration", "learning_rate": "learner/learning_rate"}
PERIOD_S = 2.0


class Sink(Protocol):
    """Destination of the points of a run."""

    def add(self, steps: int, values: dict[str, float]) -> None:
        """Adds a point at a number of farm steps."""

    def close(self) -> None:
        """Writes buffered points and closes the destination."""


def _crc32c_table() -> list[int]:
    """Returns the table of CRC-32C (Castagnoli, reflected polynomial 0x82f63b78; RFC 3720, B.4)."""
    table = []
    for value in range(256):
        for _ in range(8):
            value = value >> 1 ^ (0x82f63b78 if value & 1 else 0)
        table.append(value)
    return table


_TABLE = _crc32c_table()


def crc32c(data: bytes) -> int:
    """Returns the CRC-32C of bytes."""
    crc = 0xffffffff
    for byte in data:
        crc = crc >> 8 ^ _TABLE[(crc ^ byte) & 255]
    return crc ^ 0xffffffff


def _record(data: bytes) -> bytes:
    """Returns a TFRecord: length, CRC of the length, data, CRC of the data. The CRCs are masked:
    rotated, plus a constant (tensorflow/tsl: lib/hash/crc32c.h, Mask)."""
    def masked(part: bytes) -> bytes:
        crc = crc32c(part)
        return struct.pack("<I", ((crc >> 15 | crc << 17) + 0xa282ead8) & 0xffffffff)
    length = struct.pack("<Q", len(data))
    return length + masked(length) + data + masked(data)


def _varint(value: int) -> bytes:
    """Returns a number as a varint of protocol buffers."""
    parts = []
    while value > 127:
        parts.append(value & 127 | 128)
        value >>= 7
    return bytes([*parts, value])


def _text(field: int, data: bytes) -> bytes:
    """Returns a length-delimited field (a text or a message) of a protocol buffer."""
    return _varint(field << 3 | 2) + _varint(len(data)) + data


class TensorBoard:
    """Replaces RUN/tensorboard by a folder with one event file (tensorboard/compat/proto:
    event.proto, summary.proto)."""

    def __init__(self, run: pathlib.Path) -> None:
        folder = run / "tensorboard"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        name = f"events.out.tfevents.{time.time_ns() // 1000}.{socket.gethostname()}.{os.getpid()}"
        self._file = open(folder / name, "wb")
        self._write(_text(3, b"brain.Event:2"))  # file_version

    def _write(self, content: bytes) -> None:
        self._file.write(_record(struct.pack("<Bd", 1 << 3 | 1, time.time()) + content))
        self._file.flush()

    def add(self, steps: int, values: dict[str, float]) -> None:
        """Adds a point."""
        summary = b"".join(
            _text(1, _text(1, name.encode()) + struct.pack("<Bf", 2 << 3 | 5, value))
            for name, value in values.items())
        self._write(_varint(2 << 3) + _varint(steps) + _text(5, summary))

    def close(self) -> None:
        """Closes the file."""
        self._file.close()


class WeightsAndBiases:
    """Makes a run of Weights & Biases, with the content of run.json as its configuration."""

    def __init__(self, run: pathlib.Path) -> None:
        os.environ.setdefault("WANDB_MODE", "offline")
        import wandb
        self._run: Any = wandb.init(project="aquafarm", name=run.name, config=settings_of(run),
                                    dir=str(run), reinit="create_new")

    def add(self, steps: int, values: dict[str, float]) -> None:
        """Adds a point."""
        self._run.log(values, step=steps)

    def close(self) -> None:
        """Finishes the run."""
        self._run.finish()


SINKS: dict[str, Any] = {"tensorboard": TensorBoard, "wandb": WeightsAndBiases}


def settings_of(run: pathlib.Path) -> dict[str, Any]:
    """Returns the content of run.json; empty if the file does not exist or is not valid JSON."""
    try:
        settings: dict[str, Any] = json.loads((run / "run.json").read_text("utf-8"))
        return settings
    except (OSError, ValueError):
        return {}


class Metrics:
    """Reads the new lines of a metrics.csv that grows."""

    def __init__(self, path: pathlib.Path) -> None:
        self._path = path
        self._offset = 0
        self._names: list[str] = []

    def new_rows(self) -> Iterator[dict[str, float]]:
        """Yields the complete lines added since the last call, as numbers by column. Leaves out the
        column `reason`, which contains text. Raises ValueError if a line and the first line have
        different numbers of cells, or if a cell is not a number."""
        try:
            with open(self._path, "rb") as file:
                file.seek(self._offset)
                text = file.read()
        except FileNotFoundError:
            return
        whole = text[:text.rfind(b"\n") + 1]
        self._offset += len(whole)
        for cells in csv.reader(whole.decode("utf-8").splitlines()):
            if not self._names:
                self._names = cells
                continue
            try:
                row = dict(zip(self._names, cells, strict=True))
                row.pop("reason", None)
                yield {name: float(value) for name, value in row.items()}
            except ValueError as error:
                raise ValueError(f"{self._path}: got line {','.join(cells)[:60]!r}, expected "
                                 f"{len(self._names)} cells as in its first line, all except reason "
                                 "numbers") from error

    def is_shorter(self) -> bool:
        """Returns whether the file is shorter than the part that was read, for example because a
        run was resumed. Does not detect this if the file has since grown beyond that part."""
        return self._path.is_file() and self._path.stat().st_size < self._offset


class Curves:
    """Adds the means of the rows of one run to a sink."""

    points: int

    def __init__(self, run: pathlib.Path, kind: str, window: int) -> None:
        self._run, self._kind, self._window = run, kind, window
        self._begin()

    def _begin(self) -> None:
        self._sink: Sink = SINKS[self._kind](self._run)
        self._metrics = Metrics(self._run / "metrics.csv")
        self._rows: list[dict[str, float]] = []
        self.points = 0

    def update(self) -> None:
        """Reads new rows and adds the points of complete windows."""
        if self._metrics.is_shorter():
            self._sink.close()
            self._begin()
        for row in self._metrics.new_rows():
            self._rows.append(row)
            if len(self._rows) == self._window:
                self._add()

    def _add(self) -> None:
        means = {}
        for column, name in COLUMNS.items():
            values = [row[column] for row in self._rows
                      if column in row and math.isfinite(row[column])]
            if values:
                means[name] = sum(values) / len(values)
        self._sink.add(int(self._rows[-1]["total_steps"]), means)
        self._rows.clear()
        self.points += 1

    def has_ended(self) -> bool:
        """Returns whether the run has written its policy. A run does this after all episodes. Also
        returns True for a finished run that was resumed and still trains."""
        return (self._run / "policy.ckpt").is_file()

    def close(self) -> None:
        """Adds a point for the remaining rows and closes the sink."""
        if self._rows:
            self._add()
        self._sink.close()


def log_runs(runs: list[pathlib.Path], kind: str = "tensorboard", window: int = 50,
             follow: bool = False, endless: bool = False) -> list[int]:
    """Logs run folders and returns the number of points of each. The number is 0 for a run that had
    not begun when Ctrl-C was pressed. kind: tensorboard or wandb. follow: whether to wait until all
    runs have begun, and to continue until all have ended or Ctrl-C is pressed. endless: with
    follow, whether to continue even after all runs have ended. Raises ValueError if metrics.csv is
    invalid or, without follow, if a folder contains neither metrics.csv nor run.json. Raises
    ImportError if the package wandb is needed but missing."""
    begun = runs
    try:
        while follow and not all((run / "metrics.csv").is_file() for run in runs):
            time.sleep(PERIOD_S)
    except KeyboardInterrupt:
        follow = False
        begun = [run for run in runs if (run / "metrics.csv").is_file()]
    for run in begun:
        if not (run / "metrics.csv").is_file() and not (run / "run.json").is_file():
            raise ValueError(f"{run}: got no metrics.csv, expected a run folder of ./aquafarm train")
    curves = [Curves(run, kind, window) for run in begun]
    try:
        while True:
            ended = follow and not endless and all(one.has_ended() for one in curves)
            for one in curves:
                one.update()
            if ended or not follow:
                break
            time.sleep(PERIOD_S)
    except KeyboardInterrupt:
        for one in curves:
            one.update()
    finally:
        for one in curves:
            one.close()
    points = dict(zip(begun, (one.points for one in curves)))
    return [points.get(run, 0) for run in runs]


def main() -> int:
    """Runs the command; returns its exit code."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=pathlib.Path)
    parser.add_argument("--to", choices=sorted(SINKS), default="tensorboard")
    parser.add_argument("--window", type=int, default=50, help="number of episodes per point")
    parser.add_argument("--follow", action="store_true", help="continue until all runs have ended")
    parser.add_argument("--endless", action="store_true",
                        help="with --follow: continue until Ctrl-C, also after a run ends, because "
                        "it may be resumed")
    given = parser.parse_args()
    if given.window < 1:
        parser.error(f"--window: got {given.window}, expected at least 1")
    try:
        points = log_runs(given.runs, given.to, given.window, given.follow,
                          given.endless)
    except ImportError as error:
        print(f"logs: {error}; pip install wandb", file=sys.stderr)
        return 3
    except ValueError as error:
        print(f"logs: {error}", file=sys.stderr)
        return 2
    for run, count in zip(given.runs, points):
        print(f"{run}: {count} points")
    return 0


if __name__ == "__main__":
    sys.exit(main())
