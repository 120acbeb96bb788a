"""Mechanisms that nothing connects are islands of their own, until they may meet; at rest they sleep."""

import numpy as np
import pytest

import carom
from carom import run
from carom.model.clusters import connected
from carom.model.compile import compile_scene
from carom.options import Options
from carom.stepping.islands.layout import no_islands
from files.compare import differences
from islands.test_joined import loads, loop, tree

J, F = carom.joints, carom.forces
G, UP = 9.81, (0, 0, 1)
TIMES = {"duration": 0.6, "step": 2e-3}


def together(monkeypatch):
    """Have all bodies move as one island."""
    monkeypatch.setattr(
        run, "new_islands", lambda system, active, later: no_islands(system, active)
    )


def beside(mechanisms, floor=True):
    """Mechanisms side by side, the first at the origin; their links are "link 0 of 1", ..."""
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), UP) if floor else None
    for k, mechanism in enumerate(mechanisms):
        own = _Shifted(scene, (0.0, 3.0 * k, 0.0), k)
        mechanism(own, own.link)
        if ground is not None:
            for body in own.links:
                scene.add_contact(body, ground, restitution=0.5, friction=0.3)
    return scene


class _Shifted:
    """A scene in which a mechanism is made at another place."""

    def __init__(self, scene, by, number):
        self.scene, self.by, self.number, self.links = scene, np.array(by), number, []

    def link(self, place, length, orientation=(1, 0, 0, 0)):
        body = self.scene.add_body(
            carom.Box(length, 0.04, 0.04), mass=0.5, position=self.by + place, orientation=orientation,
            name=f"link {len(self.links)} of {self.number}",
        )  # fmt: skip
        self.links.append(body)
        return body

    def add_joint(self, joint, *bodies):
        return self.scene.add_joint(_moved(joint, self.by), *bodies)

    def add_force(self, force, *bodies, name=None):
        return self.scene.add_force(_moved(force, self.by), *bodies)

    def add_constraint(self, constraint, name):
        return self.scene.add_constraint(constraint, name=f"{name}{self.number}")

    def add_stop(self, *given, **named):
        return self.scene.add_stop(*given, **named)


def _moved(one, by):
    """A definition with its points moved."""
    points = ("anchor", "anchor_parent", "anchor_child")
    named = {
        name: np.add(getattr(one, name), by)
        for name in points
        if getattr(one, name, None) is not None
    }
    if not named:
        return one
    given = {name: value for name, value in vars(one).items() if name in one.__dataclass_fields__}
    return type(one)(**{**given, **named})


MECHANISMS = pytest.mark.parametrize("mechanism", [tree, loop, loads])


@MECHANISMS
def test_copies_move_as_one_alone(mechanism):
    """Bit for bit, with steps as they are given: events of the others do not cut its steps."""
    alone = carom.simulate(beside([mechanism]), **TIMES)
    three = carom.simulate(beside([mechanism] * 3), **TIMES)
    assert alone.status == three.status == carom.Status.SUCCESS
    count = len(alone.scene.bodies)
    for name in ("position", "orientation", "velocity", "angular_velocity"):
        one, first = getattr(alone, name), getattr(three, name)[:, :count]
        np.testing.assert_array_equal(first, one, err_msg=name)


@MECHANISMS
def test_parts_that_are_switched_do_not_concern_the_others(mechanism):
    """The last force of the first one is off from .2 s on: bit for bit as without the others."""
    alone, three = beside([mechanism]), beside([mechanism] * 3)
    for scene in (alone, three):
        scene.switch(scene.forces[len(alone.forces) - 1], at=0.2)
    one, all_of_them = (carom.simulate(scene, **TIMES) for scene in (alone, three))
    assert one.status == all_of_them.status == carom.Status.SUCCESS
    np.testing.assert_array_equal(all_of_them.position[:, : len(alone.bodies)], one.position)


def test_mechanisms_of_all_kinds_side_by_side(monkeypatch):
    """They have one kind of back end, that of closed loops, each its own part of it."""
    scene = beside([tree, loop, loads, tree])
    apart = carom.simulate(scene, **TIMES)
    together(monkeypatch)
    one = carom.simulate(beside([tree, loop, loads, tree]), **TIMES)
    assert apart.status == one.status == carom.Status.SUCCESS
    for name in ("position", "velocity", "total_energy"):
        np.testing.assert_allclose(getattr(apart, name)[:150], getattr(one, name)[:150], atol=1e-7)


@pytest.mark.parametrize("method", ["rk4", "implicit"])
def test_reactions_and_forces_are_those_of_each(method, monkeypatch):
    def made():
        scene = beside([loop, loads, loop], floor=False)
        return scene, carom.simulate(scene, **TIMES, method=method)

    scene, apart = made()
    together(monkeypatch)
    _, one = made()
    for joint in scene.joints:
        a, b = (np.asarray(s[joint.name].force) for s in (apart, one))
        np.testing.assert_allclose(a, b, atol=1e-6 * np.abs(b).max())
    np.testing.assert_allclose(apart.ledger.loads, one.ledger.loads, atol=1e-9)
    assert np.abs(apart.ledger.residual).max() < 1e-3


