"""Rolling and pivoting friction of a ball: closed forms of deceleration, stop and rest."""

import numpy as np
import pytest

import carom
from verified import agree, verifies

G, R = 9.81, 0.1


def ball(rolling, pivoting, *, mu=0.5, angle=0.0, duration=1.0, step=0.01, **motion):
    """A ball of radius .1 and 2 kg on a plane that falls towards +x."""
    normal = np.array([np.sin(angle), 0, np.cos(angle)])
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), normal)
    body = scene.add_body(carom.Sphere(R), mass=2.0, position=R * normal, **motion)
    scene.add_contact(
        body, ground, restitution=0.5, friction=mu, rolling_friction=rolling,
        pivoting_friction=pivoting,
    )  # fmt: skip
    return carom.simulate(scene, duration, step=step)


@verifies("add_contact(rolling_friction=)", r"$\dot v = -\tfrac57 g d/r$, then rest", "closed form")
@pytest.mark.parametrize("step", [0.1, 0.01, 1e-3])
def test_rolls_to_a_stop(step):
    # J w' = r T - d N, m v' = -T, v = r w: v' = -d g / (7/5 r). Stops after v0^2/(2 a), for good.
    d, v0 = 0.002, 0.2
    a = d * G / (1.4 * R)
    s = ball(d, 0.0, velocity=(v0, 0, 0), angular_velocity=(0, v0 / R, 0), duration=2.0, step=step)
    v = np.maximum(v0 - a * s.t, 0.0)
    agree(s.velocity[:, 0, 0], v, atol=2e-14)
    agree(s.angular_velocity[:, 0, 1], v / R, atol=2e-13)
    way = np.where(v > 0, v0 * s.t - 0.5 * a * s.t**2, v0**2 / (2 * a))
    agree(s.position[:, 0, 0], way, atol=1e-14)
    late = s.t > v0 / a + step
    assert np.all(s.velocity[late] == 0.0)
    assert np.all(s.angular_velocity[late] == 0.0)
    assert np.all(s.position[late] == s.position[-1])
    # friction takes all of it, 7/10 m v0^2
    agree(s.ledger.friction[-1], -0.7 * 2 * v0**2, rtol=1e-12)


@verifies("add_static", "the same on the top of a box", "closed form")
@pytest.mark.few(2)
@pytest.mark.parametrize("shape", [carom.Sphere(R), carom.Capsule(R, 0.2), carom.Cylinder(R, 0.2)])
@pytest.mark.parametrize("friction", [1e-3, 5e-3])
def test_rolls_on_a_static_box(shape, friction):
    # The same on the top of a box: m a (1 + J/(m r^2)) = d N/r, in as many steps as on a half-space.
    v0, duration, steps = 3.0, 2.0, []
    for static in (False, True):
        scene = carom.Scene(gravity=(0, 0, -G))
        if static:
            floor = scene.add_static(carom.Box(60, 60, 1), position=(20, 0, -0.5))
        else:
            floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
        body = scene.add_body(
            shape, mass=1, position=(0, 0, R), orientation=carom.euler("x", 90),
            velocity=(v0, 0, 0), angular_velocity=(0, v0 / R, 0),
        )  # fmt: skip
        scene.add_contact(
            body, floor, restitution=0.3, friction=0.4, rolling_friction=friction
        )  # fmt: skip
        inertia = np.asarray(body.inertia)[2]
        a = friction * G / R / (1 + np.max(inertia) / R**2)
        s = carom.simulate(scene, duration)
        way = v0 * duration - 0.5 * a * duration**2
        agree(s.position[-1, 0, 0], way, atol=1e-11)
        steps.append(s.stats["trial_steps"])
    assert steps[1] <= 1.1 * steps[0]


@verifies("add_contact(pivoting_friction=)", r"$\tfrac25 m r^2 \dot\omega = -d m g$", "closed form")
@pytest.mark.parametrize("step", [0.1, 0.01])
def test_spins_to_a_stop(step):
    # 2/5 m r^2 w' = -d m g, on the spot.
    d, w0 = 0.002, 5.0
    a = 2.5 * d * G / R**2
    s = ball(0.0, d, angular_velocity=(0, 0, w0), duration=1.5, step=step)
    agree(s.angular_velocity[:, 0, 2], np.maximum(w0 - a * s.t, 0.0), atol=1e-13)
    agree(s.position[:, 0], [(0, 0, R)] * len(s.t), atol=1e-15)
    assert np.all(s.angular_velocity[s.t > w0 / a + step] == 0.0)


