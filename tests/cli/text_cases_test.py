"""Text motion files of kinds that people stumbled over, through the real program: fixtures by number,
what comes out, what is said on stderr and in --json."""
import json
import os
import pathlib
import shutil

from support import Case, SharedModelCase, main, marey

FIXTURES = pathlib.Path(__file__).resolve().parent.parent / "fixtures"


class TextCase(Case):
    def run_aloud(self, *words):
        """(the --json object, stderr) of a run that succeeds."""
        done = marey(*words, "--json")
        self.assertEqual(done.returncode, 0, f"{words}: {done.stderr}")
        return json.loads(done.stdout), done.stderr

    def assert_warns(self, kind, words, *expected):
        """The run tells a doubt of this kind on stderr and in --json."""
        result, stderr = self.run_aloud(*words)
        kinds = [w["kind"] for w in result.get("warnings", [])]
        self.assertIn(kind, kinds, words)
        evidence = next(w["evidence"] for w in result["warnings"] if w["kind"] == kind)
        self.assertIn(evidence, stderr)
        for text in expected:
            self.assertIn(text, evidence)

    def assert_footsteps(self, words, **expected):
        result, stderr = self.run_aloud("analyze", *words, "--tolerance-step", 1, "--resamples", 0)
        for key, value in expected.items():
            found = result["seconds"] if key == "seconds" else result["footsteps"][key]
            self.assertAlmostEqual(found, value, places=4, msg=f"{words} {key}")
        return result, stderr


class ReadFiles(TextCase):
    def test_03_odd_names_give_the_same_footsteps_and_utf8(self):
        for name in ("ascii.bvh", "shift_jis.bvh", "gbk.bvh"):
            path = FIXTURES / "03-odd-joint-names" / name
            names = [line.split(b" ", 1)[1].strip() for line in
                     (raw.strip() for raw in path.read_bytes().split(b"\n"))
                     if line.startswith((b"ROOT ", b"JOINT "))]
            feet = os.fsdecode(names[15] + b"," + names[19])
            with self.subTest(name=name):
                self.assert_footsteps([path, "--feet", feet, "--unit", "cm", "--up", "y"],
                                      max_count=7, v95_cm_s=16.0)
                for extension in ("csv", "gltf", "bvh"):
                    out = self.dir / f"{name}.{extension}"
                    self.run_json("convert", path, "--out", out)
                    if extension != "bvh":
                        out.read_bytes().decode("utf-8")
                    elif name != "ascii.bvh":
                        self.assertIn(names[15], out.read_bytes())

    def test_04_every_habit_of_naming_has_feet_and_makes_a_data_set(self):
        files = sorted((FIXTURES / "04-naming-habits").glob("*.bvh"))
        self.assertEqual(len(files), 7)
        for path in files:
            with self.subTest(name=path.name):
                result, stderr = self.assert_footsteps(
                    [path], max_count=12, v95_cm_s=16.0, duration_mean_s=0.6667,
                    duration_std_s=0.2577, seconds=6.05)
                self.assertNotIn("warnings", result)
                self.assertNotIn("uncertain", stderr)
                made = self.run_json("prepare", path, "--out", self.dir / f"{path.stem}.marey")
                self.assertEqual(made["pose_dim"], 63)

    def test_05_every_file_of_the_folder_is_read_and_the_counts_are_told(self):
        folder = FIXTURES / "05-frame-count"
        result, stderr = self.run_aloud("prepare", folder, "--out", self.dir / "d.marey")
        self.assertEqual(result["train_clips"], 4)
        for text in ("one_row_more.bvh", "31 frames, the file has 32", "60 of 66", "'Frames:'"):
            self.assertIn(text, stderr)
        out = self.dir / "more.bvh"
        self.run_json("convert", folder / "one_row_more.bvh", "--out", out)
        notes = json.loads((self.dir / "more.bvh.recipe.json").read_text())["source"]["notes"]
        self.assertTrue(any("31 frames, the file has 32" in note for note in notes), notes)

    def test_05_whole_rows_of_a_cut_file_are_read_when_asked_for(self):
        text = (FIXTURES / "05-frame-count" / "right.bvh").read_text()
        path = self.dir / "cut.bvh"
        path.write_text("\n".join(text.splitlines()[:-8]) + "\n")
        self.assert_refused(["analyze", path], "cut.bvh:", "31 frames", "after 23", "--whole-rows")
        result, stderr = self.run_aloud("analyze", path, "--whole-rows", "--resamples", 0)
        self.assertAlmostEqual(result["seconds"], 23 / 30)
        self.assertIn("the file has 23", stderr)

    def test_09_a_wrong_rate_is_doubted_and_a_given_one_counts(self):
        path = FIXTURES / "09-wrong-frame-time" / "walk_120_labelled_24.bvh"
        self.assert_footsteps([path, "--source-fps", 120, "--fps", 20], max_count=8, v95_cm_s=16.0,
                              duration_mean_s=0.6, duration_std_s=0.2937)
        self.assert_warns("rate_doubtful", ["analyze", path, "--resamples", 0], "--source-fps")

    def test_09_frames_that_are_made_are_told(self):
        path = FIXTURES / "09-wrong-frame-time" / "keyframes_1_s.bvh"
        out = self.dir / "k.bvh"
        self.assert_warns("upsampled", ["convert", path, "--fps", 20, "--out", out])
        recipe = json.loads((self.dir / "k.bvh.recipe.json").read_text())
        self.assertIn("20 frames per second are made of 1", recipe["warnings"][0])
        self.assert_warns("upsampled", ["analyze", path, "--fps", 20, "--resamples", 0])
        self.assert_warns("upsampled", ["prepare", path, "--out", self.dir / "d.marey"])

    def test_10_bones_without_offsets_have_their_length(self):
        for name in ("offsets_kept_cm.bvh", "offsets_zero_cm.bvh"):
            result = self.run_json("analyze", FIXTURES / "10-all-offsets-zero" / name,
                                   "--resamples", 0)
            self.assertLess(result["bone_length_rmse_cm"], 0.001)

    def test_15_an_uncertain_unit_is_told_by_every_command(self):
        folder = FIXTURES / "15-scaled-characters"
        for name in ("giant_in_cm.bvh", "feet_as_unit.bvh"):
            path = folder / name
            for words in (["analyze", path, "--resamples", 0],
                          ["convert", path, "--out", self.dir / "a.bvh"],
                          ["prepare", path, "--out", self.dir / "d.marey"]):
                with self.subTest(name=name, command=words[0]):
                    self.assert_warns("unit_uncertain", words, "units")
        result, stderr = self.run_aloud("analyze", folder / "person.bvh", "--resamples", 0)
        self.assertNotIn("warnings", result)
        self.assertNotIn("marey:", stderr)
        self.assert_footsteps([folder / "feet_as_unit.bvh", "--unit", "foot"], v95_cm_s=16.0)

    def test_16_a_calibration_pose_is_warned_of_and_can_be_left_out(self):
        folder = FIXTURES / "16-one-frame-and-pose-files"
        self.assert_footsteps([folder / "walk_alone.bvh", "--fps", 20], max_count=7, v95_cm_s=21.0)
        self.assert_warns("calibration_pose",
                          ["analyze", folder / "tpose_then_walk.bvh", "--resamples", 0],
                          "first frame", "--frames 1:")

    def test_17_two_people_are_two_clips_and_a_prop_is_named(self):
        folder = FIXTURES / "17-two-people-in-one-file"
        result = self.run_json("convert", folder / "two_roots.bvh", "--format", "csv", "--out",
                               self.dir / "two")
        self.assertEqual(sorted(p.name for p in (self.dir / "two").glob("*.csv")),
                         ["two_roots_B_Hips.csv", "two_roots_Hips.csv"])
        self.assertEqual(len(result["written"]), 4)
        self.assert_warns("left_out", ["analyze", folder / "person_and_prop.bvh", "--resamples", 0],
                          "'Ball'")

    def test_23_an_asf_unit_that_the_body_contradicts_is_told(self):
        folder = FIXTURES / "23-asf-length-units"
        for name, size in (("length_1_values_in_cm", "4."), ("spec_254_values_in_inch", "0.")):
            path = folder / name / "p.amc"
            self.assert_warns("unit_uncertain", ["analyze", path, "--resamples", 0], size)
            self.assert_warns("unit_uncertain", ["convert", path, "--out", self.dir / "a.bvh"])
        result, _ = self.run_aloud("analyze", folder / "inch_1" / "p.amc", "--resamples", 0)
        self.assertNotIn("warnings", result)


