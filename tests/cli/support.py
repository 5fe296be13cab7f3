"""Runs the real program, with fresh folders, and judges what it leaves behind.

The environment names the program (MAREY_BINARY) and the folder of the motion data that may lie
beside the checkout (MAREY_SHARED_DIR).
"""
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

BINARY = os.environ.get("MAREY_BINARY", "")
SHARED = pathlib.Path(os.environ.get("MAREY_SHARED_DIR", "../shared"))

TINY_CONFIG = {
    "family": "moglow",
    "name": "tiny",
    "model": {
        "pose_dim": 63, "control_dim": 3, "tau": 2, "lookahead": 0, "steps": 2, "hidden": 8,
        "lstm_layers": 1, "cell": "lstm", "lu": True, "base": "normal", "dropout": 0.5,
        "start": "orthogonal", "pose_base": "none"},
    "training": {
        "window_s": 2.0, "hop_s": 1.0, "batch": 4, "learning_rate": 0.001, "schedule": "fixed",
        "clip_value": 5, "clip_norm": 100, "steps": 3, "checkpoint_every": 2},
}


def marey(*words, timeout=50, cwd=None):
    """The finished process; words may be paths."""
    return subprocess.run([BINARY, *map(str, words)], capture_output=True, text=True,
                          timeout=timeout, cwd=cwd, check=False)


def listing(folder):
    """Every file and folder below, with what the files hold."""
    folder = pathlib.Path(folder)
    return {str(p.relative_to(folder)): p.read_bytes() if p.is_file() else None
            for p in folder.rglob("*")}


def shared(*parts):
    """A folder of the data beside the checkout; skips where it is missing, fails under CI."""
    path = SHARED.joinpath(*parts)
    if not path.exists():
        message = f"{path} is not there: this test needs the motion data beside the checkout"
        if os.environ.get("CI"):
            raise AssertionError(message)
        raise unittest.SkipTest(message)
    return path


def need_tools(*names):
    """Other programs as judges; skips where one is missing, fails under CI."""
    missing = [name for name in names if shutil.which(name) is None]
    if missing and os.environ.get("CI"):
        raise AssertionError(f"not installed: {', '.join(missing)}")
    if missing:
        raise unittest.SkipTest(f"not installed: {', '.join(missing)}")


def read_tensors(path):
    """(metadata, {name: (dtype, shape, bytes)}) of the container of models and data sets."""
    blob = pathlib.Path(path).read_bytes()
    size = struct.unpack("<Q", blob[:8])[0]
    header = json.loads(blob[8:8 + size])
    metadata = header.pop("__metadata__", {})
    body = blob[8 + size:]
    return metadata, {k: (v["dtype"], v["shape"], body[slice(*v["data_offsets"])])
                      for k, v in header.items()}


def write_tensors(path, metadata, tensors):
    header, body = {"__metadata__": metadata}, b""
    for name, (dtype, shape, data) in tensors.items():
        header[name] = {"dtype": dtype, "shape": shape,
                        "data_offsets": [len(body), len(body) + len(data)]}
        body += data
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    pathlib.Path(path).write_bytes(struct.pack("<Q", len(text)) + text + body)


class Case(unittest.TestCase):
    """A test with its own folder `self.dir`."""

    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="marey-cli-"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def run_json(self, *words, timeout=50):
        """Stdout of a run that succeeds is exactly one JSON object; --quiet silences stderr."""
        done = marey(*words, "--json", "--quiet", timeout=timeout)
        self.assertEqual(done.returncode, 0, f"{words}: {done.stderr}")
        self.assertEqual(done.stderr, "")
        result, end = json.JSONDecoder().raw_decode(done.stdout)
        self.assertIsInstance(result, dict)
        self.assertEqual(done.stdout[end:].strip(), "", "more than one object on stdout")
        return result

    def assert_refused(self, words, *expected, status=1, untouched=None, cwd=None):
        """The run ends with `status`, says every one of `expected` on stderr, prints nothing on
        stdout and leaves `untouched` (default: the test's folder) as it was."""
        folder = untouched or self.dir
        before = listing(folder)
        done = marey(*words, cwd=cwd)
        self.assertEqual(done.returncode, status, f"{words}: {done.stdout}{done.stderr}")
        for text in expected:
            self.assertIn(str(text), done.stderr)
        self.assertEqual(done.stdout, "")
        after = listing(folder)
        self.assertEqual(sorted(set(after) - set(before)), [], "left behind")
        self.assertEqual(before, after)
        return done.stderr

    def walker(self, clips=2, seconds=4, seed=1, name="walker"):
        folder = self.dir / name
        done = marey("demo", "--write-data", folder, "--clips", clips, "--clip-seconds", seconds,
                     "--seed", seed, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        return folder

    def tiny_config(self, name="tiny.json", model=None, **training):
        config = json.loads(json.dumps(TINY_CONFIG))
        config["model"].update(model or {})
        config["training"].update(training)
        path = self.dir / name
        path.write_text(json.dumps(config))
        return path

    def prepared(self, walker):
        path = self.dir / "data.marey"
        done = marey("prepare", walker, "--out", path, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        return path

    def trained(self, steps=3):
        """A model trained for a moment on the walker, and the walker's folder."""
        walker = self.walker()
        data = self.prepared(walker)
        run = self.dir / "run"
        done = marey("train", self.tiny_config(), "--data", data, "--out", run, "--steps", steps,
                     "--threads", 1, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        return run / "last.marey", walker


class SharedModelCase(Case):
    """Tests that only read one model and its walker clips."""

    @classmethod
    def setUpClass(cls):
        maker = Case()
        maker.dir = cls.home = pathlib.Path(tempfile.mkdtemp(prefix="marey-cli-"))
        cls.addClassCleanup(shutil.rmtree, cls.home, ignore_errors=True)
        cls.model, cls.clips = maker.trained()
        cls.clip = cls.clips / "walker_0000.bvh"
        cls.data = cls.home / "data.marey"


def main():
    if not BINARY or not os.access(BINARY, os.X_OK):
        sys.exit(f"MAREY_BINARY: expected the built program, found '{BINARY}'")
    unittest.main(verbosity=2)
