"""Derivatives of motions with closed forms."""

import numpy as np
import pytest

import carom
from verified import agree, verifies

g, r = 9.81, 0.1


def ball(height=0.4, e=0.7, mu=0.0, velocity=(0, 0, 0), spin=(0, 0, 0), mass=2.0, duration=0.9):
    scene = carom.Scene(gravity=(0, 0, -g))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    body = scene.add_body(
        carom.Sphere(r), mass=mass, position=(0, 0, height + r), velocity=velocity,
        angular_velocity=spin, name="ball",
    )  # fmt: skip
    scene.add_contact(body, floor, restitution=e, friction=mu)
    return carom.simulate(scene, duration, step=1e-2)


@verifies("sensitivities", r"$t_2 = \sqrt{2h/g}\,(1 + 2e)$ and its derivatives", "closed form")
@pytest.mark.plain
def test_a_ball_that_is_dropped():
    # t_1 = sqrt(2 h / g), t_2 = t_1 (1 + 2 e), u_k = -e^(k-1) sqrt(2 g h);
    # at t > t_2: z = e^2 v (t - t_2) - g (t - t_2)^2 / 2, v = sqrt(2 g h)
    h, e, run = 0.4, 0.7, ball(duration=0.8)
    found = carom.sensitivities(
        run, ("ball.position", "ball-floor.restitution", "gravity", "ball.mass")
    )
    z, E, G, M = 2, found.columns["ball-floor.restitution"], 6, found.columns["ball.mass"]
    t1, v = np.sqrt(2 * h / g), np.sqrt(2 * g * h)
    assert len(run.impacts) == 2
    time = found.impact_time
    agree(time[:, z], [t1 / (2 * h), t1 / (2 * h) * (1 + 2 * e)], rtol=1e-11)
    agree(time[:, E], [0, 2 * t1], rtol=1e-11, atol=1e-13)
    # gravity points down: g = -gravity_z
    agree(time[:, G], [t1 / (2 * g), t1 / (2 * g) * (1 + 2 * e)], rtol=1e-11)
    agree(found.velocity_before[:, 0, z], [-g / v, -e * g / v], rtol=1e-11)
    agree(found.velocity_after[:, 0, E], [v, 2 * e * v], rtol=1e-11)
    agree(found.impulse[:, 0, M], [(1 + e) * v, (1 + e) * e * v], rtol=1e-11, atol=0)
    t2, s = t1 * (1 + 2 * e), 0.8 - t1 * (1 + 2 * e)
    up = e**2 * v - g * s
    agree(found.final.velocity[0, 2, E], 2 * e * v + g * 2 * t1, rtol=1e-10)
    agree(found.final.position[0, 2, E], 2 * e * v * s - up * 2 * t1, rtol=1e-10)
    slope = e**2 * g / v * s - up * t2 / (2 * h)
    agree(found.final.position[0, 2, z], slope, rtol=1e-10)
    agree(found.final.position[0, 2, [0, 1, M]], 0.0, atol=1e-12)
    agree(found.final.position[0, :2, :2], np.eye(2), rtol=1e-14)


@verifies("sensitivities", r"$v_x^+ = v_x - \mu (1 + e)\,v$ and its derivatives", "closed form")
def test_a_ball_that_slides_through_its_impact():
    # P_t = mu P_n, P_n = (1 + e) m v: v_x+ = v_x - mu (1 + e) v, w_y+ = 5/2 mu (1 + e) v / r
    h, e, mu = 0.4, 0.7, 0.1
    run = ball(e=e, mu=mu, velocity=(3, 0, 0), duration=0.5)
    found = carom.sensitivities(run, ("ball.velocity", "restitution", "ball-floor.friction"))
    v = np.sqrt(2 * g * h)
    X, E, F = 0, found.columns["restitution"], found.columns["ball-floor.friction"]
    velocity, spin = found.final.velocity[0], found.final.angular_velocity[0]
    agree(velocity[0, [X, E, F]], [1, -mu * v, -(1 + e) * v], rtol=1e-10)
    agree(spin[1, [E, F]], [2.5 * mu * v / r, 2.5 * (1 + e) * v / r], rtol=1e-10)
    # what pushes sideways turns slip: P_y = -mu P_n v_y / v_x
    agree(velocity[1, 1], 1 - mu * (1 + e) * v / 3.0, rtol=1e-10)
    agree(found.impulse[0, 0, F], 0.0, atol=1e-10)
    left = [q for q in found.margins if "slip at the end" in q.what]
    agree(left[0].value, 3 - 3.5 * mu * (1 + e) * v, rtol=1e-11)
    agree(left[0].reach[F], left[0].value / (3.5 * (1 + e) * v), rtol=1e-9)


def test_a_ball_that_sticks_in_its_impact_rolls_off():
    # slip ends: v_x+ = r w_y+ = (v_x + 2/5 r w_y) 5/7, whatever mu and e
    run = ball(mu=0.6, velocity=(1, 0, 0), spin=(0, 4, 0), duration=0.5)
    found = carom.sensitivities(
        run, ("ball.velocity", "ball.angular_velocity", "ball-floor.friction", "restitution")
    )
    row = found.final.velocity[0, 0]
    np.testing.assert_allclose(row[[0, 4]], [5 / 7, 2 * r / 7], rtol=1e-10)
    np.testing.assert_allclose(row[[6, 7]], 0.0, atol=1e-10)


def test_free_flight_turns_as_a_rotation():
    # equal moments: R(t) = exp(t w) R_0, so a change of w along w turns by t, and gravity does not turn
    run = ball(height=9.0, spin=(0, 0, 5), duration=0.5)
    found = carom.sensitivities(run, ("ball.angular_velocity", "ball.orientation", "gravity"))
    np.testing.assert_allclose(found.final.rotation[0, :, 2], [0, 0, 0.5], atol=1e-14)
    c, s = np.cos(2.5), np.sin(2.5)
    np.testing.assert_allclose(found.final.rotation[0, :2, 3:5], [[c, -s], [s, c]], atol=1e-14)
    np.testing.assert_allclose(found.final.rotation[0, :2, 0], [s / 5, (1 - c) / 5], atol=1e-14)
    np.testing.assert_allclose(found.final.position[0, :, 6:], 0.125 * np.eye(3), atol=1e-15)
