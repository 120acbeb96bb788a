"""Contacts that are held: sliding, rolling, sticking, rest, opening. One point each."""

import numpy as np
import pytest

import carom
from simulate.scenes import G, ball, event_times, on_plane
from verified import agree, verifies

OPEN, SLIP, STICK = 0, 1, 2


def slope_ball(angle, mu, *, e=0.0, height=0.0, **body):
    """A ball of radius .1 on (or `height` above) a plane that falls towards +x at `angle`."""
    normal = np.array([np.sin(angle), 0, np.cos(angle)])
    start = {"shape": carom.Sphere(0.1), "mass": 2.0, "position": (0.1 + height) * normal}
    return on_plane({**start, **body}, normal=normal, contact={"restitution": e, "friction": mu})


def down(angle):
    return np.array([np.cos(angle), 0, -np.sin(angle)])


@verifies(
    "simulate", r"slides until $t = 2 v_0/7\mu g$, then rolls with $\tfrac57 v_0$", "closed form"
)
@pytest.mark.few(3)
@pytest.mark.parametrize("method", ["rk4", "paper"])
@pytest.mark.parametrize("step", [0.1, 0.01, 1e-3])
def test_slides_then_rolls(method, step):
    # v = v0 - mu g t, w = (5/2) mu g t / r until v = w r: t = 2 v0/(7 mu g), v = 5/7 v0,
    # x = 12 v0^2/(49 mu g). v0 = 7, mu = .2: t = 1.019367991845, x = 6.11620795. It rolls on.
    v0, mu = 7.0, 0.2
    t_roll, x_roll = 2 * v0 / (7 * mu * G), 12 * v0**2 / (49 * mu * G)
    a = carom.simulate(ball(0.5, mu, height=0, velocity=(v0, 0, 0)), 2.0, step=step, method=method)
    (sticks,) = event_times(a, "sticks")
    agree(sticks, 1.019367991845056, atol=1e-6)
    agree(sticks, t_roll, atol=1e-12)
    x, _, v, w = a.evaluate(sticks)
    agree(x[0, 0], 6.116207951070336, atol=1e-6)
    agree(x_roll, 6.116207951070336, atol=1e-12)
    agree(v[0], (5, 0, 0), atol=1e-9)
    agree(w[0], (0, 50, 0), atol=1e-8)
    late = a.t > sticks
    agree(a.velocity[late, 0], [[5, 0, 0]] * late.sum(), atol=1e-9)
    agree(a.position[-1, 0], (6.116207951070336 + 5 * (2 - t_roll), 0, 0.1), rtol=1e-7)
    np.testing.assert_array_equal(a.contact_mode[late, 0], STICK)
    np.testing.assert_array_equal(a.contact_mode[a.t < sticks, 0], SLIP)
    # forces: (m g, mu m g against the slip) while sliding, no friction while rolling
    slide = a.contact_force[a.t < sticks, 0]
    agree(slide[:, 0], G, rtol=1e-12)
    agree(np.hypot(slide[:, 1], slide[:, 2]), mu * G, rtol=1e-12)
    agree(a.contact_force[late, 0, 1:], 0.0, atol=1e-9)
    # friction takes m v0^2/2 - m (5/7 v0)^2/2 * 7/5 = m v0^2/7
    agree(a.ledger.friction[-1], -(v0**2) / 7, rtol=1e-9)
    agree(a.ledger.residual, 0, atol=1e-10 * a.kinetic_energy[0])


def test_slides_across_with_spin():
    # v = (1, .5, 0), w = (-9, 4, 20): slip u = v + w x r keeps its direction and
    # falls by 7/2 mu g t.
    v0, w0, mu = np.array([1, 0.5, 0.0]), np.array([-9, 4, 20.0]), 0.2
    a = carom.simulate(ball(0.5, mu, height=0, velocity=v0, angular_velocity=w0), 1.0, step=0.01)
    u = v0 + np.cross(w0, (0, 0, -0.1))
    t = np.linalg.norm(u) / (3.5 * mu * G)
    np.testing.assert_allclose(event_times(a, "sticks"), [t], rtol=0, atol=1e-12)
    v = v0 - 2 / 7 * u
    np.testing.assert_allclose(a.velocity[-1, 0], v, rtol=0, atol=1e-9)
    assert a.angular_velocity[-1, 0, 2] == pytest.approx(20, abs=1e-9)  # no drilling friction
    x = v0 * t - 0.5 * mu * G * t**2 * u / np.linalg.norm(u) + v * (1 - t)
    np.testing.assert_allclose(a.position[-1, 0, :2], x[:2], rtol=0, atol=1e-9)


