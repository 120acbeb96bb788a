"""No impact is missed inside a step, however large the step."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from simulate.scenes import G, on_plane, turn


def skimmer(spin=(0, 40, 0), height=0.1, velocity=(1, 0, 0), gravity=(0, 0, 0), e=0.5, **body):
    """A flat box that turns fast just above the plane."""
    start = {
        "shape": carom.Box(0.2, 0.1, 0.05), "mass": 1, "position": (0, 0, height),
        "velocity": velocity, "angular_velocity": spin,
    }  # fmt: skip
    return on_plane({**start, **body}, gravity=gravity, contact={"restitution": e, "friction": 0.1})


def test_a_vertex_that_dips_and_returns():
    # A cube of edge .1 turns at 40 rad/s, its centre just below the half-diagonal r = .1/sqrt(2).
    # With steps of a quarter turn it stands flat at the end of each, r - .05 above the plane. An
    # edge is r cos(phi) below the centre: it strikes at cos(phi) = 1 - 1e-5, so much before pi/4.
    r, rate = 0.1 / np.sqrt(2), 40.0
    step = np.pi / 2 / rate
    cube = {"shape": carom.Box(0.1, 0.1, 0.1), "height": r * (1 - 1e-5)}
    a = carom.simulate(skimmer(**cube), 4 * step, step=step, throw=False)
    assert a.stats["cuts"] > 0
    first = (np.pi / 4 - np.arccos(1 - 1e-5)) / rate
    assert a.impacts.time[0] == pytest.approx(first, abs=1e-12)


def test_just_clear_is_no_impact():
    # A hair higher the same box turns freely for ever; cuts keep it honest, and end.
    r = np.hypot(0.1, 0.025)
    step = np.pi / 2 / 40.0
    a = carom.simulate(skimmer(height=r * (1 + 1e-6)), 40 * step, step=step)
    assert len(a.impacts) == 0
    assert a.stats["cuts"] > 0
    np.testing.assert_allclose(a.angular_velocity[-1, 0], (0, 40, 0), rtol=0, atol=1e-10)


@pytest.mark.few(2)
@pytest.mark.parametrize("method", ["rk4", "paper"])
@pytest.mark.parametrize("step", [0.5, 0.1, 0.02])
def test_a_fast_box_with_huge_steps(step, method):
    # Up to three turns in a step, falling: the first impacts are where steps of 1e-4 find them. The
    # free flight of a cube is exact, so that is to round-off.
    box = {"shape": carom.Box(0.1, 0.1, 0.1), "orientation": turn((1, 1, 0.3), 0.4)}
    scene = skimmer(spin=(30, -20, 25), height=0.5, gravity=(0, 0, -G), **box)
    exact = carom.simulate(scene, 0.6, step=1e-4, method=method, throw=False)
    a = carom.simulate(scene, 0.6, step=step, method=method, throw=False)
    assert len(a.impacts) > 0
    np.testing.assert_allclose(a.impacts.time[:2], exact.impacts.time[:2], rtol=0, atol=1e-10)
    np.testing.assert_allclose(a.impacts.impulse[:2], exact.impacts.impulse[:2], rtol=0, atol=1e-8)


@pytest.mark.parametrize("step", [0.1, 0.03, 0.01])
def test_a_general_body_with_large_steps(step):
    # General moments, 30 rad/s: time of the first impact converges with order 4 of the attitude.
    scene = skimmer(spin=(30, 5, 10), height=0.3, gravity=(0, 0, -G))
    exact = carom.simulate(scene, 0.25, step=1e-4, throw=False).impacts.time[0]
    a = carom.simulate(scene, 0.25, step=step, throw=False)
    assert a.impacts.time[0] == pytest.approx(exact, abs=3e-3 * (step / 0.01) ** 4 + 1e-6)


@settings(max_examples=20, deadline=None)
@given(
    spin=st.tuples(*[st.floats(-50, 50)] * 3), axis=st.tuples(*[st.floats(-1, 1)] * 3),
    angle=st.floats(0, 3), step=st.sampled_from([0.4, 0.1, 0.03]),
)  # fmt: skip
def test_a_thrown_cube_never_goes_below_the_plane(spin, axis, angle, step):
    # First impact as with steps of 5e-4; no saved state has a corner below z = 0.
    orientation = turn(axis, angle) if np.linalg.norm(axis) > 0.1 else (1, 0, 0, 0)
    box = {"shape": carom.Box(0.1, 0.1, 0.1), "orientation": orientation}
    scene = skimmer(spin=spin, height=0.3, velocity=(0.5, 0, -1), gravity=(0, 0, -G), **box)
    a = carom.simulate(scene, 0.4, step=step, throw=False)
    exact = carom.simulate(scene, 0.4, step=5e-4, throw=False)
    # where two corners strike within 1e-7 s round-off decides which is first
    assert a.impacts.time[0] == pytest.approx(exact.impacts.time[0], abs=1e-9)
    corners = scene.bodies[0].shape.vertices
    for x, q in zip(exact.position[:, 0], exact.orientation[:, 0]):
        w, u = q[0], q[1:]
        turned = corners + 2 * np.cross(u, np.cross(u, corners) + w * corners)
        assert np.min(turned[:, 2] + x[2]) > -1e-12


def test_fast_ball_and_thin_time():
    # 1 km/s towards the plane with a step of 1 s: one bounce at h/v, not a jump through the plane.
    scene = on_plane(
        {
            "shape": carom.Sphere(0.01),
            "mass": 1,
            "position": (0, 0, 300.01),
            "velocity": (0, 0, -1e3),
        },
        gravity=(0, 0, 0),
        contact={"restitution": 1},
    )
    a = carom.simulate(scene, 1.0, step=1.0)
    np.testing.assert_allclose(a.impacts.time, [0.3], rtol=1e-13)
    assert a.position[-1, 0, 2] == pytest.approx(700.01, rel=1e-12)


def test_two_planes():
    # A ball between two parallel planes 1 m apart at 7 m/s, e = 1: 7 blows a second, in turn.
    scene = carom.Scene(gravity=(0, 0, 0))
    low = scene.add_half_space((0, 0, 0), (0, 0, 1))
    high = scene.add_half_space((0, 0, 1.2), (0, 0, -1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 0.6), velocity=(0, 0, -7))
    for plane in (low, high):
        scene.add_contact(ball, plane, restitution=1)
    for step in (1.0, 0.3, 0.01):
        a = carom.simulate(scene, 1.0, step=step)
        np.testing.assert_allclose(a.impacts.time, (np.arange(7) + 0.5) / 7, rtol=0, atol=1e-12)
        np.testing.assert_array_equal(a.impacts.contact, [0, 1, 0, 1, 0, 1, 0])
        assert a.kinetic_energy[-1] == pytest.approx(24.5, rel=1e-13)
