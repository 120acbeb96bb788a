"""A run that was stopped goes on from its file and ends as if it had not been: bit for bit."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import carom
from carom import forces, joints
from carom._compiled.record_arrays import table
from carom.io.files.checkpoint import FIXED, capture, restore
from carom.io.files.kept import run_again
from carom.model import records as r
from carom.model.allowance import COUNTS
from files.compare import derived_differences, differences
from files.made_up import rewrite
from files.scenes import pendulum, pile, push, slider
from simulate.scenes import die
from verified import agree, verifies

TESTS = Path(__file__).parents[1]
CHILD = """
import sys, time
import carom
from files.scenes import slider
from simulate.scenes import die

scene = {"die": lambda: die(mu=0.3), "slider": slider}[sys.argv[1]]()
slow = int(sys.argv[3])

def progress(done, total):  # slow enough to be killed, from some step on
    if done >= slow:
        time.sleep(0.5)

carom.simulate(
    scene, 0.5, step=1e-3, save=sys.argv[2], save_seconds=0.1, progress=progress
)
"""


def stopped_at(fraction):
    """Progress that stops a run, as Ctrl-C does."""

    def progress(done, total):
        if done >= fraction * total:
            raise KeyboardInterrupt

    return progress


def interrupted(scene, duration, fraction, path, **settings):
    """A run that is stopped and saved."""
    progress = stopped_at(fraction)
    return carom.simulate(scene, duration, save=path, progress=progress, throw=False, **settings)


# the die is stopped after it has struck, the block while it slides on the plane
@pytest.mark.bits
@pytest.mark.parametrize(("name", "late"), [("die", 300), ("slider", 120)])
def test_killed_process(name, late, tmp_path):
    path = tmp_path / "run.nc"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), *sys.path])}
    command = [sys.executable, "-c", CHILD, name, str(path), str(late)]
    child = subprocess.Popen(command, env=environment)
    try:
        until = time.monotonic() + 600.0
        while not (path.exists() and carom.Solution.load(path).t[-1] >= 1e-3 * late):
            assert child.poll() is None, "the run ended before it was to be killed"
            assert time.monotonic() < until
            time.sleep(0.2)
    finally:
        child.kill()
        child.wait()
    assert child.returncode == -signal.SIGKILL
    part = carom.Solution.load(path)
    assert part.status is carom.Status.INTERRUPTED
    whole = carom.simulate(die(mu=0.3) if name == "die" else slider(), 0.5, step=1e-3)
    reached = len(part.t)
    assert late < reached < len(whole.t)
    assert part.position.tobytes() == whole.position[:reached].tobytes()
    assert len(part.impacts) > 0
    assert (part.contact_mode[-1, 0] > 0) == (name == "slider")  # the die is in flight
    again = carom.resume(path)
    assert differences(again, whole) == []
    assert derived_differences(again, whole) == []
    assert differences(carom.Solution.load(path), whole) == []
    assert list(tmp_path.iterdir()) == [path]  # whatever the killed process had begun to write


#: a stop that is held is stepped with order 2 and loses .3 % here, a heap with order 1
ALLOWED = carom.Options(energy_tolerance=0.01)


@verifies("resume", "a run that goes on is the whole run, bit for bit", "invariant")
@pytest.mark.few(3)
@pytest.mark.parametrize("fraction", [0.2, 0.8])
@pytest.mark.parametrize(
    "settings",
    [
        {"step": 2e-2, "options": ALLOWED},
        {"step": "auto", "rtol": 1e-6, "options": ALLOWED},
        {"step": 2e-2, "save_every": 7, "options": ALLOWED},
    ],
    ids=["steps", "auto", "seldom"],
)
def test_pendulum(fraction, settings, tmp_path):
    # with whole turns of its hinges, a spring along them, and a stop that it strikes
    path = tmp_path / "run.nc"
    part = interrupted(pendulum(), 1.0, fraction, path, **settings)
    assert part.status is carom.Status.INTERRUPTED
    assert differences(carom.Solution.load(path), part) == []
    whole = carom.simulate(pendulum(), 1.0, **settings)
    again = carom.resume(path)
    assert differences(again, whole) == []
    assert derived_differences(again, whole) == []
    agree(again.position, whole.position)


def test_interrupted_run_works_out_the_same(tmp_path):
    path = tmp_path / "run.nc"
    part = interrupted(pendulum(), 1.0, 0.5, path, step=2e-2)
    loaded = carom.Solution.load(path)
    for name in ("joint_reactions", "constraint_forces", "constraint_errors"):
        vars(loaded).pop(name, None)  # what the file holds: to be worked out again
    assert derived_differences(loaded, part) == []


def test_heap(tmp_path):
    # six balls: islands that come and go, impacts of several points, a heap with all its memory
    path = tmp_path / "run.nc"
    settings = {"step": 5e-3, "options": ALLOWED}
    interrupted(pile(6), 0.3, 0.6, path, **settings)
    assert differences(carom.resume(path), carom.simulate(pile(6), 0.3, **settings)) == []


def test_stopped_twice(tmp_path):
    path = tmp_path / "run.nc"
    interrupted(die(mu=0.3), 0.5, 0.3, path, step=1e-3)
    with pytest.raises(KeyboardInterrupt, match="interrupted"):
        carom.resume(path, progress=stopped_at(0.7))
    assert 0.35 <= carom.Solution.load(path).t[-1] < 0.36  # at the next report
    whole = carom.simulate(die(mu=0.3), 0.5, step=1e-3)
    assert differences(carom.resume(path), whole) == []
    assert differences(carom.resume(path), whole) == []  # at its end: as it is


def test_saving_changes_nothing(tmp_path):
    path, plain = tmp_path / "run.nc", carom.simulate(slider(), 0.2, step=5e-3)
    saved = carom.simulate(slider(), 0.2, step=5e-3, save=path, save_seconds=0.0)
    assert differences(saved, plain) == []
    assert differences(carom.Solution.load(path), plain) == []


def pushed():
    """A rod on a hinge with a plain function of the user's."""
    scene = carom.Scene()
    rod = scene.add_body(carom.Box(1, 0.1, 0.1), mass=1.0, position=(0.5, 0, 0))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, rod)
    scene.add_force(forces.JointForce(hinge, push), name="motor")
    return scene


