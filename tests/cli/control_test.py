"""Control besides the path: types of motion, signals, bodies, from files to sampled motion."""
import json
import math
import pathlib

from support import Case, main


class Control(Case):
    def setUp(self):
        super().setUp()
        self.run_json("demo", "--write-data", self.dir / "walks", "--clips", "4",
                      "--clip-seconds", "4", "--seed", "11")
        for i, clip in enumerate(sorted((self.dir / "walks").glob("*.bvh"))):
            self.write(clip.with_suffix(".labels.csv"), "from,to,label",
                       *(["0,1.5,stand", "2,4,walk"] if i % 2 else ["0,4,walk"]))
            self.write(clip.with_suffix(".speech.csv"), "time,loud",
                       *[f"{t / 50},{math.sin(t / 5)}" for t in range(200)])
        self.clip = self.dir / "walks/walker_0001.bvh"
        self.data = self.dir / "data.marey"

    def write(self, path, *rows):
        path.write_text("\n".join(rows) + "\n")
        return path

    def trained(self, *options):
        found = self.run_json("prepare", self.dir / "walks", *options, "--out", self.data)
        config = self.dir / "rnn.json"
        self.run_json("model", "example", "rnn", "--out", config)
        self.run_json("train", config, "--data", self.data, "--steps", "2",
                      "--out", self.dir / "run")
        return found, self.dir / "run/last.marey"

    def sampled(self, model, name, *options):
        found = self.run_json("sample", model, "--seconds", "2", "--format", "csv", "--out",
                              self.dir / name, *options)
        return pathlib.Path(found["clips"][0]).read_bytes()

    def test_types_and_signals_reach_the_model_from_every_side(self):
        found, model = self.trained("--types", "stand,walk", "--signal", "speech:future=0.5",
                                    "--optional", "speech")
        # Root 3, two types, 1 + 10 frames of speech and whether there is any.
        self.assertEqual(found["control_dim"], 3 + 2 + 11 + 1)
        info = self.run_json("model", "info", model)
        self.assertEqual(info["control"], found["control"])
        self.assertEqual([c["name"] for c in info["control"]], ["root", "type", "speech"])
        path = ["--path", "preset:slow"]
        walk = self.sampled(model, "a", *path, "--type", "walk")
        self.assertNotEqual(walk, self.sampled(model, "b", *path, "--type", "stand"))
        speech = self.dir / "walks/walker_0000.speech.csv"
        spoken = self.sampled(model, "c", *path, "--type", "walk", "--control", speech)
        self.assertNotEqual(walk, spoken)
        self.assertEqual(spoken, self.sampled(model, "d", *path, "--type", "walk",
                                              "--control", f"speech={speech}"))
        self.assertEqual(walk, self.sampled(model, "e", *path, "--type", "walk", "--control",
                                            speech, "--without", "speech"))
        along = ["--path", f"clip:{self.clip}"]
        own = self.sampled(model, "f", *along)
        self.assertNotEqual(own, self.sampled(model, "g", *along, "--type", "walk"))
        way = self.write(self.dir / "way.csv", "x,z,time,type", "0,0,0,stand", "0,1,1.5,walk",
                         "0,3,4,")
        self.assertNotEqual(self.sampled(model, "h", "--path", way),
                            self.sampled(model, "i", "--path", way, "--type", "stand"))

    def test_what_is_missing_or_unknown_is_named(self):
        _, model = self.trained("--types", "auto", "--no-mirror")
        out = ["--path", "preset:slow", "--out", self.dir / "s"]
        self.assert_refused(["sample", model, *out], "one of stand, walk")
        self.assert_refused(["sample", model, *out, "--type", "dance"], "'dance'", "stand, walk")
        self.assert_refused(["sample", model, *out, "--type", "walk", "--without", "type"],
                            "one of stand, walk")
        self.assert_refused(["sample", model, *out, "--type", "walk", "--without", "speech"],
                            "'speech'")
        self.assert_refused(["sample", model, *out, "--control", "a.csv"], "a signal", status=2)
        self.assert_refused(["sample", model, *out, "--type", "walk", "--body", self.clip],
                            "whose control is a body")
        self.assertFalse((self.dir / "s").exists())
        self.write(self.clip.with_suffix(".labels.csv"), "from,to,label", "0,4,jump")
        self.assert_refused(["prepare", self.dir / "walks", "--types", "stand,walk",
                             "--out", self.dir / "d2.marey"], "walker_0001", "'jump'")
        self.assert_refused(["prepare", self.dir / "walks", "--optional", "type",
                           "--out", self.dir / "d2.marey"], "'type'", status=2)
        self.assert_refused(["prepare", self.dir / "walks", "--signal", "speech:rate=2",
                           "--out", self.dir / "d2.marey"], "speech:rate=2", status=2)

    def test_a_model_without_types_says_so(self):
        _, model = self.trained()
        self.assert_refused(["sample", model, "--path", "preset:slow", "--type", "walk",
                             "--out", self.dir / "s"], "knows types")

    def test_documents_and_bodies(self):
        _, model = self.trained("--types", "stand,walk", "--bodies", "--future-path", "0.3,0.6")
        document = {"natural": ["walker:2,4,3"], "systems": [{"name": "RNN", "model": str(model)}],
                    "samples": 2, "held_out_samples": 0,
                    "paths": [{"name": "stand", "path": "preset:slow", "seconds": 2,
                               "type": "stand"},
                              {"name": "walk", "path": "preset:slow", "seconds": 2,
                               "type": "walk", "body": str(self.clip)}]}
        document["natural"] = [str(self.dir / "walks")]
        file = self.dir / "experiment.json"
        file.write_text(json.dumps(document))
        report = self.run_json("report", file, "--out", self.dir / "report")
        self.assertTrue(report["tables"])
        document["paths"][0]["typ"] = "stand"
        file.write_text(json.dumps(document))
        self.assert_refused(["report", file, "--out", self.dir / "r2"], "paths[0].typ")


if __name__ == "__main__":
    main()