@verifies(
    "Sphere", r"slope: $\tfrac57 g \sin\alpha$, or $g (\sin\alpha - \mu\cos\alpha)$", "closed form"
)
@pytest.mark.few(5)
@pytest.mark.parametrize("angle", [0.1, 0.4, 1.0])
@pytest.mark.parametrize("part", [0.0, 0.5, 0.9, 1.1, 3.0])
def test_ball_on_an_incline(angle, part):
    # mu >= 2/7 tan(angle): rolls with 5/7 g sin, friction 2/7 m g sin; below it slides with
    # g (sin - mu cos) and spins up with 5/2 mu g cos / r. N = m g cos.
    mu = part * 2 / 7 * np.tan(angle)
    a = carom.simulate(slope_ball(angle, mu), 0.5, step=0.01)
    rolls = part > 1
    pull = 5 / 7 * G * np.sin(angle) if rolls else G * (np.sin(angle) - mu * np.cos(angle))
    friction = 2 / 7 * np.sin(angle) if rolls else mu * np.cos(angle)
    t = a.t[:, None]
    start = a.position[0, 0]
    agree(a.position[:, 0], start + 0.5 * pull * t**2 * down(angle), atol=1e-12)
    agree(a.velocity[:, 0], pull * t * down(angle), atol=1e-12)
    spin = 2.5 * friction * G * a.t / 0.1
    agree(a.angular_velocity[:, 0, 1], spin, atol=1e-10)
    agree(a.contact_force[:, 0, 0], 2 * G * np.cos(angle), rtol=1e-12)
    T = np.hypot(a.contact_force[:, 0, 1], a.contact_force[:, 0, 2])
    agree(T, 2 * G * friction, rtol=1e-10, atol=1e-12)
    np.testing.assert_array_equal(a.contact_mode, STICK if rolls else SLIP)
    assert np.max(T - mu * a.contact_force[:, 0, 0]) <= 1e-11


def test_incline_with_friction_that_changes_sign():
    # Thrown up the slope without spin, mu = .5 > 2/7 tan: slides until v = w r, then rolls up and
    # down again with 5/7 g sin.
    angle, mu, v0 = 0.4, 0.5, 3.0
    a = carom.simulate(slope_ball(angle, mu, velocity=-v0 * down(angle)), 2.0, step=0.01)
    # up: v = v0 - g (sin + mu cos) t, w r = 5/2 mu g cos t; equal at t1
    s, c = G * np.sin(angle), G * np.cos(angle)
    t1 = v0 / (s + 3.5 * mu * c)
    np.testing.assert_allclose(event_times(a, "sticks"), [t1], rtol=0, atol=1e-12)
    v1 = v0 - (s + mu * c) * t1
    v = -v1 + 5 / 7 * s * (2 - t1)
    np.testing.assert_allclose(a.velocity[-1, 0], v * down(angle), rtol=0, atol=1e-9)


@pytest.mark.plain
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_a_ball_that_starts_at_rest_stays(e, method):
    # Bitwise, whatever e: nothing approaches, so there is no impact.
    a = carom.simulate(ball(e, 0.3, height=0), 0.2, step=0.02, method=method)
    assert len(a.impacts) == 0
    assert np.all(a.position == a.position[0])
    assert np.all(a.orientation == a.orientation[0])
    assert np.all(a.velocity == 0.0)
    np.testing.assert_allclose(a.contact_force[1:, 0], [[G, 0, 0]] * 10, atol=1e-13)


def test_a_ball_at_rest_far_from_the_origin():
    # Round-off of a gap at coordinates of 1e3 is no gap: held, still.
    scene = on_plane(
        {"shape": carom.Sphere(0.1), "mass": 1, "position": (1e3, -1e3, 77.7 + 0.1)},
        point=(0, 0, 77.7),
        contact={"restitution": 0.5, "friction": 0.3},
    )
    a = carom.simulate(scene, 1.0, step=0.01)
    assert np.ptp(a.position, axis=0).max() < 1e-12
    assert np.all(a.velocity[-1] == 0.0)


