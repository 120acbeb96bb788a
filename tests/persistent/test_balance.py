"""Held steps that are cut: for what they lose without a name, and for contacts that are not solved."""

import numpy as np
import pytest

import carom
from carom.scene import Box, Scene


def two_boxes(seed):
    """Two boxes that fly at each other, spinning, where nothing weighs."""
    draw = np.random.default_rng(seed)
    scene, bodies = Scene(gravity=(0, 0, 0)), []
    for k in range(2):
        q = draw.normal(size=4)
        y, z = draw.uniform(-0.03, 0.03, 2)
        bodies.append(
            scene.add_body(
                Box(0.1, 0.08, 0.06), mass=0.5, position=(0.3 * k, y, z), velocity=(-k, 0, 0),
                orientation=q / np.linalg.norm(q), angular_velocity=3.0 * draw.normal(size=3),
            )
        )  # fmt: skip
    scene.add_contact(*bodies, restitution=0.2, friction=0.4)
    return scene


# where slip ends in a step of 5 ms friction may give 1e-3 of the energy
@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
@pytest.mark.parametrize("seed", [54, 86, 100, 129])
def test_edges_that_push_each_other_lose_what_is_named(seed):
    # Whole steps over such pushes lost 5e-5, 2e-4, 2e-4 and 3e-2 of the energy. What is left is that of order
    # 2, up to 1e-6 of the motion in each step that is not cut.
    s = carom.simulate(two_boxes(seed), 0.6, step=5e-3)
    assert s.stats["held_steps"] > 0
    # (129 is given up at .265 s: the pair is a crowd for some steps then)
    most = 3e-3 if seed == 129 else 3e-5
    assert np.max(np.abs(s.ledger.residual)) < most * s.total_energy[0]


@pytest.mark.parametrize("part", [1.01, 1.05])
def test_a_stack_that_topples_from_a_fixed_table(part):
    # Four blocks that lean over by more than 1/2, 1/4, 1/6, 1/8 of their length. Contacts of some steps of 2 ms
    # are not solved; taken over all the same they threw a block out at 1e7 m/s.
    scene = Scene(gravity=(0, 0, -9.81))
    table = scene.add_body(Box(0.4, 0.2, 0.1), mass=1.0, position=(-0.2, 0, -0.05))
    scene.add_joint(carom.joints.Fixed(), carom.GROUND, table)
    x = -0.1
    for k in range(4):
        x += part * 0.2 / (2 * (4 - k))
        scene.add_body(Box(0.2, 0.1, 0.03), mass=1.0, position=(x, 0, (k + 0.5) * 0.03))
    scene.set_contact_default(restitution=0.0, friction=0.5)
    s = carom.simulate(scene, 0.7, step=2e-3)
    assert s.position[-1, -1, 2] < 0.0  # from .105
    assert np.max(s.held_residual) < 0.01 * 9.81 * 2e-3
    assert np.max(np.abs(s.ledger.residual)) < 1e-5 * s.total_energy[0]