def test_functions_are_given_again(tmp_path):
    path, whole = tmp_path / "run.nc", carom.simulate(pushed(), 0.2, step=0.01)
    interrupted(pushed(), 0.2, 0.5, path, step=0.01)
    with pytest.raises(ValueError, match=r"functions must be given for 'motor\.force'"):
        carom.resume(path)
    part = carom.Solution.load(path)
    assert "joint_force" in part.to_xarray()  # worked out when it was interrupted
    del vars(part)["joint_reactions"]
    assert "joint_force" not in part.to_xarray()
    with pytest.raises(ValueError, match=r"given for 'motor\.force', by Solution\.load"):
        _ = part.joint_reactions
    again = carom.resume(path, functions={"motor.force": push})
    assert differences(again, whole) == []
    bare = carom.Solution.load(
        path
    )  # what was worked out before it was saved is there without them
    assert differences(bare, whole) == []
    # between saved states there is a cubic in the place of the motion
    assert derived_differences(bare, whole) == ["evaluate left", "evaluate right"]


def test_no_checkpoint(tmp_path):
    path = tmp_path / "run.nc"
    part = carom.simulate(die(), 0.2, step=5e-3, progress=stopped_at(0.5), throw=False)
    part.save(path)
    with pytest.raises(ValueError, match=r"run\.nc': it has no checkpoint"):
        carom.resume(path)


def test_a_run_that_failed_does_not_go_on(tmp_path):
    from simulate.scenes import ball

    path, options = tmp_path / "run.nc", carom.Options(hold=False)
    with pytest.raises(carom.SimulationError):
        carom.simulate(ball(), 4.0, step=0.05, options=options, save=path)
    assert carom.Solution.load(path).status is carom.Status.TOO_MANY_IMPACTS
    with pytest.raises(ValueError, match="it ended by itself: One step has more impacts"):
        carom.resume(path)


def filled_with_nothing(value):
    """Write nan, or a number that is no place of anything, into all arrays of some workspace."""
    if isinstance(value, np.ndarray):
        for column in [value[n] for n in value.dtype.names] if value.dtype.names else [value]:
            column[...] = np.nan if column.dtype.kind == "f" else -7
    elif isinstance(value, tuple):
        for one in value:
            filled_with_nothing(one)


@pytest.mark.parametrize("scene", [slider(), pile(6)], ids=["slider", "pile"])
def test_scratch_is_no_state(scene):
    # What a checkpoint leaves out is written in each step before it is read: with nan in it at the
    # checkpoint the run ends with the same records.
    settings = {
        "duration": 0.4, "step": 5e-3, "method": "rk4", "impact_location": "locate",
        "save_every": 1,
    }  # fmt: skip
    whole, part, again = (run_again(scene, settings, carom.Options()) for _ in range(3))
    assert whole.go_on(80) is carom.Status.SUCCESS
    part.go_on(60)
    checkpoint = capture(part)
    assert checkpoint is not None
    assert "work.search" not in checkpoint.arrays
    # as in files of before, whose clock also had what is in `work.step`
    clock = table([("spent", "f8"), *r.CLOCK, ("counts", "f8", COUNTS)], 1)
    for name, *_ in r.CLOCK:
        clock[name] = part.clock[name]
    older = {**checkpoint.arrays, "clock": clock, "islands.clock": clock, "work.point": clock}
    restore(again, checkpoint._replace(arrays=older), r.trimmed(part.records, part.clock))
    work = again.work
    left_out = [getattr(work, name) for name in work._fields if f"work.{name}" in FIXED]
    left_out += (
        again.group,
        again.multiple,
        again.crowd,
        again.islands.clock,
        again.islands.single.clock,
    )
    filled_with_nothing(tuple(left_out))
    for name in "spent", "paused":
        work.step[name] = 0  # as in a new run
    work.search["pending"] = 0
    assert again.go_on(80) is carom.Status.SUCCESS
    one, two = (r.trimmed(run.records, run.clock) for run in (whole, again))
    assert [name for name, a, b in zip(one._fields, one, two) if a.tobytes() != b.tobytes()] == []
    assert whole.clock.tobytes() == again.clock.tobytes()


def test_checkpoint_of_another_version(tmp_path):
    path = tmp_path / "run.nc"
    interrupted(die(), 0.2, 0.5, path, step=5e-3)

    def older(index):
        index["checkpoint"]["arrays"]["clock"][0][0][0] = "then"

    rewrite(path, older)
    assert carom.Solution.load(path).t[-1] > 0.0  # what it has computed is read all the same
    with pytest.raises(
        ValueError, match=r"run\.nc': the checkpoint was written by another version"
    ):
        carom.resume(path)
