"""What a file gives back is what was saved, to the last bit."""

from dataclasses import replace

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import carom
from files.compare import derived_differences, differences

WORDS = st.integers(0, 2**64 - 1)  # any pattern of bits: nan, -0.0, subnormal numbers too


def test_all_that_is_stored(run, tmp_path):
    run.save(tmp_path / "run.nc")
    again = carom.Solution.load(tmp_path / "run.nc")
    assert differences(run, again) == []
    assert repr(again) == repr(run)
    assert [p.name for p in tmp_path.iterdir()] == ["run.nc"]  # no part is left behind
    assert derived_differences(run, again) == []  # nor is what is worked out another


def test_history_of_an_impact(thrown, path):
    again = carom.Solution.load(path)
    np.testing.assert_array_equal(again.impact_history(1).x, thrown.impact_history(1).x)


def test_a_loaded_run_is_saved_as_it_was(swung, saved, tmp_path):
    (tmp_path / "one.nc").write_bytes(saved["swung"])
    carom.Solution.load(tmp_path / "one.nc").save(tmp_path / "two.nc")
    again = carom.Solution.load(tmp_path / "two.nc")
    assert differences(swung, again) == []
    assert derived_differences(swung, again) == []


def test_the_scene_that_was_loaded_runs_alike(thrown, path):
    again = carom.Solution.load(path)
    repeated = carom.simulate(again.scene, again.settings["duration"], step=again.settings["step"])
    assert differences(thrown, repeated) == []


def test_a_run_that_failed(tmp_path):
    from simulate.scenes import ball

    options = carom.Options(hold=False)
    failed = carom.simulate(ball(), 4.0, step=0.05, options=options, throw=False)
    assert not failed.success
    failed.save(tmp_path / "run.nc")
    again = carom.Solution.load(tmp_path / "run.nc")
    assert differences(failed, again) == []
    assert again._run.options == options


@settings(max_examples=6, deadline=None, suppress_health_check=list(HealthCheck))
@given(words=arrays(np.uint64, 51 * 3, elements=WORDS))
def test_any_number(thrown, tmp_path_factory, words):
    """Of an array that is no longer that of the records too, which are kept beside it."""
    path = tmp_path_factory.mktemp("any") / "run.nc"
    changed = replace(thrown, position=words.view(float).reshape(51, 1, 3))
    changed.save(path)
    again = carom.Solution.load(path)
    assert differences(changed, again) == []
    assert all(np.array_equal(a, b) for a, b in zip(again.evaluate(0.1), thrown.evaluate(0.1)))
