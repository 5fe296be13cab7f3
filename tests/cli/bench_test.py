"""marey bench: what it measures and how it says so."""
import json

from support import TINY_CONFIG, Case, main, marey


class Bench(Case):
    def test_render_measures_both_paths_in_one_run(self):
        result = self.run_json("bench", "render", "--motions", "3", "--frames", "4", "--size",
                               "160x120", "--detail", "lines")
        self.assertEqual({k: result[k] for k in ("motions", "joints", "detail", "width",
                                                 "height", "frames")},
                         {"motions": 3, "joints": 21, "detail": "lines", "width": 160,
                          "height": 120, "frames": 4})
        for key in ("ms_per_frame", "frames_per_s", "fill_ms", "reference_ms_per_frame", "ratio"):
            self.assertIsInstance(result[key], float, key)
            self.assertGreater(result[key], 0.0, key)
        self.assertAlmostEqual(result["frames_per_s"], 1000.0 / result["ms_per_frame"], places=3)
        self.assertAlmostEqual(result["ratio"], result["reference_ms_per_frame"] /
                               result["ms_per_frame"], places=3)
        self.assertLess(result["fill_ms"], result["ms_per_frame"])

    def model_bench(self, what, *more):
        config = self.dir / "tiny.json"
        config.write_text(json.dumps(TINY_CONFIG))
        result = self.run_json("bench", what, "--config", config, "--frames", 12, *more)
        for key in ("ms_per_frame", "best_ms_per_frame", "frames_per_s", "gflops",
                    "sgemm_gflops", "share_of_sgemm", "weight_gb_s", "read_gb_s",
                    "share_of_read"):
            self.assertIsInstance(result[key], float, key)
            self.assertGreater(result[key], 0.0, key)
        self.assertAlmostEqual(result["share_of_sgemm"], result["gflops"] /
                               result["sgemm_gflops"], places=6)
        self.assertAlmostEqual(result["frames_per_s"] * result["ms_per_frame"],
                               1000.0 * result["batch"], places=3)
        self.assertAlmostEqual(
            result["gflops"], 2e-9 * result["parameters"] * result["frames_per_s"], places=6)
        return result

    def test_sampling_and_scoring_measure_both_paths_and_find_them_equal(self):
        for what in ("sample", "score"):
            result = self.model_bench(what, "--batch", 5)
            self.assertEqual((result["batch"], result["weights"]), (5, "float32"))
            self.assertAlmostEqual(result["ratio"], result["reference_ms_per_frame"] /
                                   result["ms_per_frame"], places=6)
            # Nats are about a hundred, poses about one.
            self.assertLess(result["max_abs_difference"], 1e-5 if what == "sample" else 1e-3)

    def test_sixteen_bits_differ_and_the_plain_path_can_be_left_out(self):
        rounded = self.model_bench("sample", "--weights", "bf16")
        self.assertGreater(rounded["max_abs_difference"], 1e-6)
        self.assertLess(rounded["max_abs_difference"], 0.5)
        self.assertNotIn("ratio", self.model_bench("score", "--no-reference"))

    def test_training_measures_both_paths_and_finds_the_same_loss(self):
        config = self.tiny_config(model={"hidden": 32})
        result = self.run_json("bench", "train", "--config", config, "--batch", 6, "--frames", 10,
                               "--steps", 3)
        self.assertEqual((result["batch"], result["frames"]), (6, 10))
        for key in ("ms_per_step", "best_ms_per_step", "ms_per_frame", "reference_ms_per_step",
                    "reference_ms_per_frame", "gflops", "sgemm_gflops", "share_of_sgemm"):
            self.assertIsInstance(result[key], float, key)
            self.assertGreater(result[key], 0.0, key)
        self.assertAlmostEqual(result["ratio"] * result["ms_per_frame"],
                               result["reference_ms_per_frame"], places=6)
        self.assertAlmostEqual(result["ms_per_step"], 10 * result["ms_per_frame"], places=6)
        self.assertAlmostEqual(result["frames_per_s"] * result["ms_per_step"], 60000.0, places=3)
        self.assertAlmostEqual(
            result["gflops"], 6e-9 * result["parameters"] * result["frames_per_s"], places=6)
        self.assertGreater(abs(result["loss_nats_per_frame"]), 10.0)
        self.assertLess(result["max_abs_difference"], 1e-3)
        self.assertNotIn("ratio", self.run_json("bench", "train", "--config", config, "--batch",
                                                2, "--frames", 3, "--no-reference"))

    def test_a_crowd_becomes_lines(self):
        words = ["bench", "render", "--frames", "1", "--size", "64x64"]
        self.assertEqual(self.run_json(*words, "--motions", "2")["drawn_as"], "capsules")
        self.assertEqual(self.run_json(*words, "--motions", "450")["drawn_as"], "lines")

    def test_wrong_usage_is_refused(self):
        for words in ([], ["render", "--motions", "0"], ["render", "--frames", "0"],
                      ["sample"], ["score", "--config", "x.json", "--batch", "0"],
                      ["sample", "--config", "x.json", "--weights", "int3"],
                      ["render", "--detail", "blobs"], ["render", "--size", "1280"],
                      ["render", "--size", "8x8"]):
            with self.subTest(words=words):
                self.assert_refused(["bench", *words], status=2, cwd=self.dir)

    def test_help_has_an_example(self):
        done = marey("bench", "render", "--help")
        self.assertEqual(done.returncode, 0)
        self.assertIn("marey bench render ", done.stdout)


if __name__ == "__main__":
    main()
