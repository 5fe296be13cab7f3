"""NumPy files as people have them, through the real program (cases 26 and 27)."""
import csv
import json
import subprocess

from support import FIXTURES, Case, main, marey, need_python

JOINTS = FIXTURES / "26-numpy-arrays"
DIALECTS = FIXTURES / "27-npz-dialects"


class NumpyFiles(Case):
    def test_case_26_joints_are_a_walk(self):
        steps = self.run_json("analyze", JOINTS / "joints_22.npy",
                              "--tolerance-step", 1)["footsteps"]
        self.assertEqual(steps["max_count"], 12)
        self.assertEqual(steps["v95_cm_s"], 16.0)
        report = self.run_json("doctor", JOINTS / "joints_22.npy")["files"][0]
        self.assertTrue(any("20 frames per second" in note for note in report["notes"]), report)

    def test_case_26_features_are_named_and_nothing_is_written(self):
        for words in (["analyze", JOINTS / "features_263.npy"],
                      ["convert", JOINTS / "features_263.npy", "--out", self.dir / "a.bvh"]):
            self.assert_refused(words, "a NumPy array (30, 263), features", "joint_names",
                                "positions", "fps", "parents", "offsets")

    def test_case_27_is_read_beside_what_nobody_needs(self):
        for name in ("f4.npz", "with_text_and_object_arrays.npz"):
            out = self.dir / name.removesuffix(".npz")
            written = self.run_json("convert", DIALECTS / name, "--out", out, "--format", "csv",
                                    "--unit", "m")["written"]
            self.assertEqual(sum(path.endswith(".csv") for path in written), 2)
            for path in sorted(out.glob("*.csv")):
                self.assert_positions(path, DIALECTS / "expected.csv")

    def assert_positions(self, path, expected):
        with open(path, newline="", encoding="utf-8") as file:
            found = list(csv.DictReader(file))
        joints = list(dict.fromkeys(row["joint"] for row in found))
        at = {(int(row["frame"]), joints.index(row["joint"])): row for row in found}
        with open(expected, newline="", encoding="utf-8") as file:
            for want in csv.DictReader(file):
                row = at[int(want["frame"]), int(want["joint"])]
                for axis in ("x_m", "y_m", "z_m"):
                    self.assertAlmostEqual(float(row[axis]), float(want[axis]), delta=1e-4)

    def test_case_27_faults_are_named(self):
        self.assert_refused(["analyze", DIALECTS / "nan_in_clip_1.npz", "--quiet"], "clip 1",
                            "frame 11", "LeftUpLeg")
        self.assert_refused(["analyze", DIALECTS / "truncated.npz", "--quiet"], "damaged or cut")

    def test_npz_that_is_written_is_read_by_numpy_without_pickles(self):
        need_python("numpy")
        out = self.dir / "walk.npz"
        done = marey("convert", JOINTS / "joints_22.npy", "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        script = ("import json, numpy, sys\n"
                  "z = numpy.load(sys.argv[1], allow_pickle=False)\n"
                  "print(json.dumps([z['joint_names'].tolist(), z['name'].item(),\n"
                  "                  json.loads(z['recipe'].item())['export']['format']]))\n")
        read = subprocess.run(["/usr/bin/python3", "-c", script, out], check=True,
                              capture_output=True, text=True)
        names, name, form = json.loads(read.stdout)
        self.assertEqual(names[:3], ["pelvis", "left_hip", "right_hip"])
        self.assertEqual((name, form), ("joints_22", "npz"))


if __name__ == "__main__":
    main()