class Folders(TextCase):
    def setUp(self):
        super().setUp()
        self.data = self.dir / "data"
        shutil.copytree(FIXTURES / "38-folder-with-strangers" / "data", self.data)
        shutil.copytree(FIXTURES / "38-folder-with-strangers" / "lists", self.dir / "lists")
        (self.data / "g_dead.bvh").symlink_to("nowhere.bvh")
        (self.data / "h_again.bvh").symlink_to("a_good.bvh")

    def assert_all_named(self, result, stderr):
        reasons = {pathlib.Path(n["path"]).name: n["reason"] for n in result["not_read"]}
        for name, reason in (("e_lfs.bvh", "Git LFS"), ("f_empty.bvh", "empty"),
                             ("g_dead.bvh", "nothing"), ("h_again.bvh", "a_good.bvh"),
                             ("sub", "1 motion file")):
            self.assertIn(reason, reasons[name])
            self.assertIn(name, stderr)
        self.assertEqual(result["other_files"], {"c3d": 1, "fbx": 1, "trc": 1, "txt": 1})
        self.assertIn("3 files of other formats: c3d, fbx, trc", stderr)

    def test_38_every_file_of_a_folder_is_read_or_named(self):
        result, stderr = self.run_aloud("analyze", self.data, "--resamples", 0)
        self.assertEqual(result["clips"], 5)
        self.assert_all_named(result, stderr)
        result, stderr = self.run_aloud("prepare", self.data, "--out", self.dir / "d.marey")
        self.assertEqual(result["train_clips"], 5)
        self.assert_all_named(result, stderr)
        result, stderr = self.run_aloud("convert", self.data, "--out", self.dir / "out")
        self.assertEqual(len(list((self.dir / "out").glob("*.bvh"))), 5)
        self.assert_all_named(result, stderr)
        result, stderr = self.run_aloud("doctor", self.data)
        self.assertEqual(len(result["files"]), 5)
        self.assert_all_named(result, stderr)

    def test_38_a_broken_file_in_a_folder_is_named_and_the_others_are_read(self):
        text = (self.data / "a_good.bvh").read_text()
        (self.data / "i_broken.bvh").write_text(text.replace("CHANNELS 3", "CHANNELS three", 1))
        for words in (["analyze", self.data, "--resamples", 0],
                      ["prepare", self.data, "--out", self.dir / "d.marey"],
                      ["convert", self.data, "--out", self.dir / "out"]):
            with self.subTest(command=words[0]):
                result, stderr = self.run_aloud(*words)
                reasons = {pathlib.Path(n["path"]).name: n["reason"] for n in result["not_read"]}
                self.assertIn("i_broken.bvh:", reasons["i_broken.bvh"])
                self.assertIn("three", stderr)
        only = self.dir / "only"
        only.mkdir()
        shutil.move(self.data / "i_broken.bvh", only)
        self.assert_refused(["analyze", only], "i_broken.bvh:", "three")

    def test_38_all_named_files_that_cannot_be_read_are_named(self):
        good, lfs, empty = (self.data / n for n in ("a_good.bvh", "e_lfs.bvh", "f_empty.bvh"))
        for words in (["prepare", good, lfs, empty, "--out", self.dir / "d.marey"],
                      ["convert", good, lfs, empty, "--out", self.dir / "out"]):
            self.assert_refused(words, "e_lfs.bvh", "Git LFS", "f_empty.bvh", "an empty file")

    def test_38_formats_that_are_not_read_are_named_as_such(self):
        for name in ("c3d", "fbx", "trc"):
            done = marey("doctor", self.data / f"clip.{name}")
            self.assertEqual(done.returncode, 1)
            self.assertIn(f"{name.upper()} is not read", done.stderr)

    def test_38_lists_are_read_as_they_are_or_say_what_is_meant(self):
        lists = self.dir / "lists"

        def analyzed(name):
            return self.run_aloud("analyze", f"@{lists}/{name}", "--resamples", 0)

        self.assertEqual(analyzed("bom.txt")[0]["clips"], 2)
        result, stderr = analyzed("twice.txt")
        self.assertEqual(result["clips"], 1)
        self.assertIn("twice", stderr)
        self.assertEqual(analyzed("wildcard.txt")[0]["clips"], 4)
        self.assert_refused(["analyze", f"@{lists}/no_extension.txt"], "no_extension.txt:1",
                            "did you mean ../data/a_good.bvh?")
        (lists / "windows.txt").write_bytes("﻿..\\data\\a_good.bvh\r\n".encode("utf-16-le"))
        self.assertEqual(analyzed("windows.txt")[0]["clips"], 1)


