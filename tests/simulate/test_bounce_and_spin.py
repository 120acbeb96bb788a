"""Balls that fall with spin: impacts, Zeno bounces, slip and rolling, against closed forms of others.

Numbers of an independent program (events in closed form). A ball of 1 kg, r = 0.1 m, from 1 m: its spin w makes
the point of contact slide; friction stops that at v = (2/7) w r, in the impact if 7/2 mu (1 + e) v_n > w r.
"""

import numpy as np
import pytest

import carom

G = 9.81


def drop(e, mu, spin, radius=0.1, height=1.0):
    """Return a ball that turns about -y, so that friction pushes it to -x."""
    scene = carom.Scene(gravity=(0, 0, -G))
    plane = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(
        carom.Sphere(radius), mass=1.0, position=(0, 0, height), angular_velocity=(0, -spin, 0)
    )
    scene.add_contact(ball, plane, restitution=e, friction=mu)
    return scene


def test_zeno_bounces_without_spin():
    """Times and speeds of the first impacts, and where all of them end."""
    s = carom.simulate(drop(0.5, 0.2, 0.0), 1.5, step=1e-3)
    times = [0.4283529368781193, 0.8567058737562386, 1.0708823421952982, 1.177970576414828]
    speeds = [2.1010711553871753, 1.0505355776935876, 0.5252677888467938, 0.2626338944233969]
    np.testing.assert_allclose(s.impacts.time[:4], times, atol=1e-12)
    np.testing.assert_allclose(s.impacts.relative_velocity_after[:4, 0], speeds, atol=1e-12)
    held = s.contacts.start[0]
    assert held == pytest.approx(1.2850588090386188, abs=1e-3)  # within a step
    assert s.position[-1, 0, 2] == pytest.approx(0.1, abs=1e-15)
    assert np.all(s.velocity[-1] == 0.0)


@pytest.mark.parametrize(
    ("spin", "after", "slip_until", "final"),
    [
        (
            50.0, (-0.8404284621548701, 28.98928844612825), 0.72811999417504,
            (-0.871342861303543, -10 / 7, 100 / 7, 33.21642846741143),
        ),
        (
            10.0, (-0.2857142857142857, 2.8571428571428594), 0.4283529368781194,
            (-0.19189916089196596, -2 / 7, 20 / 7, 6.2025209777008525),
        ),
    ],
)  # fmt: skip
def test_a_plastic_impact_with_spin_then_slip_then_rolling(spin, after, slip_until, final):
    s = carom.simulate(drop(0.0, 0.2, spin), 1.1, step=1e-3)
    hit = s.impacts.time[0]
    assert hit == pytest.approx(0.4283529368781193, abs=1e-12)
    _, _, v, w = s.evaluate(hit)
    np.testing.assert_allclose((v[0, 0], -w[0, 1]), after, rtol=0, atol=1e-12 * spin)
    stuck = s.contacts.start[s.contacts.mode == "sticking"]
    assert stuck[0] == pytest.approx(slip_until, abs=1e-9)
    place, speed, turning, turned = final
    assert s.position[-1, 0, 0] == pytest.approx(place, abs=1e-9)
    assert s.velocity[-1, 0, 0] == pytest.approx(speed, abs=1e-10)
    assert -s.angular_velocity[-1, 0, 1] == pytest.approx(turning, abs=1e-9)
    angle = -2.0 * np.arctan2(s.orientation[-1, 0, 2], s.orientation[-1, 0, 0])
    assert np.sin(0.5 * (angle - turned)) == pytest.approx(0.0, abs=1e-8)


def test_a_ball_that_bounces_to_rolling():
    """r = 0.5, e = 0.9, mu = 0.1, w = 2: all impacts together give it v = (2/7) w r."""
    s = carom.simulate(drop(0.9, 0.1, 2.0, radius=0.5), 8.0, step=2e-3, save_every=100)
    assert s.velocity[-1, 0, 0] == pytest.approx(-0.2857142857142857, abs=1e-12)
    assert -s.angular_velocity[-1, 0, 1] == pytest.approx(0.5714285714285714, abs=1e-12)
    assert s.position[-1, 0, 2] == pytest.approx(0.5, abs=1e-14)
