"""One odd file among good ones: it is skipped, counted and named; alone, or named and broken, it is
an error."""
import json

from support import SharedModelCase, main, marey


class MixedFiles(SharedModelCase):
    def setUp(self):
        super().setUp()
        self.folder = self.dir / "clips"
        self.folder.mkdir()
        self.text = self.clip.read_text()

    def write(self, name, text=None):
        path = self.folder / name
        path.write_text(text or self.text)
        return path

    def other_body(self, name):
        return self.write(name, self.text.replace("JOINT LeftFoot", "JOINT LeftPaw"))

    def broken(self, name):
        return self.write(name, self.text[:len(self.text) // 2])

    def counted(self, *words):
        """The result on stdout and what is told on stderr."""
        done = marey(*words, "--json")
        self.assertEqual(done.returncode, 0, f"{words}: {done.stderr}")
        return json.loads(done.stdout), done.stderr

    def report(self, *natural):
        document = self.dir / "document.json"
        document.write_text(json.dumps({
            "title": "Mixed", "natural": [str(name) for name in natural],
            "systems": [{"name": "A", "model": str(self.model)}], "paths": [], "samples": 1,
            "held_out_samples": 0, "fps": 20}))
        return ["report", document, "--out", self.dir / "report", "--no-pdf"]

    def test_a_clip_of_another_skeleton_is_skipped_counted_and_named(self):
        odd = self.other_body("a_odd.bvh")
        good = [self.write("b.bvh"), self.write("c.bvh")]
        for words in (["analyze", odd, *good, "--resamples", 0],
                      ["analyze", self.folder, "--resamples", 0],
                      ["analyze", *good, odd, "--resamples", 0],
                      ["analyze", odd, *good, "--resamples", 0, "--feet", "LeftFoot,RightFoot"],
                      ["score", self.model, odd, *good]):
            with self.subTest(words=words):
                result, told = self.counted(*words)
                clips = result["clips"]
                self.assertEqual(clips if isinstance(clips, int) else len(clips), 2)
                self.assertEqual([one["path"] for one in result["left_out"]], [str(odd)])
                self.assertIn("LeftPaw", result["left_out"][0]["why"])
                self.assertIn("a_odd.bvh", told)
                self.assertIn("1 clip left out", told)

    def test_leaving_a_clip_out_changes_no_number_of_the_others(self):
        good = [self.write("b.bvh"), self.write("c.bvh")]
        alone, _ = self.counted("analyze", *good, "--resamples", 0)
        mixed, _ = self.counted("analyze", self.other_body("a.bvh"), *good, "--resamples", 0)
        self.assertEqual(len(mixed.pop("left_out")), 1)
        self.assertNotIn("left_out", alone)
        self.assertEqual(mixed["statistics"], alone["statistics"])

    def test_natural_clips_of_another_skeleton_are_left_out_of_the_comparison(self):
        odd, good = self.other_body("a.bvh"), self.write("b.bvh")
        result, _ = self.counted("analyze", good, "--against", odd, good, "--resamples", 0)
        self.assertEqual([one["path"] for one in result["left_out"]], [str(odd)])
        self.assert_refused(["analyze", good, "--against", odd, "--quiet"], "a.bvh", "LeftPaw")

    def test_one_clip_of_the_wrong_skeleton_alone_is_an_error(self):
        odd, second = self.other_body("a.bvh"), self.other_body("b.bvh")
        self.assert_refused(["score", self.model, odd, "--quiet"], "a.bvh", "LeftPaw")
        self.assert_refused(["score", self.model, odd, second, "--quiet"], "a.bvh", "b.bvh")

    def test_a_broken_file_of_a_folder_is_named_in_report_and_json(self):
        bad = self.broken("a_bad.bvh")
        self.write("b.bvh")
        self.write("c.bvh")
        self.write("labels.npz", "no archive")
        (self.folder / "notes.doc").write_text("mine")
        result, told = self.counted(*self.report(self.folder))
        self.assertEqual([one["path"].rsplit("/", 1)[1] for one in result["not_read"]],
                         ["labels.npz", "a_bad.bvh"])
        self.assertIn("240 frames", result["not_read"][1]["reason"])
        self.assertEqual(result["other_files"], {"doc": 1})
        for text in (str(bad), "2 files not read", "240 frames"):
            self.assertIn(text, told)
        page = (self.dir / "report" / "report.html").read_text()
        for text in ("Files of the natural motion", "a_bad.bvh", "labels.npz", "240 frames"):
            self.assertIn(text, page)

    def test_a_broken_file_that_is_named_stops_the_report(self):
        bad, good = self.broken("a_bad.bvh"), self.write("b.bvh")
        self.assert_refused([*self.report(bad, good), "--quiet"], "a_bad.bvh", "240 frames",
                            untouched=self.folder)

    def test_a_folder_without_one_good_file_stops_the_report_with_its_reasons(self):
        self.broken("a_bad.bvh")
        self.assert_refused([*self.report(self.folder), "--quiet"], "a_bad.bvh", "240 frames",
                            untouched=self.folder)


if __name__ == "__main__":
    main()
