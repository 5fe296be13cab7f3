"""A model that makes whole clips and has no likelihood, through every command."""
import json
import pathlib
import shutil
import tempfile

from support import Case, main, marey, read_tensors

CONFIG = {
    "family": "vae",
    "name": "tiny-vae",
    "model": {"hidden": 8, "layers": 1, "kld_warmup_steps": 2},
    "training": {"window_s": 2.0, "hop_s": 1.0, "batch": 4, "learning_rate": 0.003, "steps": 6,
                 "checkpoint_every": 2},
}


class WholeClips(Case):
    @classmethod
    def setUpClass(cls):
        maker = Case()
        maker.dir = cls.home = pathlib.Path(tempfile.mkdtemp(prefix="marey-cli-"))
        cls.addClassCleanup(shutil.rmtree, cls.home, ignore_errors=True)
        cls.flow, cls.clips = maker.trained()
        cls.clip = cls.clips / "walker_0000.bvh"
        cls.data = cls.home / "data.marey"
        cls.model = cls.train(cls.home / "vae", "deterministic")

    @classmethod
    def train(cls, run, decoder):
        config = json.loads(json.dumps(CONFIG))
        config["model"]["decoder"] = decoder
        path = cls.home / f"{run.name}.json"
        path.write_text(json.dumps(config))
        done = marey("train", path, "--data", cls.data, "--out", run, "--threads", 1, "--json",
                     "--quiet")
        assert done.returncode == 0, done.stderr
        cls.result = json.loads(done.stdout)
        return run / "last.marey"

    def sample(self, name, count, *more, model=None):
        out = self.dir / name
        done = marey("sample", model or self.model, "--path", "preset:figure-eight", "--seconds",
                     2, "-n", count, "--out", out, "--quiet", *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return {p.name: p.read_bytes() for p in out.glob("sample_*.bvh")}

    def test_a_training_tells_its_own_objective_and_no_bits(self):
        self.assertEqual(self.result["steps"], 6)
        self.assertIn("divergence", self.result["objective"])
        self.assertNotIn("train_bits_per_frame", self.result)
        self.assertGreater(self.result["train"], 0.0)
        rows = (self.home / "vae" / "log.csv").read_text().splitlines()
        self.assertEqual(len(rows), 4)
        for term in ("reconstruction", "kld"):
            self.assertIn(term, rows[0])
        self.assertNotIn("bits", rows[0])

    def test_info_counts_what_the_configuration_counts(self):
        info = self.run_json("model", "info", self.model)
        self.assertEqual((info["family"], info["pose_dim"], info["context"]), ("vae", 63, 0))
        stored = sum(len(data) // 4 for name, (_, _, data) in read_tensors(self.model)[1].items()
                     if name.startswith("weights/"))
        self.assertEqual(info["parameters"], stored)
        of_config = self.run_json("model", "info", "--config", self.home / "vae.json")
        self.assertEqual(of_config["parameters"], stored)

    def test_few_samples_are_the_first_of_many_and_seeds_and_numbers_differ(self):
        gaussian = self.train(self.home / f"{self.id()}-gaussian", "gaussian")
        for name, model in (("plain", self.model), ("noisy", gaussian)):
            few = self.sample(f"{name}-few", 2, "--seed", 4, "--threads", 1, model=model)
            many = self.sample(f"{name}-many", 5, "--seed", 4, "--threads", 2, model=model)
            self.assertEqual(few, {k: many[k] for k in few})
            self.assertEqual(len(set(many.values())), 5)
            other = self.sample(f"{name}-other", 2, "--seed", 5, model=model)
            self.assertNotEqual(few["sample_000.bvh"], other["sample_000.bvh"])
            cold = self.sample(f"{name}-cold", 2, "--temperature", 0, model=model)
            self.assertEqual(len(set(cold.values())), 1)

    def test_what_needs_a_likelihood_or_a_rollout_says_so(self):
        self.assert_refused(["score", self.model, self.clip], "tiny-vae", "likelihood", "vae")
        self.assert_refused(["bench", "sample", "--config", self.home / "vae.json", "--batch", 1,
                             "--frames", 2], "frame by frame", "all control first")
        self.assert_refused(["bench", "score", "--config", self.home / "vae.json", "--batch", 1,
                             "--frames", 2], "likelihood")

    def test_a_misspelt_key_is_refused(self):
        config = json.loads(json.dumps(CONFIG))
        config["model"]["decodr"] = "gaussian"
        path = self.dir / "misspelt.json"
        path.write_text(json.dumps(config))
        self.assert_refused(["train", path, "--data", self.data, "--out", self.dir / "run"],
                            "misspelt.json", "decodr")

    def test_half_precision_halves_the_network_alone(self):
        half = self.dir / "half.marey"
        self.run_json("model", "export", self.model, "--half", "--out", half)
        whole, rounded = read_tensors(self.model)[1], read_tensors(half)[1]
        self.assertEqual(sorted(whole), sorted(rounded))
        for name, (kind, shape, data) in whole.items():
            network = name.startswith("weights/")
            self.assertEqual(rounded[name][0], "F16" if network else kind, name)
            self.assertEqual(rounded[name][1], shape)
            self.assertEqual(len(rounded[name][2]), len(data) // (2 if network else 1))
        self.assertEqual(len(self.sample("half", 1, model=half)), 1)

    def test_a_report_compares_it_with_a_flow_and_shows_no_likelihood_of_it(self):
        document = self.dir / "experiment.json"
        document.write_text(json.dumps(
            {"title": "Both", "natural": [str(self.clips)],
             "systems": [{"name": "FLOW", "model": str(self.flow)},
                         {"name": "VAE", "model": str(self.model)}],
             "paths": [{"name": "left", "path": "preset:turn-left", "seconds": 2}],
             "samples": 2, "held_out_samples": 1, "seed": 1, "fps": 20}))
        out = self.dir / "report"
        result = self.run_json("report", document, "--out", out)
        page = (out / pathlib.Path(result["report"]).name).read_text()
        self.assertIn("Log-likelihood under FLOW", page)
        self.assertNotIn("Log-likelihood under VAE", page)
        self.assertIn("This model has no likelihood", page)
        tables = [json.loads((out / t).read_text()) for t in result["tables"]
                  if pathlib.Path(t).name == "likelihood.json"]
        self.assertEqual(len(tables), 1)
        nats = {row["system"]: row["natural clips"] for row in rows_of(tables[0])}
        self.assertIsInstance(nats["FLOW"], float)
        self.assertIsNone(nats["VAE"])


def rows_of(table):
    """Rows of a report's table by the names of their columns."""
    names = [column["name"] for column in table["columns"]]
    return [dict(zip(names, row)) for row in table["rows"]]


if __name__ == "__main__":
    main()
