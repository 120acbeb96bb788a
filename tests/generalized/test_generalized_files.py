"""Files of systems in coordinates: what was saved is loaded, bit for bit, and runs go on from there."""

import numpy as np
import pytest
from coordinate_systems import falling_rod

import carom
from carom.generalized import CoordinateImpact, GeneralizedSolution

pytest.importorskip("h5netcdf")


def rod(restitution=0.5):
    """A rod that falls on a floor, with two contacts."""
    return falling_rod(0.3, (0.5, 0.0), 1.0, restitution, 0.3, "newton")


def test_a_file_has_the_run(tmp_path):
    path, system = tmp_path / "rod.nc", rod()
    saved = carom.simulate(system, 0.5, events=lambda t, state: state.q[1] - 0.3)
    saved.save(path)
    loaded = GeneralizedSolution.load(path, system)
    for name in ("t", "q", "v", "contact_force", "kinetic_energy", "potential_energy"):
        assert np.array_equal(getattr(loaded, name), getattr(saved, name)), name
    for name in CoordinateImpact._fields:
        assert np.array_equal(getattr(loaded.impacts, name), getattr(saved.impacts, name)), name
    for one, other in zip(loaded.evaluate(0.31), saved.evaluate(0.31)):
        assert np.array_equal(one, other)
    assert loaded.message == saved.message
    assert np.array_equal(loaded.t_events[0], saved.t_events[0])
    assert np.array_equal(loaded.state_events[0][0].q, saved.state_events[0][0].q)


def test_others_read_the_coordinates(tmp_path):
    xarray = pytest.importorskip("xarray")
    saved = carom.simulate(rod(), 0.2, step=1e-2)
    saved.save(tmp_path / "rod.nc")
    with xarray.open_dataset(tmp_path / "rod.nc", engine="h5netcdf") as data:
        assert data.q.dims == ("time", "coordinate")
        assert np.array_equal(data.q.values, saved.q)
        assert np.array_equal(data.v.values, saved.v)


def test_a_run_goes_on(tmp_path):
    # The first part has a whole number of steps: the bits of one run over the whole time.
    path, system = tmp_path / "rod.nc", rod()
    whole = carom.simulate(system, 1.0, step=1e-3)
    half = carom.simulate(system, 0.5, step=1e-3, save=path)
    for run in (half.simulate(0.5), carom.resume(path, until=1.0, system=system)):
        assert isinstance(run, GeneralizedSolution)
        assert np.array_equal(run.q, whole.q)
        assert np.array_equal(run.impacts.impulse, whole.impacts.impulse)


def test_an_interrupted_run_goes_on(tmp_path):
    def stop(done, total):
        if done > 0.6 * total:
            raise KeyboardInterrupt

    path, system = tmp_path / "rod.nc", rod()
    whole = carom.simulate(system, 1.0, step=1e-3)
    part = carom.simulate(system, 1.0, step=1e-3, save=path, progress=stop, throw=False)
    assert part.status is carom.Status.INTERRUPTED
    assert np.array_equal(carom.resume(path, system=system).q, whole.q)


def test_other_systems_and_files_are_refused(tmp_path):
    path = tmp_path / "rod.nc"
    saved = carom.simulate(rod(), 0.1, save=path)
    with pytest.raises(ValueError, match=r"GeneralizedSolution.load\(path, system\)"):
        carom.Solution.load(path)
    with pytest.raises(ValueError, match="with another start, metric there, scale or contacts"):
        GeneralizedSolution.load(path, rod(restitution=0.4))
    broken = path.with_name("broken.nc")
    broken.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(ValueError, match="path must be a file of a run"):
        GeneralizedSolution.load(broken, rod())
    with pytest.raises(TypeError, match="system must be"):
        GeneralizedSolution.load(path, 3)
    with pytest.raises(ValueError, match=r"path must end in \.nc"):
        saved.save(tmp_path / "rod.csv")
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0)
    carom.simulate(scene, 0.1).save(path)
    with pytest.raises(ValueError, match="it is of a scene"):
        GeneralizedSolution.load(path, rod())
