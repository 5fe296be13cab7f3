"""marey train in several processes: the numbers of one, and an end for all of them."""
import csv
import os
import signal
import socket
import struct
import subprocess
import time

from support import BINARY, LIMIT_S, Case, main, read_tensors

MODEL = {"hidden": 32, "dropout": 0.5}


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def floats(entry):
    kind, _, data = entry
    return struct.unpack(f"<{len(data) // 4}f", data) if kind == "F32" else ()


class Processes(Case):
    def setUp(self):
        super().setUp()
        self.data = self.prepared(self.walker())

    def words(self, config, run, *more):
        return [BINARY, "train", str(config), "--data", str(self.data), "--out",
                str(self.dir / run), "--threads", "1", "--quiet", *map(str, more)]

    def start(self, words_of, launcher=("RANK", "WORLD_SIZE")):
        """Two processes; words_of(rank) is the command line of each."""
        port = str(free_port())
        out = []
        for rank in range(2):
            environment = {**os.environ, launcher[0]: str(rank), launcher[1]: "2",
                           "MASTER_ADDR": "127.0.0.1", "MASTER_PORT": port}
            process = subprocess.Popen(words_of(rank), env=environment, text=True,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.addCleanup(process.stdout.close)
            self.addCleanup(process.stderr.close)
            self.addCleanup(process.kill)
            out.append(process)
        return out

    def ends(self, processes, within=LIMIT_S):
        """(exit status, stderr) of each."""
        said = [p.communicate(timeout=within) for p in processes]
        return [(p.returncode, err) for p, (_, err) in zip(processes, said)]

    def log(self, run):
        with open(self.dir / run / "log.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def wait_for_checkpoint(self, run, process):
        until = time.monotonic() + LIMIT_S
        while not (self.dir / run / "state.marey").exists():
            self.assertIsNone(process.poll(), "ended before it could be stopped")
            self.assertLess(time.monotonic(), until)
            time.sleep(0.01)

    def test_two_processes_train_as_one_does(self):
        config = self.tiny_config(model=MODEL, batch=5, steps=8, checkpoint_every=4, ema=0.9,
                                  accumulate=2, validation_share=0.5)
        done = subprocess.run(self.words(config, "one"), capture_output=True, text=True,
                              timeout=LIMIT_S, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        two = self.start(lambda rank: self.words(config, "two"),
                         ("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"))
        self.assertEqual(self.ends(two), [(0, ""), (0, "")])
        one, two = self.log("one"), self.log("two")
        self.assertEqual([row["step"] for row in one], ["4", "8"])
        for left, right in zip(one, two, strict=True):
            for key in set(left) - {"seconds"}:
                a, b = float(left[key]), float(right[key])
                self.assertTrue(a == b or abs(a - b) <= 1e-5 * abs(a) or a != a and b != b,
                                f"{key}: {a} {b}")
        a = read_tensors(self.dir / "one" / "last.marey")[1]
        b = read_tensors(self.dir / "two" / "last.marey")[1]
        self.assertEqual(sorted(a), sorted(b))
        for name in a:
            for x, y in zip(floats(a[name]), floats(b[name]), strict=True):
                self.assertAlmostEqual(x, y, delta=1e-5, msg=name)
        self.assertEqual(sorted(p.name for p in (self.dir / "one").iterdir()),
                         sorted(p.name for p in (self.dir / "two").iterdir()))

    def test_a_killed_process_is_named_by_the_other(self):
        config = self.tiny_config(model=MODEL, steps=1000000, checkpoint_every=5)
        for victim in (1, 0):
            processes = self.start(lambda rank, run=f"killed{victim}": self.words(config, run))
            self.wait_for_checkpoint(f"killed{victim}", processes[0])
            processes[victim].kill()
            status, error = self.ends([processes[1 - victim]], within=20)[0]
            self.assertEqual(status, 1)
            self.assertIn(f"no answer from process {victim}", error)

    def test_ctrl_c_on_one_ends_both_after_a_checkpoint(self):
        config = self.tiny_config(model=MODEL, steps=1000000, checkpoint_every=5)
        processes = self.start(lambda rank: self.words(config, "stopped"))
        self.wait_for_checkpoint("stopped", processes[0])
        processes[1].send_signal(signal.SIGINT)
        for status, error in self.ends(processes):
            self.assertEqual(status, 1)
            self.assertIn("cancelled", error)
        last = int(self.log("stopped")[-1]["step"])
        self.assertGreater(last, 0)
        # What was written is whole: one process goes on from there.
        done = subprocess.run(self.words(config, "stopped", "--resume", "--steps", last + 1),
                              capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(int(self.log("stopped")[-1]["step"]), last + 1)

    def test_an_error_of_the_first_ends_the_other_and_says_why(self):
        config = self.tiny_config(model=MODEL, steps=1000000, checkpoint_every=5)
        processes = self.start(lambda rank: self.words(config, "broken"))
        self.wait_for_checkpoint("broken", processes[0])
        log = self.dir / "broken" / "log.csv"
        log.unlink()
        log.mkdir()
        (first, own), (second, other) = self.ends(processes)
        self.assertEqual((first, second), (1, 1))
        self.assertIn("log.csv", own)
        self.assertRegex(other, "process 0: .*log.csv|no answer from process 0")

    def test_processes_of_different_runs_are_refused(self):
        configs = [self.tiny_config(f"{rank}.json", model=MODEL, learning_rate=0.001 * (rank + 1))
                   for rank in range(2)]
        processes = self.start(lambda rank: self.words(configs[rank], "mixed"))
        for status, error in self.ends(processes):
            self.assertEqual(status, 1)
            self.assertIn("run", error)
        self.assertFalse((self.dir / "mixed" / "last.marey").exists())


if __name__ == "__main__":
    main()
