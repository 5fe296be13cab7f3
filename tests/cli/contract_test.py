"""Every command: its help, its --json object, its exit status, on the walker's own clips."""
import json
import math
import re
import subprocess
from xml.etree import ElementTree

from support import (Case, SharedModelCase, gltf_floats, listing, main, marey, need_tools,
                     read_gltf, without_rotations)

COMMANDS = ["demo", "doctor", "convert", "prepare", "train", "sample", "steer", "predict",
            "complete", "denoise", "score", "analyze", "report", "render", "model info",
            "model example", "model import", "model export", "model check", "bench render"]
SHARED_OPTIONS = ["--json", "--quiet", "--seed", "--threads"]


class Help(Case):
    def test_every_command_helps_with_an_example_of_itself(self):
        for command in COMMANDS:
            with self.subTest(command=command):
                done = marey(*command.split(), "--help")
                self.assertEqual(done.returncode, 0)
                self.assertRegex(done.stdout, rf"Example:\n  marey {command} ")
                for option in SHARED_OPTIONS:
                    self.assertIn(option, done.stdout)

    def test_the_help_lists_every_command_and_no_other(self):
        text = marey("--help").stdout
        found = re.findall(r"^  ([a-z]+) {2,}\S", text[text.index("Subcommands:"):], re.M)
        self.assertEqual(found, list(dict.fromkeys(c.split()[0] for c in COMMANDS)))

    def test_the_version_is_printed(self):
        done = marey("--version")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"^marey \d+\.\d+\.\d+")


class Usage(Case):
    def test_wrong_usage_ends_with_status_2_and_writes_nothing(self):
        wrong = [
            [], ["nonsense"], ["demo"], ["demo", "--out", "a", "--write-data", "b"],
            ["doctor"], ["doctor", "--nonsense", "x"], ["convert", "a.bvh"],
            ["convert", "a.bvh", "--out", "b.bvh", "--frames", "1-2"],
            ["prepare", "--out", "d.marey"], ["train", "--data", "d", "--out", "r"],
            ["train", "c.json", "--data", "d", "--out", "r", "--steps", "-1"],
            ["sample", "m.marey", "--path", "preset:still"],
            ["sample", "m.marey", "--path", "preset:still", "--out", "s", "-n", "0"],
            ["sample", "m.marey", "--path", "preset:still", "--out", "s", "-n", "many"],
            ["score", "m.marey"], ["analyze"], ["analyze", "a.bvh", "--fps", "-3"],
            ["report", "e.json"], ["render", "a.bvh", "--out", "film.avi"],
            ["render", "a.bvh", "--out", "a{frame:x}.png"],
            ["render", "a.bvh", "--out", "{frame}/a.png"],
            ["render", "a.bvh", "--out", "a.png", "--follow"],
            ["render", "a.bvh", "--out", "a.png", "--size", "9"],
            ["model"], ["model", "info"], ["model", "check", "m.marey"],
            ["model", "import", "m.pkg", "--out", "m.marey"],
        ]
        for words in wrong:
            with self.subTest(words=words):
                self.assert_refused(words, status=2, cwd=self.dir)

    def test_an_unknown_command_names_the_nearest_even_where_help_is_asked_for(self):
        for words, wrong, near in (
                (["skore", "--help"], "skore", "score"), (["--help", "skore"], "skore", "score"),
                (["skore"], "skore", "score"), (["bnech", "sample", "--help"], "bnech", "bench"),
                (["model", "chekc", "--help"], "model chekc", "model check"),
                (["model", "--quiet", "inof"], "model inof", "model info"),
                (["bench", "-h", "scroe"], "bench scroe", "bench score")):
            with self.subTest(words=words):
                self.assert_refused(words, f"unknown command '{wrong}'; did you mean '{near}'?",
                                    status=2)

    def test_an_unknown_option_names_the_nearest(self):
        text = self.assert_refused(
            ["sample", "m.marey", "--path", "preset:still", "--out", "s", "--temprature=2"],
            "did you mean '--temperature'?", status=2)
        self.assertIn("'--temprature'", text)

    def test_a_kernel_set_that_is_not_here_is_refused_at_the_start(self):
        for words in (["--version"], ["doctor", "absent.bvh"], ["bench", "sample", "--help"]):
            done = marey(*words, env={"MAREY_ISA": "avx1024"})
            self.assertEqual(done.returncode, 2)
            self.assertEqual(done.stdout, "")
            self.assertRegex(done.stderr, r"MAREY_ISA: expected a kernel set of this machine "
                                          r"\((\w+, )*generic\), found 'avx1024'")
        self.assertEqual(marey("--version", env={"MAREY_ISA": "generic"}).returncode, 0)

    def test_a_failure_prints_one_line_on_stderr_and_no_json(self):
        for words in (["analyze", "absent.bvh", "--json"], ["doctor", "absent.bvh", "--json"],
                      ["score", "absent.marey", "absent.bvh", "--json"]):
            with self.subTest(words=words):
                text = self.assert_refused([*words, "--quiet"], "absent", cwd=self.dir)
                self.assertEqual(len(text.strip().splitlines()), 1, text)


