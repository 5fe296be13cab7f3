"""NumPy files and checkpoints as people have them, through the real program."""
import csv
import json
import re
import shutil
import subprocess
import zipfile

from support import FIXTURES, Case, main, marey, need_python, read_tensors, write_tensors

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


class CheckpointFiles(Case):
    """Cases 28, 29, 30 and 33. The vectors were computed by the published implementation."""

    PREFIXES = FIXTURES / "28-checkpoint-key-prefixes"
    TRAINING = FIXTURES / "29-checkpoint-with-training-state"
    TWO = FIXTURES / "30-two-models-in-one-checkpoint"
    NONE = FIXTURES / "33-not-a-checkpoint"

    def imported(self, path, *words):
        out = self.dir / "model.marey"
        out.unlink(missing_ok=True)
        result = self.run_json("model", "import", path, "--config", path.parent / "config.json",
                               "--out", out, *words)
        return out, result["provenance"]

    def latent_error(self, path, *words):
        model, _ = self.imported(path, *words)
        errors = self.run_json("model", "check", model, "--vectors", self.TWO / "vectors.npz")
        return errors["latent_max_abs_error"]

    def assert_right(self, path, *words):
        with self.subTest(path=path.name):
            model, provenance = self.imported(path, *words)
            errors = self.run_json("model", "check", model, "--vectors",
                                   path.parent / "vectors.npz")
            self.assertLess(errors["latent_max_abs_error"], 1e-5)
            self.assertLess(errors["loglik_max_abs_error"], 1e-4)
            self.assertLess(errors["sample_max_abs_error"], 1e-5)
            return provenance

    def assert_no_model(self, path, *expected, words=()):
        return self.assert_refused(["model", "import", path, "--config",
                                    self.PREFIXES / "config.json", "--out",
                                    self.dir / "model.marey", "--quiet", *words], *expected)

    def test_case_28_prefixes_of_wrappers_are_no_part_of_the_names(self):
        for name, state in (("bare_state_dict.pt", "."), ("compiled.pkg", "graph/_orig_mod"),
                            ("lightning.ckpt", "state_dict/model")):
            self.assertEqual(self.assert_right(self.PREFIXES / name)["state_dict"], state)

    def test_case_28_an_unknown_prefix_is_shown_beside_an_expected_name(self):
        path = self.renamed(b"model.flow", b"modex.flow")
        self.assert_no_model(path, "modex.flow.layers.0.actnorm.bias",
                             "'flow.layers.0.actnorm.bias'")
        self.imported(path, "--state-dict", "state_dict/modex")

    def renamed(self, old, new):
        """The checkpoint of Lightning with other bytes of the same length in its pickle."""
        path = self.dir / "renamed.ckpt"
        with zipfile.ZipFile(self.PREFIXES / "lightning.ckpt") as source, \
                zipfile.ZipFile(path, "w") as target:
            for name in source.namelist():
                content = source.read(name)
                target.writestr(name, content.replace(old, new)
                                if name.endswith("data.pkl") else content)
        shutil.copy(self.PREFIXES / "config.json", self.dir)
        return path

    def test_case_29_training_state_beside_the_weights_does_no_harm(self):
        for path in sorted(self.TRAINING.glob("*.pkg")):
            provenance = self.assert_right(path)
            self.assertEqual(provenance["state_dict"], "graph")
            if path.name.startswith("02"):
                self.assertIn("optimizer", " ".join(provenance["left_out"]))

    def test_case_30_of_two_models_none_is_taken_silently(self):
        self.assert_no_model(self.TWO / "graph_and_graph_ema.pkg", "two state dicts: graph, graph_ema",
                             "--state-dict")
        self.assert_no_model(self.TWO / "ema_then_model.pt", "two state dicts: ema, model")
        self.assert_no_model(self.TWO / "ema_then_model.pt", "ema, model", "'eam'",
                             words=["--state-dict", "eam"])

    def test_case_30_the_chosen_one_is_taken_whole_and_recorded(self):
        for name, model, average in (("graph_and_graph_ema.pkg", "graph", "graph_ema"),
                                     ("ema_then_model.pt", "model", "ema")):
            path = self.TWO / name
            provenance = self.assert_right(path, "--state-dict", model)
            self.assertEqual(provenance["state_dict"], model)
            self.assertIn(average, " ".join(provenance["left_out"]))
            self.assertAlmostEqual(self.latent_error(path, "--state-dict", average), 0.44,
                                   delta=0.005)

    def test_case_30_the_other_network_is_named(self):
        provenance = self.assert_right(self.TWO / "generator_and_discriminator.pt")
        self.assertEqual(provenance["left_out"], ["discriminator/a"])

    def test_case_33_what_is_no_checkpoint_is_named(self):
        for name, *expected in (("git_lfs_pointer.pkg", "Git LFS pointer", "git lfs pull"),
                                ("web_page.pkg", "an HTML page in place of the file"),
                                ("half_downloaded.pkg", "cut", "incomplete download"),
                                ("model.safetensors", "a safetensors file"),
                                ("keras.h5", "an HDF5 file"), ("empty.pkg", "an empty file")):
            with self.subTest(name=name):
                self.assert_no_model(self.NONE / name, *expected)
                self.assert_refused(["model", "info", self.NONE / name, "--quiet"], *expected)

    def test_a_safetensors_file_of_the_weights_is_read(self):
        # The tensors of an import, under the authors' names and shapes again.
        model, _ = self.imported(self.PREFIXES / "bare_state_dict.pt")
        _, tensors = read_tensors(model)
        path = self.dir / "weights.safetensors"
        write_tensors(path, {"format": "pt"},
                      {self.authors_name(k): v for k, v in tensors.items() if "flow.step" in k})
        shutil.copy(self.PREFIXES / "config.json", self.dir)
        other, _ = self.imported(path)
        self.assertEqual(read_tensors(other)[1], tensors)

    @staticmethod
    def authors_name(name):
        step, rest = re.fullmatch(r"weights/flow\.step(\d+)_(.+)", name).groups()
        for ours, theirs in (("linear.permutation", "invconv.p"), ("linear.lower", "invconv.l"),
                             ("linear.upper", "invconv.u"), ("linear.", "invconv."),
                             ("coupling.net.out_", "f.linear."), ("coupling.net.", "f.lstm.")):
            if rest.startswith(ours):
                rest = theirs + rest[len(ours):]
                break
        return f"flow.layers.{step}.{rest}"


if __name__ == "__main__":
    main()
