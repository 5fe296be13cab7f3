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
        error = found["results"][0]["error"]
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

    def test_the_error_stands_beside_that_of_no_model(self):
        found = self.run_json("predict", DEMO, self.clip, "--seed-frames", "20", "--seconds", "1",
                              "--format", "npz", "--out", self.dir / "p")
        result = found["results"][0]
        # A walker that stands still falls behind; a model of it does not.
        self.assertLess(result["error"]["mean_cm"], result["error_without_model"]["mean_cm"])
        self.assertEqual(found["error"]["without_model_cm"],
                         result["error_without_model"]["mean_cm"])

    def test_commands_steer(self):
        commands = self.dir / "commands.csv"
        commands.write_text("time,forward,turn_deg\n0,1,0\n1,1,45\n2,0,0\n")
        found = self.run_json("steer", DEMO, commands, "-n", "2", "--format", "npz",
                              "--out", self.dir / "s")
        self.assertEqual([f.split("/")[-1] for f in found["clips"]],
                         ["commands_000.npz", "commands_001.npz"])
        doctor = self.run_json("doctor", found["clips"][0])["files"][0]
        self.assertEqual((doctor["frames"], doctor["fps"]), (60, 20.0))
        for text, expected in (("time,forward\n0,1\n", "two rows"),
                               ("time,forward\n1,1\n0,1\n", ".csv:3"),
                               ("time,foreward\n0,1\n1,1\n", "'foreward'")):
            commands.write_text(text)
            self.assert_refused(["steer", DEMO, commands, "--out", self.dir / "t"], expected)

    def test_what_no_model_can_do_is_said_before_any_work(self):
        mask = self.dir / "mask.csv"
        mask.write_text("1\n")
        self.assert_refused(["complete", DEMO, self.clip, "--mask", mask, "--out", self.dir / "c"],
                            "can complete", "cannot fill in")
        self.assert_refused(["denoise", DEMO, self.clip, "--noise", "0.02", "--out",
                             self.dir / "c"], "can denoise", "cannot take noise out")

    def test_a_document_asks_every_system(self):
        document = {"natural": [str(self.dir / "walks")], "paths": [], "held_out_samples": 1,
                    "systems": [{"name": "demo", "model": str(DEMO)}],
                    "cases": [{"name": "soon", "task": "predict", "samples": 2,
                               "options": {"seed_frames": 20, "seconds": 1}},
                              {"name": "clean", "task": "denoise", "options": {"noise": 0.02}}]}
        file = self.dir / "experiment.json"
        file.write_text(json.dumps(document))
        report = self.run_json("report", file, "--out", self.dir / "r")
        table = json.loads(next(pathlib.Path(t).with_suffix(".json").read_text()
                                for t in report["tables"] if "tasks" in t))
        self.assertEqual([row[:2] for row in table["rows"]],
                         [["soon", "the last frame held"], ["soon", "demo"]])
        self.assertLess(table["rows"][1][2], table["rows"][0][2])
        self.assertIn("demo cannot denoise", table["caption"])
        for key, value, expected in (("options", {"seedframes": 20}, "options.seedframes"),
                                     ("task", "dance", "predict, complete, denoise"),
                                     ("sample", 2, "cases[0].sample")):
            wrong = json.loads(json.dumps(document))
            wrong["cases"][0][key] = value
            file.write_text(json.dumps(wrong))
            self.assert_refused(["report", file, "--out", self.dir / "w"], expected)

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
        for option in (("--temperature", "0.5"), ("--option", "temperature=0.5"),
                       ("--option", "style=1")):
            self.assert_refused(["sample", model, "--path", "preset:circle", *option,
                                 "--out", self.dir / "t"], option[1].split("=")[0]
                                if "=" in option[1] else "temperature")
        info = self.run_json("model", "info", model)
        self.assertEqual(info["options"], [])
        self.assertEqual(info["facts"]["latent"], "none: equal control gives equal motion")
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