class ControlPaths(SharedModelCase, TextCase):
    FOLDER = FIXTURES / "39-control-paths"

    def sample(self, path, *more):
        return ["sample", self.model, "--path", path, "--out", self.dir / "out", "--format", "csv",
                *more]

    def test_39_a_clip_of_other_joints_gives_its_path_but_no_start(self):
        clip = f"clip:{self.FOLDER / 'walk.bvh'}"
        self.run_json(*self.sample(clip))
        rows = [r.split(",") for r in (self.dir / "out" / "sample_000.csv").read_text().split("\n")]
        hips = [r for r in rows[1:] if len(r) == 6 and r[2] == "Hips"]
        self.assertEqual(len(hips), 81)
        self.assertAlmostEqual(float(hips[-1][5]) - float(hips[0][5]), 4.0, delta=0.5)
        shutil.rmtree(self.dir / "out")
        self.assert_refused(self.sample(clip, "--start", "clip"), "joint")

    def test_39_a_path_that_is_too_fast_or_has_idle_speeds_is_told(self):
        self.assert_warns("too_fast", self.sample(self.FOLDER / "running_50_m_s.json"), "50.00 m/s")
        shutil.rmtree(self.dir / "out")
        self.assert_warns("no_effect", self.sample(self.FOLDER / "speed_on_last_point.json"),
                          "way-point 2", "1.4 m/s")

    def test_39_a_table_is_a_path_and_other_text_says_what_is_wanted(self):
        result = self.run_json(*self.sample(self.FOLDER / "root_positions.csv"))
        times = (self.FOLDER / "root_positions.csv").read_text().split()[1:]
        self.assertAlmostEqual(result["seconds_each"], len(times) / 20, delta=0.06)
        shutil.rmtree(self.dir / "out")
        for text in ("hello", "a,b\n1,2\n", "[[0,0],[1,1]]", "time,x,z\n0,0,0\n1,one,2\n"):
            path = self.dir / "path.txt"
            path.write_text(text)
            self.assert_refused(self.sample(path), "path.txt")


if __name__ == "__main__":
    main()
