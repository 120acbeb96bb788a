"""Piles: bodies that stand on, slide under and fall on each other, some by steps that are taken whole."""

import numpy as np
import pytest

import carom
import contact_kinds
from carom.scene import Box, Scene

G = 9.81


def rise(line):
    """Return the greatest rise of what must not rise."""
    return max(0.0, float(np.max(np.diff(line, prepend=0.0))))


def struck_plate(x, mass, lean, friction):
    """A plate that slides at 1 m/s, and a card that falls on it from 1 cm and topples."""
    scene = Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_body(Box(0.2, 0.1, 0.02), mass=0.1, position=(0, 0, 0.01), velocity=(1, 0, 0))
    scene.add_body(
        Box(0.002, 0.06, 0.09), mass=mass, position=(x, 0, 0.075),
        orientation=(np.cos(lean), 0, np.sin(lean), 0),
    )  # fmt: skip
    scene.set_contact_default(restitution=0.0, friction=friction)
    return scene


@pytest.mark.parametrize(
    ("x", "mass", "lean", "friction"),
    [(0.085, 0.376, 0.497, 0.887), (0.106, 0.946, 0.188, 0.472), (0.046, 2.16, 0.434, 0.450)],
)
def test_what_slid_and_sticks_stays_where_it_is(x, mass, lean, friction):
    # Points that stick go back to an anchor at the end of a step. One that had slid before a blow made it stick
    # had its anchor where it was first held: the plate jumped back by up to 45 mm, at no cost of energy.
    h = 1e-3
    s = carom.simulate(struck_plate(x, mass, lean, friction), 0.2, step=h)
    assert "sticks" in s.events.kind
    way = np.abs(np.diff(s.position[:, 0, 0]))
    assert np.max(way) <= 1.001 * h * np.max(np.abs(s.velocity[:, 0, 0]))


def overhang(count, part, friction):
    """Blocks over the edge of a heavy block, by `part` of what just stands."""
    scene = Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_body(Box(0.4, 0.2, 0.1), mass=50.0, position=(-0.2, 0, 0.05))
    x = -0.1
    for k in range(count):
        x += part * 0.2 / (2 * (count - k))
        scene.add_body(
            Box(0.2, 0.1, 0.03), mass=1.0, position=(x, 0, 0.1 + (k + 0.5) * 0.03), name=f"{k}"
        )
    scene.set_contact_default(restitution=0.0, friction=friction)
    return scene


@pytest.mark.parametrize(("count", "step"), [(1, 2e-2), (2, 2e-2), (1, 5e-3)])
def test_blocks_that_topple_lose_what_is_named(count, step):
    # A step of 20 ms lost up to 1 % of what a fall gains in it, 2e-3 of all; friction rose by 1e-4 of it where
    # rows turn. A thousandth of the tolerance of a run in each of its steps is what is asked for.
    s = carom.simulate(overhang(count, 1.05, 0.6), 0.5, step=step)
    energy = np.max(s.kinetic_energy)
    assert energy > 0.1
    assert np.max(np.abs(s.ledger.residual)) < 1e-4 * energy
    assert rise(s.ledger.friction) < 1e-9 * energy
    assert rise(s.ledger.bounces) < 1e-9 * energy


@pytest.mark.parametrize("step", [5e-3, 2e-2])
def test_steps_that_are_taken_whole_name_what_they_lose(step):
    # No impact in a step is too many: all steps with one are whole. They come back to the surfaces from where
    # they would have sunk to, which had no name, and friction and bounces rose.
    scene = Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(3):
        angle = 0.2 * k + 0.1
        scene.add_body(
            Box(0.12 - 0.02 * k, 0.08, 0.004 + 0.02 * k), mass=0.3, position=(0.01 * k, 0, 0.1 + 0.1 * k),
            orientation=(np.cos(angle), np.sin(angle), 0, 0),
        )  # fmt: skip
    scene.set_contact_default(restitution=0.3, friction=0.4)
    options = carom.Options(max_impacts_per_step=1)
    s = carom.simulate(scene, 0.6, step=step, options=options)
    assert s.stats["whole_steps"] > 0
    energy = np.max(s.kinetic_energy)
    for line in (s.ledger.impacts, s.ledger.friction, s.ledger.bounces):
        assert rise(line) < 1e-9 * energy
    assert np.max(np.abs(s.ledger.residual)) < 1e-4 * energy
    assert np.min(s.position[-1, :, 2]) > 0.0


def test_a_stack_on_a_fixed_table_falls_to_the_end():
    # Contacts of a step of 2 ms at .60 s are not solved, also in parts of it, and the run stopped. Its
    # points are let go there, and strike again at the end of the part.
    scene = Scene(gravity=(0, 0, -G))
    table = scene.add_body(Box(0.4, 0.2, 0.1), mass=1.0, position=(-0.2, 0, -0.05))
    scene.add_joint(carom.joints.Fixed(), carom.GROUND, table)
    x = -0.1
    for k in range(4):
        x += 1.02 * 0.2 / (2 * (4 - k))
        scene.add_body(Box(0.2, 0.1, 0.03), mass=1.0, position=(x, 0, (k + 0.5) * 0.03))
    scene.set_contact_default(restitution=0.0, friction=0.5)
    s = carom.simulate(scene, 0.8, step=2e-3)
    assert s.t[-1] == 0.8
    assert s.position[-1, -1, 2] < 0.0
    assert np.max(np.abs(s.ledger.residual)) < 1e-4 * np.max(s.kinetic_energy)


@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")  # for 1e-6 of a time-stepping step
@pytest.mark.parametrize("rtol", [1e-3, 1e-4, 1e-6])
def test_a_block_that_slides_off_a_corner_loses_what_is_named(rtol):
    # The normal of the two jumps to the horizontal there. A closing step over that moment, which no bound of
    # energy watched, stopped the block as a wall would: a fifth of all energy had no name.
    s, _ = contact_kinds.one("pile of three", 6, rtol)
    assert s.status.name == "SUCCESS"
    assert abs(s.ledger.residual[-1]) < 1e-5 * np.max(s.kinetic_energy)
