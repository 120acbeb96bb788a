"""A short form of `benchmarks/campaign.py`: every kind of shape, law and step, thrown on a floor."""

import warnings
from dataclasses import asdict

import numpy as np
import pytest

import carom
from campaigns import (
    belts,
    crowds,
    forced,
    grounds,
    laws,
    piles,
    presses,
    rolls,
    rough,
    strikes,
    surfaces,
    throws,
)  # fmt: skip
from campaigns.case import run, wrong
from carom.io.files.kept import run_again
from carom.model.records import FULL_MULTIPLE


@pytest.mark.few(1)
@pytest.mark.processors
@pytest.mark.parametrize("first", range(2000, 2090, 15))
def test_throws_end_and_lose_nothing_without_a_name(first):
    # What 100 427 others met but six, chaotic as they are: the end is reached, nothing sinks, no line of the
    # ledger rises, and no more than 1e-4 of what was exchanged has no name (2e-5 at most there).
    for seed in range(first, first + 15):
        found = run(throws.case(seed))
        assert found.status == "SUCCESS", seed
        assert found.reached == 1.0, seed
        assert found.depth <= 1e-9, seed
        assert found.residual <= 1e-4, seed
        assert found.gained <= 1e-6, seed


@pytest.mark.few(1)
@pytest.mark.processors
@pytest.mark.parametrize("first", range(3001, 3049, 12))
def test_piles_end_and_lose_nothing_without_a_name(first):
    # Bounds far above what 2200 others met (12 beyond 1e-4 and 1e-9), as these are chaotic too.
    for seed in range(first, first + 12):
        found = run(piles.case(seed))
        assert found.status in ("SUCCESS", "INACCURATE"), seed
        assert found.reached == 1.0, seed
        assert found.depth <= 1e-5 or (found.warned and found.depth <= 1e-2), seed
        assert found.residual <= 1e-3 or found.warned, seed


@pytest.mark.few(1)
@pytest.mark.parametrize("first", range(2000, 2036, 12))
def test_laws_of_restitution_end_and_lose_nothing_without_a_name(first):
    # What 600 others met: five beyond 1e-4, said, and one line that rose by 1.2e-5.
    for seed in range(first, first + 12):
        found = run(laws.case(seed))
        assert found.status in ("SUCCESS", "INACCURATE"), seed
        assert found.reached == 1.0, seed
        assert found.depth <= 1e-9, seed
        assert found.residual <= 1e-4 or found.warned, seed
        assert found.gained <= 1e-4, seed


@pytest.mark.few(1)
@pytest.mark.parametrize("first", range(2000, 2036, 12))
def test_tangential_restitution_adds_no_energy(first):
    # What 300 others met: no gain at all, 19 beyond 1e-4, said, all with mu above 1.
    for seed in range(first, first + 12):
        found = run(rough.case(seed))
        assert found.reached == 1.0, seed
        assert found.residual <= 1e-4 or found.warned, seed
        assert found.gained <= 1e-9, seed


@pytest.mark.few(1)
def test_presses():
    # What a motor presses together ends as BLOCKED, at the known time for stacks; nothing else stops a run.
    for seed in range(2000, 2010):
        found = run(presses.case(seed), tolerances=True)
        assert found.status in ("SUCCESS", "INACCURATE", "BLOCKED"), seed
        assert found.reached == 1.0 or found.status == "BLOCKED", seed
        assert found.off <= 1.0, seed
        assert found.residual <= 1e-4 or found.warned, seed
        assert found.depth <= 1e-9 or found.warned, seed


@pytest.mark.parametrize("first", range(2000, 2030, 15))
def test_rolls_end_and_lose_nothing_without_a_name(first):
    # What 500 others met, the worst with 4e-7 of what was exchanged.
    for seed in range(first, first + 15):
        found = run(rolls.case(seed), tolerances=True)
        assert found.status == "SUCCESS", seed
        assert found.reached == 1.0, seed
        assert found.depth <= 1e-9, seed
        assert found.residual <= 1e-5, seed
        assert found.gained <= 1e-6, seed


def test_belts_end_and_lose_nothing_without_a_name():
    # What ten met, the worst with 7e-7 of what was exchanged.
    for seed in range(2000, 2010):
        found = run(belts.case(seed), tolerances=True)
        assert found.status == "SUCCESS", seed
        assert found.depth <= 1e-9, seed
        assert found.residual <= 1e-5, seed
        assert found.gained <= 1e-6, seed


def test_friction_of_a_given_step_takes_energy():
    # Slip stopped within a step of a plate over rollers: the weights of its stages are not all positive, and
    # the line `friction` rose by 1e-6 in silence, by 8e-6 on a turntable (121).
    found = run(belts.case(138))
    assert found.status == "SUCCESS"
    assert found.gained <= 1e-7
    assert found.residual <= 1e-5  # as of other belts: at most 2e-6 of seeds 100 to 139


@pytest.mark.few(1)
@pytest.mark.parametrize("first", [0, 7])
def test_surfaces_and_materials_are_right_or_say_so(first):
    # Each kind of ground with some bodies; forces within their cones by the law that is in force.
    quicker = {14: 54, 140: 260, 175: 55, 182: 142}  # of the same kind
    for seed in (quicker.get(k, k) for k in range(first, 210, 14)):
        found = run(surfaces.case(seed))
        assert found.reached == 1.0, seed
        assert found.gained <= 1e-6, seed
        assert found.off <= 1.0, seed
        assert found.warned or not wrong(asdict(found)), seed


