"""Elastic mounts, and forces that follow their body."""

import numpy as np
import pytest
from mechanism_scenes import orders
from multipliers import applied_force

import carom
from carom import Scene, forces
from verified import agree, verifies


def mounted(**given):
    """A body of unequal moments on a mount off its centre, thrown."""
    scene = Scene(gravity=(0, 0, 0))
    base = scene.add_body(mass=3.0, inertia=[0.3, 0.2, 0.4], angular_velocity=(0.3, 0.2, -0.1))
    body = scene.add_body(
        mass=1.0, inertia=[0.1, 0.2, 0.25], position=(0.5, 0.1, 0), velocity=(0.5, -0.2, 0.4),
        angular_velocity=(1.0, 2.0, -1.5),
    )  # fmt: skip
    mount = forces.Bushing(
        (300.0, 200.0), (6.0, 9.0), axis=(1, 1, 0), anchor=(0.3, 0, 0.1), **given
    )
    scene.add_force(mount, body, base)
    return scene


def test_momentum_and_energy_of_two_bodies_on_a_mount():
    """No force from outside: both momenta stay; without dampers the energy does, at order 4 and better."""
    worst = []
    for step in (4e-3, 2e-3):
        s = carom.simulate(mounted(), 1.0, step=step)
        m = np.array([3.0, 1.0])
        p = np.einsum("n,tnk->tk", m, s.velocity)
        np.testing.assert_allclose(p, np.broadcast_to(p[0], p.shape), atol=1e-13)
        W = carom.geometry.quaternion.rotate_back(s.orientation, s.angular_velocity)
        inertia = np.array([[0.3, 0.2, 0.4], [0.1, 0.2, 0.25]])
        spin = carom.geometry.quaternion.rotate(s.orientation, inertia * W).sum(axis=1)
        spin += np.einsum("n,tnk->tk", m, np.cross(s.position, s.velocity))
        worst.append(
            [np.max(np.abs(spin - spin[0])), np.max(np.abs(s.total_energy - s.total_energy[0]))]
        )
    assert np.all(orders(np.array(worst)) > 3.7)
    turn = np.max(np.linalg.norm(s.angular_velocity, axis=-1))
    assert turn > 1.0  # it does turn
    assert worst[1][1] < 1e-7 * s.total_energy[0]


def test_dampers_take_what_the_ledger_says():
    s = carom.simulate(mounted(damping=3.0, turn_damping=(0.1, 0.2)), 2.0, step=1e-3)
    assert np.all(np.diff(s.ledger.loads) <= 0.0)
    np.testing.assert_allclose(s.ledger.residual, 0.0, atol=1e-8 * s.total_energy[0])
    relative = s.angular_velocity[-1, 0] - s.angular_velocity[-1, 1]
    assert np.linalg.norm(relative) < 0.4 * np.linalg.norm([0.7, 1.8, -1.4])


@verifies("forces.Bushing", r"$\sqrt{k/m}$ along, $\sqrt{k_t/J}$ about its axis", "closed form")
@pytest.mark.plain
def test_frequencies_along_and_about_the_axis():
    """From rest displaced along z by a: a cos(sqrt(k/m) t); turned about z by b: b cos(sqrt(k_t/J) t)."""
    scene = Scene(gravity=(0, 0, 0))
    body = scene.add_body(
        mass=2.0, inertia=[0.3, 0.3, 0.5], velocity=(0, 0, 0.3), angular_velocity=(0, 0, 0.7)
    )
    scene.add_force(forces.Bushing((50.0, 80.0), (8.0, 3.0)), body)
    s = carom.simulate(scene, 0.5, step=5e-3)
    w, v = np.sqrt(50 / 2.0), np.sqrt(8 / 0.5)
    agree(s.position[:, 0, 2], 0.3 / w * np.sin(w * s.t), atol=1e-8)
    turned = 2 * np.arctan2(s.orientation[:, 0, 3], s.orientation[:, 0, 0])
    agree(turned, 0.7 / v * np.sin(v * s.t), atol=1e-8)


def test_wrenches_are_the_slope_of_the_energy():
    """Of large turns too: F . u + T . w = -dU/dt along a motion, and the kernel is as NumPy."""
    s = carom.simulate(mounted(), 0.6, step=1e-3)
    system = s._run.compiled.system
    rows = s._run.records.state[: len(s.t)]
    state = [np.array(a) for a in (rows.x, rows.Q, rows.v, rows.w)]
    f = applied_force(system, *state)
    W = carom.geometry.quaternion.rotate_back(state[1], state[3])
    power = np.einsum("tnk,tnk->t", f, np.concatenate([state[2], W], axis=-1))
    slope = np.gradient(s.potential_energy, s.t, edge_order=2)
    np.testing.assert_allclose(power[2:-2], -slope[2:-2], atol=5e-4 * np.max(np.abs(slope)))


@verifies(
    "forces.Force",
    r"turns with its body: $v = \frac{F}{m\omega}(\sin\omega t, 1 - \cos\omega t)$",
    "closed form",
)
def test_a_thruster_turns_with_its_body():
    """A force F that turns with a body at w: v = F/(m w) (sin wt, 1 - cos wt)."""
    scene = Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=2.0, inertia=[1, 1, 1], angular_velocity=(0, 0, 3.0))
    scene.add_force(forces.Force((4.0, 0, 0), follow=True), body)
    s = carom.simulate(scene, 1.0, step=0.01)
    exact = 4.0 / 2.0 / 3.0 * np.stack([np.sin(3 * s.t), 1 - np.cos(3 * s.t), 0 * s.t], axis=1)
    agree(s.velocity[:, 0], exact, atol=1e-8)
    agree(s.ledger.residual, 0.0, atol=1e-7)


def test_a_torque_that_follows_keeps_angular_momentum():
    """Between two bodies: opposite on the other, whichever way it points."""
    scene = Scene(gravity=(0, 0, 0))
    a = scene.add_body(mass=1.0, inertia=[0.2, 0.2, 0.2], position=(0, 1, 0))
    b = scene.add_body(mass=1.0, inertia=[0.1, 0.1, 0.1], angular_velocity=(2.0, 0, 0))
    scene.add_force(forces.Torque((0, 0.3, 0), follow=True), a, b)
    s = carom.simulate(scene, 1.0, step=0.01)
    spin = 0.2 * s.angular_velocity[:, 0] + 0.1 * s.angular_velocity[:, 1]
    np.testing.assert_allclose(spin, np.broadcast_to(spin[0], spin.shape), atol=1e-12)
    assert abs(s.angular_velocity[-1, 1, 2]) > 0.5


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"stiffness": -1.0}, r"stiffness must be at least 0, got -1.0"),
        ({"stiffness": (1.0, 2.0, 3.0)}, r"stiffness must have shape \(2,\)"),
        ({"stiffness": 1.0, "axis": (0, 0, 0)}, "axis"),
    ],
)
def test_bad_mounts(given, message):
    with pytest.raises(ValueError, match=message):
        forces.Bushing(**given)


def test_bad_follow():
    with pytest.raises(ValueError, match="follow must be True or False, got 1"):
        forces.Force((1, 0, 0), follow=1)
