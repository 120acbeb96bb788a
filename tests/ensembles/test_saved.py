"""Ensembles on disk: streamed, interrupted, gone on with; what is no such thing is refused."""

import json

import numpy as np
import pytest

import carom
from ensembles.ensemble_scenes import die
from ensembles.test_ensemble import THROWN, observed, same

zarr = pytest.importorskip("zarr")


def throw(save=None, **more):
    given = {"step": 2e-3, "vary": THROWN, "runs": 20, "chunk": 4, "observe": observed, **more}
    return carom.ensemble(die(), 0.3, save=save, **given)


class StopAfter:
    """A progress function that interrupts once so many runs are made."""

    def __init__(self, runs):
        self.runs = runs
        self.seen = []

    def __call__(self, done, total):
        self.seen.append((done, total))
        if done >= self.runs:
            raise KeyboardInterrupt


@pytest.mark.bits
def test_streamed_and_read_again(tmp_path):
    e, plain = throw(tmp_path / "e.zarr"), throw()
    again = carom.Ensemble.load(tmp_path / "e.zarr")
    for one in (e, again):
        assert same(one, plain)
        assert all(np.array_equal(one.inputs[name], plain.inputs[name]) for name in THROWN)
        assert np.array_equal(one.observed["top"], plain.observed["top"])
    with pytest.raises(ValueError, match="needs the scene"):
        again.solution(0)
    assert np.array_equal(e.solution(3).position[-1], again.position[3])


def test_interrupted_and_gone_on_with(tmp_path):
    """No run is lost, none is made twice, and the result is that of one go."""
    stop = StopAfter(8)
    with pytest.raises(
        KeyboardInterrupt, match="interrupted after 8 of 20 runs; call again"
    ) as error:
        throw(tmp_path / "e.zarr", progress=stop, executor="serial")
    part = error.value.solution
    assert part.counts() == {"pending": 12, "success": 8}
    assert not part.complete
    assert np.all(np.isnan(part.position[8:]))
    seen = []
    whole = throw(tmp_path / "e.zarr", progress=lambda done, total: seen.append((done, total)))
    assert seen[0] == (8, 20)
    assert len(seen) == 4
    assert same(whole, throw())
    throw(tmp_path / "e.zarr", progress=lambda done, total: seen.append(done))
    assert seen[4:] == [20]  # nothing was left to do


def test_interrupted_in_memory():
    with pytest.raises(KeyboardInterrupt, match=r"interrupted after 8 of 20 runs$") as error:
        throw(progress=StopAfter(8), executor="serial")
    assert error.value.solution.done.sum() == 8


@pytest.mark.parametrize("executor", ["serial", "threads"])
@pytest.mark.parametrize("saved", [True, False])
def test_interrupted_within_a_part(tmp_path, executor, saved):
    """In the third run: what was made before is kept, and threads do not make the rest of their parts."""
    begun = []

    def look(solution):
        begun.append(solution)
        if len(begun) == 3:
            raise KeyboardInterrupt
        return {"top": solution.position[:, 0, 2].max()}

    given = {"vary": THROWN, "runs": 20, "chunk": 10, "executor": executor, "workers": 1}
    place = tmp_path / "e.zarr" if saved else None
    with pytest.raises(KeyboardInterrupt, match="interrupted after 2 of 20 runs") as error:
        carom.ensemble(die(), 0.1, step=2e-3, save=place, observe=look, **given)
    part, whole = error.value.solution, carom.ensemble(die(), 0.1, step=2e-3, **given)
    assert len(begun) == 3
    assert part.counts() == {"pending": 18, "success": 2}
    assert np.array_equal(part.position[:2], whole.position[:2])
    assert np.all(np.isfinite(part.observed["top"][:2]))


def test_a_part_without_its_status_is_done_again(tmp_path):
    """What a killed process leaves: numbers of a part, but not its status, which is written last."""
    throw(tmp_path / "e.zarr")
    group = zarr.open_group(str(tmp_path / "e.zarr"))
    group["outcomes/status"][4:8] = -1
    group["outcomes/position"][4:8] = 3.0
    assert not carom.Ensemble.load(tmp_path / "e.zarr").complete
    assert same(throw(tmp_path / "e.zarr"), throw())


@pytest.mark.parametrize("column", ["outcomes/position", "outcomes/status", "inputs/die.velocity"])
def test_a_column_that_is_said_to_be_endless_is_refused(tmp_path, column):
    """Before it is read: 1e11 rows are more than any memory holds."""
    throw(tmp_path / "e.zarr", runs=2)
    about = tmp_path / "e.zarr" / column / "zarr.json"
    known = json.loads(about.read_text())
    about.write_text(json.dumps({**known, "shape": [10**11, *known["shape"][1:]]}))
    with pytest.raises(ValueError, match="is damaged"):
        carom.Ensemble.load(tmp_path / "e.zarr")


def test_failures_are_kept(tmp_path):
    at = np.array([[0, 0, 0.1], [0, 0, 0.005], [0, 0, 0.2]])
    vary = {"die.position": at}
    carom.ensemble(die(), 0.1, step=2e-3, vary=vary, save=tmp_path / "e.zarr", chunk=1)
    e = carom.Ensemble.load(tmp_path / "e.zarr")
    assert e.counts() == {"refused": 1, "success": 2}
    assert "deep into" in e.failures[1]


def test_what_is_no_such_ensemble_is_refused(tmp_path):
    throw(tmp_path / "e.zarr")
    for change in ({"seed": 1}, {"step": 1e-3}, {"runs": 12}):
        with pytest.raises(ValueError, match="has another ensemble"):
            throw(tmp_path / "e.zarr", **change)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("keep me")
    with pytest.raises(ValueError, match="must be an ensemble of carom"):
        throw(tmp_path / "mine")
    with pytest.raises(FileNotFoundError, match=r"nothing\.zarr"):
        carom.Ensemble.load(tmp_path / "nothing.zarr")
    assert (tmp_path / "mine" / "notes.txt").read_text() == "keep me"


def test_labelled(tmp_path):
    pytest.importorskip("xarray")
    e = throw()
    data = e.to_xarray()
    assert data.position.dims == ("run", "body", "axis")
    assert data.position.units == "m"
    assert np.array_equal(data["input:die-ground.friction"], e.inputs["die-ground.friction"])
    assert data.sizes["run"] == 20
