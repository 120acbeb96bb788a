"""A disk that is full: an error with path and reason, the old file as it was, and no run lost.

The system lets the process write so many bytes to a file and no more: what it then says is what a full disk
says, but for the name of the error.
"""

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import carom
from files.compare import differences

resource = pytest.importorskip("resource")
#: files for other programs, and what writes them
PACKAGES = {
    "html": "carom", "csv": "pandas", "glb": "pygltflib", "pvd": "meshio", "gif": "PIL",
    "mp4": "imageio_ffmpeg",
}  # fmt: skip
TESTS = Path(__file__).parents[1]
CHILD = """
import resource, signal, sys, warnings
import carom
from files.compare import differences
from simulate.scenes import die

path = sys.argv[1]
hard = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
straight = carom.simulate(die(), 0.25, step=5e-3)
write = {
    "html": lambda p: carom.view(straight, export=p), "glb": straight.export, "pvd": straight.export,
    "gif": lambda p: carom.film(straight, p, fps=10, size=(64, 48)), "csv": straight.save,
    "mp4": lambda p: carom.film(straight, p, fps=10, size=(64, 48)),
}
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (0, hard))
for kind in sys.argv[2:]:
    out = path.replace("run.nc", f"run.{kind}")
    try:
        write[kind](out)
    except OSError as error:
        print(f"{kind}: {error.filename == out} {error.strerror}")
warnings.simplefilter("always")
for full in (0, 30000):
    resource.setrlimit(resource.RLIMIT_FSIZE, (full, hard))
    with warnings.catch_warnings(record=True) as said:
        try:
            straight.save(path)
        except OSError as error:
            print(f"save {full}:", error)
        try:
            carom.simulate(die(), 0.25, step=5e-3, save=path, save_seconds=0.0)
        except carom.SimulationError as error:
            print(f"simulate {full}:", error, differences(error.solution, straight))
    print(f"said {full}:", len(said), {str(one.message).split(":")[0] for one in said})
    with open(path, "rb") as file:
        print(f"left {full}:", file.read())
resource.setrlimit(resource.RLIMIT_FSIZE, (hard, hard))
straight.save(path)
print("then:", differences(carom.Solution.load(path), straight))
"""


@pytest.mark.bits
def test_full_disk(thrown, tmp_path):
    """Full from the first byte on, and in the middle of a file."""
    path = tmp_path / "run.nc"
    path.write_bytes(b"what was there")
    kinds = [kind for kind, package in PACKAGES.items() if find_spec(package)]
    olds = [tmp_path / f"run.{kind}" for kind in kinds]
    for old in olds:
        old.write_bytes(b"what was there")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), *sys.path])}
    done = subprocess.run(
        [sys.executable, "-c", CHILD, str(path), *kinds],
        env=environment, capture_output=True, text=True, check=True, timeout=300,
    )  # fmt: skip
    told = dict(line.split(": ", 1) for line in done.stdout.splitlines())
    for old, kind in zip(olds, kinds):
        assert old.read_bytes() == b"what was there"
        assert told[kind].startswith("True ")
        assert "nothing was written, an old file is unchanged" in told[kind]
    for full in (0, 30000):
        save, simulate = told[f"save {full}"], told[f"simulate {full}"]
        assert "File too large; nothing was written, an old file is unchanged" in save
        assert "run.nc" in save
        assert simulate.startswith("The run ended, but its result could not be saved: [Errno ")
        assert simulate.endswith("[]")  # the solution that it holds is the run
        assert "the run could not be saved to" in told[f"said {full}"]
        assert told[f"left {full}"] == "b'what was there'"
    assert told["then"] == "[]"
    assert differences(carom.Solution.load(path), thrown) == []
    assert set(tmp_path.iterdir()) == {path, *olds}
