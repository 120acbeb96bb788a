"""Dry friction in a joint while a stop is closed: closed forms of what it holds, turns and takes."""

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints

G = 9.81


def rod(bound, start, duration):
    """A rod of 1 m and 1 kg on a hinge, `start` rad below the horizontal, with a plastic stop at 1 rad."""
    scene = carom.Scene(gravity=(0, 0, -G))
    body = scene.add_body(
        carom.Box(1, 0.05, 0.05), mass=1,
        position=(0.5 * np.cos(start), 0, -0.5 * np.sin(start)),
        orientation=carom.euler("y", np.degrees(start)),
    )  # fmt: skip
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, body)
    scene.add_stop(hinge, upper=1.0 - start, restitution=0)
    scene.add_force(forces.JointFriction(hinge, bound=bound))
    return carom.simulate(scene, duration)


@pytest.mark.parametrize("bound", [0.5, 2.0, 4.0])
def test_at_rest_on_a_stop_it_does_no_work(bound):
    s = rod(bound, 1.0, 3.0)
    assert not s.warnings
    np.testing.assert_allclose(s.ledger.friction, 0.0, atol=1e-12)
    np.testing.assert_allclose(s.ledger.impacts, 0.0, atol=1e-12)


@pytest.mark.parametrize("bound", [0.5, 2.0])
def test_a_rod_falls_onto_its_stop(bound):
    """Friction takes bound times the angle of 1 rad, the stop the rest of m g L/2 sin 1, and nothing after."""
    s = rod(bound, 0.0, 3.0)
    assert not s.warnings
    np.testing.assert_allclose(s.ledger.friction[-1], -bound, atol=1e-8)
    np.testing.assert_allclose(s.ledger.impacts[-1], bound - 0.5 * G * np.sin(1.0), atol=1e-8)
    assert np.ptp(s.ledger.friction[s.t > 1.5]) < 1e-12


def sliders(friction, rtol, save_at):
    """Two blocks of 1 kg on ways; the second is driven to its stop, the first has springs and dry friction."""
    scene = carom.Scene(gravity=(0, 0, 0))
    box = carom.Box(0.2, 0.1, 0.1)
    a = scene.add_body(box, mass=1.0)
    b = scene.add_body(box, mass=1.0, position=(0.5, 0, 0))
    way, other = (scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, one) for one in (a, b))
    scene.add_force(forces.JointSpring(way, 100.0, rest=0.02))
    scene.add_force(forces.JointForce(other, 20.0))
    scene.add_stop(other, upper=0.001, restitution=0.0)
    scene.add_force(forces.Spring(200.0, (0, 0, 0.05), (0.5, 0, 0.05), 0.5), a, b)
    scene.add_force(forces.JointFriction(way, friction))
    return carom.simulate(scene, 0.5, rtol=rtol, save_at=save_at)


def end_of_slider(friction):
    """Return where the first block is at .5 s.

    While the second moves, x'' = 2 - 300 x + 200 y - F, y'' = 20 + 200 (x - y), in the modes of the stiffness
    [[300, -200], [-200, 200]]. From y = .001 on x'' = 2.2 - 300 x -+ F: an oscillation about
    (2.2 -+ F)/300 from each turn to the next, until friction holds a turn.
    """
    squares, modes = np.linalg.eigh([[300.0, -200.0], [-200.0, 200.0]])
    w, push = np.sqrt(squares), modes.T @ (2.0 - friction, 20.0)

    def before(t):
        q, rate = push / squares * (1 - np.cos(w * t)), push / w * np.sin(w * t)
        return modes @ q, modes @ rate

    low, high = 0.0, 0.02
    for _ in range(100):
        t = 0.5 * (low + high)
        low, high = (t, high) if before(t)[0][1] < 0.001 else (low, t)
    (x, _), (v, _) = before(t)
    left, w, way = 0.5 - t, np.sqrt(300.0), 1.0
    while True:
        c = (2.2 - way * friction) / 300.0
        angle = np.arctan2(v / w, x - c)  # of the phase at which it turns
        angle = angle % np.pi or np.pi
        phase = min(angle, w * left)
        x = c + (x - c) * np.cos(phase) + v / w * np.sin(phase)
        if phase < angle:
            return x
        left, v, force = left - phase / w, 0.0, 2.2 - 300.0 * x
        if abs(force) <= friction:
            return x
        way = np.sign(force)


@pytest.mark.few(3)
@pytest.mark.parametrize("friction", [0.3, 1.0, 1.9])
@pytest.mark.parametrize("save_at", [[0.5], np.linspace(0, 0.5, 51)])
def test_slip_turns_while_a_stop_is_closed(friction, save_at):
    """It stuck at its first turn, where the springs pulled five times as much as friction holds."""
    for rtol in (1e-6, 1e-8):
        s = sliders(friction, rtol, save_at)
        assert not s.warnings
        # 30 times the tolerance for a block of .12 m: each turn adds its error
        assert abs(s.position[-1, 0, 0] - end_of_slider(friction)) < 30.0 * 0.25 * rtol
