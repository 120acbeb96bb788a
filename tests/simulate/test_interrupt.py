"""Ctrl-C ends any run soon, with what was computed until then: the loop is left for a moment now and then."""

import signal
import subprocess
import sys
import threading
import time

import numba
import numpy as np
import pytest

import carom
from carom.model import records
from carom.stepping import time_loop
from files.compare import differences
from simulate.scenes import die, turn

#: A run says when it begins in earnest, and at its end how far it came. Longer than anybody waits.
RUN = """
import signal
import numpy as np, carom
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored by what begins in the background
for scene in ball(), balls():
    carom.simulate(scene, 3.0, step=1e-3)  # compiled
    print("begins", flush=True)
    s = carom.simulate(scene, 1e6, step=1e-3, save_every=10**8, throw=False)
    whole = all(np.all(np.isfinite(a)) for a in (s.t, s.position, s.velocity, s.total_energy))
    print(s.status.name, whole, 0.0 < s.t[-1] < 1e6, flush=True)
"""

SCENES = """
def ball():
    scene = carom.Scene(gravity=(0, 0, -9.81))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_contact(
        scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5)), floor, restitution=1.0
    )
    return scene

def balls():
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(2):
        scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0.05 * k, 0, 0.3 * k + 0.2))
    scene.set_contact_default(restitution=0.5, friction=0.3)
    return scene
"""


@pytest.mark.skipif(sys.platform == "win32", reason="SIGINT is sent by other means there")
def test_an_interrupt_ends_a_run():
    """Within a second on an idle machine; five are allowed for. One body, then two that touch."""
    code = "import carom\n" + SCENES + RUN
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        late = threading.Timer(120.0, child.kill)  # then it says nothing more
        late.start()
        try:
            for _ in range(2):
                assert child.stdout.readline() == "begins\n"
                time.sleep(0.3)
                assert child.poll() is None
                child.send_signal(signal.SIGINT)
                begin = time.monotonic()
                assert child.stdout.readline() == "INTERRUPTED True True\n"
                assert time.monotonic() - begin < 5.0
        finally:
            late.cancel()
            child.kill()


@pytest.fixture
def paused(monkeypatch):
    """Have the loop left after each trial step. (What is compiled does not see the patch.)"""
    if not numba.config.DISABLE_JIT:
        pytest.skip("only without the JIT")
    monkeypatch.setattr(records, "LONG", 0.5)
    return monkeypatch


def thrown(count):
    """Return a scene of a die, alone or with a ball."""
    scene = die((3, 10, 0), 0.2, orientation=turn((1, 2, 3), 0.5), position=(0, 0, 0.03))
    if count == 2:
        scene.add_body(carom.Sphere(0.01), mass=0.01, position=(0.002, 0, 0.06))
        scene.set_contact_default(restitution=0.3, friction=0.3)
    return scene


@pytest.mark.plain
@pytest.mark.parametrize("count", [1, 2])
def test_leaving_the_loop_changes_nothing(paused, count):
    """After each trial step, or never: the same bits."""
    a = carom.simulate(thrown(count), 0.15, step=5e-3)
    paused.setattr(records, "LONG", np.inf)
    b = carom.simulate(thrown(count), 0.15, step=5e-3)
    assert len(a.impacts) > 5
    np.testing.assert_array_equal(a.position, b.position)
    np.testing.assert_array_equal(a.velocity, b.velocity)
    np.testing.assert_array_equal(a.events.time, b.events.time)


@pytest.mark.plain
@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("last", [7, 20, 41])
def test_a_run_that_is_interrupted_goes_back_to_the_end_of_a_step(paused, count, last):
    """Wherever in a step that happens."""
    whole, run, left = carom.simulate(thrown(count), 0.15, step=5e-3), time_loop.run, []

    def entered(*arguments):
        code = run(*arguments)
        left.append(code)
        if left.count(records.PAUSE) == last:
            raise KeyboardInterrupt
        return code

    paused.setattr(time_loop, "run", entered)
    a = carom.simulate(thrown(count), 0.15, step=5e-3, throw=False)
    assert a.status is carom.Status.INTERRUPTED
    assert 0.0 < a.t[-1] < 0.15
    np.testing.assert_array_equal(a.t, whole.t[: len(a.t)])
    np.testing.assert_array_equal(a.position, whole.position[: len(a.t)])
    np.testing.assert_array_equal(a.velocity, whole.velocity[: len(a.t)])


def slider():
    """A block that slides along an axis with dry friction, and stops in its first steps."""
    scene = carom.Scene(gravity=(0, 0, 0))
    block = scene.add_body(
        carom.Box(0.2, 0.2, 0.2), mass=1.0, position=(1, 0, 0), velocity=(2, 0, 0)
    )
    slide = scene.add_joint(carom.joints.Prismatic(axis=(1, 0, 0)), carom.GROUND, block)
    scene.add_force(carom.forces.JointSpring(slide, stiffness=100.0, rest=0.0))
    scene.add_force(carom.forces.JointFriction(slide, 20.0))
    return scene


@pytest.mark.plain
@pytest.mark.parametrize("last", [20, 34, 40, 47])
def test_a_run_with_friction_in_joints_goes_on_as_if_not_interrupted(paused, tmp_path, last):
    """The mode of dry friction is that at the start of the step, not that of the attempt."""
    whole, run, left = carom.simulate(slider(), 0.5, step=0.05), time_loop.run, []

    def entered(*arguments):
        code = run(*arguments)
        left.append(code)
        if left.count(records.PAUSE) == last:
            raise KeyboardInterrupt
        return code

    path = tmp_path / "run.h5"
    with paused.context() as patch:
        patch.setattr(time_loop, "run", entered)
        part = carom.simulate(slider(), 0.5, step=0.05, save=path, throw=False)
    assert part.status is carom.Status.INTERRUPTED
    assert differences(carom.resume(path), whole) == []
