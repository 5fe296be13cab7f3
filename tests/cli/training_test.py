"""What a killed run, a repeated run and a prolonged run have in common: the same numbers."""
import io
import json
import math
import pathlib
import re
import shutil
import signal
import subprocess
import time
import zipfile

from support import BINARY, LIMIT_S, Case, SharedModelCase, main, marey, read_tensors

STEPS = 120


class KilledTraining(Case):
    def setUp(self):
        super().setUp()
        self.data = self.prepared(self.walker())
        self.config = self.tiny_config(steps=STEPS, checkpoint_every=5)

    def words(self, run, *more):
        return [BINARY, "train", str(self.config), "--data", str(self.data), "--out",
                str(self.dir / run), "--threads", "1", "--quiet", *more]

    def finish(self, *words):
        done = subprocess.run(words, capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def interrupt(self, run, number):
        """Starts a run, sends the signal after its second checkpoint; the process that ended."""
        log = self.dir / run / "log.csv"
        process = subprocess.Popen(self.words(run), stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        until = time.monotonic() + LIMIT_S
        while not log.exists() or len(log.read_text().splitlines()) < 3:
            self.assertIsNone(process.poll(), "ended before it could be stopped")
            self.assertLess(time.monotonic(), until)
            time.sleep(0.005)
        process.send_signal(number)
        process.wait(timeout=LIMIT_S)
        return process

    def stored_step(self, run):
        return int(re.search(r'"step":(\d+)', read_tensors(
            self.dir / run / "state.marey")[0]["marey"])[1])

    def logged_steps(self, run):
        return [line.split(",")[0] for line in (self.dir / run / "log.csv").read_text()
                .splitlines()]

    def assert_same_tensors(self, left, right, *names):
        for name in names:
            a = read_tensors(self.dir / left / name)[1]
            b = read_tensors(self.dir / right / name)[1]
            self.assertGreater(len(a), 10)
            self.assertEqual(sorted(a), sorted(b))
            for key in a:
                self.assertEqual(a[key], b[key], f"{name}: {key}")
    def test_a_killed_run_that_is_resumed_ends_as_an_unbroken_one(self):
        killed = self.interrupt("killed", signal.SIGKILL)
        self.assertEqual(killed.returncode, -signal.SIGKILL)
        self.assertLess(self.stored_step("killed"), STEPS)
        before = read_tensors(self.dir / "killed" / "last.marey")[1]
        self.finish(*self.words("killed", "--resume"))
        self.finish(*self.words("unbroken"))
        self.assertEqual(self.stored_step("killed"), STEPS)
        self.assert_same_tensors("killed", "unbroken", "last.marey", "best.marey", "state.marey")
        self.assertEqual(self.logged_steps("killed"), self.logged_steps("unbroken"))
        self.assertNotEqual(before, read_tensors(self.dir / "killed" / "last.marey")[1])

    def test_an_interrupted_run_saves_says_so_and_can_be_resumed(self):
        stopped = self.interrupt("stopped", signal.SIGINT)
        self.assertEqual(stopped.returncode, 1)
        self.assertTrue(stopped.stderr.read().strip())
        self.assertEqual([p.name for p in (self.dir / "stopped").iterdir()
                          if "partial" in p.name], [])
        self.assertLess(self.stored_step("stopped"), STEPS)
        self.finish(*self.words("stopped", "--resume"))
        self.finish(*self.words("unbroken"))
        # Not the best one: the stop adds a validation that the unbroken run has not.
        self.assert_same_tensors("stopped", "unbroken", "last.marey", "state.marey")

    def test_resuming_a_run_that_has_ended_changes_nothing_and_says_what_it_reached(self):
        self.finish(*self.words("run", "--steps", "10"))
        files = [p for p in sorted((self.dir / "run").rglob("*")) if p.is_file()]
        before = {p: p.read_bytes() for p in files}
        result = self.run_json(*self.words("run", "--steps", "10", "--resume")[1:])
        self.assertEqual(before, {p: p.read_bytes() for p in files})
        self.assertEqual(result["steps"], 10)
        self.assertIsNone(result["train_bits_per_frame"])
        self.assertTrue(math.isfinite(result["valid_bits_per_frame"]))

    def test_a_run_is_not_overwritten_and_another_one_is_not_resumed(self):
        self.finish(*self.words("run", "--steps", "2"))
        train = ["train", self.config, "--data", self.data, "--out", self.dir / "run", "--quiet"]
        self.assert_refused(train, "run", "--resume")
        self.assert_refused([*train, "--resume", "--seed", "9"], "state.marey", "seed")
        other = self.tiny_config(name="other.json", model={"hidden": 12}, steps=STEPS,
                                 checkpoint_every=5)
        train[1] = other
        self.assert_refused([*train, "--resume"], "state.marey", "model")
        train[5:6] = [self.dir / "fresh", "--resume"]
        self.assert_refused(train, "state.marey", "nothing to resume")


SHIPPED = pathlib.Path(__file__).parents[2] / "resources/models/moglow-plus-small.marey"


class Sampling(SharedModelCase):
    def sample(self, name, count, *more, model=None, env=None):
        out = self.dir / name
        done = marey("sample", model or self.model, "--path", "preset:figure-eight", "--seconds",
                     1, "-n", count, "--out", out, "--quiet", *more, env=env)
        self.assertEqual(done.returncode, 0, done.stderr)
        form = more[more.index("--format") + 1] if "--format" in more else "bvh"
        clips = {p.name: p.read_bytes() for p in out.glob(f"sample_*.{form}")}
        self.assertEqual(len(clips), count)
        return clips

    def test_the_same_seed_gives_the_same_bytes_and_another_seed_others(self):
        first = self.sample("first", 3, "--seed", 4)
        self.assertEqual(first, self.sample("again", 3, "--seed", 4))
        other = self.sample("other", 3, "--seed", 5)
        for name, content in first.items():
            self.assertNotEqual(content, other[name])
        self.assertEqual(len(set(first.values())), 3)

    def assert_few_are_the_first_of_many(self, model, env):
        for form in ("bvh", "npz"):
            few = self.positions(self.sample(f"few-{form}", 3, "--seed", 4, "--threads", 1,
                                             "--format", form, model=model, env=env))
            many = self.positions(self.sample(f"many-{form}", 5, "--seed", 4, "--threads", 2,
                                              "--format", form, model=model, env=env))
            self.assertEqual(few, {name: many[name] for name in few}, form)
            self.assertEqual(len(set(many.values())), 5)
            shutil.rmtree(self.dir / f"few-{form}")
            shutil.rmtree(self.dir / f"many-{form}")

    @staticmethod
    def positions(clips):
        """Of archives the positions alone: their recipes hold the command."""
        out = {}
        for name, content in clips.items():
            if name.endswith(".npz"):
                with zipfile.ZipFile(io.BytesIO(content)) as archive:
                    content = archive.read("positions.npy")
            out[name] = content
        return out

    def test_fewer_samples_are_the_first_of_more_whatever_the_threads(self):
        self.assert_few_are_the_first_of_many(self.model, None)

    def test_so_they_are_with_a_base_below_the_flow_and_with_other_blas_kernels(self):
        for env in (None, {"OPENBLAS_CORETYPE": "Haswell"}):
            with self.subTest(env=env):
                self.assert_few_are_the_first_of_many(SHIPPED, env)

    def test_sixteen_bits_come_close_and_are_named_in_the_recipe(self):
        full = self.sample("full", 1, "--seed", 4, "--format", "csv")
        rounded = self.sample("rounded", 1, "--seed", 4, "--format", "csv", "--weights", "bf16")
        numbers = [[float(v) for line in clips["sample_000.csv"].decode().splitlines()[1:]
                    for v in line.split(",")[3:]] for clips in (full, rounded)]
        worst = max(abs(a - b) for a, b in zip(*numbers))
        self.assertEqual(len(numbers[0]), len(numbers[1]))
        self.assertLess(worst, 0.2)
        self.assertGreater(worst, 0.0)
        for name, weights in (("full", "float32"), ("rounded", "bf16")):
            recipe = json.loads((self.dir / name / "sample_000.csv.recipe.json").read_text())
            self.assertEqual(recipe["weights"], weights)

    def test_memory_grows_by_less_than_two_megabytes_with_each_motion(self):
        peaks = [self.run_json("sample", self.model, "--path", "preset:figure-eight", "--seconds",
                               4, "-n", count, "--out", self.dir / f"peak-{count}", "--format",
                               "npz")["peak_memory_mb"] for count in (1, 41)]
        self.assertGreater(peaks[0], 1.0)
        self.assertLess(peaks[1] - peaks[0], 2.0 * 40)

    def test_temperature_zero_leaves_nothing_random(self):
        cold = self.sample("cold", 2, "--temperature", 0)
        self.assertEqual(len(set(cold.values())), 1)


if __name__ == "__main__":
    main()
