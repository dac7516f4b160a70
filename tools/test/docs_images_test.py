# SPDX-License-Identifier: BSD-3-Clause
"""tools/draw_docs_images lists every picture of docs/images, and pages show each of them."""
import importlib.machinery
import importlib.util
import pathlib
import signal
import subprocess
import sys
import time

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "draw_docs_images"


def load():
    loader = importlib.machinery.SourceFileLoader("draw_docs_images", str(TOOL))
    module = importlib.util.module_from_spec(
        importlib.util.spec_from_loader(loader.name, loader))
    sys.dont_write_bytecode = True
    loader.exec_module(module)
    return module


def test_every_picture_of_the_docs_can_be_drawn_again():
    tool = load()
    drawn = {*tool.names(), *tool.BENCHMARK, *tool.PRINTED, *tool.ELSEWHERE}
    there = {path.stem for path in (ROOT / "docs" / "images").glob("*.png")}
    assert there == drawn


def test_every_picture_is_on_a_page():
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
    unused = [path.name for path in (ROOT / "docs" / "images").glob("*.png")
              if f"images/{path.name}" not in text]
    assert not unused


def test_an_alarm_is_a_headline_with_a_colour():
    tool = load()
    pixels = numpy.full((720, 1280, 3), 30, numpy.uint8)
    assert not tool.has_alarm(pixels)
    pixels[90:100, 700:800] = (255, 255, 255)  # "no known danger"
    assert not tool.has_alarm(pixels)
    pixels[90:100, 700:800] = (210, 120, 230)  # hurricane force
    assert tool.has_alarm(pixels)


def test_an_unknown_name_is_refused_with_the_known_ones():
    done = subprocess.run([TOOL, "valuess"], capture_output=True, text=True, timeout=60,
                          check=False)
    assert done.returncode == 2
    assert "got 'valuess', expected some of: zhoushan_infa_2021" in done.stderr


def living(session):
    """Returns the processes of a session that have not ended."""
    listed = subprocess.run(["ps", "-eo", "sid=,stat=,pid="], capture_output=True, text=True,
                            check=True).stdout
    return [line for line in listed.splitlines()
            if line.split()[0] == str(session) and not line.split()[1].startswith("Z")]


def test_ctrl_c_leaves_no_process():
    # A program that ignores Ctrl-C, with a child in a process group of its own.
    code = f"""
import importlib.machinery, signal, sys
sys.dont_write_bytecode = True
signal.signal(signal.SIGINT, signal.default_int_handler)  # a background shell ignores it
tool = importlib.machinery.SourceFileLoader("tool", {str(TOOL)!r}).load_module()
ends = [(signal.SIGINT, 1), (signal.SIGTERM, 10), (signal.SIGKILL, 10)]
shell = "set -m; trap '' INT; sleep 600 & wait"
with tool.started(["bash", "-c", shell], ends) as process:
    print(process.pid, flush=True)
    signal.pause()
"""
    outer = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True,
                             stderr=subprocess.DEVNULL)
    session = int(outer.stdout.readline())
    end = time.monotonic() + 30
    while len(living(session)) < 2 and time.monotonic() < end:  # the shell and its child
        time.sleep(0.05)
    assert len(living(session)) == 2
    outer.send_signal(signal.SIGINT)
    assert outer.wait(60) != 0
    assert not living(session)