class MotionCommands(SharedModelCase):
    def test_demo_writes_clips_that_repeat_with_the_seed(self):
        first = self.walker(seed=5, name="first")
        names = sorted(listing(first))
        self.assertIn("truth.json", names)
        self.assertEqual(len([n for n in names if n.endswith(".bvh")]), 2)
        again = self.walker(seed=5, name="again")
        other = self.walker(seed=6, name="other")
        for name in ("walker_0000.bvh", "walker_0001.bvh", "truth.json"):
            self.assertEqual((first / name).read_bytes(), (again / name).read_bytes())
            self.assertNotEqual((first / name).read_bytes(), (other / name).read_bytes())

    def test_doctor_tells_what_a_walker_file_is(self):
        files = self.run_json("doctor", self.clips)["files"]
        self.assertEqual(len(files), 2)
        for found in files:
            self.assertEqual({k: found[k] for k in ("format", "fps", "frames", "joints", "up",
                                                    "unit", "faults")},
                             {"format": "bvh", "fps": 60.0, "frames": 240, "joints": 21,
                              "up": "y", "unit": "cm", "faults": []})
            self.assertTrue(found["path"].endswith(".bvh"))

    def test_convert_resamples_slices_and_keeps_the_motion(self):
        out = self.dir / "half.bvh"
        result = self.run_json("convert", self.clip, "--fps", "30", "--frames", "60:180",
                               "--out", out)
        self.assertIn(str(out), result["written"])
        for path in result["written"]:
            self.assertIn(path.removeprefix(f"{self.dir}/"), listing(self.dir))
        text = out.read_text()
        self.assertRegex(text, r"Frames:\s*60\b")
        self.assertRegex(text, r"Frame Time:\s*0\.0333")
        # Frame 60 of the source is the first frame here: the hips' place is the same.
        rows = self.clip.read_text().split("Frame Time:")[1].splitlines()[1:]
        first = text.split("Frame Time:")[1].splitlines()[1]
        for a, b in zip(rows[60].split()[:3], first.split()[:3]):
            self.assertAlmostEqual(float(a), float(b), places=2)

    def test_convert_to_every_format_and_back_keeps_the_hips(self):
        source = self.clip.read_text().split("Frame Time:")[1].splitlines()[1:]
        for extension in ("bvh", "npz", "csv"):
            with self.subTest(extension=extension):
                there = self.dir / f"there.{extension}"
                self.assertTrue(self.run_json("convert", self.clip, "--out", there)["written"])
                if extension == "csv":
                    self.assertIn("Hips", there.read_text())
                    continue
                back = self.dir / f"back_{extension}.bvh"
                self.run_json("convert", there, "--out", back)
                rows = back.read_text().split("Frame Time:")[1].splitlines()[1:]
                self.assertEqual(len(rows), 240)
                for a, b in zip(source[-1].split()[:3], rows[-1].split()[:3]):
                    self.assertAlmostEqual(float(a), float(b), places=2)

    def test_convert_to_gltf_moves_the_joints_as_the_clip_does(self):
        rows = self.csv_positions(self.clip)
        for extension in ("gltf", "glb"):
            with self.subTest(extension=extension):
                out = self.dir / f"a.{extension}"
                result = self.run_json("convert", self.clip, "--out", out)
                self.assertEqual(result, {"written": [str(out)]})  # rotations: no fit
                scene, buffer = read_gltf(out)
                self.assertIn("convert", scene["asset"]["extras"]["recipe"]["command"])
                animation, = scene["animations"]
                channel, = [c for c in animation["channels"] if c["target"]["path"] ==
                            "translation"]
                sampler = animation["samplers"][channel["sampler"]]
                times = gltf_floats(scene, buffer, sampler["input"])
                places = gltf_floats(scene, buffer, sampler["output"])
                self.assertEqual(len(times), 240)
                for t in (0, 100, 239):
                    self.assertAlmostEqual(times[t], t / 60, places=5)
                    for a, b in zip(places[3 * t:3 * t + 3], rows[t, "Hips"]):
                        self.assertAlmostEqual(a, b, places=4)

    def test_positions_alone_are_fitted_and_the_residual_is_stated(self):
        wide, lifted = self.csv_positions(self.clip), 0.1
        bare = self.dir / "bare.npz"
        self.run_json("convert", self.clip, "--out", bare)
        without_rotations(bare, lifted)
        for extension in ("bvh", "glb"):
            with self.subTest(extension=extension):
                out = self.dir / f"fit.{extension}"
                result = self.run_json("convert", bare, "--out", out)
                # The head was lifted off its bone by 10 cm in every frame.
                residual = result["fit_residual_cm"]
                self.assertEqual(len(residual), 21)
                self.assertEqual(max(residual, key=residual.get), "Head")
                self.assertGreater(residual["Head"], 1)
                self.assertLess(result["fit_residual_max_cm"], 100 * lifted)
                self.assertGreaterEqual(result["fit_residual_max_cm"], residual["Head"])
                if extension == "glb":
                    fit = read_gltf(out)[0]["asset"]["extras"]["recipe"]["fit"]
                else:
                    fit = json.loads((self.dir / "fit.bvh.recipe.json").read_text())["fit"]
                self.assertAlmostEqual(fit["fit_residual_cm"]["Head"], residual["Head"], places=9)
                self.assertEqual(fit["fit_residual_max_cm"], result["fit_residual_max_cm"])
        # What is written is as far from the positions as stated.
        fitted = self.csv_positions(self.dir / "fit.bvh")
        head = [math.dist(fitted[t, "Head"], (x, y + lifted, z))
                for t in range(240) for x, y, z in [wide[t, "Head"]]]
        self.assertAlmostEqual(100 * math.sqrt(sum(d * d for d in head) / 240), residual["Head"],
                               places=3)
        self.assertAlmostEqual(100 * max(head), result["fit_residual_max_cm"], places=3)

    def csv_positions(self, clip):
        """{(frame, joint): (x, y, z)} in metres."""
        out = self.dir / "positions.csv"
        self.run_json("convert", clip, "--out", out)
        rows = [line.split(",") for line in out.read_text().splitlines()[1:]]
        return {(int(r[0]), r[2]): tuple(map(float, r[3:])) for r in rows}

    def test_prepare_counts_windows_and_dimensions(self):
        out = self.dir / "d.marey"
        held = self.clips / "walker_0001.bvh"
        result = self.run_json("prepare", self.clips, "--test", held, "--out", out)
        # 4 s at windows of 4 s: one window per clip, times mirrored and reversed.
        self.assertEqual({k: result[k] for k in ("train_windows", "test_windows", "pose_dim",
                                                 "control_dim", "seconds")},
                         {"train_windows": 4, "test_windows": 1, "pose_dim": 63,
                          "control_dim": 3, "seconds": 8.0})
        plain = self.run_json("prepare", self.clips, "--out", self.dir / "plain.marey",
                              "--no-mirror", "--no-reverse")
        self.assertEqual(plain["train_windows"], 2)
        self.assertTrue(out.is_file())

    def test_analyze_reports_statistics(self):
        result = self.run_json("analyze", self.clips, "--fps", "20", "--resamples", "0")
        self.assertEqual(result["clips"], 2)
        self.assertAlmostEqual(result["seconds"], 8.0, delta=0.11)
        self.assertEqual(set(result["footsteps"]),
                         {"tolerance_cm_s", "count", "max_count", "v95_cm_s", "duration_mean_s",
                          "duration_std_s"})
        self.assertEqual(result["footsteps"]["tolerance_cm_s"],
                         [float(v) for v in range(1, 201)])
        self.assertLess(result["bone_length_rmse_cm"], 0.001)
        against = self.run_json("analyze", self.clips, "--against", self.clip, "--fps", "20",
                                "--resamples", "0")
        self.assertTrue(any("natural" in s for s in against["statistics"]))

    def test_render_writes_a_picture_and_a_video(self):
        picture, video = self.dir / "a.png", self.dir / "a.mp4"
        result = self.run_json("render", self.clip, "--out", picture, "--size", "160x120")
        self.assertEqual((result["file"], result["frames"]), (str(picture), 1))
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        result = self.run_json("render", self.clip, "--out", video, "--size", "160x120",
                               "--fps", "5")
        self.assertEqual((result["frames"], result["fps"]), (20, 5.0))
        self.assertEqual(video.read_bytes()[4:8], b"ftyp")

    def test_every_kind_of_video_has_the_frames_rate_and_size_it_was_asked_for(self):
        need_tools("ffprobe")
        for name, codec in (("a.mp4", "h264"), ("a.webm", "vp9"), ("a.gif", "gif"),
                            ("f{frame:03}.png", "png")):
            with self.subTest(name=name):
                out = self.dir / name
                options = ("--size", "160x120", "--fps", "5", "--title", "walk")
                result = self.run_json("render", self.clip, "--out", out, *options)
                self.assertEqual(result, {"file": str(out), "frames": 20, "fps": 5.0})
                probe = ["ffprobe", "-v", "error", "-count_frames", "-show_streams",
                         "-show_format", "-of", "json"]
                if codec == "png":
                    probe += ["-framerate", "5", "-start_number", "0"]
                    out = self.dir / "f%03d.png"
                found = json.loads(subprocess.run([*probe, out], check=True, capture_output=True,
                                                  text=True).stdout)
                stream, = found["streams"]
                self.assertEqual((stream["codec_name"], stream["width"], stream["height"],
                                  stream["avg_frame_rate"], stream["nb_read_frames"]),
                                 (codec, 160, 120, "5/1", "20"))
                if codec != "png":
                    tags = {k.lower(): v for k, v in found["format"]["tags"].items()}
                    recipe = json.loads(tags["comment"])
                    self.assertIn(str(self.clip), recipe["inputs"])
                    first = out.read_bytes()
                    self.run_json("render", self.clip, "--out", self.dir / name, *options)
                    self.assertEqual(first, out.read_bytes())

    def test_a_shorter_video_is_not_mixed_with_the_pictures_of_a_longer_one(self):
        out = self.dir / "{frame}.png"
        self.run_json("render", self.clip, "--out", out, "--size", "64x64", "--fps", "2")
        self.assertEqual(len(listing(self.dir)), 8)
        self.assert_refused(["render", self.clip, "--out", out, "--size", "64x64", "--fps", "1"],
                            "{frame}.png", "4.png", "longer")

    def test_lists_name_files_relative_to_their_folder(self):
        (self.dir / "clips").mkdir()
        (self.dir / "clips" / "a.bvh").write_bytes(self.clip.read_bytes())
        (self.dir / "clips" / "list.txt").write_text("a.bvh\n")
        result = self.run_json("analyze", f"@{self.dir}/clips/list.txt", "--resamples", "0")
        self.assertEqual(result["clips"], 1)


