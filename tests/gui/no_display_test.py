"""The window's program where there is no display (case 36), through the real program."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

WORKBENCH = os.environ.get("MAREY_WORKBENCH", "")
WALK = pathlib.Path(__file__).resolve().parent.parent / "fixtures" / "36-no-display" / "walk.bvh"
WINDOW_SYSTEM = ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "QT_QPA_PLATFORM",
                 "XDG_SESSION_TYPE", "XDG_RUNTIME_DIR")


class NoDisplay(unittest.TestCase):
    def run_without(self, *words, **env):
        clean = {k: v for k, v in os.environ.items() if k not in WINDOW_SYSTEM}
        return subprocess.run([WORKBENCH, *map(str, words)], capture_output=True, text=True,
                              timeout=120, check=False, env={**clean, **env})

    def assert_one_line(self, done, *expected):
        self.assertEqual(done.returncode, 1, done.stderr)
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 1, done.stderr)
        for text in ("no display", "marey render", "marey report", *expected):
            self.assertIn(text, lines[0])
        self.assertEqual(done.stdout, "")

    def test_without_any_display_one_line_says_so(self):
        self.assert_one_line(self.run_without(WALK), "DISPLAY and WAYLAND_DISPLAY are not set")

    def test_a_display_where_nothing_listens_is_named(self):
        # A host that no resolver knows: no screen of this machine is meant.
        self.assert_one_line(self.run_without(WALK, DISPLAY="nowhere.invalid:99"),
                             "nowhere.invalid:99")
        with tempfile.TemporaryDirectory() as folder:
            self.assert_one_line(self.run_without(WALK, WAYLAND_DISPLAY="wayland-77",
                                                  XDG_RUNTIME_DIR=folder), "wayland-77")

    def test_an_unknown_platform_is_named(self):
        self.assert_one_line(self.run_without(WALK, QT_QPA_PLATFORM="nonsense"), "nonsense")

    def test_help_and_version_need_none(self):
        for word, expected in (("--help", "Usage"), ("--version", "Marey")):
            done = self.run_without(word)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(expected, done.stdout)


if __name__ == "__main__":
    if not os.access(WORKBENCH, os.X_OK):
        sys.exit(f"MAREY_WORKBENCH: expected the built program, found '{WORKBENCH}'")
    unittest.main(verbosity=2)
