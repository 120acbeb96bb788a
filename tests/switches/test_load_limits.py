"""Loads that the compiled loop looks at: as those found from Python, with the same bits, and seldom left."""

import numpy as np
import pytest

import carom
from campaigns import switches
from carom import GROUND, joints
from carom.run import Run
from carom.watch import limits as within
from carom.watch.switching import Loads
from carom.watch.watched import Watched

G = 9.81


def chain(count=4, **breaks):
    """Balls on hinges 1 m apart, level at the start, the first on the ground; one hinge may break."""
    scene = carom.Scene(gravity=(0, 0, -G))
    last = GROUND
    for k in range(count):
        ball = scene.add_body(
            carom.Sphere(0.1), mass=1.0 + k, position=(1.0 + k, 0, 0.1 * k), name=f"ball{k}"
        )
        hinge, own = joints.Revolute((k + 0.1, 0, 0.1 * k), (0, 1, 0.2 * k)), {}
        if k == 1:
            own = breaks
        scene.add_joint(
            hinge, *((last, ball) if k % 2 == 0 else (ball, last)), name=f"pin{k}", **own
        )
        last = ball
    return scene


def on_a_floor(**breaks):
    """The chain falls on a floor, and lies there."""
    scene = chain(2, **breaks)
    floor = scene.add_half_space((0, 0, -0.4), (0, 0, 1))
    for body in scene.bodies:
        scene.add_contact(body, floor, friction=0.4, restitution=0.2)
    return scene


def loop(**breaks):
    """Four bars of which one pin may break."""
    scene = carom.Scene(gravity=(0, 0, -G))
    places = [(0, 0, 0.5), (0.5, 0, 1.0), (1.0, 0, 0.5)]
    for k, place in enumerate(places):
        scene.add_body(carom.Sphere(0.05), mass=1.0, position=place, name=f"bar{k}")
    ends = [(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0)]
    pairs = [(GROUND, "bar0"), ("bar0", "bar1"), ("bar1", "bar2"), (GROUND, "bar2")]
    for k, (end, pair) in enumerate(zip(ends, pairs)):
        own = breaks if k == 2 else {}
        scene.add_joint(joints.Revolute(end, (0, 1, 0)), *pair, name=f"pin{k}", **own)
    scene.add_force(carom.forces.JointSpring("pin0", stiffness=3.0, rest=1.0))
    return scene


def both(scene, monkeypatch, duration=1.0, **how):
    """Return a run whose loads are looked at in the loop, and one in which they are from Python."""
    ours = carom.simulate(scene, duration, **how)
    with monkeypatch.context() as patch:
        patch.setattr(within.Within, "go_on", lambda self, until: None)
        theirs = carom.simulate(scene, duration, **how)
    return ours, theirs


@pytest.mark.parametrize("make", [chain, on_a_floor, loop])
def test_the_loads_are_those_found_from_python(make):
    limits = {"force": 1e6, "torque": 1e5}
    watched = Watched(Run(make(breaks_at=limits), carom.Run(make(), step=1e-3)._run.how))
    own, run = watched.within, watched.run
    (condition,) = watched.conditions
    part = condition.switch.parts[0]
    loads = Loads(run)
    for _ in range(40):
        before = run.steps_done
        assert own.go_on(before + 20) is not None
        assert run.steps_done == before + 20
        assert own.reading is not None
        force, torque = loads.of(part, watched.look())
        most = max(np.linalg.norm(force) / 1e6, np.linalg.norm(torque) / 1e5) - 1.0
        assert watched.values[0] == pytest.approx(most, abs=1e-15)
        assert watched.values[0] > -1.0


HOW = {"tolerances": {}, "step": {"step": 5e-3}, "few": {"save_every": 10, "step": 2e-3}}


@pytest.mark.bits
@pytest.mark.parametrize("how", HOW.values(), ids=HOW)
@pytest.mark.parametrize("make", [chain, on_a_floor, loop])
@pytest.mark.parametrize("part", [0.3, 0.9, 0.9999])
def test_a_joint_breaks_as_when_each_step_is_looked_at(make, part, how, monkeypatch):
    free = carom.simulate(make(), 1.0, **how)
    load = np.linalg.norm(free["pin1" if make is not loop else "pin2"].force, axis=1)
    limits = {"force": part * load[1:].max()}
    ours, theirs = both(make(breaks_at=limits), monkeypatch, **how)
    assert len(ours.switches) == len(theirs.switches) == 1
    assert ours.switches.time[0] == theirs.switches.time[0]
    np.testing.assert_array_equal(ours.position, theirs.position)
    np.testing.assert_array_equal(ours.velocity, theirs.velocity)


@pytest.mark.bits
def test_by_an_impulse_too(monkeypatch):
    scene = on_a_floor(breaks_at={"impulse": 1e-3})
    ours, theirs = both(scene, monkeypatch)
    assert len(ours.switches) == 1
    assert ours.switches.time[0] == theirs.switches.time[0]
    np.testing.assert_array_equal(ours.position, theirs.position)
    ours, theirs = both(on_a_floor(breaks_at={"impulse": 1e3}), monkeypatch)
    assert len(ours.switches) == 0
    np.testing.assert_array_equal(ours.position, theirs.position)


@pytest.mark.bits
def test_random_scenes_are_the_same_bits(monkeypatch):
    """Those of the campaign that have joints which break."""
    seen = 0
    for seed in range(60):
        case = switches.case(seed)
        if not any(one.limits for one in case.scene.switches):
            continue
        ours, theirs = both(
            case.scene, monkeypatch, min(case.duration, 0.3), step=case.step, throw=False
        )
        assert ours.status == theirs.status
        np.testing.assert_array_equal(ours.position, theirs.position)
        np.testing.assert_array_equal(ours.switches.time, theirs.switches.time)
        seen += 1
    assert seen > 3


def test_the_loop_is_left_once_in_many_steps(monkeypatch):
    calls, go_on = [], Run.go_on

    def counted(self, until):
        calls.append(until)
        return go_on(self, until)

    monkeypatch.setattr(Run, "go_on", counted)
    carom.simulate(chain(breaks_at=1e6), 1.0, step=1e-3)
    assert len(calls) < 1000 / within.STEPS_AT_ONCE + 2
