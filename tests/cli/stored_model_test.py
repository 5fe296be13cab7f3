"""Models that were stored by earlier versions give the numbers that they gave."""
import json
import shutil

from support import FIXTURES, Case, main, read_tensors, write_tensors

FOLDER = FIXTURES / "trained-lengths"
# What is left between instruction sets: the flow's float32. A sum of 63 squares of values up to 10
# that are each rounded to 2^-24 of themselves is off by 63 * 100 * 2^-23 at most; the flow has one
# step, which rounds each value some ten times more.
ROUNDING = 63 * 100 * 2**-23 * 10


class TrainedLengths(Case):
    """A model of the time before the key 'bone_lengths'."""

    def scores(self, model):
        found = self.run_json("score", model, FOLDER / "walker.bvh")
        return found["clips"][0]["loglik_nats"]

    def with_lengths(self, value, tensors=None):
        metadata, old = read_tensors(FOLDER / "model.marey")
        inner = json.loads(metadata["marey"])
        self.assertNotIn("bone_lengths", inner["config"])
        inner["config"]["bone_lengths"] = value
        path = self.dir / f"{value}.marey"
        write_tensors(path, {**metadata, "marey": json.dumps(inner)}, tensors or old)
        return path

    def test_scores_are_those_of_the_version_that_stored_it(self):
        wanted = json.loads((FOLDER / "scores.json").read_text())["loglik_nats"]
        found = self.scores(FOLDER / "model.marey")
        self.assertEqual(len(found), len(wanted))
        for a, b in zip(found, wanted):
            self.assertAlmostEqual(a, b, delta=ROUNDING)

    def test_what_it_left_unsaid_changes_no_bit_when_said(self):
        self.assertEqual(self.scores(self.with_lengths("trained")),
                         self.scores(FOLDER / "model.marey"))

    def test_lengths_of_the_history_are_another_density(self):
        other = self.scores(self.with_lengths("history"))
        self.assertGreater(max(abs(a - b) for a, b in
                               zip(other, self.scores(FOLDER / "model.marey"))), 1e-4)

    def test_written_again_it_scores_the_same(self):
        copy = self.dir / "copy.marey"
        shutil.copy(FOLDER / "model.marey", copy)
        self.run_json("model", "export", copy, "--out", self.dir / "again.marey")
        self.assertEqual(self.scores(self.dir / "again.marey"), self.scores(copy))

    def test_another_word_is_refused(self):
        self.assert_refused(["score", self.with_lengths("both"), FOLDER / "walker.bvh"],
                            "bone_lengths", "trained, history", "'both'")


if __name__ == "__main__":
    main()
