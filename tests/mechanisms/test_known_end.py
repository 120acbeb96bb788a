"""Accelerations kept from the end of a step: the same motion as with all worked out anew, bit by bit."""

import numpy as np
import pytest
from mechanism_scenes import chain, four_bar
from test_rattle import on_a_wall

import carom
from carom import GROUND, forces
from carom.run import Run
from carom.stepping.settings import checked_settings


def loaded_chain():
    scene = chain(5, axis=(0, 1, 0))
    first, last = scene.bodies[0], scene.bodies[-1]
    scene.add_force(forces.Spring(40.0, (0, 0, 1), (0, 0, 0), damping=0.3), GROUND, last)
    scene.add_force(forces.Force((0.4, 0, 0.2)), first)
    return scene


CASES = {
    "chain": (loaded_chain, 1.0),
    "loops": (lambda: four_bar(2, 0.3), 1.0),
    "through singular positions": (four_bar, 2.0),
    "with impacts": (on_a_wall, 1.5),
}


def begun(scene, duration):
    return Run(scene, checked_settings(duration, method="rk5", rtol=1e-7))


@pytest.mark.parametrize("case", CASES)
def test_the_loop_may_be_left_after_any_step(case):
    """Where the loop is entered, nothing is known of the step before."""
    make, duration = CASES[case]
    whole, parts = begun(make(), duration), begun(make(), duration)
    whole.go_on(whole.steps)
    for k in range(parts.steps):
        parts.go_on(k + 1)
    assert parts.now.tobytes() == whole.now.tobytes()
    assert parts.clock["trials"] == whole.clock["trials"]
    assert np.array_equal(parts.watch["amount"], whole.watch["amount"])


def test_a_force_that_is_set_acts_at_once():
    """The state at which it is set is the one whose accelerations were kept."""
    scene = carom.Scene(gravity=(0, 0, 0))
    cart = scene.add_body(mass=2.0, inertia=(1, 1, 1), name="cart")
    scene.add_force(forces.Force((0, 0, 0)), cart, name="motor")
    run = carom.Run(scene, rtol=1e-6)
    run.advance(0.5)
    run.set_force("motor", (8.0, 0, 0))
    run.advance(0.25)
    assert run.state["cart"].velocity[0] == pytest.approx(1.0, rel=1e-14)
    assert run.state["cart"].position[0] == pytest.approx(0.125, rel=1e-14)