def robots(count, gap):
    """Bodies on a floor that slide at each other, each with an arm on a spring with dry friction and stops."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), UP)
    for k in range(count):
        v = (1.5 - 1.0 * k, 0, 0)
        trunk = scene.add_body(
            carom.Box(0.3, 0.2, 0.1), mass=2.0, position=(gap * k, 0, 0.05), velocity=v,
            name=f"trunk{k}",
        )  # fmt: skip
        arm = scene.add_body(
            carom.Box(0.2, 0.05, 0.05), mass=0.3, position=(gap * k, 0, 0.3), velocity=v,
            name=f"arm{k}",
        )  # fmt: skip
        joint = scene.add_joint(J.Revolute(anchor=(gap * k, 0, 0.3), axis=(0, 1, 0)), trunk, arm)
        scene.add_force(F.JointSpring(joint, stiffness=1.0, damping=0.02))
        scene.add_force(F.JointFriction(joint, 0.01))
        scene.add_force(F.JointForce(joint, 0.0), name=f"motor{k}")
        scene.add_stop(joint, lower=-1.0, restitution=0.4)
        scene.ignore_contact(trunk, arm)
    scene.set_contact_default(restitution=0.5, friction=0.3)
    return scene


def test_robots_that_collide_are_one_cluster(monkeypatch):
    """A third one, far from them, stays by itself; the motion is that in one island."""
    scene = robots(2, 0.5)
    trunk = scene.add_body(carom.Box(0.3, 0.2, 0.1), mass=2.0, position=(9.0, 0, 0.05))
    scene.add_force(F.Spring(5.0, (9, 0, 1), (9, 0, 0.05), rest_length=0.9), trunk)
    steps = carom.Run(scene, step=1e-3)
    assert steps._run.islands.united.tolist() == [0, 1, 2]
    steps.advance(0.6)
    assert steps._run.islands.united.tolist() == [0, 0, 2]
    apart = steps.solution
    together(monkeypatch)
    one = carom.simulate(scene, 0.6, step=1e-3)
    assert apart.status == one.status == carom.Status.SUCCESS
    assert len(apart.impacts) == len(one.impacts) > 20
    np.testing.assert_allclose(apart.position, one.position, atol=1e-7)
    assert np.abs(apart.ledger.residual).max() < 1e-6


def test_robots_that_have_parted_are_divided(monkeypatch):
    """Two that collide and fly apart are one for a hundred steps, then each has its own again."""
    scene = carom.Scene()
    for k, v in ((0, 2.0), (1, -2.0)):
        x = np.array([1.0 * k, 0, 0])
        one = scene.add_body(carom.Sphere(0.1), mass=1.0, position=x, velocity=(v, 0, 0))
        two = scene.add_body(
            carom.Sphere(0.1), mass=0.5, position=x + (0, 0.3, 0), velocity=(v, 0, 0)
        )
        scene.add_joint(J.Revolute(anchor=x + (0, 0.15, 0), axis=UP), one, two)
        scene.ignore_contact(one, two)
    scene.set_contact_default(restitution=0.8, friction=0.2)
    steps, clusters = carom.Run(scene, step=1e-3), []
    for _ in range(60):
        steps.advance(0.01)
        clusters.append(steps._run.islands.united.tolist())
    assert clusters[0] == clusters[-1] == [0, 1]
    assert 9 <= clusters.count([0, 0]) <= 14
    apart = steps.solution
    together(monkeypatch)
    one = carom.simulate(scene, 0.6, step=1e-3)
    assert len(apart.impacts) == len(one.impacts) > 0
    np.testing.assert_allclose(apart.position, one.position, atol=1e-9)


def assert_goes_on(scene, path, part):
    """A run that is interrupted after this part goes on from its file, bit for bit as the whole run."""
    whole = carom.simulate(scene, **TIMES)

    def stop(done, total):
        if done >= part * total:
            raise KeyboardInterrupt

    carom.simulate(scene, **TIMES, save=path, progress=stop, throw=False)
    assert differences(whole, carom.resume(path)) == []


def test_a_run_goes_on_after_robots_have_met(tmp_path):
    """Bit for bit: a file says which clusters are one."""
    path, scene = tmp_path / "run.h5", robots(3, 0.5)
    assert_goes_on(scene, path, 0.5)


def test_a_force_between_mechanisms_couples_them():
    scene = robots(3, 2.0)
    assert connected(compile_scene(scene, Options()).system).component.tolist() == [
        0, 0, 1, 1, 2, 2,
    ]  # fmt: skip
    ends = (0, 0, 0.3), (4.0, 0, 0.3)
    scene.add_force(F.Spring(1.0, *ends, rest_length=4.0), "arm0", "arm2")
    system = compile_scene(scene, Options()).system
    assert connected(system).component.tolist() == [0, 0, 1, 1, 0, 0]


def test_a_force_that_is_set_acts_on_its_robot():
    """Of three robots the motor of the last turns its arm: as it does alone."""
    turned = []
    for count, last in ((3, 2), (1, 0)):
        steps = carom.Run(robots(count, 2.0), step=1e-3)
        steps.advance(0.2)
        steps.set_force(f"motor{last}", 0.05)
        steps.advance(0.2)
        turned.append(steps.solution[f"arm{last}"].angular_velocity[:, 1])
    assert np.abs(turned[0]).max() > 0.5
    np.testing.assert_allclose(turned[0], turned[1], atol=1e-9)


def at_rest(more):
    """A robot that stands still at the origin, and what `more` adds to the scene."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), UP)
    trunk = scene.add_body(carom.Box(0.3, 0.2, 0.1), mass=2.0, position=(0, 0, 0.05), name="trunk")
    arm = scene.add_body(carom.Box(0.2, 0.05, 0.05), mass=0.3, position=(0, 0, 0.3), name="arm")
    joint = scene.add_joint(J.Revolute(anchor=(0, 0, 0.3), axis=(0, 1, 0)), trunk, arm)
    scene.add_force(F.JointSpring(joint, stiffness=1.0, damping=0.02))
    scene.add_force(F.JointForce(joint, 0.0), name="motor")
    more(scene, joint)
    scene.set_contact_default(restitution=0.3, friction=0.3)
    scene.ignore_contact(trunk, arm)
    return scene


