"""marey predict: goes on with clips, and says how far it is from what really came."""
import json
import pathlib

from support import Case, main, marey

DEMO = pathlib.Path(__file__).parents[2] / "resources/demo/demo.marey"


class Predict(Case):
    def setUp(self):
        super().setUp()
        self.run_json("demo", "--write-data", self.dir / "walks", "--clips", "2",
                      "--clip-seconds", "4", "--seed", "11")
        self.clip = self.dir / "walks/walker_0000.bvh"

    def test_goes_on_along_the_clips_own_control(self):
        found = self.run_json("predict", DEMO, self.clip, "--seed-frames", "20", "-n", "2",
                              "--seconds", "2", "--format", "npz", "--out", self.dir / "p")
        self.assertEqual(len(found["clips"]), 2)
        for file in found["clips"]:
            doctor = self.run_json("doctor", file)["files"][0]
            self.assertEqual((doctor["frames"], doctor["fps"]), (40, 20.0))
        error = found["predictions"][0]["error"]
        self.assertEqual(sorted(error["at_ms_cm"], key=int),
                         ["80", "160", "320", "400", "560", "1000"])
        # A model of this walker is near it for a tenth of a second, and nearer than later.
        self.assertLess(error["at_ms_cm"]["80"], 5.0)
        self.assertLess(error["at_ms_cm"]["80"], error["at_ms_cm"]["1000"])
        self.assertLessEqual(error["best_sample_cm"], error["mean_cm"])
        self.assertAlmostEqual(found["error"]["mean_cm"], error["mean_cm"])

    def test_the_same_seed_gives_the_same_bytes(self):
        for name in ("a", "b"):
            self.run_json("predict", DEMO, self.clip, "--format", "csv", "--seconds", "1",
                          "--out", self.dir / name, "--seed", "5")
        self.assertEqual((self.dir / "a/walker_0000_000.csv").read_bytes(),
                         (self.dir / "b/walker_0000_000.csv").read_bytes())

    def test_along_a_path_nobody_knows_the_error(self):
        found = self.run_json("predict", DEMO, self.dir / "walks", "--path", "preset:circle",
                              "--seconds", "2", "--out", self.dir / "p")
        self.assertEqual(len(found["clips"]), 2)
        self.assertNotIn("error", found)

    def test_refuses_what_cannot_be_continued(self):
        self.assert_refused(["predict", DEMO, self.clip, "--seed-frames", "80",
                             "--out", self.dir / "p"], "80 frames", "seed frames")
        self.assert_refused(["predict", DEMO, self.clip, "--seed-frames", "1",
                             "--out", self.dir / "p"], "at least the 3 frames")
        self.assertFalse((self.dir / "p").exists())
        config = self.dir / "rnn.json"
        self.run_json("model", "example", "rnn", "--out", config)
        self.run_json("prepare", self.dir / "walks", "--out", self.dir / "data.marey")
        self.run_json("train", config, "--data", self.dir / "data.marey", "--steps", "1",
                      "--out", self.dir / "run")
        self.assert_refused(["predict", self.dir / "run/last.marey", self.clip,
                             "--out", self.dir / "p"], "sees no past poses")


class Families(Case):
    """A family without likelihood through the commands."""

    def test_an_rnn_is_trained_sampled_and_reported_without_a_likelihood(self):
        self.run_json("demo", "--write-data", self.dir / "walks", "--clips", "3",
                      "--clip-seconds", "4", "--seed", "11")
        config = self.dir / "rnn.json"
        shown = self.run_json("model", "example", "rnn", "--out", config)
        self.assertEqual(json.loads(config.read_text()), shown["config"])
        self.run_json("prepare", self.dir / "walks", "--out", self.dir / "data.marey")
        trained = self.run_json("train", config, "--data", self.dir / "data.marey",
                                "--steps", "2", "--out", self.dir / "run")
        self.assertEqual(trained["objective"], "squared error")
        self.assertNotIn("train_bits_per_frame", trained)
        self.assertIn("train_squared_deviations_per_frame",
                      (self.dir / "run/log.csv").read_text().splitlines()[0])
        model = self.dir / "run/last.marey"
        self.run_json("sample", model, "--path", "preset:circle", "-n", "2", "--seconds", "1",
                      "--format", "csv", "--out", self.dir / "s")
        self.assertEqual((self.dir / "s/sample_000.csv").read_bytes(),
                         (self.dir / "s/sample_001.csv").read_bytes())
        self.assert_refused(["score", model, self.dir / "walks"], "likelihood", "rnn")
        self.assert_refused(["sample", model, "--path", "preset:circle", "--temperature", "0.5",
                             "--out", self.dir / "t"], "temperature")
        experiment = self.dir / "e.json"
        experiment.write_text(json.dumps({
            "title": "both", "natural": ["walker:2,3,5"], "samples": 2, "held_out_samples": 2,
            "systems": [{"name": "MG+", "model": str(DEMO)}, {"name": "RNN", "model": str(model)}],
            "paths": [{"name": "circle", "path": "preset:circle", "seconds": 2}]}))
        self.run_json("report", experiment, "--out", self.dir / "r")
        table = json.loads((self.dir / "r/tables/likelihood.json").read_text())
        rows = {row[0]: row for row in table["rows"]}
        self.assertIsInstance(rows["MG+"][1], float)
        self.assertIn(rows["RNN"][1], (None, "-"))
        statistics = (self.dir / "r/tables/statistics-rnn.csv").read_text()
        diversity = next(row for row in statistics.splitlines() if row.startswith("diversity,"))
        self.assertEqual(diversity.split(",")[2], "0")
        page = next((self.dir / "r").glob("*.html")).read_text()
        self.assertIn("RNN draws nothing", page)
        self.assertIn("Log-likelihood under MG+", page)
        self.assertNotIn("Log-likelihood under RNN", page)


if __name__ == "__main__":
    main()
