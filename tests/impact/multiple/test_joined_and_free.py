"""An impact of points of joined bodies and of free ones: W of a group that has both."""

import numpy as np
import pytest

import carom

R = 0.05


def column(law):
    """Two balls on the ground that a joint holds, a free one on the first, and one that falls on that."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    first = scene.add_body(carom.Sphere(R), mass=1.0, position=(0, 0, R))
    second = scene.add_body(carom.Sphere(R), mass=0.7, position=(0.12, 0, R))
    scene.add_joint(carom.joints.Spherical(anchor=(0.06, 0, R)), first, second)
    scene.add_body(carom.Sphere(R), mass=0.5, position=(0, 0, 3 * R))
    scene.add_body(carom.Sphere(R), mass=0.8, position=(0.02, 0, 5 * R + 0.01), velocity=(0, 0, -1))
    scene.set_contact_default(restitution=0.3, friction=0.4, impact_law=law)
    return scene


@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
def test_impulses_move_bodies_as_their_inverse_mass_says(law):
    """What impacts lose by their impulses and velocities, W, is what bodies lose, to 1e-9 of it.

    Free pairs were given what the last joined body had done to others: parts of the energy came from nowhere.
    """
    solution = carom.simulate(column(law), 0.05)  # steps of 1 ms are off by up to 1e-6 themselves
    assert solution.status is carom.Status.SUCCESS
    assert np.max(solution.impacts.together) >= 4
    lost = -solution.ledger.impacts[-1]
    assert lost > 0.1
    assert np.max(np.abs(solution.ledger.residual)) < 1e-9 * lost


def test_a_group_with_joined_bodies_does_not_rest_in_part():
    """Two joined balls fall on two columns: what lies below them bears them, and nothing sinks into anything.

    Points between free bodies rested by themselves; then the group was not stepped, and fell.
    """
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for x in (0.0, 0.3):
        for k in range(3):
            scene.add_body(carom.Sphere(R), mass=0.2, position=(x, 0, (2 * k + 1) * R))
    top = [
        scene.add_body(carom.Sphere(R), mass=0.3, position=(x, 0, 7 * R + 0.1)) for x in (0, 0.3)
    ]
    scene.add_joint(carom.joints.Spherical(anchor=(0.15, 0, 7 * R + 0.1)), *top)
    scene.set_contact_default(restitution=0.0, friction=0.5)
    solution = carom.simulate(scene, 0.3, step=5e-3)
    assert solution.status is carom.Status.SUCCESS
    height = np.array([1, 3, 5, 1, 3, 5, 7, 7]) * R
    np.testing.assert_allclose(solution.position[-1][:, 2], height, atol=1e-9)