def pendulum(scene, joint=None):
    """Another mechanism, which swings."""
    bob = scene.add_body(carom.Sphere(0.05), mass=0.1, position=(5.0, 0, 2.0), name="bob")
    scene.add_joint(J.Revolute(anchor=(4.0, 0, 2.0), axis=(0, 1, 0)), carom.GROUND, bob)


def falling(scene, joint):
    """A ball that falls on the arm, and the other mechanism."""
    pendulum(scene)
    scene.add_body(carom.Sphere(0.05), mass=0.2, position=(0.05, 0, 1.5), name="ball")


@pytest.mark.parametrize("how", [{"step": 2e-3}, {"rtol": 1e-7}])
def test_a_robot_at_rest_sleeps_beside_one_that_moves(how):
    solution = carom.simulate(at_rest(pendulum), 1.0, **how)
    assert solution.stats["held_steps"] <= 6
    assert np.all(solution["arm"].position == solution["arm"].position[0])
    force = solution["trunk-half_space1"].force[:, 0]
    np.testing.assert_allclose(force[1:], 2.3 * G, rtol=1e-9)


@pytest.mark.parametrize("how", [{"step": 1e-3}, {"rtol": 1e-8}])
def test_it_wakes_when_it_is_struck(how, monkeypatch):
    """The ball falls from 1.5 m to the arm; then all is as where nothing ever sleeps."""
    apart = carom.simulate(at_rest(falling), 0.8, **how)
    together(monkeypatch)
    one = carom.simulate(at_rest(falling), 0.8, **how)
    assert apart.status == one.status == carom.Status.SUCCESS
    first = np.sqrt(2 * (1.5 - 0.05 - 0.325) / G)
    assert apart.impacts.time[0] == pytest.approx(first, abs=1e-9)
    times = np.linspace(0.0, 0.8, 81)
    a, b = (np.array([s.evaluate(t)[0] for t in times]) for s in (apart, one))
    assert np.abs(a[-1] - a[0]).max() > 0.01
    np.testing.assert_allclose(a, b, atol=1e-5)
    assert np.abs(apart.ledger.residual).max() < 1e-5


def test_a_force_that_is_set_wakes_it():
    """It has slept when its motor begins; then its arm turns as that of a robot that never slept."""
    turned = []
    for more in (pendulum, lambda scene, joint: None):  # alone it is the only island
        steps = carom.Run(at_rest(more), step=1e-3)
        steps.advance(0.3)
        steps.set_force("motor", 0.3)
        steps.advance(0.1)
        turned.append(steps.solution["arm"].angular_velocity[:, 1])
    assert np.abs(turned[0]).max() > 0.5
    np.testing.assert_allclose(turned[0], turned[1], atol=1e-9)


def test_what_a_function_of_time_drives_does_not_sleep():
    """A motor holds the arm, then turns it from .2 s on."""

    def hold(scene, joint):
        pendulum(scene)
        scene.add_constraint(carom.constraints.Driver(joint, motion=later), name="drive")

    def later(t):
        s = max(t - 0.2, 0.0)
        return 5.0 * s**3, 15.0 * s**2, 30.0 * s

    solution = carom.simulate(at_rest(hold), 0.4, step=1e-3)
    assert solution.success
    assert abs(solution["arm"].angular_velocity[-1, 1]) == pytest.approx(0.6, rel=1e-3)


def test_a_run_goes_on_while_robots_sleep(tmp_path):
    """Bit for bit: a file says what rests."""
    path, scene = tmp_path / "run.h5", at_rest(falling)
    assert_goes_on(scene, path, 0.3)
