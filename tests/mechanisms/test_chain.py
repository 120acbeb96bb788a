"""Chains of rods: joint gap, order 4, energy; and what may not start."""

import numpy as np
import pytest
from mechanism_scenes import chain, matrix, orders, run

import carom
from carom import GROUND, Scene, joints


def gaps(solution, count):
    """Distance of the two anchors of each joint, by this test's own account (rods along body x)."""
    ends = [np.zeros((len(solution.t), 3))]
    out = []
    for k in range(count):
        along = np.array([matrix(q)[:, 0] for q in solution.orientation[:, k]])
        out.append(np.linalg.norm(solution.position[:, k] - 0.5 * along - ends[-1], axis=1))
        ends.append(solution.position[:, k] + 0.5 * along)
    return np.max(out)


# forty links whip about: 6e-4 of the energy in ten seconds
@pytest.mark.parametrize("count", [1, 10, 40])
def test_joints_hold_for_ten_seconds(count):
    s = carom.simulate(chain(count), 10.0, step=0.002, save_every=250)
    assert gaps(s, count) < 1e-12
    assert np.max(s.constraint_errors[1]) < 1e-11
    assert np.max(np.abs(s.position[..., 1])) < 1e-12


@pytest.mark.parametrize("count", [3, 10])
def test_order_four(count):
    fine = run(chain(count), 0.8, 2e-4).position[-1]
    errors = [np.max(np.abs(run(chain(count), 0.8, h).position[-1] - fine)) for h in (4e-3, 2e-3)]
    assert orders(errors)[0] == pytest.approx(4.0, abs=0.2)
    assert errors[-1] < 1e-6


def test_energy_over_ten_seconds():
    # in units of m g N L/2; a chain of ten whips: 1.5e-5 at 2 ms in an independent program
    s = carom.simulate(chain(10), 10.0, step=0.002, save_every=10)
    assert np.max(np.abs(s.ledger.residual)) < 2e-4 * 9.81 * 10 * 5


@pytest.mark.parametrize("method", ["paper"])
def test_papers_method_on_a_chain(method):
    fine = run(chain(3), 0.5, 2e-4).position[-1]
    ends = [run(chain(3), 0.5, h, method=method) for h in (4e-3, 2e-3, 1e-3)]
    errors = [np.max(np.abs(s.position[-1] - fine)) for s in ends]
    np.testing.assert_allclose(orders(errors), 2.0, rtol=0, atol=0.15)
    assert max(np.max(s.constraint_errors[k]) for s in ends for k in (0, 1)) < 1e-11


def rod(**velocity):
    scene = Scene()
    scene.add_body(mass=1.0, inertia=[0.1] * 3, position=(0.5, 0, 0), name="rod", **velocity)
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, scene["rod"], name="elbow")
    return scene


@pytest.mark.parametrize(
    "velocity",
    [
        dict(velocity=(0, 0, 1)),  # moves without turning
        dict(angular_velocity=(0, 1, 0)),  # turns without moving
        dict(angular_velocity=(1, 0, 0)),  # turns about another axis, anchor at rest
        dict(velocity=(1e-5, 0, -0.5), angular_velocity=(0, 1, 0)),
    ],
)
def test_velocity_that_breaks_a_joint_is_refused(velocity):
    with pytest.raises(ValueError, match=r"velocity of 'rod' violates joint 'elbow' \(Revolute\)"):
        carom.simulate(rod(**velocity), 0.1, step=0.01)


def test_velocity_that_fits_is_taken():
    s = run(rod(velocity=(0, 0, -0.5), angular_velocity=(0, 1, 0)), 0.01, 0.01)
    assert s.success


def test_second_joint_is_named():
    scene = chain(3)
    scene.add_body(mass=1.0, inertia=[1, 1, 1], position=(9, 0, 0), velocity=(1, 0, 0), name="ball")
    scene.add_joint(joints.Distance((9, 0, 1), (9, 0, 0)), GROUND, scene["ball"], name="rope")
    assert run(scene, 0.01, 0.01).success  # across the rope
    other = chain(3)
    other.add_body(mass=1.0, inertia=[1, 1, 1], position=(9, 0, 0), velocity=(0, 0, 1), name="ball")
    other.add_joint(joints.Distance((9, 0, 1), (9, 0, 0)), GROUND, other["ball"], name="rope")
    with pytest.raises(ValueError, match="velocity of 'ball' violates joint 'rope'"):
        run(other, 0.01, 0.01)


def test_distance_sees_along_itself_only():
    scene = Scene(gravity=(0, 0, 0))
    ball = scene.add_body(mass=1.0, inertia=[1, 1, 1], position=(1, 0, 0), velocity=(0, 2, 0))
    scene.add_joint(joints.Distance((0, 0, 0), (1, 0, 0)), GROUND, ball)
    s = run(scene, 1.0, 0.01)
    np.testing.assert_allclose(s.position[-1, 0], [np.cos(2), np.sin(2), 0], rtol=0, atol=1e-8)
