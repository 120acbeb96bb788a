"""Friction of impacts and of persistent contacts apart; boxes with rounded edges, in motion."""

import numpy as np
import pytest

import carom
from carom.geometry import quaternion
from simulate.scenes import G
from verified import agree, verifies


def thrown(shape, contact, **body):
    scene = carom.Scene(gravity=(0, 0, -G))
    plane = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    scene.add_contact(scene.add_body(shape, mass=1.5, **body), plane, **contact)
    return scene


@verifies(
    "add_contact(friction_held=)",
    r"slides $v^2/2\mu g$ by the friction of persistent contact",
    "closed form",
)
@pytest.mark.parametrize("radius", [0.0, 0.01])
def test_a_block_slides_by_the_friction_of_held_contacts(radius):
    # stops after v0^2/(2 mu g), at t = v0/(mu g) = 0.51 s
    mu, v0 = 0.2, 1.0
    box = carom.Box(0.2, 0.2, 0.1, radius=radius)
    contact = {"restitution": 0.0, "friction": 0.9, "friction_held": mu}
    scene = thrown(box, contact, position=(0, 0, 0.05), velocity=(v0, 0, 0))
    a = carom.simulate(scene, 0.7, step=0.01)
    agree(a.position[-1, 0, 0], v0**2 / (2 * mu * G), atol=1e-9)
    assert np.all(a.velocity[-1] == 0.0)
    agree(a.position[:, 0, 2], 0.05, atol=1e-14)


def test_an_impact_has_the_friction_of_impacts():
    # a ball that slips throughout the impact: P_t = mu P_n = mu m (1 + e) |u_n|
    mu, e, v, u = 0.15, 0.4, 3.0, -1.0
    contact = {"restitution": e, "friction": mu, "friction_held": 0.8}
    scene = thrown(carom.Sphere(0.1), contact, position=(0, 0, 0.11), velocity=(v, 0, u))
    a = carom.simulate(scene, 0.05, step=0.01)
    (impact,) = a.impacts
    assert impact.friction == mu
    assert -impact.impulse[1] / impact.impulse[0] == pytest.approx(mu, rel=1e-12)


@pytest.mark.parametrize("radius", [0.0, 0.004, 0.05])
def test_a_rounded_corner_strikes_when_it_reaches_the_plane(radius):
    # lowest point: centre - sum_i |R_zi| (half - r) - r; falls freely until then
    half, height = 0.05, 0.2
    q = quaternion.normalize(np.array([0.8, 0.3, -0.4, 0.2]))
    low = np.sum(np.abs(quaternion.matrix(q)[2])) * (half - radius) + radius
    box = carom.Box(2 * half, 2 * half, 2 * half, radius=radius)
    contact = {"restitution": 0.3, "friction": 0.2}
    a = carom.simulate(
        thrown(box, contact, position=(0, 0, height), orientation=q), 0.25, step=0.01
    )
    assert a.impacts.time[0] == pytest.approx(np.sqrt(2 * (height - low) / G), abs=1e-12)
    assert np.max(np.abs(a.ledger.residual)) < 1e-12


def test_a_rounded_box_comes_to_rest_on_a_face():
    half = 0.05
    box = carom.Box(2 * half, 2 * half, 2 * half, radius=0.005)
    contact = {"restitution": 0.3, "friction": 0.17, "friction_held": 0.23}
    scene = thrown(
        box, contact, position=(0, 0, 0.2), orientation=quaternion.exp([0.5, 0.9, -0.2]),
        velocity=(0.5, 0, 0), angular_velocity=(1, 7, -2),
    )  # fmt: skip
    a = carom.simulate(scene, 3.0, step=0.002)
    assert np.all(a.velocity[-1] == 0.0)
    assert np.all(a.angular_velocity[-1] == 0.0)
    assert a.position[-1, 0, 2] == pytest.approx(half, abs=1e-14)
    up = np.abs(quaternion.matrix(a.orientation[-1, 0])[2])
    assert np.max(up) == pytest.approx(1.0, abs=1e-14)
