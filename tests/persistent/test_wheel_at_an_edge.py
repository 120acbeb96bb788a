"""A wheel rolls against a kerb parallel to its axis, or off the edge of a table, and turns about the edge."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom

R, M, G = 0.3, 5.0, 9.81
INERTIA = 0.5 * M * R * R
J = INERTIA + M * R * R
WHEELS = {
    "ball": carom.Sphere(R),
    "capsule": carom.Capsule(R, 0.2),
    "cylinder": carom.Cylinder(R, 0.2),
}


def off(wheel, scene, start, v, edge, before, arrives):
    """Return errors of place and spin .2 s after the arrival at an edge.

    There it turns about the edge: J a'' = m g R sin a, a from the vertical; `before` is angle and rate.
    """
    scene.add_body(
        WHEELS[wheel], mass=M, inertia=(INERTIA,) * 3, position=(start, 0, R),
        orientation=carom.euler("x", 90), velocity=(v, 0, 0), angular_velocity=(0, v / R, 0),
    )  # fmt: skip
    scene.set_contact_default(restitution=0, friction=2)
    s = carom.simulate(scene, arrives + 0.2)
    assert not s.warnings
    assert s.stats["whole_steps"] == 0
    a, w = solve_ivp(
        lambda t, y: (y[1], M * G * R / J * np.sin(y[0])), (0, 0.2), before, rtol=1e-12, atol=1e-13
    ).y[:, -1]
    x, z = s.position[-1, 0, [0, 2]] - (edge[0] + R * np.sin(a), edge[1] + R * np.cos(a))
    return x, z, s.angular_velocity[-1, 0, 1] - w


@pytest.mark.few(3)
@pytest.mark.parametrize("wheel", WHEELS)
@pytest.mark.parametrize(("height", "factor"), [(0.06, 0.9), (0.06, 1.1), (0.09, 1.05)])
def test_it_climbs_a_kerb(wheel, height, factor):
    """Angular momentum about the edge stays: w' = v (m (R - h) + I/R)/J; it climbs if J w'^2/2 > m g h."""
    v = factor * np.sqrt(2 * M * G * height / J) * J / (M * (R - height) + INERTIA / R)
    w, far = v * (M * (R - height) + INERTIA / R) / J, np.sqrt(R * R - (R - height) ** 2)
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_static(carom.Box(2, 4, height + 0.5), position=(2, 0, height / 2 - 0.25))
    before = -np.arcsin(far / R), w
    found = off(wheel, scene, 0.5, v, (1, height), before, (0.5 - far) / v)
    np.testing.assert_allclose(found, 0.0, atol=1e-8)


@pytest.mark.few(2)
@pytest.mark.parametrize("wheel", WHEELS)
@pytest.mark.parametrize("v", [0.3, 0.6])
def test_it_rolls_off_a_table(wheel, v):
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_static(carom.Box(2, 4, 1), position=(-1, 0, -0.5))
    found = off(wheel, scene, -0.02, v, (0, 0), (0.0, v / R), 0.02 / v)
    np.testing.assert_allclose(found, 0.0, atol=1e-7)
