"""A run that has reached its end goes on from its file, as if it had been longer from the start."""

import numpy as np
import pytest

import carom
from carom.io.files.checkpoint import capture
from files.compare import derived_differences, differences
from files.scenes import pendulum, slider
from files.test_resume import interrupted
from simulate.scenes import die


def but_settings(a, b):
    """Differences of two solutions but for how long they were to be at first."""
    return [name for name in differences(a, b) if name != "settings"]


@pytest.mark.parametrize(
    "make", [lambda: die(mu=0.3), slider, pendulum], ids=["die", "slider", "pendulum"]
)
def test_whole_steps(make, tmp_path):
    """Bit for bit the run of the whole time; twice, and from what `Solution.save` has written."""
    path = tmp_path / "run.nc"
    carom.simulate(make(), 0.25, step=5e-3, save=path)
    longer = carom.resume(path, until=0.5)
    whole = carom.simulate(make(), 0.5, step=5e-3)
    assert longer.t[-1] == 0.5
    assert but_settings(longer, whole) == []
    again = carom.Solution.load(path)
    assert differences(again, longer) == []
    assert derived_differences(again, longer) == []
    again.save(tmp_path / "copy.nc")
    more = carom.resume(tmp_path / "copy.nc", until=0.75)
    assert but_settings(more, carom.simulate(make(), 0.75, step=5e-3)) == []


def test_a_last_step_that_was_shorter(tmp_path):
    """0.103 s in steps of 10 ms, every third saved: 3 ms at its end, and then whole ones again."""
    path = tmp_path / "run.nc"
    carom.simulate(die(), 0.103, step=0.01, save_every=3, save=path)
    longer = carom.resume(path, until=0.18)
    first = [0.0, 0.03, 0.06, 0.09, 0.103]
    assert longer.t == pytest.approx([*first, 0.133, 0.163, 0.18], abs=1e-15)
    # free flight is in closed form: where it is does not depend on steps
    assert len(longer.impacts) == 0
    whole = carom.simulate(die(), 0.18, step=0.01)
    np.testing.assert_allclose(longer.position[-1], whole.position[-1], rtol=0, atol=1e-14)


def test_with_tolerances_states_come_as_often_as_before(tmp_path):
    path = tmp_path / "run.nc"
    short = carom.simulate(die(), 0.2, save=path)
    longer = carom.resume(path, until=0.3)
    assert np.array_equal(longer.t[:201], short.t)
    assert longer.t[201:] == pytest.approx(0.2 + 1e-3 * np.arange(1, 101), abs=1e-12)
    assert np.array_equal(longer.position[:201], short.position)


def test_times_to_save_at(tmp_path):
    path = tmp_path / "run.nc"
    carom.simulate(die(), 0.2, save_at=[0.05, 0.1], save=path)
    longer = carom.resume(path, until=0.3)
    assert longer.t[:4].tolist() == [0.0, 0.05, 0.1, 0.2]
    assert longer.t[-1] == 0.3


def test_interrupted_on_the_way(tmp_path):
    """The part beyond the end may be interrupted, too; so may the first part go on to another end."""
    path = tmp_path / "run.nc"
    interrupted(die(mu=0.3), 0.25, 0.5, path, step=5e-3)
    whole = carom.simulate(die(mu=0.3), 0.5, step=5e-3)

    def stop(done, total):
        if done >= 80:
            raise KeyboardInterrupt

    part = carom.resume(path, until=0.5, progress=stop, throw=False)
    assert part.status is carom.Status.INTERRUPTED
    assert but_settings(carom.resume(path), whole) == []


def test_an_interrupted_run_may_end_earlier(tmp_path):
    """Interrupted at half of .25 s: to any time after that, bit for bit the run of that time."""
    path = tmp_path / "run.nc"
    part = interrupted(die(mu=0.3), 0.25, 0.5, path, step=5e-3)
    for until in (part.t[-1], 0.01):
        with pytest.raises(ValueError, match=r"until must be .* above 0\.12"):
            carom.resume(path, until=until)
    shorter = carom.resume(path, until=0.2)
    assert but_settings(shorter, carom.simulate(die(mu=0.3), 0.2, step=5e-3)) == []
    longer = carom.resume(path, until=0.25)
    assert but_settings(longer, carom.simulate(die(mu=0.3), 0.25, step=5e-3)) == []
    interrupted(die(mu=0.3), 0.25, 0.5, path)  # with tolerances, to a time between two states
    assert carom.resume(path, until=0.1933).t[-1] == 0.1933


def test_a_run_in_memory_that_has_gone_on_has_no_state_to_save(tmp_path):
    short = carom.simulate(die(), 0.1, step=0.01)
    assert capture(short._run) is not None
    short._run.clock["now"] = 0.2  # as if somebody had gone on with it
    short.save(tmp_path / "run.nc")
    with pytest.raises(ValueError, match="it has no checkpoint"):
        carom.resume(tmp_path / "run.nc", until=0.3)


def test_its_end_was_called_duration(tmp_path):
    path = tmp_path / "run.nc"
    carom.simulate(die(), 0.05, step=0.01, save=path)
    with pytest.warns(DeprecationWarning, match=r"resume\(duration=\) is called until="):
        longer = carom.resume(path, duration=0.08)
    assert longer.t[-1] == 0.08
    with pytest.raises(ValueError, match="until must be"):
        carom.resume(path, until=1e300)


@pytest.mark.parametrize("until", [0.25, 0.05, -1.0, "2"])
def test_not_beyond_the_end(path, until):
    with pytest.raises(ValueError, match="until must be"):
        carom.resume(path, until=until)


@pytest.mark.parametrize(
    "make", [lambda: die(mu=0.3), slider, pendulum], ids=["die", "slider", "pendulum"]
)
def test_a_solution_goes_on(make):
    """Without a file, twice, bit for bit the run of the whole time; the solution itself stays as it is."""
    short = carom.simulate(make(), 0.25, step=5e-3)
    known = short.position.copy()
    longer = short.simulate(0.25)
    again = short.simulate(0.5)
    assert but_settings(longer, carom.simulate(make(), 0.5, step=5e-3)) == []
    assert but_settings(again, carom.simulate(make(), 0.75, step=5e-3)) == []
    assert but_settings(longer.simulate(0.25), again) == []
    assert np.array_equal(short.position, known)
    assert short.t[-1] == 0.25


def test_it_goes_on_for_a_time_that_has_steps():
    run = carom.simulate(die(), 0.05, step=0.01)
    for wait in (1e308, 1e20, 1e-300):
        with pytest.raises(ValueError, match=r"^duration must be .*, got 1e[+-]?\d+"):
            run.simulate(wait)


def test_a_loaded_solution_goes_on(tmp_path):
    short = carom.simulate(die(mu=0.3), 0.25, step=5e-3)
    short.save(tmp_path / "run.nc")
    longer = carom.Solution.load(tmp_path / "run.nc").simulate(0.25)
    assert but_settings(longer, short.simulate(0.25)) == []


def test_a_run_that_was_stopped_does_not_go_on():
    def stop(done, total):
        if done > 50:
            raise KeyboardInterrupt

    s = carom.simulate(die(), 0.5, step=5e-3, progress=stop, throw=False)
    assert s.status is carom.Status.INTERRUPTED
    with pytest.raises(
        ValueError, match="the run must have reached its end to continue from there"
    ):
        s.simulate(0.1)
