"""marey bench: what it measures and how it says so."""
from support import Case, main, marey


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

    def test_a_crowd_becomes_lines(self):
        words = ["bench", "render", "--frames", "1", "--size", "64x64"]
        self.assertEqual(self.run_json(*words, "--motions", "2")["drawn_as"], "capsules")
        self.assertEqual(self.run_json(*words, "--motions", "450")["drawn_as"], "lines")

    def test_wrong_usage_is_refused(self):
        for words in ([], ["render", "--motions", "0"], ["render", "--frames", "0"],
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
