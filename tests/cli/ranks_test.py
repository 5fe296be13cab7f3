"""Several processes under mpirun do what one does: the same bytes, one voice, one exit status."""
import json
import os
import signal
import subprocess
import time

from support import BINARY, LIMIT_S, Case, SharedModelCase, listing, main, marey, need_tools

# As many processes as asked for on any machine, also as root (containers).
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy":
               "none", "OMPI_MCA_btl": "self,vader"}


def launch_words(ranks, *words):
    return ["mpirun", "-n", str(ranks), BINARY, *map(str, words)]


def launch(ranks, *words, timeout=LIMIT_S, env=None):
    """The finished run of several processes; of one without mpirun."""
    if ranks == 1:
        return marey(*words, timeout=timeout, env=env)
    return subprocess.run(launch_words(ranks, *words), capture_output=True, text=True,
                          timeout=timeout, check=False,
                          env={**os.environ, **ENVIRONMENT, **(env or {})})


def own_lines(text):
    """What Marey itself said on stderr."""
    return [line for line in text.splitlines() if line.startswith("marey:")]


class RanksCase(SharedModelCase):
    def setUp(self):
        super().setUp()
        need_tools("mpirun")

    def sample_words(self, out, count=40, seconds=1, *more):
        return ("sample", self.model, "--path", "preset:figure-eight", "--seconds", seconds, "-n",
                count, "--seed", 4, "--threads", 1, "--out", self.dir / out, *more)

    def launch_json(self, ranks, *words, timeout=LIMIT_S):
        done = launch(ranks, *words, "--json", "--quiet", timeout=timeout)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def moved(self, name):
        """Runs write to one place, since recipes hold it; a result moves out of the way."""
        (self.dir / "out").rename(self.dir / name)
        return listing(self.dir / name)


class RanksSample(RanksCase):
    def test_any_number_of_processes_writes_the_same_files(self):
        for form, many in (("bvh", (2, 3)), ("npz", (3,))):
            results, files = {}, {}
            for ranks in (1, *many):
                words = self.sample_words("out", 33, 0.5, "--format", form, "--json", "--quiet")
                done = launch(ranks, *words)
                self.assertEqual(done.returncode, 0, done.stderr)
                results[ranks] = json.loads(done.stdout)
                files[ranks] = self.moved(f"{form}-{ranks}")
                self.assertEqual([p.name for p in self.dir.glob("*partial*")], [])
            self.assertEqual(len([n for n in files[1] if n.endswith(form)]), 33)
            self.assertNotIn(".run", files[1])
            for ranks in many:
                self.assertEqual(files[ranks], files[1], f"{form}, {ranks} processes")
                for key in ("clips", "seconds_each", "fit_residual_cm", "fit_residual_max_cm"):
                    self.assertEqual(results[ranks].get(key), results[1].get(key), key)

    def test_fewer_motions_than_processes_are_written_all_the_same(self):
        result = self.launch_json(3, *self.sample_words("out", 2))
        self.assertEqual(len(result["clips"]), 2)
        self.assertEqual(len([n for n in self.moved("few") if n.endswith(".bvh")]), 2)

    def test_an_error_of_one_process_ends_all_with_one_message_that_names_it(self):
        absent = [BINARY, *map(str, self.sample_words("out"))]
        absent[2] = str(self.dir / "absent.marey")
        done = subprocess.run(
            [*launch_words(2, *self.sample_words("out", 40, 4)), ":", "-n", "1", *absent],
            capture_output=True, text=True, timeout=LIMIT_S, check=False,
            env={**os.environ, **ENVIRONMENT})
        self.assertEqual(done.returncode, 1, done.stderr)
        lines = own_lines(done.stderr)
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertIn("rank 2 of 3 processes: ", lines[0])
        self.assertIn("absent.marey", lines[0])
        self.assertEqual(done.stdout, "")
        self.assertEqual(list(listing(self.dir)), [])

    def test_motions_that_leave_the_range_of_numbers_leave_nothing(self):
        done = launch(3, *self.sample_words("out", 40, 1, "--temperature", "1e38"))
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(len(own_lines(done.stderr)), 1, done.stderr)
        self.assertEqual(list(listing(self.dir)), [])

    def test_what_is_wrong_for_all_is_said_once(self):
        done = launch(3, "sample", self.dir / "absent.marey", "--path", "preset:still", "--out",
                      self.dir / "out")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(own_lines(done.stderr)), 1, done.stderr)
        self.assertIn("absent.marey", own_lines(done.stderr)[0])

    def test_wrong_usage_has_its_own_status(self):
        done = launch(2, "sample", self.model, "--path", "preset:nowhere", "--out",
                      self.dir / "out")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(own_lines(done.stderr)), 1, done.stderr)
        self.assertFalse((self.dir / "out").exists())

    def test_a_command_for_one_process_refuses_several(self):
        done = launch(2, "convert", self.clip, "--out", self.dir / "a.npz")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(own_lines(done.stderr)), 1, done.stderr)
        self.assertIn("2", own_lines(done.stderr)[0])
        self.assertFalse((self.dir / "a.npz").exists())