class ModelCommands(SharedModelCase):
    def test_train_reports_steps_and_bits(self):
        out = self.dir / "run"
        result = self.run_json("train", self.tiny_config(), "--data", self.data, "--out", out,
                               "--steps", "3")
        self.assertEqual(result["steps"], 3)
        for key in ("train_bits_per_frame", "valid_bits_per_frame"):
            self.assertIsInstance(result[key], float)
        self.assertTrue((out / "last.marey").is_file())
        self.assertTrue((out / "best.marey").is_file())

    def test_sample_names_its_clips_and_records_their_recipe(self):
        out = self.dir / "samples"
        result = self.run_json("sample", self.model, "--path", "preset:turn-left", "-n", "2",
                               "--seconds", "1", "--seed", "7", "--out", out)
        self.assertEqual([p.rsplit("/", 1)[1] for p in result["clips"]],
                         ["sample_000.bvh", "sample_001.bvh"])
        self.assertGreater(result["frames_per_s"], 0)
        for path in result["clips"]:
            text = (out / path.rsplit("/", 1)[1]).read_text()
            self.assertRegex(text, r"Frames:\s*20\b")
        recipe = (out / "sample_000.bvh.recipe.json").read_text()
        for word in ("model_hash", '"seed"', "temperature", '"marey"'):
            self.assertIn(word, recipe)

    def test_sample_states_how_far_rotations_are_from_the_sampled_positions(self):
        words = ("sample", self.model, "--path", "preset:turn-left", "-n", "2", "--seconds", "1")
        exact = self.run_json(*words, "--format", "npz", "--out", self.dir / "npz")
        self.assertNotIn("fit_residual_cm", exact)
        for extension in ("bvh", "glb"):
            result = self.run_json(*words, "--format", extension, "--out", self.dir / extension)
            self.assertEqual(len(result["fit_residual_cm"]), 21)
            self.assertGreaterEqual(result["fit_residual_max_cm"],
                                    max(result["fit_residual_cm"].values()))
        scene, _ = read_gltf(self.dir / "glb" / "sample_001.glb")
        recipe = scene["asset"]["extras"]["recipe"]
        self.assertEqual((recipe["seed"], recipe["sample"]), (1, "sample_001"))
        self.assertIn("fit_residual_cm", recipe["fit"])

    def test_sample_follows_a_clip(self):
        out = self.dir / "samples"
        result = self.run_json("sample", self.model, "--path", f"clip:{self.clip}", "--start",
                               "clip", "--out", out)
        self.assertEqual(len(result["clips"]), 1)

    def test_score_gives_a_likelihood_per_frame_after_the_context(self):
        result = self.run_json("score", self.model, self.clip)
        clip, = result["clips"]
        self.assertEqual((clip["name"], clip["first_frame"]), ("walker_0000", 2))
        nats = clip["loglik_nats"]
        self.assertEqual(len(nats), 4 * 20 - 2)  # less the context
        self.assertAlmostEqual(clip["mean_nats_per_frame"], sum(nats) / len(nats), places=6)
        plain = self.run_json("score", self.model, self.clip, "--standardised")["clips"][0]
        # The standardiser's log-determinant is one constant for every frame.
        shifts = [a - b for a, b in zip(nats, plain["loglik_nats"])]
        self.assertGreater(abs(shifts[0]), 1.0)
        self.assertLess(max(shifts) - min(shifts), 1e-3)

    def test_model_info_export_and_half_precision(self):
        info = self.run_json("model", "info", self.model)
        self.assertEqual({k: info[k] for k in ("family", "pose_dim", "control_dim")},
                         {"family": "moglow", "pose_dim": 63, "control_dim": 3})
        of_config = self.run_json("model", "info", "--config", self.tiny_config())
        self.assertEqual(of_config["parameters"], info["parameters"])
        whole, half = self.dir / "whole.marey", self.dir / "half.marey"
        self.run_json("model", "export", self.model, "--out", whole, "--name", "renamed")
        self.run_json("model", "export", self.model, "--half", "--out", half)
        # Two bytes of every trained weight at least; what a likelihood is judged by stays as it is.
        saved = whole.stat().st_size - half.stat().st_size
        self.assertGreater(saved, 2 * info["parameters"])
        self.assertLess(saved, whole.stat().st_size / 2)
        self.assertEqual(self.run_json("model", "info", whole)["name"], "renamed")
        mean = [self.run_json("score", m, self.clip)["clips"][0]["mean_nats_per_frame"]
                for m in (self.model, whole, half)]
        self.assertEqual(mean[0], mean[1])
        self.assertAlmostEqual(mean[0], mean[2], delta=0.5)

    def test_a_model_keeps_its_card_and_its_recommended_temperature(self):
        self.assertEqual(self.run_json("model", "info", self.model)["card"], "")
        card = self.dir / "card.md"
        card.write_text("# Tiny\nWalks.\n")
        out = self.dir / "carded.marey"
        self.run_json("model", "export", self.model, "--out", out, "--card", card,
                      "--temperature", "0.75")
        again = self.dir / "again.marey"
        self.run_json("model", "export", out, "--half", "--out", again)
        for model in (out, again):
            info = self.run_json("model", "info", model)
            self.assertEqual(info["card"], "# Tiny\nWalks.\n")
            self.assertEqual(info["recommended"], {"temperature": 0.75})

    def test_report_runs_an_experiment(self):
        experiment = {"title": "Small", "natural": [str(self.clips)],
                      "systems": [{"name": "tiny", "model": str(self.model)}],
                      "paths": [{"name": "left", "path": "preset:turn-left", "seconds": 2}],
                      "samples": 2, "held_out_samples": 1, "seed": 1, "fps": 20}
        document = self.dir / "experiment.json"
        document.write_text(json.dumps(experiment))
        result = self.run_json("report", document, "--out", self.dir / "report")
        page = self.dir / "report" / result["report"].rsplit("/", 1)[1]
        self.assertIn("Small", page.read_text())
        self.assertTrue(result["tables"])
        self.assertTrue(result["figures"])
        for name in result["tables"] + result["figures"]:
            path = name if name.startswith("/") else self.dir / "report" / name
            with open(path, "rb") as file:
                self.assertTrue(file.read(1), name)
        for scene in [f for f in result["figures"] if "scene" in f and f.endswith(".svg")]:
            self.assertEqual(ElementTree.parse(self.dir / "report" / scene).getroot().tag,
                             "{http://www.w3.org/2000/svg}svg")
        need_tools("weasyprint", "pdftotext")
        text = subprocess.run(["pdftotext", self.dir / "report" / "report.pdf", "-"],
                              check=True, capture_output=True, text=True).stdout
        self.assertIn("Small", text)
        self.assertIn("Footsteps", text)


class Demo(Case):
    def test_the_demo_ends_with_a_report(self):
        out = self.dir / "demo"
        result = self.run_json("demo", "--out", out, "--no-pdf", timeout=280)
        self.assertTrue(result["report"].endswith(".html"))
        self.assertGreater((out / result["report"].rsplit("/", 1)[1]).stat().st_size, 10000)
        for name in ("experiment.json", "demo.marey"):
            self.assertTrue((out / name).is_file())


if __name__ == "__main__":
    main()