def test_slides_rolls_and_spins():
    # It slides with v' = -mu g and r w' = 5/2 (mu - d/r) g until v = r w, then rolls as above. Meanwhile its
    # spin about the normal falls at its own rate.
    mu, d, v0, w0 = 0.5, 0.002, 1.0, 3.0
    s = ball(d, d, mu=mu, velocity=(v0, 0, 0), angular_velocity=(0, 0, w0), duration=8.0)
    t1 = v0 / (mu * G + 2.5 * (mu - d / R) * G)
    assert s.events.time[s.events.kind == "sticks"] == pytest.approx([t1], abs=1e-13)
    v1, a = v0 - mu * G * t1, d * G / (1.4 * R)
    way = v0 * t1 - 0.5 * mu * G * t1**2 + v1**2 / (2 * a)
    np.testing.assert_allclose(s.position[-1, 0], (way, 0, R), rtol=0, atol=1e-12)
    spin = np.maximum(w0 - 2.5 * d * G / R**2 * s.t, 0.0)
    np.testing.assert_allclose(s.angular_velocity[:, 0, 2], spin, rtol=0, atol=1e-12)
    assert np.all(s.angular_velocity[-1] == 0.0)
    np.testing.assert_allclose(s.ledger.residual, 0, rtol=0, atol=1e-13)


@pytest.mark.parametrize("part", [0.5, 0.999, 1.001, 2.0])
def test_ball_on_an_incline(part):
    # It stays where d > r tan(angle), bitwise; else v' = 5/7 g (sin - d/r cos).
    angle = 0.1
    d = part * R * np.tan(angle)
    s = ball(d, 0.0, angle=angle)
    if part > 1:
        assert np.all(s.position == s.position[0])
        assert np.all(s.velocity == 0.0)
    else:
        v = 5 / 7 * G * (np.sin(angle) - d / R * np.cos(angle)) * s.t
        np.testing.assert_allclose(np.linalg.norm(s.velocity[:, 0], axis=1), v, rtol=0, atol=1e-13)


def test_rolls_in_a_curve_of_its_spin():
    # Pivoting friction does not turn the way, rolling friction acts along it: both straight on.
    s = ball(0.001, 0.003, velocity=(0.3, 0.4, 0), angular_velocity=(-4, 3, -20), duration=1.0)
    np.testing.assert_allclose(s.position[:, 0, 1], 4 / 3 * s.position[:, 0, 0], rtol=0, atol=1e-13)
    speed = 0.5 - 0.001 * G / (1.4 * R) * s.t
    np.testing.assert_allclose(np.linalg.norm(s.velocity[:, 0], axis=1), speed, rtol=0, atol=1e-13)


@pytest.mark.parametrize("step", [0.02, 0.004])
def test_a_ball_that_spins_on_a_box(step):
    # The box lies on ice: pivoting friction takes both to one spin, J1 w0/(J1 + J2), at the rate
    # d m g (1/J1 + 1/J2); the moment of momentum about the normal stays.
    d, w0, m = 0.01, 20.0, 2.0
    J1, J2 = 0.4 * m * R**2, 1.0 * (0.4**2 + 0.4**2) / 12
    scene = carom.Scene(gravity=(0, 0, -G))
    ice = scene.add_half_space((0, 0, 0), (0, 0, 1))
    box = scene.add_body(carom.Box(0.4, 0.4, 0.2), mass=1.0, position=(0, 0, 0.1))
    top = scene.add_body(
        carom.Sphere(R), mass=m, position=(0, 0, 0.2 + R), angular_velocity=(0, 0, w0)
    )
    scene.add_contact(box, ice, restitution=0.0, friction=0.0)
    scene.add_contact(top, box, restitution=0.0, friction=0.5, pivoting_friction=d)
    s = carom.simulate(scene, 0.8, step=step)
    relative = s.angular_velocity[:, 1, 2] - s.angular_velocity[:, 0, 2]
    rate = d * m * G * (1 / J1 + 1 / J2)
    np.testing.assert_allclose(relative, np.maximum(w0 - rate * s.t, 0), rtol=0, atol=1e-9)
    momentum = J1 * s.angular_velocity[:, 1, 2] + J2 * s.angular_velocity[:, 0, 2]
    np.testing.assert_allclose(momentum, J1 * w0, rtol=1e-12)
    assert s.t[-1] > w0 / rate


