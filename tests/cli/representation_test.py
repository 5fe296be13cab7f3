"""A model of joint rotations through every command: prepare, train, sample, score, report, export."""
import json
import math
import pathlib
import re
import struct

from support import Case, main, marey, read_tensors

JOINTS = 21


def bvh_offsets(path):
    """{joint: offset} of the hierarchy, as text says it."""
    text = path.read_text()
    return {name: tuple(map(float, offset.split())) for name, offset in re.findall(
        r"(?:ROOT|JOINT)\s+(\S+)\s*\{\s*OFFSET\s+([^\n]+)", text)}


class JointExpmap(Case):
    """One test, for a training takes its time: every step needs the one before."""

    def test_goes_through_every_command(self):
        walker = self.walker(clips=3)
        data = self.dir / "data.marey"
        prepared = self.run_json("prepare", walker, "--layout", "joint-expmap", "--out", data)
        self.assertEqual(prepared["layout"], "joint-expmap")
        self.assertEqual(prepared["pose_dim"], 6 + 3 * (JOINTS - 1))
        config = self.tiny_config(model={"pose_dim": prepared["pose_dim"]})
        run = self.dir / "run"
        trained = self.run_json("train", config, "--data", data, "--out", run, "--threads", 1)
        self.assertEqual(trained["test_unit"], "nats per frame, cm and rad")
        model = run / "last.marey"
        info = self.run_json("model", "info", model)
        self.assertEqual(info["layout"], "joint-expmap")
        self.assertEqual(info["likelihood_unit"], "nats per frame, cm and rad")

        clips = self.sampled(model, walker)
        self.scored(model, walker, data)
        self.reported(model, walker)
        # Bones are exact, whatever an all but untrained model says.
        analysed = self.run_json("analyze", *clips)
        self.assertLess(analysed["bone_length_rmse_cm"], 1e-4)

    def sampled(self, model, walker):
        """BVH files whose rotations are the model's own, about the joints of the data."""
        out = self.dir / "samples"
        made = self.run_json("sample", model, "--path", "preset:circle", "-n", 2, "--seconds", 2,
                             "--out", out, "--format", "bvh")
        natural = bvh_offsets(walker / "walker_0000.bvh")
        for clip in made["clips"]:
            recipe = json.loads(pathlib.Path(clip + ".recipe.json").read_text())
            self.assertNotIn("fit", recipe, "rotations were fitted to positions")
            offsets = bvh_offsets(pathlib.Path(clip))
            self.assertEqual(set(offsets), set(natural))
            for joint, offset in offsets.items():
                if joint != "Hips":
                    for a, b in zip(offset, natural[joint]):
                        self.assertAlmostEqual(a, b, delta=2e-4, msg=joint)
        return made["clips"]

    def scored(self, model, walker, data):
        clip = walker / "walker_0000.bvh"
        score = self.run_json("score", model, clip)
        self.assertEqual(score["unit"], "nats per frame, cm and rad")
        self.assertNotIn("mean_nats_per_frame_cm", score)
        self.assertIn("0.002 rad", score["floor"])
        self.assertNotIn("joint", score["clips"][0]["worst"])
        # From standardised poses: ln 100 for each of the 3 lengths, none for angles.
        plain = self.run_json("score", model, clip, "--standardised")
        deviations = read_floats(data, "standardiser/pose_std")
        shift = -sum(map(math.log, deviations)) - 3 * math.log(100)
        for a, b in zip(score["clips"][0]["loglik_nats"], plain["clips"][0]["loglik_nats"]):
            self.assertAlmostEqual(a - b, shift, delta=1e-4 * abs(shift))

    def reported(self, model, walker):
        positions = self.dir / "positions"
        data = self.prepared(walker)
        done = marey("train", self.tiny_config("positions.json"), "--data", data, "--out",
                     positions, "--threads", 1, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        document = self.dir / "experiment.json"
        document.write_text(json.dumps({
            "title": "two representations", "fps": 20, "natural": [str(walker)],
            "systems": [{"name": "rotations", "model": str(model)},
                        {"name": "places", "model": str(positions / "last.marey")}],
            "paths": [], "held_out_samples": 1}))
        report = self.run_json("report", document, "--out", self.dir / "report")
        tables = [pathlib.Path(t).read_text() for t in report["tables"]
                  if re.fullmatch(r"likelihood.*\.csv", pathlib.Path(t).name)]
        self.assertEqual(len(tables), 2, report["tables"])
        for table in tables:
            self.assertEqual("rotations" in table, "cm and rad" in table, table)
            self.assertNotEqual("rotations" in table, "places" in table, table)

    def test_refuses_what_does_not_fit(self):
        walker = self.walker()
        data = self.dir / "data.marey"
        self.assert_refused(["prepare", walker, "--layout", "six-d", "--out", data], "six-d",
                            "root-positions, joint-expmap")
        self.run_json("prepare", walker, "--layout", "joint-expmap", "--out", data)
        run = self.dir / "run"
        self.assert_refused(
            ["train", self.tiny_config(model={"pose_dim": 66, "pose_base": "kinematic", "tau": 3,
                                              "dropout": 0.0}), "--data", data, "--out", run],
            "pose_base", "root-positions")
        self.assert_refused(["train", self.tiny_config(), "--data", data, "--out", run],
                            "model.pose_dim", "66")
        model = self.trained()[0]
        self.assert_refused(["train", self.tiny_config(model={"pose_dim": 66}), "--data",
                             self.expmap_again(walker), "--out", self.dir / "other", "--init", model],
                            "layout", "joint-expmap", "root-positions")

    def expmap_again(self, walker):
        path = self.dir / "again.marey"
        self.run_json("prepare", walker, "--layout", "joint-expmap", "--out", path)
        return path

    def test_reads_data_of_the_former_name(self):
        data = self.prepared(self.walker())
        blob = data.read_bytes()
        self.assertIn(b'root-positions', blob)
        # The same length, so that the file stays whole.
        old = self.dir / "old.marey"
        old.write_bytes(blob.replace(b'\\"layout\\":\\"root-positions\\"',
                                     b'\\"layout\\":\\"positions\\"     '))
        self.assertNotEqual(old.read_bytes(), blob)
        for path, run in ((data, "new"), (old, "former")):
            done = marey("train", self.tiny_config(), "--data", path, "--out", self.dir / run,
                         "--threads", 1, "--quiet")
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(read_tensors(self.dir / "new" / "last.marey")[1],
                         read_tensors(self.dir / "former" / "last.marey")[1])


def read_floats(path, name):
    _, _, content = read_tensors(path)[1][name]
    return struct.unpack(f"<{len(content) // 4}f", content)


if __name__ == "__main__":
    main()
