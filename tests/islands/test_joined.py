"""Joined and loaded bodies share an island, numbered among themselves; bodies that are not near have others."""

import numpy as np
import pytest

import carom
from carom import run
from carom.stepping.islands.layout import no_islands
from files.compare import differences

J, C = carom.joints, carom.constraints
G = 9.81
TIMES = {"duration": 0.6, "step": 2e-3}


def pull(t, states):
    """A force that does work on the two bodies that it names."""
    return np.array([[0.2 * np.cos(7 * t), 0, 0, 0, 0, 0], [-0.2 * np.cos(7 * t), 0, 0, 0, 0, 0]])


def turn(t):
    """The angle of a crank, and its derivatives."""
    return 3 * t * t, 6 * t, 6.0


def tree(scene, link):
    """A pendulum of two links with a spring, dry friction, a stop, and a torque."""
    upper, lower = link((0.25, 0, 1), 0.5), link((0.75, 0, 1), 0.5)
    first = scene.add_joint(J.Revolute(anchor=(0, 0, 1), axis=(0, 1, 0)), carom.GROUND, upper)
    second = scene.add_joint(J.Revolute(anchor=(0.5, 0, 1), axis=(0, 1, 0)), upper, lower)
    scene.add_force(carom.forces.JointSpring(second, stiffness=0.3, damping=0.01))
    scene.add_force(carom.forces.JointFriction(first, 0.05))
    scene.add_force(carom.forces.Torque((0, 0.1, 0)), lower)
    scene.add_stop(second, upper=1.0, restitution=0.4)


def loop(scene, link):
    """A four-bar of three links that a motor drives, and a spring to the ground."""
    y, up = (0, 1, 0), (np.sqrt(0.5), 0, np.sqrt(0.5), 0)
    crank, coupler = link((0, 0, 1.1), 0.2, up), link((0.3, 0, 1.2), 0.6)
    rocker = link((0.6, 0, 1.1), 0.2, up)
    base = scene.add_joint(J.Revolute(anchor=(0, 0, 1), axis=y), carom.GROUND, crank)
    scene.add_joint(J.Revolute(anchor=(0, 0, 1.2), axis=y), crank, coupler)
    scene.add_joint(J.Revolute(anchor=(0.6, 0, 1.2), axis=y), coupler, rocker)
    scene.add_joint(J.Revolute(anchor=(0.6, 0, 1), axis=y), carom.GROUND, rocker)
    scene.add_constraint(C.Driver(base, motion=turn), name="motor")
    scene.add_force(carom.forces.Spring(5.0, (0.3, 0, 1.5), (0.3, 0, 1.2)), coupler)


def loads(scene, link):
    """Two bodies that a mount and a function hold together; one has a load in its own axes."""
    one, two = link((0, 0, 0.7), 0.3), link((0.4, 0, 0.7), 0.3)
    scene.add_force(carom.forces.Bushing(stiffness=50, damping=0.1), one, two)
    scene.add_force(carom.forces.UserForce((one, two), pull), name="pull")
    scene.add_force(carom.forces.Force((0, 0, 0.5), follow=True), two)


def scene_of(mechanism, between):
    """A mechanism over a floor, three balls that are thrown at it, one that lies afar and one in flight.

    Balls are added before, between and after its bodies where `between`, else after them.
    """
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    places = [(0.1, 0, 1.5), (0.45, 0.01, 1.5), (0.9, 0, 1.4), (5.0, 0, 0.05), (-4.0, 0, 9.0)]

    def ball():
        place = places.pop(0)
        scene.add_body(
            carom.Sphere(0.05), mass=0.3, position=place, name=f"ball at {place[0]}",
            velocity=(0, 0, -3.0 if abs(place[0]) < 1.0 else 0.0),
        )  # fmt: skip

    def link(place, length, orientation=(1, 0, 0, 0)):
        if between and len(places) > 2:
            ball()
        count = len(scene.bodies) - sum(body.name.startswith("ball") for body in scene.bodies)
        return scene.add_body(
            carom.Box(length, 0.04, 0.04), mass=0.5, position=place, orientation=orientation,
            name=f"link{count}",
        )  # fmt: skip

    mechanism(scene, link)
    while places:
        ball()
    scene.set_contact_default(restitution=0.5, friction=0.3)
    for body in scene.bodies:  # links of one mechanism pass each other
        for other in scene.bodies:
            if body.name.startswith("link") and other.name.startswith("link") and body is not other:
                scene.ignore_contact(body, other)
    return scene


def together(monkeypatch):
    """Have all bodies move as one island."""
    monkeypatch.setattr(
        run, "new_islands", lambda system, active, later: no_islands(system, active)
    )


def motion(solution):
    """The motion of all bodies by name."""
    return {
        body.name: np.hstack([solution.position[:, b], solution.velocity[:, b]])
        for b, body in enumerate(solution.scene.bodies)
    }


MECHANISMS = pytest.mark.parametrize("mechanism", [tree, loop, loads])


@pytest.mark.parametrize(
    ("mechanism", "method"),  # the implicit method knows no dry friction in joints
    [(tree, "rk4"), (loop, "rk4"), (loop, "implicit"), (loads, "rk4"), (loads, "implicit")],
)
def test_islands_do_not_change_the_motion(mechanism, method, monkeypatch):
    """Up to round-off, which impacts make larger: the first 0.3 s have some."""
    scene = scene_of(mechanism, True)
    apart = carom.simulate(scene, **TIMES, method=method)
    together(monkeypatch)
    one = carom.simulate(scene, **TIMES, method=method)
    assert apart.status == one.status == carom.Status.SUCCESS
    assert np.sum(apart.impacts.time < 0.3) > 1
    for name in ("position", "velocity", "total_energy"):
        np.testing.assert_allclose(getattr(apart, name)[:150], getattr(one, name)[:150], atol=1e-7)


@MECHANISMS
def test_the_order_of_bodies_does_not_change_the_motion(mechanism):
    """Up to round-off, as above."""
    one, two = (
        motion(carom.simulate(scene_of(mechanism, between), **TIMES)) for between in (True, False)
    )
    for name, path in one.items():
        np.testing.assert_allclose(path[:150], two[name][:150], atol=1e-7, err_msg=name)


@MECHANISMS
def test_bodies_that_are_not_near_do_not_know_of_joints(mechanism):
    """One lies still from the start, another falls by z = 9 - g t^2/2, exactly."""
    solution = carom.simulate(scene_of(mechanism, True), **TIMES)
    path = motion(solution)
    assert np.all(path["ball at 5.0"] == path["ball at 5.0"][0])
    falls = 9.0 - 0.5 * G * solution.t**2
    np.testing.assert_allclose(path["ball at -4.0"][:, 2], falls, atol=2e-14)


@MECHANISMS
def test_a_run_goes_on_where_it_stopped(mechanism, tmp_path):
    """Bit for bit: whole turns and modes of friction are kept, factors are not."""
    path, scene = tmp_path / "run.h5", scene_of(mechanism, True)
    functions = {loop: {"motor.motion": turn}, loads: {"pull.function": pull}}.get(mechanism)
    whole = carom.simulate(scene, **TIMES)

    def stop(done, total):
        if done >= 0.6 * total:
            raise KeyboardInterrupt

    carom.simulate(scene, **TIMES, save=path, progress=stop, throw=False)
    assert differences(whole, carom.resume(path, functions=functions)) == []
