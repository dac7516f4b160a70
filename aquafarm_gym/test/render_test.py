#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the render modes: text, pictures, a window and HTML.

Runs in the virtual environment given by --venv (venv_tools.py), or in the Python that starts it.
"""
import base64
import contextlib
import importlib.util
import io
import os
import pickle
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from unittest import mock

from venv_tools import enter_venv, run_tests

WHY_NOT = enter_venv()

if not WHY_NOT:
    import aquafarm_core as core
    import aquafarm_gym
    import gymnasium
    import numpy as np
    from aquafarm_gym import FarmEnv, FarmParallelEnv, FarmVectorEnv, TeamVectorEnv
    try:
        import aquafarm_core.pictures
        DRAWS = True
    except ImportError:
        DRAWS = False
else:
    DRAWS = False


def pixels_of(png):
    """Returns the pixels of a PNG without row filters, uint8 [height, width, 3]."""
    width, height = struct.unpack(">II", png[16:24])
    start = png.index(b"IDAT")
    size = struct.unpack(">I", png[start - 4:start])[0]
    rows = np.frombuffer(zlib.decompress(png[start + 4:start + 4 + size]), np.uint8)
    return rows.reshape(height, 1 + 3 * width)[:, 1:].reshape(height, width, 3)


@unittest.skipIf(WHY_NOT, WHY_NOT)
class RenderTest(unittest.TestCase):
    def test_text_shows_the_farm(self):
        env = FarmEnv(render_mode="ansi")
        env.reset(seed=1)
        lines = env.render().splitlines()
        self.assertRegex(lines[0], "^paper  step 0 of ")
        self.assertEqual([len(line) for line in lines[1:]], [25] * 25)
        self.assertEqual("".join(lines[1:]).count("0"), 1)
        self.assertEqual(len(FarmVectorEnv(3, render_mode="ansi").render()), 3)
        self.assertIn("4 of 9 farms", FarmVectorEnv(9)._repr_html_())

    def test_human_prints_the_farm_where_there_is_no_display(self):
        env = FarmEnv(render_mode="ansi")
        env.reset(seed=1)
        kept = {name: os.environ.pop(name) for name in ("DISPLAY", "WAYLAND_DISPLAY",
                                                        "SDL_VIDEODRIVER") if name in os.environ}
        with contextlib.redirect_stdout(io.StringIO()) as shown:
            FarmEnv(render_mode="human").reset(seed=1)
        os.environ.update(kept)
        self.assertEqual(shown.getvalue(), env.render() + "\n")

    def test_an_unknown_mode_is_refused_in_one_line(self):
        for make, words in (
                (lambda: FarmEnv(render_mode="video"), "render_mode: got 'video', expected ansi, "
                 "human, rgb_array or None"),
                (lambda: FarmVectorEnv(2, render_mode="human"), "render_mode: got 'human' for many "
                 "farms, expected ansi, rgb_array or None; show")):
            with self.assertRaisesRegex(ValueError, f"^{words}"):
                make()

    def test_without_the_drawing_module_one_line_says_what_to_install(self):
        code = ("import sys; sys.modules['aquafarm_core._pictures'] = None\n"
                "import aquafarm_gym\n"
                "env = aquafarm_gym.FarmEnv()\n"
                "assert '<pre' in env._repr_html_()\n"
                "aquafarm_gym.FarmEnv(render_mode='rgb_array')\n")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr.splitlines()[-1], "^ImportError: aquafarm_core: got no module "
                         "that draws pictures .*libopencv-dev.*or use render_mode='ansi'$")

    @unittest.skipUnless(DRAWS, "built without OpenCV")
    def test_pictures_show_the_present_state(self):
        env, same = (gymnasium.make("aquafarm/Paper-v1", render_mode="rgb_array").unwrapped
                     for _ in range(2))
        env.reset(seed=1)
        same.reset(seed=1)
        first = env.render()
        self.assertEqual((first.shape, first.dtype), ((640, 800, 3), np.uint8))
        np.testing.assert_array_equal(first, same.render())
        again = pickle.loads(pickle.dumps(env))
        np.testing.assert_array_equal(again.render(), first)
        env.step(core.ACTIONS.index("north"))
        changed = (env.render() != first).any(axis=2)
        self.assertTrue(changed.any())
        self.assertLess(changed.mean(), 0.5)

    @unittest.skipUnless(DRAWS, "built without OpenCV")
    def test_size_and_layers_are_the_users(self):
        seen = {}
        for layers in ("none", "trail,risk", "labels"):
            env = FarmEnv("paper", render_mode="rgb_array",
                          picture_size=(400, 320), picture_layers=layers)
            env.reset(seed=1)
            seen[layers] = env.render()
            self.assertEqual(seen[layers].shape, (320, 400, 3))
        self.assertTrue((seen["none"] != seen["labels"]).any())
        light = FarmEnv(render_mode="rgb_array", picture_style="light")
        light.reset(seed=1)
        self.assertGreater(light.render().mean(), 1.5 * seen["none"].mean())
        for options, words in (({"picture_layers": "rain"}, "layers: got 'rain', expected some of"),
                               ({"picture_size": (20, 320)}, "Painter: width: got 20, expected a"),
                               ({"picture_style": "blue"}, "style: got 'blue', expected dark")):
            with self.assertRaisesRegex(ValueError, f"^{words}"):
                FarmEnv(render_mode="rgb_array", **options).render()
        batch = core.FarmBatch(aquafarm_gym.find_scenario("paper"), 2)
        with self.assertRaisesRegex(ValueError, "^Painter: farm: got 2, expected a whole number"):
            aquafarm_core.pictures.Painter().draw(batch, 2)

    @unittest.skipUnless(DRAWS, "built without OpenCV")
    def test_every_environment_draws(self):
        envs = FarmVectorEnv(3, render_mode="rgb_array")
        one = FarmEnv(render_mode="rgb_array")
        envs.reset(seed=4)
        one.reset(seed=4, options={"episode": 2})
        map_part = (slice(60, 500), slice(60, 640))  # other parts show the number of the episode
        frames = envs.render()
        self.assertEqual(len(frames), 3)
        np.testing.assert_array_equal(frames[2][map_part], one.render()[map_part])
        team = FarmParallelEnv("two_squads", render_mode="rgb_array")
        team.reset(seed=4)
        teams = TeamVectorEnv(2, "two_squads", render_mode="rgb_array")
        teams.reset(seed=4)
        np.testing.assert_array_equal(team.render(), teams.render()[0])

    @unittest.skipUnless(DRAWS, "built without OpenCV")
    def test_a_notebook_displays_the_picture(self):
        env = FarmEnv(render_mode="rgb_array")
        env.reset(seed=1)
        picture = env.render()
        data = re.search(r'^<img alt="farm 0 of paper" src="data:image/png;base64,([^"]*)">$',
                         env._repr_html_()).group(1)
        np.testing.assert_array_equal(pixels_of(base64.b64decode(data)), picture)

    @unittest.skipUnless(DRAWS and importlib.util.find_spec("pygame"), "no OpenCV or no pygame")
    def test_human_shows_the_picture_in_a_window(self):
        os.environ["SDL_VIDEODRIVER"] = "dummy"
        import pygame
        env = FarmEnv(render_mode="human")
        env.reset(seed=1)
        shown = pygame.surfarray.array3d(pygame.display.get_surface()).swapaxes(0, 1)
        np.testing.assert_array_equal(shown, env._pictures.draw())
        env.close()
        self.assertFalse(pygame.display.get_init())

    @unittest.skipUnless(DRAWS and importlib.util.find_spec("pygame"), "no OpenCV or no pygame")
    def test_human_prints_the_farm_if_the_display_cannot_be_reached(self):
        with mock.patch.dict(os.environ, SDL_VIDEODRIVER="x11", DISPLAY=":999"), \
                contextlib.redirect_stdout(io.StringIO()) as shown, \
                contextlib.redirect_stderr(io.StringIO()) as errors:
            env = FarmEnv(render_mode="human")
            env.reset(seed=1)
            env.step(0)
        self.assertEqual(shown.getvalue().count("paper  step "), 2)
        self.assertIn("render_mode human: prints text, because: ", errors.getvalue())
        self.assertEqual(errors.getvalue().count("because"), 1)

    @unittest.skipUnless(DRAWS and importlib.util.find_spec("moviepy"), "no OpenCV or no moviepy")
    def test_record_video_writes_an_mp4(self):
        with tempfile.TemporaryDirectory() as folder:
            env = gymnasium.wrappers.RecordVideo(
                gymnasium.make("aquafarm/Paper-v1", render_mode="rgb_array", max_episode_steps=5),
                folder, disable_logger=True)
            env.reset(seed=1)
            for _ in range(5):
                env.step(env.action_space.sample())
            env.close()
            with open(f"{folder}/rl-video-episode-0.mp4", "rb") as video:
                self.assertEqual(video.read(8)[4:], b"ftyp")


if __name__ == "__main__":
    run_tests("render", RenderTest, WHY_NOT)
