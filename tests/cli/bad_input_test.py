"""Damaged, wrong and hostile input: an error that names the place, status 1, nothing left."""
import json
import os
import pickle
import struct
import subprocess
import zipfile

from support import LIMIT_S, Case, SharedModelCase, main, marey, read_tensors, write_tensors


class MotionFiles(SharedModelCase):
    """Each damage is one change of a good file, which the tests first read without complaint."""

    def setUp(self):
        super().setUp()
        self.lines = self.clip.read_text().splitlines()
        self.time = next(i for i, line in enumerate(self.lines) if line.startswith("Frame Time"))

    def damaged(self, name, lines, end="\n"):
        path = self.dir / name
        path.write_text("\n".join(lines) + end)
        return path

    def assert_unreadable(self, path, *expected, every_command=False):
        out = self.dir / "out"
        commands = [["convert", path, "--out", f"{out}/"], ["analyze", path, "--json"],
                    ["convert", path, "--out", f"{out}.bvh"], ["prepare", path, "--out", out],
                    ["score", self.model, path], ["render", path, "--out", f"{out}.png"],
                    ["sample", self.model, "--path", f"clip:{path}", "--out", out]]
        for words in commands if every_command else commands[:1]:
            with self.subTest(command=words[0]):
                self.assert_refused([*words, "--quiet"], *expected)

    def test_the_undamaged_file_is_read(self):
        result = self.run_json("analyze", self.damaged("good.bvh", self.lines), "--resamples", 0)
        self.assertEqual(result["clips"], 1)

    def test_a_joint_of_another_name_than_the_models_is_named(self):
        lines = [line.replace("JOINT LeftFoot", "JOINT LeftPaw") for line in self.lines]
        self.assertEqual(sum(a != b for a, b in zip(lines, self.lines)), 1)
        path = self.damaged("renamed.bvh", lines)
        for words in (["score", self.model, path],
                      ["sample", self.model, "--path", f"clip:{path}", "--start", "clip", "--out",
                       self.dir / "out"]):
            with self.subTest(command=words[0]):
                self.assert_refused([*words, "--quiet"], "renamed.bvh", "LeftFoot", "LeftPaw")

    def test_a_number_that_is_none_is_named_by_line_and_frame(self):
        row = self.lines[self.time + 3].split()
        row[5] = "nan"
        self.lines[self.time + 3] = " ".join(row)
        self.assert_unreadable(self.damaged("nan.bvh", self.lines),
                               f"nan.bvh:{self.time + 4}", "'nan'", every_command=True)

    def test_a_row_of_the_wrong_length_is_named_by_line_with_both_counts(self):
        row = self.lines[self.time + 3].split()
        self.lines[self.time + 3] = " ".join(row[:-1])
        self.assert_unreadable(self.damaged("short.bvh", self.lines),
                               f"short.bvh:{self.time + 4}", "66", "65")

    def test_a_file_cut_inside_the_motion_is_refused(self):
        half = self.time + len(self.lines[self.time:]) // 2
        self.assert_unreadable(self.damaged("cut.bvh", self.lines[:half]),
                               f"cut.bvh:{half}", "240 frames")

    def test_a_file_cut_inside_the_hierarchy_is_refused(self):
        self.assert_unreadable(self.damaged("cut.bvh", self.lines[:20]), "cut.bvh:")

    def test_zero_frames_are_refused(self):
        self.lines[self.time - 1] = "Frames: 0"
        self.assert_unreadable(self.damaged("zero.bvh", self.lines[:self.time + 1]),
                               "zero.bvh:", "at least one frame")

    def test_a_header_that_promises_a_billion_frames_is_refused_at_once(self):
        self.lines[self.time - 1] = "Frames: 1000000000"
        path = self.damaged("billion.bvh", self.lines)
        # Were the promise believed, the memory for it would be asked for: 500 GB.
        limited = subprocess.run(
            ["sh", "-c", 'ulimit -v 8000000; exec "$@"', "sh", os.environ["MAREY_BINARY"],
             "analyze", str(path)], capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(limited.returncode, 1, limited.stderr)
        self.assertIn("1000000000", limited.stderr)
        self.assert_unreadable(path, "billion.bvh:", "1000000000", "240")

    def test_an_unknown_channel_is_named(self):
        lines = [line.replace("3 Zrotation", "3 Wrotation") for line in self.lines]
        where = next(i for i, line in enumerate(lines) if "Wrotation" in line) + 1
        self.assert_unreadable(self.damaged("channel.bvh", lines),
                               f"channel.bvh:{where}", "'Wrotation'")

    def test_doctor_reports_the_bad_file_beside_the_good_one_and_fails(self):
        self.damaged("a_good.bvh", self.lines)
        self.lines[self.time - 1] = "Frames: 9999"
        self.damaged("b_bad.bvh", self.lines)
        done = marey("doctor", self.dir, "--json", "--quiet")
        self.assertEqual(done.returncode, 1)
        self.assertIn("b_bad.bvh:", done.stderr)
        good, bad = json.loads(done.stdout)["files"]
        self.assertEqual(good["faults"], [])
        self.assertEqual(bad["faults"][0]["kind"], "unreadable")

    def test_one_bad_file_of_several_leaves_no_converted_file(self):
        good = self.damaged("a_good.bvh", self.lines)
        self.lines[self.time - 1] = "Frames: 9999"
        bad = self.damaged("b_bad.bvh", self.lines)
        self.assert_refused(["convert", good, bad, "--out", self.dir / "out"], "b_bad.bvh:")
        # A folder that is there keeps what it holds.
        kept = self.dir / "kept"
        kept.mkdir()
        (kept / "a_good.bvh").write_text("mine")
        self.assert_refused(["convert", good, bad, "--out", kept], "b_bad.bvh:")

    def test_an_empty_folder_and_an_absent_file_are_named(self):
        empty = self.dir / "empty"
        empty.mkdir()
        for words in (["analyze"], ["prepare", "--out", self.dir / "d.marey"],
                      ["score", self.model], ["convert", "--out", self.dir / "c.bvh"]):
            for path in (empty, self.dir / "absent.bvh"):
                with self.subTest(command=words[0], path=path.name):
                    self.assert_refused([*words, path], path)

    def test_unknown_feet_are_named(self):
        self.assert_refused(["analyze", self.clip, "--feet", "LeftFoot,Paw"], "Paw")


class ClipsForModels(SharedModelCase):
    def write_chain(self, joints):
        """A straight chain of joints, ten frames."""
        text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition " \
               "Zrotation Xrotation Yrotation\n"
        for i in range(1, joints):
            text += f"JOINT J{i}\n{{\nOFFSET 0 10 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
        text += "End Site\n{\nOFFSET 0 10 0\n}\n" + "}\n" * joints
        row = " ".join(["0"] * (6 + 3 * (joints - 1)))
        text += "MOTION\nFrames: 120\nFrame Time: 0.05\n" + (row + "\n") * 120
        path = self.dir / f"chain_{joints}.bvh"
        path.write_text(text)
        return path

    def test_another_number_of_joints_than_the_model_has_is_refused(self):
        path = self.write_chain(4)
        for words in (["score", self.model, path],
                      ["sample", self.model, "--path", f"clip:{path}", "--start", "clip", "--out",
                       self.dir / "out"]):
            with self.subTest(command=words[0]):
                self.assert_refused(words, "chain_4", "21 joints", "4")

    def test_a_control_clip_shorter_than_the_context_is_refused(self):
        lines = self.clip.read_text().splitlines()
        time = next(i for i, line in enumerate(lines) if line.startswith("Frame Time"))
        lines[time - 1] = "Frames: 4"
        path = self.dir / "brief.bvh"
        path.write_text("\n".join(lines[:time + 5]) + "\n")
        self.assert_refused(["sample", self.model, "--path", f"clip:{path}", "--start", "clip",
                             "--out", self.dir / "out"], "brief", "frames")
        self.assert_refused(["score", self.model, path], "brief", "frames")

    def test_a_wrong_configuration_is_named_by_its_key(self):
        for name, change in {"steps": {"steps": -4}, "cell": {"cell": "gruu"},
                             "hiden": {"hiden": 3}, "tau": {"tau": "two"}}.items():
            with self.subTest(key=name):
                config = self.tiny_config(model=change)
                self.assert_refused(["train", config, "--data", self.data, "--out",
                                     self.dir / "run"], "tiny.json", name)
        broken = self.dir / "broken.json"
        broken.write_text('{"family": "moglow",\n "model": ')
        self.assert_refused(["train", broken, "--data", self.data, "--out", self.dir / "run"],
                            "broken.json")
        broken.write_text('{"family": 3, "model": {}}')
        self.assert_refused(["train", broken, "--data", self.data, "--out", self.dir / "run"],
                            "broken.json", "family")
        broken.write_text('{"family": "unheard", "model": {}}')
        self.assert_refused(["train", broken, "--data", self.data, "--out", self.dir / "run"],
                            "broken.json", "unheard")

    def test_an_unknown_path_is_wrong_usage_and_lists_the_known(self):
        self.assert_refused(["sample", self.model, "--path", "preset:moon", "--out",
                             self.dir / "out"], "moon", "turn-left", status=2)

    def test_a_bad_experiment_document_is_refused_by_its_place(self):
        path = self.dir / "experiment.json"
        for text, expected in (("{", "experiment.json"), ("[]", "experiment.json"),
                               ('{"systems": [{"name": "x", "model": "no.marey"}], "natural": '
                                '["walker:1,4,1"], "paths": [{"name": "p", "path": '
                                '"preset:still", "seconds": 1}], "samples": 1}', "no.marey")):
            path.write_text(text)
            with self.subTest(text=text):
                self.assert_refused(["report", path, "--out", self.dir / "out", "--no-pdf"],
                                    expected)


class Models(SharedModelCase):
    KEY = "weights/flow.step0_coupling.net.out_weight"

    def assert_no_model(self, path, *expected, every_command=False):
        out = self.dir / "out"
        commands = [["sample", path, "--path", "preset:still", "--out", out],
                    ["model", "info", path], ["model", "export", path, "--out", out],
                    ["score", path, self.clip]]
        for words in commands if every_command else commands[:1]:
            with self.subTest(command=words[:2]):
                self.assert_refused([*words, "--quiet"], path.name, *expected)

    def changed(self, name, change):
        metadata, tensors = read_tensors(self.model)
        self.assertIn(self.KEY, tensors)
        path = self.dir / name
        write_tensors(path, *(change(metadata, tensors) or (metadata, tensors)))
        return path

    def with_tensor(self, name, dtype, shape, data):
        return self.changed(name, lambda m, t: t.update({self.KEY: (dtype, shape, data)}))

    def test_a_rewritten_model_is_read(self):
        path = self.changed("same.marey", lambda m, t: None)
        self.assertEqual(self.run_json("model", "info", path)["pose_dim"], 63)

    def test_a_cut_model_is_refused_wherever_it_is_cut(self):
        blob = self.model.read_bytes()
        path = self.dir / "cut.marey"
        for length in (0, 5, 8, 900, len(blob) // 2, len(blob) - 1):
            with self.subTest(length=length):
                path.write_bytes(blob[:length])
                self.assert_refused(["model", "info", path], "cut.marey")

    def test_another_family_is_named(self):
        def change(metadata, tensors):
            inner = json.loads(metadata["marey"])
            inner["family"] = "unheard"
            metadata["marey"] = json.dumps(inner)
        self.assert_no_model(self.changed("family.marey", change), "unheard", "moglow")

    def test_a_data_set_is_no_model(self):
        self.assert_no_model(self.data, "model")

    def test_a_missing_tensor_is_named(self):
        path = self.changed("missing.marey", lambda m, t: t.pop(self.KEY) and None)
        self.assert_no_model(path, "out_weight", every_command=True)

    def test_a_tensor_too_many_is_named(self):
        path = self.changed("extra.marey", lambda m, t: t.update(
            {"weights/flow.step9_actnorm.bias": ("F32", [1], b"\0" * 4)}))
        self.assert_no_model(path, "step9_actnorm")

    def test_a_misshaped_tensor_is_named_with_both_shapes(self):
        path = self.with_tensor("shape.marey", "F32", [8, 64], b"\0" * 2048)
        self.assert_no_model(path, "out_weight", "(64, 8)", "(8, 64)")

    def test_weights_that_are_no_numbers_are_named(self):
        data = struct.pack("<512f", *[0.0] * 511, float("nan"))
        path = self.with_tensor("nan.marey", "F32", [64, 8], data)
        self.assert_no_model(path, "out_weight")


class Touch:
    """Unpickling this runs a shell command."""

    def __init__(self, command):
        self.command = command

    def __reduce__(self):
        return os.system, (self.command,)


class Checkpoints(Case):
    def setUp(self):
        super().setUp()
        self.config = self.tiny_config()
        self.out = self.dir / "model.marey"

    def test_a_pickle_that_asks_for_more_than_tensors_is_not_obeyed(self):
        marker = self.dir / "obeyed"
        stream = pickle.dumps({"state_dict": Touch(f"touch {marker}")}, protocol=2)
        # The stream is live: Python obeys it.
        pickle.loads(stream)
        self.assertTrue(marker.exists())
        marker.unlink()
        zipped = self.dir / "hostile.pkg"
        with zipfile.ZipFile(zipped, "w") as archive:
            archive.writestr("archive/data.pkl", stream)
            archive.writestr("archive/version", "3\n")
        # The name that Python pickles for os.system.
        self.assert_refused(["model", "import", zipped, "--config", self.config, "--out",
                             self.out], "hostile.pkg", "posix", "system")

    def test_a_file_that_is_no_checkpoint_is_refused(self):
        path = self.dir / "text.pkg"
        for content in (b"", b"hello", b"PK\x03\x04" + b"\0" * 40, b"\x80\x02}q\0."):
            path.write_bytes(content)
            with self.subTest(content=content[:5]):
                self.assert_refused(["model", "import", path, "--config", self.config, "--out",
                                     self.out], "text.pkg")


class FullDisk(SharedModelCase):
    """Folders on a file system of a few kilobytes: needs the right to mount one."""

    def setUp(self):
        super().setUp()
        self.disk = self.dir / "disk"
        self.disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", self.disk],
                                 capture_output=True, text=True, check=False)
        if mounted.returncode != 0:
            self.skipTest(f"cannot mount a small file system: {mounted.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", self.disk], check=True)

    def assert_full(self, *words):
        with self.subTest(command=words[0]):
            self.assert_refused([*words, "--quiet"], "No space left", untouched=self.disk)

    def test_motion_commands_say_so_and_leave_nothing(self):
        self.assert_full("demo", "--write-data", self.disk / "walker", "--clips", "2")
        self.assert_full("convert", self.clip, "--out", self.disk / "a.bvh")
        self.assert_full("convert", self.clip, "--out", self.disk / "a.npz")
        self.assert_full("convert", self.clips, "--out", self.disk / "many")
        self.assert_full("render", self.clip, "--out", self.disk / "a.png")
        self.assert_full("render", self.clip, "--out", self.disk / "a.mp4", "--size", "640x480",
                         "--fps", "20")

    def test_model_commands_say_so_and_leave_nothing(self):
        self.assert_full("prepare", self.clips, "--out", self.disk / "d.marey")
        self.assert_full("sample", self.model, "--path", "preset:still", "--out",
                         self.disk / "samples", "-n", "3")
        self.assert_full("model", "export", self.model, "--out", self.disk / "m.marey")

    def test_training_says_so_and_leaves_no_broken_model(self):
        run = self.disk / "run"
        done = marey("train", self.tiny_config(), "--data", self.data, "--out", run, "--steps",
                     "1", "--quiet")
        self.assertEqual(done.returncode, 1)
        self.assertIn("No space left", done.stderr)
        self.assertLessEqual({p.name for p in run.iterdir()}, {"config.json", "log.csv"})

    def test_a_full_disk_keeps_the_file_that_was_there(self):
        old = self.disk / "m.marey"
        old.write_text("old")
        self.assert_full("model", "export", self.model, "--out", old)


if __name__ == "__main__":
    main()
