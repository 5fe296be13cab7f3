"""Runs the real program, with fresh folders, and judges what it leaves behind.

The environment names the program (MAREY_BINARY) and the folder of the motion data that may lie
beside the checkout (MAREY_SHARED_DIR).
"""
import base64
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zipfile

BINARY = os.environ.get("MAREY_BINARY", "")
# A program that hangs ends here; a busy machine must not.
LIMIT_S = 280
FIXTURES = pathlib.Path(__file__).resolve().parent.parent / "fixtures"
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


def marey(*words, timeout=LIMIT_S, cwd=None, env=None):
    """The finished process; words may be paths, `env` is added to the environment."""
    return subprocess.run([BINARY, *map(str, words)], capture_output=True, text=True,
                          timeout=timeout, cwd=cwd, check=False, env={**os.environ, **(env or {})})


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


def need_python(module):
    """A module of Debian's Python as a judge; skips where it is missing, fails under CI."""
    found = subprocess.run(["/usr/bin/python3", "-c", f"import {module}"], capture_output=True,
                           check=False)
    if found.returncode == 0:
        return
    if os.environ.get("CI"):
        raise AssertionError(f"python3-{module} is not installed")
    raise unittest.SkipTest(f"python3-{module} is not installed")


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


def read_gltf(path):
    """(scene description, its one buffer) of a .gltf or .glb file."""
    blob = pathlib.Path(path).read_bytes()
    if blob[:4] != b"glTF":
        scene = json.loads(blob)
        return scene, base64.b64decode(scene["buffers"][0]["uri"].split(",", 1)[1])
    size = struct.unpack("<I", blob[12:16])[0]
    return json.loads(blob[20:20 + size]), blob[28 + size:]


def gltf_floats(scene, buffer, index):
    """The numbers of one accessor of floats."""
    accessor = scene["accessors"][index]
    view = scene["bufferViews"][accessor["bufferView"]]
    count = accessor["count"] * {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[accessor["type"]]
    return struct.unpack_from(f"<{count}f", buffer, view.get("byteOffset", 0))


def without_rotations(path, lift):
    """Makes a clip's NPZ one of positions only, whose joint 'Head' is higher by `lift` metres."""
    with zipfile.ZipFile(path) as archive:
        arrays = {name: archive.read(name) for name in archive.namelist()}
    del arrays["rotations.npy"], arrays["translations.npy"]
    names = npy_texts(arrays["joint_names.npy"])
    header, body = npy_body(arrays["positions.npy"])
    values = list(struct.unpack(f"<{len(body) // 4}f", body))
    at = 3 * names.index("Head") + 1
    values[at::3 * len(names)] = [v + lift for v in values[at::3 * len(names)]]
    arrays["positions.npy"] = header + struct.pack(f"<{len(values)}f", *values)
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in arrays.items():
            archive.writestr(name, content)


def npy_body(content):
    """(header, data) of a NumPy array file, version 1."""
    size = 10 + struct.unpack("<H", content[8:10])[0]
    return content[:size], content[size:]


def npy_texts(content):
    """The values of a list of NumPy's text."""
    header, body = npy_body(content)
    width = 4 * int(re.search(rb"'<U(\d+)'", header).group(1))
    return [body[i:i + width].decode("utf-32-le").rstrip("\0")
            for i in range(0, len(body), width)]


class Case(unittest.TestCase):
    """A test with its own folder `self.dir`."""

    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="marey-cli-"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def run_json(self, *words, timeout=LIMIT_S):
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