class RanksScore(RanksCase):
    def test_any_number_of_processes_prints_the_same_object(self):
        walked = self.walker(clips=5, seconds=2)
        many = self.dir / "npz"
        self.run_json("convert", walked, "--out", many, "--format", "npz")
        printed = {ranks: launch(ranks, "score", self.model, walked, many, "--json", "--quiet")
                   for ranks in (1, 2, 3)}
        for ranks, done in printed.items():
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout, printed[1].stdout, f"{ranks} processes")
        self.assertEqual(len(json.loads(printed[1].stdout)["clips"]), 10)

    def test_the_table_is_printed_once(self):
        done = launch(2, "score", self.model, self.clips)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, launch(1, "score", self.model, self.clips).stdout)

    def test_a_clip_that_one_process_cannot_read_is_named(self):
        bad = self.dir / "bad.bvh"
        bad.write_text("HIERARCHY\nnonsense")
        done = launch(2, "score", self.model, self.clip, bad)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(len(own_lines(done.stderr)), 1, done.stderr)
        self.assertIn("rank 1 of 2 processes: ", own_lines(done.stderr)[0])
        self.assertIn("bad.bvh", own_lines(done.stderr)[0])
        self.assertEqual(done.stdout, "")


class RanksAnalyze(RanksCase):
    def test_any_number_of_processes_prints_the_same_object(self):
        walked = self.walker(clips=7, seconds=3, seed=3)
        words = ("analyze", walked, "--against", self.clips, "--fps", "20", "--resamples", "20",
                 "--json", "--quiet")
        printed = {ranks: launch(ranks, *words) for ranks in (1, 2, 3)}
        for ranks, done in printed.items():
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout, printed[1].stdout, f"{ranks} processes")
        result = json.loads(printed[1].stdout)
        self.assertEqual(result["clips"], 7)
        self.assertGreater(len(result["statistics"]), 12)
        self.assertGreater(result["footsteps"]["max_count"], 5)

    def test_a_clip_of_other_joints_is_left_out_whichever_process_reads_it(self):
        other = self.dir / "other.bvh"
        other.write_text(self.clip.read_text().replace("LeftFoot", "LeftPaw"))
        for ranks in (1, 2):
            done = launch(ranks, "analyze", self.clip, other, "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            named = [line for line in own_lines(done.stderr) if "left out" in line]
            self.assertIn("other.bvh is left out: another skeleton", named[0])
            left_out = json.loads(done.stdout)["left_out"]
            self.assertEqual(len(left_out), 1)
            self.assertIn("LeftPaw", json.dumps(left_out[0]))


class RanksReport(RanksCase):
    def test_any_number_of_processes_writes_the_same_report_but_for_times(self):
        document = self.dir / "experiment.json"
        document.write_text(json.dumps(
            {"title": "Small", "natural": [str(self.clips)],
             "systems": [{"name": "tiny", "model": str(self.model)}],
             "paths": [{"name": "left", "path": "preset:turn-left", "seconds": 1},
                       {"name": "on", "path": "preset:fast", "seconds": 1}],
             "samples": 3, "held_out_samples": 2, "seed": 1, "fps": 20}))
        files = {}
        for ranks in (1, 2, 3):
            result = self.launch_json(ranks, "report", document, "--no-pdf", "--threads", 1,
                                      "--out", self.dir / "out")
            self.assertTrue(result["report"].endswith(".html"))
            files[ranks] = self.moved(f"report-{ranks}")
        for ranks in (2, 3):
            self.assertEqual(sorted(files[ranks]), sorted(files[1]))
            for name, content in files[1].items():
                self.assertEqual(without_pace(files[ranks], name), without_pace(files[1], name),
                                 name)
        self.assertGreater(len([n for n in files[1] if n.endswith(".csv")]), 3)


def without_pace(files, name):
    """A file of a report without the one number that is a time: sampled frames per second."""
    content = files[name]
    table = next(n for n in files if n.endswith("likelihood.csv"))
    rows = [line for line in files[table].decode().splitlines() if not line.startswith("#")]
    pace = float(rows[1].split(",")[-1])
    for text in (rows[1].split(",")[-1], f"{pace:.0f}"):
        content = content and content.replace(text.encode(), b"PACE")
    return content


class RanksResume(RanksCase):
    """Enough motions, long enough, that a run can be broken in its midst."""
    COUNT, SECONDS = 96, 4

    def words(self, out, *more):
        return self.sample_words(out, self.COUNT, self.SECONDS, "--quiet", *more)

    def records(self):
        return list(self.dir.glob("out.partial/.run/part_*.json"))

    def broken(self, ranks, hurt):
        """Starts a run and hurts it once a part is finished; the run that ended."""
        words = launch_words(ranks, *self.words("out")) if ranks > 1 else [
            BINARY, *map(str, self.words("out"))]
        process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, env={**os.environ, **ENVIRONMENT})
        until = time.monotonic() + 60
        while not self.records():
            self.assertIsNone(process.poll(), "ended before it could be broken")
            self.assertLess(time.monotonic(), until)
            time.sleep(0.002)
        hurt(process)
        out, err = process.communicate(timeout=LIMIT_S)
        self.assertEqual(out, "")
        self.assertFalse((self.dir / "out").exists())
        self.assertLess(len(self.records()), self.COUNT // 16)
        return process.returncode, err

    @staticmethod
    def children(process):
        task = f"/proc/{process.pid}/task/{process.pid}/children"
        with open(task, encoding="ascii") as file:
            return [int(word) for word in file.read().split()]

    def assert_resumes(self, ranks):
        done = launch(ranks, *self.words("out"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("--resume", done.stderr)
        other = launch(1, *self.words("out", "--resume", "--temperature", "0.5"))
        self.assertEqual(other.returncode, 1)
        for word in ("temperature", "0.5", "1.0"):
            self.assertIn(word, other.stderr)
        done = launch(ranks, *self.words("out", "--resume"))
        self.assertEqual(done.returncode, 0, done.stderr)
        resumed = self.moved("resumed")
        self.assertFalse((self.dir / "out.partial").exists())
        done = launch(1, *self.words("out"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(resumed, self.moved("unbroken"))

    def test_a_killed_process_of_many_is_reported_and_the_run_resumed(self):
        def kill_one(process):
            os.kill(self.children(process)[1], signal.SIGKILL)
        status, err = self.broken(2, kill_one)
        self.assertNotEqual(status, 0)
        self.assertIn("--resume", err)
        self.assertRegex(err, "rank 1 .*signal 9")
        self.assert_resumes(3)

    def test_an_interrupted_run_of_many_keeps_what_is_finished(self):
        status, err = self.broken(2, lambda process: process.send_signal(signal.SIGINT))
        self.assertNotEqual(status, 0)
        self.assertIn("--resume", err)

    def test_an_interrupt_of_any_process_stops_all(self):
        def interrupt_one(process):
            os.kill(self.children(process)[1], signal.SIGINT)
        status, err = self.broken(2, interrupt_one)
        self.assertEqual(status, 1)
        self.assertEqual(len(own_lines(err)), 1, err)
        self.assertIn("cancelled", err)
        self.assertIn("--resume", err)

    def test_an_interrupted_run_of_one_process_keeps_what_is_finished(self):
        status, err = self.broken(1, lambda process: process.send_signal(signal.SIGINT))
        self.assertEqual(status, 1)
        self.assertEqual(len(own_lines(err)), 1)
        self.assertIn("--resume", err)
        self.assert_resumes(1)

    def test_there_must_be_something_to_resume(self):
        self.assert_refused(self.words("out", "--resume"), "nothing to resume")


if __name__ == "__main__":
    main()
