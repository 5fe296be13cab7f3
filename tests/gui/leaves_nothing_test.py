"""Tests of the window leave nothing in the folder for temporary files, whatever Qt writes last."""
import os
import pathlib
import subprocess
import tempfile
import unittest


class LeavesNothing(unittest.TestCase):
    def test_a_window_with_a_file_dialog_leaves_the_temporary_folder_empty(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [os.environ["XVFB_RUN"], "-a", "-s", "-screen 0 1600x1000x24",
                 os.environ["MAREY_GUI_TEST"],
                 "--gtest_filter=Documents.SavingUnderAShortName*"],
                capture_output=True, text=True, timeout=600, check=False,
                env={**os.environ, "TMPDIR": folder})
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn("[  PASSED  ] 1 test", done.stdout)
            left = [str(path) for path in pathlib.Path(folder).rglob("*")]
            self.assertEqual(left, [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
