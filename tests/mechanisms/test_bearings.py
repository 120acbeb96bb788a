"""A pin in a ring of boxes, with play: it hands over from side to side, and never leaves the polygon."""

import numpy as np
import pytest

import carom
from campaigns import bearings
from campaigns.case import run, wrong

SEEDS = (3, 9, 14, 22, 29, 36, 40, 44)


@pytest.mark.few(3)
@pytest.mark.parametrize("seed", SEEDS)
def test_random_bearings(seed):
    """Statuses, energies, and the way of the pin to a corner of the polygon, with 1e-3 of the play."""
    case = bearings.case(seed)
    outcome = run(case, tolerances=True)
    assert not wrong({**case.label, **vars(outcome)})
    assert outcome.whole == 0
    assert (
        outcome.residual < 1e-6
    )  # 100 times the tolerance: hundreds of impacts, each with its error


def ring(speed, spin, friction):
    """Return a pin without gravity that slides from side to side of a ring with plastic walls."""
    scene, play = carom.Scene(gravity=(0, 0, 0)), 1e-3
    pin = scene.add_body(
        carom.Cylinder(bearings.RADIUS, 0.01), mass=0.1, orientation=carom.euler("x", 90),
        velocity=speed, angular_velocity=(0, spin, 0),
    )  # fmt: skip
    for shape, place, turn in bearings.ring(24, play, 0.03, 0.03):
        wall = scene.add_static(shape, position=place, orientation=turn)
        scene.add_contact(pin, wall, restitution=0.0, friction=friction)
    return scene


@pytest.mark.parametrize("spin", [0.0, 2.0, 8.0])
def test_what_slides_along_without_a_force_is_no_search(spin):
    """A pin that turns and slides along a wall without a force touches it with a gap and a rate of round-off.

    Between two states no bound of its points excludes that they enter the wall: it took 200 000 trial steps.
    """
    s = carom.simulate(ring((0.2, 0, 0.06), spin, 0.0), 1.0)
    assert s.success
    assert s.stats["trial_steps"] < 4000
    far = np.hypot(s.position[:, 0, 0], s.position[:, 0, 2])
    corner = (bearings.RADIUS + 1e-3) / np.cos(np.pi / 24) - bearings.RADIUS
    assert far.max() < corner + 1e-9
    # without friction nothing changes the spin
    np.testing.assert_allclose(s.angular_velocity[:, 0, 1], spin, rtol=0, atol=1e-12)
