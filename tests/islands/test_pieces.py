"""Pieces of a step: islands are found anew while several groups share one, whatever times are saved."""

import numpy as np
import pytest

import carom
from carom.bench.many import capsules
from carom.run import Run
from carom.stepping.islands.pieces import BUSY_TRIALS
from files.compare import differences

RTOL, LENGTH = 1e-8, 0.2


def tops(numbers):
    """Bars that rock on one of their long edges, each by its own time, at places that they could leave."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.set_contact_default(restitution=0.0, friction=0.6)
    for k in numbers:
        tilt = 0.3 + 0.05 * k
        scene.add_body(
            carom.Capsule(0.03, LENGTH), mass=1.0 + k, position=(0.25 * k, 0, 0.03),
            orientation=(np.cos(np.pi / 4), np.sin(np.pi / 4), 0, 0),
            velocity=(0.2, 0, 0), angular_velocity=(0, 0.2 / 0.03 + k, tilt),
        )  # fmt: skip
    return scene


def test_groups_of_an_island_move_as_each_alone():
    together = carom.simulate(tops(range(4)), 0.5, rtol=RTOL, save_at=0.5)
    assert together.stats["trial_steps"] > 4 * BUSY_TRIALS  # of one island there would be pieces
    for k in range(4):
        alone = carom.simulate(tops([k]), 0.5, rtol=RTOL, save_at=0.5)
        error = np.abs(together.position[-1, k] - alone.position[-1, 0]).max()
        assert error < 10 * RTOL * LENGTH


def test_times_to_save_do_not_make_a_run_longer():
    """If its end alone was saved, a run of 216 balls took five times as long as with 200 states."""
    scene = capsules().scene()
    often, seldom = (
        carom.simulate(scene, 0.35, rtol=1e-6, save_at=every) for every in (0.35 / 200, 0.35)
    )
    assert seldom.stats["held_steps"] < 1.5 * often.stats["held_steps"]


def test_a_run_stopped_between_two_pieces_goes_on_bit_for_bit(tmp_path, monkeypatch):
    scene, path, duration = capsules().scene(), tmp_path / "run.nc", 0.45
    whole = carom.simulate(scene, duration, save_at=duration)

    def to_stop(run):
        if run.islands.plan["done"][0] > 0.0:
            raise KeyboardInterrupt
        return False

    with monkeypatch.context() as patch:
        patch.setattr(Run, "to_stop", to_stop)
        part = carom.simulate(scene, duration, save_at=duration, save=path, throw=False)
    assert part.status is carom.Status.INTERRUPTED
    assert part._run.islands.plan["done"][0] > 0.0
    assert differences(carom.resume(path), whole) == []


@pytest.mark.parametrize("duration", [0.1, 0.25])
def test_pieces_add_up_to_the_saved_times(duration):
    solution = carom.simulate(capsules().scene(), duration, save_at=duration / 3)
    np.testing.assert_array_equal(solution.t, np.append(duration / 3 * np.arange(3), duration))
