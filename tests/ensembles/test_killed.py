"""An ensemble that is killed at any operation on files goes on; a full disk keeps what is done."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import carom
from ensembles.ensemble_scenes import die
from ensembles.test_ensemble import THROWN, same

pytest.importorskip("zarr")
resource = pytest.importorskip("resource")
TESTS = Path(__file__).parents[1]
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), *sys.path])}
FULL = """
import resource, sys
import carom
from ensembles.test_killed import throw

hard = resource.getrlimit(resource.RLIMIT_FSIZE)[1]

def full(done, total):  # no byte more, from the second part on
    if done >= 5:
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, hard))

try:
    throw(sys.argv[1], progress=full)
except OSError as error:
    print(error)
"""


def throw(save=None, **more):
    return carom.ensemble(
        die(), 0.2, step=5e-3, vary=THROWN, runs=20, chunk=5, save=save, executor="serial", **more
    )


def python(*arguments):
    return subprocess.run(
        [sys.executable, *arguments],
        env=ENVIRONMENT, capture_output=True, text=True, timeout=600, check=True,
    ).stdout  # fmt: skip


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.parametrize("step", [172, pytest.param(12, marks=pytest.mark.slow)])
def test_killed_at_any_operation(step, tmp_path):
    # some 850 operations: half of them make the store
    kills = str(TESTS / "ensembles" / "kills.py")
    told = python(kills, str(tmp_path), "5", str(step), "200").split()
    assert len(told) == 2, told
    assert int(told[0]) >= 4


def test_killed_while_it_is_made(tmp_path):
    """What is there of a store says that it is none yet, and is made anew; nothing else is touched."""
    (tmp_path / "e.zarr" / "outcomes").mkdir(parents=True)
    (tmp_path / "e.zarr" / ".making").touch()
    (tmp_path / "e.zarr" / "zarr.json").write_text('{"zarr_fo')
    (tmp_path / "e.zarr" / "mine.txt").write_text("keep me")
    with pytest.raises(FileNotFoundError, match=r"e\.zarr does not exist"):
        carom.Ensemble.load(tmp_path / "e.zarr")
    assert same(throw(tmp_path / "e.zarr"), throw())
    assert (tmp_path / "e.zarr" / "mine.txt").read_text() == "keep me"


@pytest.mark.bits
def test_full_disk(tmp_path):
    place = tmp_path / "e.zarr"
    told = python("-c", FULL, str(place))
    assert "File too large; the parts written so far are valid: call again to continue" in told
    assert str(place) in told
    assert carom.Ensemble.load(place).counts() == {"pending": 15, "success": 5}
    assert same(throw(place), throw())


@pytest.mark.parametrize("array", ["t", "position"])
def test_damaged_numbers_are_made_again(array, tmp_path):
    throw(tmp_path / "e.zarr")
    file = tmp_path / "e.zarr" / "outcomes" / array / "c" / "1"
    file = next(f for f in [file, *file.rglob("*")] if f.is_file())
    file.write_bytes(file.read_bytes()[:-3])
    part = carom.Ensemble.load(tmp_path / "e.zarr")
    assert part.counts() == {"pending": 5, "success": 15}
    assert same(throw(tmp_path / "e.zarr"), throw())


def test_damaged_inputs_are_refused(tmp_path):
    throw(tmp_path / "e.zarr")
    for file in (tmp_path / "e.zarr" / "inputs" / "die.velocity" / "c").rglob("*"):
        if file.is_file():
            file.write_bytes(file.read_bytes()[:-3])
    with pytest.raises(ValueError, match=r"e\.zarr is damaged"):
        carom.Ensemble.load(tmp_path / "e.zarr")


@pytest.mark.bits  # the other process is not nudged
def test_a_signal_at_any_time(tmp_path):
    """Killed by the clock, wherever it is; another process ends it."""
    code = "import sys; from ensembles.test_killed import throw; print(1, flush=True); throw(sys.argv[1])"
    command = [sys.executable, "-c", code, str(tmp_path / "e.zarr")]
    with subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        child.stdout.readline()
        try:
            child.wait(0.2)
        except subprocess.TimeoutExpired:
            child.send_signal(signal.SIGKILL)
    assert same(throw(tmp_path / "e.zarr"), throw())
