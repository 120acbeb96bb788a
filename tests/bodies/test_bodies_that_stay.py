"""Bodies held to each other: stacks, blocks that slide on blocks, a ball that leaves a ball."""

import numpy as np
import pytest

import carom
from carom import Scene, joints

G = 9.81


@pytest.mark.parametrize("n", [2, 5])
def test_a_stack_stands(n):
    # Bitwise, and each contact carries what lies above it.
    scene = Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for i in range(n):
        scene.add_body(carom.Box(0.1, 0.12, 0.1), mass=1.0, position=(0, 0, 0.05 + 0.1 * i))
    scene.set_contact_default(restitution=0.5, friction=0.3)
    s = carom.simulate(scene, 1.0, step=0.01)
    assert np.all(s.position == s.position[0])
    assert np.all(s.velocity == 0.0)
    carried = np.sort(s.contact_force[-1, :, 0])[::-1][:n]
    np.testing.assert_allclose(carried, G * np.arange(n, 0, -1), rtol=1e-10)


@pytest.mark.parametrize("step", [0.01, 0.002])
def test_a_block_slides_to_rest_on_a_block(step):
    # Ground without friction: the upper is slowed by mu g, the lower driven by mu g m1/m2, until both go with
    # m1 v0/(m1 + m2), at t = v0/(mu g (1 + m1/m2)). All constant: exact for any step.
    m1, m2, mu, v0 = 1.0, 2.0, 0.3, 0.6
    scene = Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    lower = scene.add_body(carom.Box(1.0, 0.5, 0.1), mass=m2, position=(0, 0, 0.05))
    upper = scene.add_body(
        carom.Box(0.1, 0.1, 0.04), mass=m1, position=(0, 0, 0.12), velocity=(v0, 0, 0)
    )
    scene.add_contact(lower, ground, restitution=0.2)
    scene.add_contact(upper, lower, restitution=0.2, friction=mu)
    s = carom.simulate(scene, 0.3, step=step)
    stop = v0 / (mu * G * (1 + m1 / m2))
    assert stop < 0.25
    both = m1 * v0 / (m1 + m2)
    np.testing.assert_allclose(s.velocity[-1, :, 0], both, rtol=0, atol=1e-10)
    x = v0 * stop - 0.5 * mu * G * stop**2 + both * (0.3 - stop)
    assert s.position[-1, 1, 0] == pytest.approx(x, abs=1e-9)
    assert np.max(np.abs(s.position[:, 1, 2] - 0.12)) < 1e-12
    loss = -0.5 * m1 * m2 / (m1 + m2) * v0**2
    assert s.ledger.friction[-1] == pytest.approx(loss, rel=1e-8)
    assert np.max(np.abs(s.ledger.residual)) < 1e-10


def leaving(step):
    """A small ball slides without friction from angle .1 on a ball that is fixed."""
    scene = Scene(gravity=(0, 0, -G))
    big = scene.add_body(carom.Sphere(0.9), mass=1.0)
    at = np.array([np.sin(0.1), 0, np.cos(0.1)])
    small = scene.add_body(carom.Sphere(0.1), mass=1.0, position=at)
    scene.add_joint(joints.Fixed((0, 0, 0)), carom.GROUND, big)
    scene.add_contact(small, big, restitution=0.0)
    as_they_are = carom.Options(energy_tolerance=1.0)  # steps are not cut for what they lose
    return carom.simulate(scene, 1.0, step=step, options=as_they_are)


def test_a_ball_leaves_a_ball():
    # cos th = 2/3 cos .1: th = .8455282018568607, at t = .9071101110440 (R = 1). Order 4.
    errors = []
    for step in (0.02, 0.01, 0.005):
        s = leaving(step)
        (opens,) = s.events.time[s.events.kind == "opens"]
        errors.append(abs(opens - 0.9071101110440))
        x = s.evaluate(opens)[0][1]
        assert abs(np.arctan2(x[0], x[2]) - 0.8455282018568607) < 0.3 * step**2
        assert np.max(np.linalg.norm(s.position[s.t < opens, 1], axis=1)) < 1.0 + 1e-9
    assert errors[0] < 1e-5
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 4.0, rtol=0, atol=0.2)
