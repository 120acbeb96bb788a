"""Loads that the compiled loop looks at: as those found from Python, with the same bits, and seldom left."""

import numpy as np
import pytest

import carom
from campaigns import switches
from carom import GROUND, joints
from carom.run import Run
from carom.watch import limits as within
from carom.watch.conditions import Observed
from carom.watch.loads import Loads
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


def rubbing(make, by_load):
    """The same scene with dry friction in all joints, by load or constant."""

    def made(**breaks):
        scene = make(**breaks)
        for k, joint in enumerate(list(scene.joints)):
            law = {"mu": 0.2 + 0.1 * k, "radius": 0.05} if by_load else {"bound": 0.5 + 0.5 * k}
            scene.add_force(carom.forces.JointFriction(joint.name, **law))
        return scene

    return made


RUBBING = {
    f"{make.__name__}-{'load' if by_load else 'constant'}": rubbing(make, by_load)
    for make in (chain, on_a_floor, loop)
    for by_load in (False, True)
}


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


@pytest.mark.parametrize("make", RUBBING.values(), ids=RUBBING)
def test_the_loads_beside_dry_friction_are_those_of_the_step(make):
    """The loop has the bits of what locates a break; the motion agrees with them by Newton's law."""
    limits = {"force": 1e6, "torque": 1e5}
    watched = Watched(Run(make(breaks_at=limits), carom.Run(make(), step=1e-3)._run.how))
    own, run = watched.within, watched.run
    (condition,) = watched.conditions
    for _ in range(20):
        before = run.steps_done
        assert own.go_on(before + 20) is not None
        assert run.steps_done == before + 20
        force, torque = Loads(run).of(condition.switch.parts[0], watched.look())
        most = max(np.linalg.norm(force) / 1e6, np.linalg.norm(torque) / 1e5) - 1.0
        assert watched.values[0] == pytest.approx(most, abs=1e-13)


@pytest.mark.parametrize("by_load", [False, True])
def test_the_load_beside_dry_friction_is_that_of_newtons_law(by_load):
    """The force through a hinge is the sum of m (a - g) of the balls beyond, by central differences."""
    make = rubbing(chain, by_load)
    free = carom.simulate(make(), 0.5, step=1e-4)
    run, mass = carom.Run(make(), step=1e-4), 1.0 + np.arange(4)
    for k in (200, 1000, 2000, 4000):
        run.advance(free.t[k] - run.time)
        a = (free.velocity[k + 1] - free.velocity[k - 1]) / (free.t[k + 1] - free.t[k - 1])
        force = (mass[:, None] * (a + [0, 0, G]))[1:].sum(axis=0)
        look = Observed(run._run, {}, 0, at_end=True)
        found, _ = Loads(run._run).of(run._run.scene["pin1"], look)
        np.testing.assert_allclose(-found, force, rtol=0, atol=1e-5 * np.linalg.norm(force))


def test_beside_events_of_python_the_loop_looks_at_the_loads(monkeypatch):
    """The same break, and no load is found from Python before the step of the break."""

    def never(t, state):
        return 1.0

    make = rubbing(chain, True)
    free = carom.simulate(make(), 1.0, step=5e-3)
    limits = {"force": 0.9 * np.nanmax(np.linalg.norm(free["pin1"].force, axis=1)[1:])}
    alone = carom.simulate(make(breaks_at=limits), 1.0, step=5e-3)
    times, solve = [], Loads.solve

    def noted(self, run):
        times.append(run.reached)
        solve(self, run)

    monkeypatch.setattr(Loads, "solve", noted)
    beside = carom.simulate(make(breaks_at=limits), 1.0, step=5e-3, events=[never])
    assert len(beside.switches) == len(alone.switches) == 1
    assert beside.switches.time[0] == pytest.approx(alone.switches.time[0], rel=1e-12)
    np.testing.assert_allclose(beside.position, alone.position, rtol=0, atol=1e-11)
    assert min(times) > beside.switches.time[0] - 2 * 5e-3


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