def test_throws_into_bowls_pipes_and_funnels_lose_nothing_without_a_name():
    # What 554 others met but one, which sank by 5e-8 of its size and said so.
    for seed in range(2000, 2010):
        found = run(grounds.case(seed), tolerances=True)
        assert found.status == "SUCCESS", seed
        assert found.reached == 1.0, seed
        assert found.depth <= 1e-9, seed
        assert found.off <= 1.0, seed
        assert found.residual <= 1e-4, seed
        assert found.gained <= 1e-5, seed


@pytest.mark.parametrize("seed", [200109, 200195])
def test_what_does_not_move_is_not_inaccurate(seed):
    # Without gravity, in equilibrium: all energies are round-off, 1e-35 J, and so is what has no name.
    found = run(forced.case(seed), tolerances=True)
    assert found.status == "SUCCESS"


#: large crowds that take long, and others of the same kind and step, some of which come to rest too
SMALLER = {2000: 2054, 2005: 2221, 2012: 2048, 2016: 2088, 2019: 2109, 2023: 2059}


@pytest.mark.few(1)
@pytest.mark.parametrize("first", range(2000, 2036, 12))
def test_crowds_end_and_lose_nothing_without_a_name(first):
    # The twelve are of each kind, at two steps. Bounds far above what 2000 others met.
    for seed in (SMALLER.get(k, k) for k in range(first, first + 12)):
        assert_ends(seed)


def assert_ends(seed):
    found = run(crowds.case(seed))
    assert found.status in ("SUCCESS", "INACCURATE"), seed
    assert found.reached == 1.0, seed
    assert found.depth <= 1e-5, seed
    assert found.residual <= 1e-3 or found.warned, seed


@pytest.mark.slow
def test_a_row_of_twenty_ends_and_loses_nothing_without_a_name():
    assert_ends(2005)


def test_a_step_of_many_points_is_given_up_before_it_takes_minutes():
    # Twenty boxes in a row that touch: a contact step of their 157 points takes a second, and the first step
    # has thousands, which 3150 trial steps would have been allowed to do.
    case = crowds.case(740011)
    s = carom.simulate(case.scene, 4 * case.step, step=case.step)
    assert s.stats["whole_steps"] == 4
    assert s.stats["trial_steps"] < 50


def test_what_a_return_pushes_in_is_pushed_out():
    # A body that a time-stepping step had left above the floor was laid down, a corner into the wall: 1.5e-7
    # of its size in most of the runs that differ by round-off. A corner that moves away is left as it is: 1e-8.
    assert run(crowds.case(720003)).depth <= 1e-7


def test_what_runs_along_a_rim_that_is_nearly_flat_is_not_at_rest():
    # The point of contact of two cylinders had 1e13 m/s^2: their 3 m/s were taken for round-off of rest.
    found = run(crowds.case(970024))
    assert found.status == "SUCCESS"
    assert found.residual <= 1e-3


@pytest.mark.parametrize("seed", [1266, 201976, 204977])
def test_a_rim_that_becomes_flat_gives_no_energy(seed):
    # Forces grow without bound there: the shortest step gained up to 6 times what the run exchanged.
    found = run(throws.case(seed))
    assert found.status == "SUCCESS"
    assert found.residual <= 1e-4
    assert found.gained <= 1e-6


def test_a_trial_step_that_is_no_number_is_given_up():
    # A cylinder at 20 ms: the velocity of one trial was infinite, and it was taken.
    found = run(throws.case(338995))
    assert found.status == "SUCCESS"
    assert found.depth <= 1e-9
    assert found.residual <= 1e-4


def test_slip_that_comes_to_a_jam_keeps_its_energy():
    # The force of a point that slips grows as 1/(t* - t): one step went beyond t*, and gained 1e14 times the
    # energy of the body.
    found = run(strikes.case(50527))
    assert found.reached == 1.0
    assert found.residual <= 1e-2


@pytest.mark.parametrize("seed", [7014, 7077])  # a capsule and an ellipsoid that grip, then slip
def test_slip_that_has_just_begun_goes_on_at_any_tolerance(seed):
    ends = []
    for rtol in (1e-8, 1e-11):
        case = throws.case(seed)
        s = carom.simulate(case.scene, 0.3, rtol=rtol, save_at=0.3)
        assert s.stats["whole_steps"] == 0
        ends.append(s.position[-1, 0])
    size = case.scene.bodies[0].shape.size
    assert np.linalg.norm(ends[0] - ends[1]) < 1e-6 * size


def test_the_room_of_arrays_changes_nothing():
    # An island chooses at the start of a step how it moves. If the loop is left for longer arrays in between,
    # its points may have become many or few.
    case = crowds.case(901)
    solution = carom.simulate(case.scene, case.duration, step=case.step)
    again = run_again(case.scene, solution.settings, carom.Options())
    for _ in range(3):
        again.grow(FULL_MULTIPLE)
    assert again.go_on(again.steps) is carom.Status.SUCCESS
    assert again.clock.tobytes() == solution._run.clock.tobytes()


def test_what_hardly_moves_costs_few_steps():
    # A row of 15 boxes that touch, or nearly. Eight runs that differ by units in the last place of gravity take
    # 397 to 2 942 trial steps, six of them 397 to 427. While a pair was unsure if the other of two faces had
    # more room at the end, they took 1 333 to 204 945, half of them 27 000 and more.
    one, taken = crowds.case(950041), []
    for units in range(8):
        one.scene.gravity = np.array(one.scene.gravity) * (1.0 + units * 2.3e-16)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", carom.AccuracyWarning)
            taken.append(carom.simulate(one.scene, one.duration).stats["trial_steps"])
    assert np.median(taken) < 4000
