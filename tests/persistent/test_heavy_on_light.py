"""A heavy body lies on a light one: forces of both are those of statics, however different their masses are."""

import numpy as np
import pytest

import carom

SIDE, G = 0.2, 9.81


def stack(ratio, off, shape=None):
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    box = carom.Box(SIDE, SIDE, SIDE)
    scene.add_body(box, mass=1, position=(0, 0, SIDE / 2))
    scene.add_body(shape or box, mass=ratio, position=(*off, 1.5 * SIDE))
    scene.set_contact_default(restitution=0, friction=0.5)
    return scene


@pytest.mark.few(4)
@pytest.mark.parametrize("ratio", [1e4, 1e5, 1e6])
@pytest.mark.parametrize("off", [(0.0, 0.0), (0.03, 0.02), (0.04, -0.05)])
def test_it_stays(ratio, off):
    """The centre of the upper box is above the lower one, which all of its corners press: both stay at rest."""
    s = carom.simulate(stack(ratio, off), 1.0)
    assert len(s.impacts) == 0
    assert s.stats["trial_steps"] < 1000
    np.testing.assert_allclose(s.position[-1], s.position[0], rtol=0, atol=1e-12)


@pytest.mark.few(1)
@pytest.mark.parametrize("ratio", [1e4, 1e6])
def test_both_slide_as_one(ratio):
    """Pushed on ice by a force on the light one alone, both have the acceleration F/(M + m)."""
    scene = carom.Scene(gravity=(0, 0, -G))
    ice = scene.add_half_space((0, 0, 0), (0, 0, 1))
    low = scene.add_body(carom.Box(0.4, 0.4, 0.1), mass=1, position=(0, 0, 0.05))
    top = scene.add_body(carom.Box(0.2, 0.2, 0.1), mass=ratio, position=(0.02, 0, 0.15))
    scene.add_contact(low, ice, restitution=0, friction=0.0)
    scene.add_contact(top, low, restitution=0, friction=0.5)
    force = 0.1 * G * ratio  # a fifth of what friction can carry over
    scene.add_force(carom.forces.Force((force, 0, 0)), low)
    s = carom.simulate(scene, 0.02)
    way = 0.5 * force / (1 + ratio) * 0.02**2
    np.testing.assert_allclose(s.position[-1, :, 0], (way, 0.02 + way), rtol=0, atol=1e-9)
