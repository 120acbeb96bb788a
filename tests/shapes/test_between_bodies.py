"""Curved bodies against each other and against boxes: momenta, energy, gaps, rolling."""

import numpy as np
import pytest

import carom
from carom import GROUND, joints
from carom.collision.api import nearest_points
from carom.geometry import quaternion
from carom.scene import Box, Capsule, Compound, Cylinder, Disc, Ellipsoid, Scene, Sphere

G = 9.81
CAN = Cylinder(0.05, 0.12)
DUMBBELL = Compound(
    [(Sphere(0.04), (0, 0, -0.08)), (Sphere(0.04), (0, 0, 0.08)), (Capsule(0.015, 0.16), (0, 0, 0))]
)


def thrown(first, second, q, w, step=5e-3, duration=0.3, **inertia):
    """The first is thrown at the second, without gravity; masses .5 and .8."""
    scene = Scene(gravity=(0, 0, 0))
    a = scene.add_body(
        first, mass=0.5, position=(-0.3, 0.01, 0.02), orientation=q[0], velocity=(2, 0, 0),
        angular_velocity=w[0], **inertia,
    )  # fmt: skip
    b = scene.add_body(second, mass=0.8, orientation=q[1], angular_velocity=w[1], **inertia)
    scene.add_contact(a, b, restitution=0.4, friction=0.3, impact_law="stronge")
    return carom.simulate(scene, duration, step=step)


def turns(seed):
    rng = np.random.default_rng(seed)
    q = rng.normal(size=(2, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True), rng.normal(size=(2, 3)) * 5


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (Capsule(0.04, 0.1), CAN),
        (CAN, Box(0.1, 0.08, 0.12)),
        (Ellipsoid(0.08, 0.05, 0.04), Disc(0.07)),
        (DUMBBELL, CAN),
    ],
)
def test_momenta_are_kept_and_energy_falls(first, second):
    for seed in range(3, 7):
        s = thrown(first, second, *turns(seed))
        assert len(s.impacts) >= 1
        m, J = np.array([0.5, 0.8]), [np.diag(first.inertia(0.5)), np.diag(second.inertia(0.8))]
        p = np.einsum("n,tnk->tk", m, s.velocity)
        np.testing.assert_allclose(p, p[:1].repeat(len(p), 0), rtol=0, atol=1e-13)
        L = np.einsum("n,tnk->tk", m, np.cross(s.position, s.velocity))
        W = quaternion.rotate_back(s.orientation, s.angular_velocity)
        L += np.sum(quaternion.rotate(s.orientation, J * W), axis=1)
        held = s.events.time[s.events.kind == "held"]
        flies = s.t < (held[0] if len(held) else np.inf)  # where they roll on each other: order 2
        np.testing.assert_allclose(L[flies], L[:1].repeat(flies.sum(), 0), rtol=0, atol=1e-13)
        assert np.all(s.impacts.energy_change <= 1e-15)
        assert np.max(np.abs(s.ledger.residual[flies])) < 1e-9 * s.total_energy[0]
        assert np.max(np.abs(s.ledger.residual)) < 1e-3 * s.total_energy[0]
        assert min(distance(s, i, first, second) for i in range(len(s.t))) > -1e-12


def distance(s, i, first, second):
    a, b = ((s.position[i, k], s.orientation[i, k]) for k in range(2))
    return nearest_points(first, a, second, b).gap


@pytest.mark.parametrize(("first", "second"), [(CAN, Ellipsoid(0.08, 0.05, 0.04)), (CAN, CAN)])
def test_no_impact_is_missed(first, second):
    # Fast turns: ends sweep through each other's way within a large step. Equal moments: the flight is exact.
    q, _ = turns(1)
    w = np.array([(40.0, 30, -50), (-20, 60, 10)])
    runs = [thrown(first, second, q, w, step, inertia=np.eye(3) * 2e-3) for step in (0.03, 1e-3)]
    times = [s.impacts.time[0] for s in runs]
    assert times[0] == pytest.approx(times[1], abs=1e-12)


def test_a_cylinder_rolls_down_a_plank():
    # As on a half-space: a = g sin(alpha)/(1 + 1/2).
    angle = 0.3
    normal = np.array([np.sin(angle), 0, np.cos(angle)])
    down = np.array([np.cos(angle), 0, -np.sin(angle)])
    scene = Scene(gravity=(0, 0, -G))
    plank = scene.add_body(
        Box(2, 0.5, 0.1), mass=1.0, position=-0.05 * normal,
        orientation=quaternion.exp(np.array([0, angle, 0])),
    )  # fmt: skip
    scene.add_joint(joints.Fixed((0, 0, 0)), GROUND, plank)
    can = scene.add_body(
        CAN,
        mass=1.0,
        position=0.05 * normal,
        orientation=quaternion.exp(np.array([np.pi / 2, 0, 0])),
    )
    scene.add_contact(can, plank, friction=0.5)
    s = carom.simulate(scene, 0.3, step=0.01)
    rate = G * np.sin(angle) * 2 / 3
    np.testing.assert_allclose(s.velocity[:, 1] @ down, rate * s.t, rtol=0, atol=1e-9)


def test_a_pile_of_flat_things_stands():
    # Box, cylinder, disc: nothing moves, and each contact carries what lies above it.
    scene = Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_body(Box(0.3, 0.3, 0.1), mass=2.0, position=(0, 0, 0.05))
    scene.add_body(CAN, mass=1.0, position=(0.01, 0.02, 0.16))
    scene.add_body(Disc(0.06), mass=0.2, position=(0, 0, 0.22))
    scene.set_contact_default(restitution=0.3, friction=0.4)
    s = carom.simulate(scene, 0.2, step=0.01)
    assert np.all(s.position == s.position[0])
    carried = np.sort(s.contact_force[-1, :, 0])
    np.testing.assert_allclose(carried, [0, 0, 0, 0.2 * G, 1.2 * G, 3.2 * G], rtol=1e-10)