def spun_coin(rolling=1e-4, **how):
    """A coin that is spun on its rim, with rolling and pivoting friction."""
    scene = carom.Scene(gravity=(0, 0, -G))
    table = scene.add_half_space((0, 0, 0), (0, 0, 1))
    coin = scene.add_body(
        carom.Cylinder(0.0125, 0.002), mass=0.0075, position=(0, 0, 0.0126373),
        orientation=carom.euler("x", 95.729578), angular_velocity=(0, 0, 30),
    )  # fmt: skip
    scene.add_contact(
        coin, table, restitution=0.3, friction=0.4, rolling_friction=rolling,
        pivoting_friction=1e-4,
    )  # fmt: skip
    return carom.simulate(scene, **how)


@pytest.mark.parametrize("how", [{}, {"step": 1e-3}, {"step": 1e-4}])
def test_a_point_that_sticks_does_not_slip_in_turns(how):
    # It rolls far inside its cone; slip of 1e-10 m/s that a step had left was called slip, and friction at its
    # bound followed: 2500 events in .3 s.
    s = spun_coin(duration=0.3, **how)
    assert s.success
    assert np.sum(s.events.kind == "slips") == 0
    assert s.stats["held_steps"] < 4000


@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")  # that names its time-stepping step
def test_a_coin_lies_down_flat():
    # A rim that is nearly flat strikes as a flat one; its points were up to 5 micrometres above the table then.
    s = spun_coin(5e-4, duration=1.5)
    assert s.success
    # to round-off, but for steps of order 1 in which it may come to rest
    assert s.position[-1, 0, 2] == pytest.approx(0.001, abs=1e-6)
    assert np.all(s.velocity[-1] == 0.0)
    assert np.max(np.abs(s.ledger.residual)) < 1e-5 * s.total_energy[0]


def test_pivoting_friction_holds_beside_others_that_stick():
    """A box slips over a plate that sticks to its floor; a torque below pivoting friction turns nothing.

    Two points of two bodies that stick keep these from turning on each other, but not others of their group.
    The point where the box presses is ahead, in line with the force, so that slip has no moment about the
    vertical through its centre: v = v0 - mu g t, w_z = 0.
    """
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_body(carom.Box(1, 1, 0.1), mass=10.0, position=(0, 0, 0.05), name="plate")
    box = scene.add_body(
        carom.Box(0.1, 0.1, 0.04), mass=0.5, position=(-0.2, 0, 0.12), velocity=(1, 0, 0),
        name="box",
    )  # fmt: skip
    scene.add_force(carom.forces.Torque((0, 0, 0.6 * 2e-3 * 0.5 * G)), box)
    scene.set_contact_default(friction=0.3, restitution=0.0, pivoting_friction=2e-3)
    s = carom.simulate(scene, 0.2)
    assert np.max(np.abs(s["box"].angular_velocity)) < 1e-13
    agree(s["box"].velocity[:, 0], 1.0 - 0.3 * G * s.t, atol=1e-13)
    assert s.stats["trial_steps"] < 400
    assert s.stats["whole_steps"] == 0


def test_points_found_on_a_static_body_have_room_for_what_turns():
    # Each point may have an entry of rolling and one of pivoting friction; some had no room before.
    scene = carom.Scene()
    slab = scene.add_static(carom.Box(2, 2, 0.2), position=(0, 0, -0.1))
    rng = np.random.default_rng(5)
    corners = rng.normal(size=(9, 2))
    corners *= 0.1 / np.linalg.norm(corners, axis=1)[:, None]
    prism = carom.Convex([(x, y, z) for z in (-0.02, 0.02) for x, y in corners])
    low = float(prism.support(np.array((0.0, 0.0, -1.0)))[2])
    body = scene.add_body(prism, mass=1.0, position=(0, 0, -low), velocity=(0.5, 0.2, 0))
    scene.add_contact(body, slab, friction=0.3, rolling_friction=1e-3, pivoting_friction=1e-3)
    s = carom.simulate(scene, 0.5)
    assert s.stats["whole_steps"] == 0
    assert len(s.warnings) == 0
    assert len(s._run.group.closed) >= 3 * 8  # eight points, each with what rolls and what turns
