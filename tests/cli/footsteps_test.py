"""Footsteps of `marey analyze` against the walker's true contacts and against real walks."""
import json
import math
import struct
import zipfile

from support import Case, main, shared

FPS = 20
# A planted foot of a file has the rounding of its decimals, far below the least tolerance.
FEET = ("LeftFoot", "RightFoot")


def planted_runs(clip, frames):
    """True footsteps of one clip as frame counts, from contact times alone.

    A speed belongs to the pair of frames (t-1, t). It is zero where both lie within one contact,
    so a contact [b, e] holds the pairs with t-1 >= b and t <= e; one shorter than a pair, at the
    clip's ends for example, holds none and is no footstep.
    """
    runs = []
    for joint in FEET:
        still = [False] * frames
        for contact in clip["contacts"]:
            if contact["joint"] != joint:
                continue
            first = math.ceil(contact["begin_s"] * FPS - 1e-6)
            last = math.floor(contact["end_s"] * FPS + 1e-6)
            for t in range(max(first, 0) + 1, min(last, frames - 1) + 1):
                still[t] = True
        length = 0
        for value in [*still, False]:
            if value:
                length += 1
            elif length:
                runs.append(length)
                length = 0
    return runs


def add_to_last_value(source, target, array, difference):
    """A copy of an .npz in which the last number of one array is larger."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            data = old.read(name)
            if name == f"{array}.npy":
                code = "<f" if b"'<f4'" in data[:128] else "<d"
                size = struct.calcsize(code)
                value, = struct.unpack(code, data[-size:])
                data = data[:-size] + struct.pack(code, value + difference)
            new.writestr(name, data)


class WalkerFootsteps(Case):
    def test_count_and_mean_duration_are_the_true_ones(self):
        for seed in (1, 11, 23):
            with self.subTest(seed=seed):
                walker = self.walker(clips=8, seconds=8, seed=seed, name=f"walker{seed}")
                truth = json.loads((walker / "truth.json").read_text())
                runs = [r for clip in truth for r in planted_runs(clip, 8 * FPS)]
                self.assertGreater(len(runs), 50)
                result = self.run_json("analyze", walker, "--fps", FPS, "--feet", ",".join(FEET),
                                       "--resamples", 0)
                steps = result["footsteps"]
                # f at the least tolerance counts exactly the planted runs.
                self.assertEqual(steps["count"][0], len(runs))
                self.assertEqual(steps["v95_cm_s"], 1.0)
                mean = sum(runs) / len(runs) / FPS
                self.assertAlmostEqual(steps["duration_mean_s"], mean, delta=1 / FPS)

    def test_durations_spread_as_the_true_ones_do(self):
        walker = self.walker(clips=8, seconds=8, seed=3)
        truth = json.loads((walker / "truth.json").read_text())
        runs = [r / FPS for clip in truth for r in planted_runs(clip, 8 * FPS)]
        mean = sum(runs) / len(runs)
        spread = math.sqrt(sum((r - mean) ** 2 for r in runs) / len(runs))
        steps = self.run_json("analyze", walker, "--fps", FPS, "--feet", ",".join(FEET),
                              "--resamples", 0)["footsteps"]
        self.assertAlmostEqual(steps["duration_std_s"], spread, delta=1 / FPS)


class RealFootsteps(Case):
    def test_walks_of_people_have_sharp_contacts_as_published(self):
        folder = shared("data", "bandai")
        walks = sorted(folder.glob("dataset-2_walk_*.bvh"))
        self.assertGreater(len(walks), 20)
        result = self.run_json("analyze", *walks[:60], "--fps", FPS, "--feet", "Foot_L,Foot_R",
                               "--resamples", 0)
        self.assertEqual(result["clips"], len(walks[:60]))
        steps = result["footsteps"]
        # The papers' natural motion has 5 cm/s; this selection of styles lies close to it.
        self.assertGreaterEqual(steps["v95_cm_s"], 4.0)
        self.assertLessEqual(steps["v95_cm_s"], 8.0)
        self.assertGreater(steps["max_count"], result["seconds"])
        self.assertEqual(steps["max_count"], max(steps["count"]))
        # v95 is the first tolerance with 95 % of the largest count.
        reached = [v for v, n in zip(steps["tolerance_cm_s"], steps["count"])
                   if n >= 0.95 * steps["max_count"]]
        self.assertEqual(steps["v95_cm_s"], reached[0])


class ReferenceModels(Case):
    def test_imported_models_reproduce_the_authors_vectors(self):
        for name in ("tiny-lu", "plain-weight"):
            with self.subTest(model=name):
                folder = shared("conformance", "moglow", name)
                out = self.dir / f"{name}.marey"
                info = self.run_json("model", "import", folder / "checkpoint.pkg", "--config",
                                     folder / "config.json", "--out", out)
                config = json.loads((folder / "config.json").read_text())
                for key in ("parameters", "pose_dim", "control_dim"):
                    self.assertEqual(info[key], config[key])
                errors = self.run_json("model", "check", out, "--vectors", folder / "vectors.npz")
                for key in ("latent_max_abs_error", "loglik_max_abs_error",
                            "sample_max_abs_error"):
                    self.assertLess(errors[key], 1e-4)
                self.assertGreater(errors["frames"], 0)

    def test_a_changed_vector_shows_as_that_difference(self):
        folder = shared("conformance", "moglow", "tiny-lu")
        model = self.dir / "tiny.marey"
        self.run_json("model", "import", folder / "checkpoint.pkg", "--config",
                      folder / "config.json", "--out", model)
        for array, key in (("z", "latent"), ("loglik_nats", "loglik"), ("x_sampled", "sample")):
            with self.subTest(array=array):
                other = self.dir / f"{array}.npz"
                add_to_last_value(folder / "vectors.npz", other, array, 0.5)
                errors = self.run_json("model", "check", model, "--vectors", other)
                self.assertAlmostEqual(errors[f"{key}_max_abs_error"], 0.5, places=3)

    def test_vectors_of_another_model_are_refused(self):
        folder = shared("conformance", "moglow")
        out = self.dir / "tiny.marey"
        self.run_json("model", "import", folder / "tiny-lu" / "checkpoint.pkg", "--config",
                      folder / "tiny-lu" / "config.json", "--out", out)
        self.assert_refused(["model", "check", out, "--vectors",
                             folder / "human-63" / "vectors.npz"], "vectors.npz", "63", "9")

    def test_a_cut_checkpoint_and_another_configuration_are_refused(self):
        folder = shared("conformance", "moglow", "tiny-lu")
        out = self.dir / "out.marey"
        blob = (folder / "checkpoint.pkg").read_bytes()
        cut = self.dir / "cut.pkg"
        for length in (3, 1000, len(blob) // 2, len(blob) - 1):
            cut.write_bytes(blob[:length])
            with self.subTest(length=length):
                self.assert_refused(["model", "import", cut, "--config", folder / "config.json",
                                     "--out", out], "cut.pkg")
        config = json.loads((folder / "config.json").read_text())
        config.pop("parameters", None)
        config["hidden"] += 1
        other = self.dir / "other.json"
        other.write_text(json.dumps(config))
        self.assert_refused(["model", "import", folder / "checkpoint.pkg", "--config", other,
                             "--out", out], "checkpoint.pkg")


if __name__ == "__main__":
    main()