def test_superball():
    # e = 1, stick: (v_x, w r) -> (3/7 v_x, -10/7 v_x), (-4/7 w r, -3/7 w r); rolling stays rolling.
    # (No tangential restitution: slip stops and stays zero.) Roles: u_t = v_x - w r = 0 after.
    for vx, w in ((1.0, 0.0), (0.0, 10.0), (1.0, 10.0)):
        scene = ball(1.0, 10.0, velocity=(vx, 0, 0), angular_velocity=(0, w, 0))
        a = carom.simulate(scene, 0.4, step=0.01)
        u = vx - 0.1 * w
        v = vx - 2 / 7 * u
        np.testing.assert_allclose(a.velocity[-1, 0, 0], v, rtol=0, atol=1e-12)
        np.testing.assert_allclose(a.angular_velocity[-1, 0, 1], v / 0.1, rtol=0, atol=1e-11)


def test_sliding_box_face_centre():
    # A box that lands flat, without friction, is carried by four corners and stays flat; N = m g.
    scene = on_plane(
        {
            "shape": carom.Box(0.2, 0.1, 0.06),
            "mass": 1,
            "position": (0, 0, 0.1),
            "velocity": (0.3, 0, 0),
        },
        contact={"restitution": 0.4},
    )
    a = carom.simulate(scene, 1.0, step=0.01)
    np.testing.assert_allclose(a.position[-1, 0], (0.3, 0, 0.03), rtol=0, atol=1e-12)
    np.testing.assert_allclose(a.velocity[-1, 0], (0.3, 0, 0), rtol=0, atol=1e-12)
    assert np.max(np.abs(a.angular_velocity)) < 1e-13
    assert a.contact_force[-1, 0, 0] == pytest.approx(G, rel=1e-12)


@pytest.mark.few(3)
@pytest.mark.parametrize("lift", [5.0, 9.0, 12.0, 20.0])
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_a_force_lifts_a_ball(lift, method):
    # Below m g the ball stays, N = m g - F; above it leaves at once with F/m - g, no impact.
    scene = ball(0.5, 0.3, height=0)
    scene.add_force(carom.forces.Force((0, 0, lift)), scene.bodies[0])
    a = carom.simulate(scene, 0.5, step=0.01, method=method)
    assert len(a.impacts) == 0
    up = max(lift - G, 0)
    np.testing.assert_allclose(a.position[:, 0, 2], 0.1 + 0.5 * up * a.t**2, rtol=0, atol=1e-12)
    if lift < G:
        np.testing.assert_allclose(a.contact_force[1:, 0, 0], G - lift, rtol=1e-12)
    else:
        np.testing.assert_array_equal(a.contact_mode[1:], OPEN)
        np.testing.assert_array_equal(a.contact_force[1:], 0.0)


def test_a_spring_lifts_a_ball_off():
    # A spring of no length at rest, 1 m above: N = m g - k >= 0, or the ball rises from its start at
    # rest by z'' = -g + k (1 - z), with amplitude 1 - g/k.
    for stiffness, opens in ((8.0, False), (12.0, True)):
        scene = ball(0.5, height=0)
        spring = carom.forces.Spring(stiffness, (0, 0, 1.1), (0, 0, 0.1), rest_length=0.0)
        scene.add_force(spring, scene.bodies[0])
        a = carom.simulate(scene, 0.5, step=1e-3)
        if opens:
            w = np.sqrt(stiffness)
            top = 1.0 - G / stiffness  # equilibrium above the start
            z = 0.1 + top * (1 - np.cos(w * a.t))
            np.testing.assert_allclose(a.position[:, 0, 2], z, rtol=0, atol=1e-10)
        else:
            np.testing.assert_allclose(a.contact_force[1:, 0, 0], G - stiffness, rtol=1e-10)
            assert np.all(a.velocity[-1] == 0)


