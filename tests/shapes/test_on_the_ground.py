"""Cylinders, discs and ellipsoids on a half-space: falling, coming to rest, rolling."""

from typing import Any

import numpy as np
import pytest

import carom
from carom.geometry import quaternion
from carom.scene import Capsule, Cylinder, Disc, Ellipsoid, Scene, Sphere
from verified import agree, verifies

G = 9.81
R = 0.05


def on_ground(
    shape, duration, step, *, normal: Any = (0, 0, 1), restitution=0.3, friction=0.4, **start
):
    scene = Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), normal)
    body = scene.add_body(shape, mass=1.0, **start)
    scene.add_contact(body, ground, restitution=restitution, friction=friction)
    return carom.simulate(scene, duration, step=step)


def gaps(shape, solution):
    """Distances of the body from the plane z = 0 at all saved times."""
    down = quaternion.rotate_back(solution.orientation[:, 0], np.array([0, 0, -1.0]))
    depth = [shape.support(d) @ d for d in down]
    return solution.position[:, 0, 2] - depth


@pytest.mark.parametrize(
    ("length", "tilt", "height"),
    [(0.12, 0.05, 0.06), (0.12, 0.3, R), (0.04, 0.5, 0.02), (0.0, 0.4, 0.0)],
)
def test_dropped_tilted_it_comes_to_rest_flat_or_on_its_side(length, tilt, height):
    # Tilted about y by up to 30 degrees and dropped: rocks, rolls on its rim, and rests exactly.
    shape = Cylinder(R, length) if length else Disc(R)
    turn = quaternion.exp(np.array([0, tilt, 0]))
    s = on_ground(shape, 1.2, 1e-3, position=(0, 0, 0.25), orientation=turn)
    # a cylinder on its side rolls on for ever with what round-off of its impacts has left
    assert np.max(np.abs(s.velocity[-1])) < (1e-6 if height == R else 1e-300)
    assert np.max(np.abs(s.angular_velocity[-1])) < (1e-5 if height == R else 1e-300)
    # a rim that strikes flat may cost more work than a step may take; whole, gaps close to 1e-6 of the size
    assert s.position[-1, 0, 2] == pytest.approx(height, abs=1e-6 * R)
    assert s.contact_force[-1, 0, 0] == pytest.approx(G, abs=1e-6)
    assert np.min(gaps(shape, s)) > -1e-9
    assert np.max(np.abs(s.ledger.residual)) < 1e-6 * s.total_energy[0]
    # all stays in the plane; an impact of the rim that costs too much makes a step of order 1
    assert np.max(np.abs(s.position[:, 0, 1])) < 1e-4 * R


def test_a_puck_that_wobbles_comes_to_rest():
    # Its lowest point runs round the rim, at last faster than a step can follow: then the rim strikes as flat.
    # Order 2 in a motion that fast leaves 2e-5 of the energy.
    shape = Cylinder(R, 0.04)
    turn = quaternion.exp(0.1 * np.array([np.sin(0.2), np.cos(0.2), 0]))
    s = on_ground(shape, 0.6, 1e-3, position=(0, 0, 0.25), orientation=turn)
    assert np.all(s.velocity[-1] == 0.0)
    # a rim that strikes flat may cost more work than a step may take; whole, gaps close to 1e-6 of the size
    assert s.position[-1, 0, 2] == pytest.approx(0.02, abs=1e-6 * R)
    assert np.min(gaps(shape, s)) > -1e-9
    assert np.max(np.abs(s.ledger.residual)) < 1e-4 * s.total_energy[0]


@verifies("Cylinder", r"$a = g \sin\alpha/(1 + J/m r^2)$", "closed form")
@pytest.mark.parametrize(("hollow", "factor"), [(False, 2 / 3), (True, 1 / 2)])
def test_a_cylinder_rolls_down_an_incline(hollow, factor):
    # a = g sin(alpha)/(1 + J/(m r^2)), J/(m r^2) = 1/2 or 1: constant, exact for any step.
    angle = 0.3
    normal = np.array([np.sin(angle), 0, np.cos(angle)])
    down = np.array([np.cos(angle), 0, -np.sin(angle)])
    turn: dict[str, Any] = {"orientation": quaternion.exp(np.array([np.pi / 2, 0, 0]))}
    if hollow:
        turn["inertia"] = np.diag([1.0, 1.0, 1.0]) * R**2
    s = on_ground(
        Cylinder(R, 0.2), 0.5, 0.01, normal=normal, position=R * normal, friction=0.5, **turn
    )
    rate = factor * G * np.sin(angle)
    agree(s.velocity[:, 0] @ down, rate * s.t, atol=1e-9)
    agree(s.position[-1, 0] @ down, 0.5 * rate * 0.25, atol=1e-9)
    assert np.all(s.contact_mode[1:] == 2)
    agree(s.contact_force[-1, 0, 0], G * np.cos(angle), rtol=1e-6)


