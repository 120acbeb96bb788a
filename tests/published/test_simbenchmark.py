"""SimBenchmark: the page has the numbers of the files, and small variants of the tasks are exact."""

import re
from pathlib import Path

import numpy as np
import pytest

import carom
import simbenchmark
import simbenchmark_tasks as tasks

PAGE = Path(__file__).parents[2] / "docs" / "published" / "simbenchmark.md"


def test_the_page_has_the_numbers_of_the_files():
    table = re.findall(r"^\| (.*) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)[2:]
    shown = [[cell.strip() for cell in line.split("|")] for line in table]
    assert shown == simbenchmark.rows()


def test_no_program_has_a_lesser_error_but_ode_of_the_momentum():
    theirs, ours = simbenchmark.published(), simbenchmark.measured()
    better = [key for key, points in theirs.items() if min(points).error < min(ours[key[0]]).error]
    assert better == [("momentum", "ODE")]


def test_a_plate_with_rolling_balls_moves_as_it_should():
    """3.1 of ODE and DART is the error of a plate at rest, the mean of (a t)^2 over 4 s."""
    plate, ball = tasks.rolling_accelerations()
    assert (plate, ball) == pytest.approx((0.7385, 0.2110), abs=5e-5)
    assert (plate**2 + ball**2) * 16 / 3 == pytest.approx(3.145, rel=1e-3)
    task = tasks.TASKS[0]
    run = carom.simulate(task.scene(), 0.4, save_at=0.1)
    assert task.error(run) < 1e-24
    np.testing.assert_allclose(np.ptp(run.velocity[-1, 1:], axis=0), 0.0, atol=1e-13)


def test_bouncing_balls_keep_their_energy_and_are_where_they_should_be():
    run = carom.simulate(tasks.bouncing(2), 20.0, save_at=0.1)
    assert tasks.TASKS[1].error(run) < 1e-18
    v = np.sqrt(2 * tasks.GRAVITY * 4.9)
    t = (20.0 - v / tasks.GRAVITY) % (2 * v / tasks.GRAVITY)  # since the last bounce
    z = tasks.RADIUS + v * t - tasks.GRAVITY * t * t / 2
    np.testing.assert_allclose(run.position[-1, :, 2], z, atol=1e-11)


@pytest.mark.filterwarnings("ignore:.*time-stepping:carom.AccuracyWarning")
@pytest.mark.parametrize("restitution", [0.0, 1.0])
def test_a_cube_of_balls_does_not_penetrate_and_elastic_ones_keep_their_energy(restitution):
    run = carom.simulate(tasks.balls(3, restitution), 1.0, save_at=0.02, throw=False)
    assert run.success
    assert max(tasks.penetration(x)[1] for x in run.position) < 1e-10
    if restitution:
        assert len(run.impacts) > 50
        assert np.ptp(run.total_energy) < 1e-8 * run.total_energy[0]


def test_penetration_is_that_of_balls_and_floor():
    """A ball that is .02 m in the floor and touches no other; two balls on the floor, .01 m in each other."""
    squares, deepest = tasks.penetration(np.array([[0, 0, 0.08], [0.19, 0, 0.2], [5, 0, 0.5]]))
    assert (squares, deepest) == pytest.approx((4e-4, 0.02))
    squares, deepest = tasks.penetration(np.array([[0, 0, 0.1], [0.19, 0, 0.1]]))
    assert (squares, deepest) == pytest.approx((1e-4, 0.01))


def test_a_robot_keeps_its_energy_and_its_momentum():
    energy, momentum = tasks.TASKS[4:]
    run = carom.simulate(energy.scene(), 3.0, rtol=1e-10, save_at=0.01)
    assert energy.error(run) < 1e-18
    assert run.total_energy[-1] > 2 * run.total_energy[0]  # the pull has lifted it
    run = carom.simulate(momentum.scene(), 3.0, save_at=0.01)
    assert len(run.impacts) == 1
    assert momentum.error(run) < 1e-22
    assert np.ptp(run["trunk"].velocity[:, 1]) > 0.5