def test_contact_opens_on_the_way():
    # A ball slides outwards without friction below a spring that is fixed 1 m above its path, of length
    # .5 at rest: N = m g - k (1 - .5/d) falls, and is zero at d = .5/(1 - m g/k).
    rest = 0.5
    stiffness = 16.0
    scene = ball(0.0, height=0, velocity=(4.0, 0, 0), position=(0.1, 0, 0.1))
    spring = carom.forces.Spring(stiffness, (0, 0, 1.1), (0.1, 0, 0.1), rest_length=rest)
    scene.add_force(spring, scene.bodies[0])
    a = carom.simulate(scene, 0.4, step=1e-3)
    (opens,) = event_times(a, "opens")
    x = np.sqrt((rest / (1 - G / stiffness)) ** 2 - 1)
    assert a.evaluate(opens)[0][0, 0] == pytest.approx(x, abs=1e-9)
    before = a.contact_force[a.t < opens, 0, 0]
    assert np.all(before > 0)
    assert np.all(np.diff(before) < 0)
    np.testing.assert_allclose(a.ledger.residual, 0, rtol=0, atol=1e-9)


def test_rolling_up_to_the_cone():
    # A constant torque M about y drives a rolling ball with T = 5/7 M/r, while that is at most mu m g.
    mu = 0.3
    limit = 7 / 5 * mu * G * 0.1
    for factor, mode in ((0.9, STICK), (1.1, SLIP)):
        scene = ball(0.0, mu, height=0)
        scene.add_force(carom.forces.Torque((0, factor * limit, 0)), scene.bodies[0])
        a = carom.simulate(scene, 0.5, step=0.01)
        T = 5 / 7 * factor * limit / 0.1 if mode == STICK else mu * G
        np.testing.assert_allclose(a.velocity[:, 0, 0], T * a.t, rtol=0, atol=1e-11)
        np.testing.assert_array_equal(a.contact_mode[1:], mode)
        np.testing.assert_allclose(a.ledger.residual, 0, rtol=0, atol=1e-12)


def test_rolling_gives_way_to_slip():
    # A ball rolls against a spring F = -k x: x = A sin(w t), w^2 = 5k/(7m), friction 2/7 k x. Slip
    # starts at x = 7/2 mu m g/k, against the motion; the time is of order 4 in the step.
    k, mu, v0 = 40.0, 0.1, 2.0
    w = np.sqrt(5 * k / 7)
    start = np.arcsin(3.5 * mu * G / k * w / v0) / w
    errors = []
    for step in (0.012, 0.006):  # turns of less than .3 rad: longer ones are made in parts
        scene = ball(0, mu, height=0, velocity=(v0, 0, 0), angular_velocity=(0, v0 / 0.1, 0))
        spring = carom.forces.Spring(k, (-5, 0, 0.1), (0, 0, 0.1))
        scene.add_force(spring, scene.bodies[0])
        a = carom.simulate(scene, 2.0, step=step)
        errors.append(abs(event_times(a, "slips")[0] - start))
        # far out, where stick would need too much friction, slip turns without a stop
        kinds = [kind for kind in a.events.kind if kind != "sticks"]
        assert kinds[0] == "held"
        assert set(kinds[1:]) == {"slips"}
        assert np.max(np.abs(a.ledger.residual)) < 3e-6 * a.total_energy[0]
        N, T = (
            a.contact_force[:, 0, 0],
            np.hypot(a.contact_force[:, 0, 1], a.contact_force[:, 0, 2]),
        )
        np.testing.assert_allclose(N, G, rtol=1e-12)
        assert np.max(T - mu * N) < 1e-9
    assert errors[0] < 1e-5
    assert errors[0] / errors[1] > 10 or max(errors) < 1e-7  # the end of what the location can do


@pytest.mark.parametrize("push", [0.9, 1.1])
def test_push_at_the_cone(push):
    # A force F on the centre of a ball at rest. Friction of rolling is 2/7 F, so it slips from
    # F = 7/2 mu m g on, with v' = F/m - mu g.
    mu = 0.1
    force = push * 3.5 * mu * G
    scene = ball(0, mu, height=0)
    scene.add_force(carom.forces.Force((force, 0, 0)), scene.bodies[0])
    a = carom.simulate(scene, 0.5, step=0.01)
    rate = 5 / 7 * force if push < 1 else force - mu * G
    np.testing.assert_allclose(a.velocity[:, 0, 0], rate * a.t, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(a.contact_mode[:, 0], STICK if push < 1 else SLIP)
    assert len(a.events.time) == 1