@verifies("Ellipsoid", "equal axes: moves as a ball", "invariant: two descriptions of one shape")
def test_an_ellipsoid_of_equal_axes_moves_as_a_ball():
    start = {"position": (0, 0, 0.3), "velocity": (1, 0.5, 0), "angular_velocity": (3, -1, 2)}
    one = on_ground(Ellipsoid(0.1, 0.1, 0.1), 0.8, 2e-3, **start)
    two = on_ground(Sphere(0.1), 0.8, 2e-3, **start)
    assert len(one.impacts) == len(two.impacts) >= 5
    assert one.events.kind.tolist() == two.events.kind.tolist()
    agree(one.position, two.position, atol=1e-12)
    agree(one.angular_velocity, two.angular_velocity, atol=1e-11)


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_an_ellipsoid_bounces(friction):
    # Energy only falls, by what the ledger says. Without friction the ground pushes along z: horizontal
    # momentum and the angular momentum about z are kept.
    shape = Ellipsoid(0.1, 0.06, 0.04)
    start = {"position": (0, 0, 0.3), "velocity": (1, 0.5, 0), "angular_velocity": (3, -8, 2)}
    s = on_ground(shape, 0.6, 2e-3, restitution=0.8, friction=friction, **start)
    assert len(s.impacts) >= 2
    assert np.all(s.impacts.energy_change < 0.0)
    assert np.max(np.abs(s.ledger.residual)) < 1e-9 * s.total_energy[0]
    assert np.min(gaps(shape, s)) > -1e-12
    if friction == 0.0:
        np.testing.assert_allclose(s.velocity[:, 0, :2], [(1, 0.5)] * len(s.t), atol=1e-13)
        W = quaternion.rotate_back(s.orientation[:, 0], s.angular_velocity[:, 0])
        L = quaternion.rotate(s.orientation[:, 0], np.diag(shape.inertia(1.0)) * W)
        np.testing.assert_allclose(L[:, 2], L[0, 2], rtol=0, atol=1e-14)


@verifies("Disc", "rolls straight on at a constant speed", "closed form")
def test_a_coin_rolls_upright():
    # v = 1 m/s is far above sqrt(g r/3), where it would fall: straight on, at constant speed, to round-off
    r = 0.0125
    turn = quaternion.exp(np.array([np.pi / 2, 0, 0]))
    s = on_ground(
        Disc(r), 0.4, 2e-3, position=(0, 0, r), orientation=turn, velocity=(1, 0, 0),
        angular_velocity=(0, 1 / r, 0),
    )  # fmt: skip
    agree(s.velocity[:, 0], [(1, 0, 0)] * len(s.t), atol=1e-12)
    agree(s.position[-1, 0, 0], 0.4, atol=1e-12)
    agree(s.position[:, 0, 2], r, atol=1e-12)


def rolling_in_a_circle(step):
    """A thin disc that leans by 30 degrees from upright and rolls in a circle; the error of its path.

    e: the axis, at the angle th from the vertical; d: in the disc, to its lowest point; t = e x d. With the yaw
    rate O and the spin s about the axis (C = m r^2/2, A = C/2) rolling gives v = -r s t, so a = r s O (cos d +
    sin e), horizontal, and the moment r d x m(a + g z) about the centre turns L = C s e - A O sin d:

        (C + m r^2) s O sin - A O^2 sin cos + m g r cos = 0,   s = (O^2 sin/4 - g/r) cos/(3/2 O sin).
    """
    r, th, O = 0.1, np.pi / 3, 6.0
    sin, cos = np.sin(th), np.cos(th)
    s = (O * O * sin / 4 - G / r) * cos / (1.5 * O * sin)
    e, d = np.array([sin, 0, cos]), np.array([cos, 0, -sin])
    run = on_ground(
        Disc(r), 0.2, step, friction=50.0, position=(0, 0, r * sin),
        orientation=quaternion.exp(np.array([0, th, 0])), velocity=-r * s * np.cross(e, d),
        angular_velocity=s * e - O * sin * d,
    )  # fmt: skip
    assert np.all(run.contact_mode[1:] == 2)
    a = r * s * O * (cos * d + sin * e)
    turned = np.cos(O * run.t)[:, None] * a + np.sin(O * run.t)[:, None] * np.cross((0, 0, 1), a)
    exact = run.position[0, 0] + (a - turned) / O**2
    return np.max(np.linalg.norm(run.position[:, 0] - exact, axis=1))


@verifies(
    "Disc",
    r"steady circle: $s = (\tfrac14\Omega^2 \sin\theta - g/r)\cos\theta/(\tfrac32\Omega\sin\theta)$",
    "closed form",
)
def test_a_disc_rolls_in_a_circle_at_order_4():
    # a step of 10 ms would lose 1e-9 of the energy, and is cut
    errors = np.array([rolling_in_a_circle(step) for step in (0.005, 0.0025, 0.00125)])
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), 4.0, rtol=0, atol=0.15)
    agree(errors[-1], 0.0, atol=1e-10)


@pytest.mark.few(8)
@pytest.mark.parametrize("step", [1e-3, 20e-3])
@pytest.mark.parametrize("friction", [0.0, 0.3, 50.0])
@pytest.mark.parametrize(
    ("shape", "spin"),
    [
        (Ellipsoid(0.1, 0.06, 0.03), (20, -30, 25)),
        (Cylinder(R, 0.12), (30, 5, 20)),
        (Cylinder(R, 0.004), (20, 10, 5)),
        (Capsule(0.02, 0.1), (60, 5, 20)),
    ],
)
def test_all_energy_has_a_name_while_it_rolls_and_slips(shape, spin, friction, step):
    # Put down at one point, with a spin of some 40 rad/s: up to 0.8 rad in a step, which is cut by its balance.
    # At one point it may lose 1e-9 of its energy a step, at several 2e-8. Moments are made equal, so that what
    # flies off again is exact for any step.
    turn = quaternion.exp(np.array([0.4, 0.7, 0.1]))
    down = quaternion.rotate_back(turn, np.array([0, 0, -1.0]))
    start: dict[str, Any] = {"orientation": turn, "angular_velocity": spin}
    s = on_ground(
        shape, 0.4, step, position=(0, 0, shape.support(down) @ down), restitution=0.0,
        friction=friction, inertia=0.25 * np.eye(3) * shape.size**2, **start,
    )  # fmt: skip
    assert s.status.name == "SUCCESS"
    assert s.contact_mode.any()
    assert np.max(np.abs(s.ledger.residual)) < 2e-6 * np.max(s.kinetic_energy)
    assert np.min(gaps(shape, s)) > -1e-12


def test_no_impact_of_a_rod_is_missed():
    # It turns six times while it falls, ends sweeping through the ground and out again within a large step.
    # Moments are made equal, so that the flight itself is exact for any step.
    times = []
    for step in (0.05, 1e-3):
        s = on_ground(
            Cylinder(0.02, 0.8), 0.4, step, position=(0, 0, 0.75), angular_velocity=(90, 3, 0),
            inertia=np.eye(3) * 0.05, friction=0.0, restitution=1.0,
        )  # fmt: skip
        times.append(s.impacts.time[0])
    assert times[0] == pytest.approx(times[1], abs=1e-13)


def test_the_scene_may_be_turned_about_the_vertical():
    # The same throw, turned by 1 rad: the same motion, turned (quarters of a rim are fixed in the body).
    Q = quaternion.exp(np.array([0, 0, 1.0]))
    start = {"position": (0, 0, 0.2), "velocity": (0.5, 0, 0), "angular_velocity": (4, 2, 1)}
    tilt = quaternion.exp(np.array([0.9, 0.2, 0]))
    one = on_ground(Cylinder(R, 0.1), 0.35, 2e-3, orientation=tilt, **start)
    turned: dict[str, Any] = {
        name: quaternion.rotate(Q, np.array(v, float)) for name, v in start.items()
    }
    two = on_ground(
        Cylinder(R, 0.1), 0.35, 2e-3, orientation=quaternion.multiply(Q, tilt), **turned
    )
    assert len(one.impacts) >= 2
    np.testing.assert_allclose(
        quaternion.rotate(Q, one.position[:, 0]), two.position[:, 0], rtol=0, atol=1e-8
    )
