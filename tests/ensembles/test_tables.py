"""An ensemble as a table, and in files by their endings; tables, generators and executors that it takes."""

import csv
import multiprocessing
from concurrent.futures.process import BrokenProcessPool

import numpy as np
import pytest
from scipy.stats import uniform

import carom
from carom.studies.ensembles import engines
from ensembles.ensemble_scenes import die
from ensembles.test_ensemble import same

pandas = pytest.importorskip("pandas")
NEEDS = {".zarr": "zarr", ".parquet": "pyarrow", ".nc": "h5netcdf", ".h5": "h5netcdf"}


def look(solution):
    return {"hit": len(solution.impacts) > 2, "path": solution.position[::20, 0, :2], "die.x": 3}


@pytest.fixture(scope="module")
def thrown():
    """Runs of which one cannot start, with words, vectors, truth values and a name that an outcome has."""
    vary = {
        "die.position.z": [0.1, 0.05, 0.001], "die-ground.impact_law": ["stronge", "newton", "newton"],
        "die.velocity": np.outer([1, 2, 3], [0.1, 0, -0.1]),
    }  # fmt: skip
    made = carom.ensemble(die(), 0.2, step=2e-3, vary=vary, observe=look, executor="serial")
    assert made.counts() == {"refused": 1, "success": 2}
    return made


def test_one_row_for_each_run(thrown):
    table = thrown.to_pandas()
    assert table.index.name == "run"
    assert np.array_equal(table["die.z"], thrown.position[:, 0, 2], equal_nan=True)
    assert np.array_equal(table["die.qw"], thrown.orientation[:, 0, 0], equal_nan=True)
    assert np.array_equal(table["die.velocity.z"], thrown.inputs["die.velocity"][:, 2])
    assert table["status"].tolist() == ["success", "success", "refused"]
    assert "deep into" in table["message"][2]
    assert table["observed:die.x"].tolist() == [3, 3, 0]
    assert table["path.1.0"][0] == thrown.observed["path"][0, 1, 0]


def test_outcomes_are_listed_and_runs_have_numbers(thrown):
    assert {"impacts", "position", "rest_time", "save", "grid"} <= set(dir(thrown))
    pytest.importorskip("xarray")
    data = thrown.to_xarray()
    assert data.run.values.tolist() == [0, 1, 2]
    assert data.body.values.tolist() == ["die"]
    assert float(data.position.sel(run=1, body="die", axis="z")) == thrown.position[1, 0, 2]


@pytest.mark.parametrize("ending", NEEDS)
def test_saved_by_the_ending(thrown, ending, tmp_path):
    pytest.importorskip(NEEDS[ending])
    path = tmp_path / f"runs{ending}"
    for _ in range(2):  # the second replaces the first
        thrown.save(path)
    again = carom.Ensemble.load(path)
    assert same(again, thrown)
    for folder in ("inputs", "observed"):
        old, new = getattr(thrown, folder), getattr(again, folder)
        assert old.keys() == new.keys()
        for name, values in old.items():
            assert values.dtype == new[name].dtype, name
            assert np.array_equal(values, new[name], equal_nan=values.dtype.kind == "f"), name
    assert again.to_pandas()[thrown.to_pandas().columns].equals(thrown.to_pandas())


@pytest.mark.parametrize("ending", [".nc", ".parquet"])
def test_no_damaged_file_is_loaded_with_other_numbers(thrown, ending, tmp_path):
    """Of a bit that has changed, anywhere: refused, or it was none of the numbers."""
    pytest.importorskip(NEEDS[ending])
    thrown.save(whole := tmp_path / f"runs{ending}")
    data, rng = whole.read_bytes(), np.random.default_rng(5)
    places = rng.integers(len(data), size=60).tolist()
    numbers = data.find(thrown.position[1].tobytes())
    for at in [*places, numbers + 7, len(data) - 20]:
        made = bytearray(data)
        made[at] ^= 1 << int(rng.integers(8))
        (tmp_path / f"x{ending}").write_bytes(made)
        try:
            loaded = carom.Ensemble.load(tmp_path / f"x{ending}")
        except ValueError:
            pass
        else:
            assert ending == ".parquet"
            assert same(loaded, thrown)


def test_no_cell_of_a_table_is_a_formula(thrown, tmp_path):
    """Spreadsheets take what begins with = + - @ for one: names and words have an apostrophe, numbers none."""
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0, velocity=(-1, 0, 0), name="=1+1")
    carom.ensemble(scene, 0.1, vary={"=1+1.velocity.x": [-2.0, -1.0]}, step=0.1).save(
        tmp_path / "runs.csv"
    )
    carom.simulate(scene, 0.1, step=0.1).save(tmp_path / "run.csv")
    cells = [
        cell
        for path in tmp_path.iterdir()
        for row in csv.reader(path.read_text().splitlines())
        for cell in row
    ]
    assert {cell for cell in cells if cell[:1] in tuple("=+-@")} <= {
        cell for cell in cells if is_number(cell)
    }
    assert {"'=1+1.vx", "-1.0", "-2.0"} <= set(cells)


def is_number(cell):
    try:
        float(cell)
    except ValueError:
        return False
    return True


def test_files_are_what_their_names_say(thrown, tmp_path):
    """Others read them."""
    for module in ("xarray", "zarr", "pyarrow", "h5netcdf"):
        pytest.importorskip(module)
    import xarray
    import zarr

    for ending in (".nc", ".zarr", ".parquet", ".csv"):
        thrown.save(tmp_path / f"runs{ending}")
    z = thrown.position[:, 0, 2]
    with xarray.open_dataset(tmp_path / "runs.nc", engine="h5netcdf") as data:
        assert np.array_equal(data.position[:, 0, 2], z, equal_nan=True)
        laws = thrown.inputs["die-ground.impact_law"]
        assert np.array_equal(data["input:die-ground.impact_law"], laws)
    group = zarr.open_group(tmp_path / "runs.zarr")
    assert np.array_equal(group["outcomes/position"][:, 0, 2], z, equal_nan=True)
    text = pandas.read_csv(tmp_path / "runs.csv")
    assert np.allclose(text["die.z"], z, rtol=1e-15, equal_nan=True)
    table = pandas.read_parquet(tmp_path / "runs.parquet")
    assert np.array_equal(table["die.z"], z, equal_nan=True)


@pytest.mark.parametrize("ending", [".nc", ".zarr", ".parquet"])
def test_a_grid_and_a_slash_in_files(tmp_path, ending):
    """Names of models have slashes, which lead into folders in files."""
    pytest.importorskip(NEEDS[ending])
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0, name="arm/hand")
    axes = {"arm/hand.mass": [1.0, 2.0], "arm/hand.velocity.x": [0.0, 1.0, 2.0]}
    vary = {name: carom.Grid(values) for name, values in axes.items()}
    made = carom.ensemble(scene, 0.1, step=0.05, vary=vary, executor="serial")
    made.save(tmp_path / f"runs{ending}")
    again = carom.Ensemble.load(tmp_path / f"runs{ending}")
    assert same(again, made)
    assert {name: values.tolist() for name, values in again.grid.items()} == axes
    assert list(again.grid) == list(axes)
    assert np.array_equal(again.inputs["arm/hand.mass"], made.inputs["arm/hand.mass"])


def test_a_folder_without_names_of_bodies_is_read(tmp_path):
    """As carom 0.1.0 wrote them; their bodies have numbers, and the order of inputs is that of the letters."""
    for module in ("zarr", "pyarrow"):
        pytest.importorskip(module)
    import zarr

    vary = {"die.mass": [1.0, 2.0], "die-ground.friction": [0.1, 0.2]}
    made = carom.ensemble(die(), 0.02, step=5e-3, vary=vary, executor="serial")
    made.save(tmp_path / "old.zarr")
    attributes = zarr.open_group(tmp_path / "old.zarr", mode="r+").attrs
    for name in ("body_names", "names", "words"):
        del attributes[name]
    old = carom.Ensemble.load(tmp_path / "old.zarr")
    assert same(old, made)
    assert np.array_equal(old.to_pandas()["body1.z"], made.position[:, 0, 2])
    old.save(tmp_path / "new.parquet")
    assert same(carom.Ensemble.load(tmp_path / "new.parquet"), made)


def test_what_is_no_file_of_an_ensemble(thrown, tmp_path):
    with pytest.raises(ValueError, match=r"path must end in \.zarr, \.nc"):
        thrown.save(tmp_path / "runs.txt")
    with pytest.raises(ValueError, match="folder that exists"):
        thrown.save(tmp_path / "no" / "runs.nc")
    with pytest.raises(FileNotFoundError, match=r"nothing\.nc does not exist"):
        carom.Ensemble.load(tmp_path / "nothing.nc")
    pytest.importorskip("h5netcdf")
    (tmp_path / "mine.nc").write_bytes(b"mine")
    with pytest.raises(ValueError, match="must be an ensemble of carom"):
        carom.Ensemble.load(tmp_path / "mine.nc")
    (tmp_path / "a.csv").write_text("run")
    with pytest.raises(ValueError, match="got the table"):
        carom.Ensemble.load(tmp_path / "a.csv")
    one = {"vary": {"die.mass": [1.0]}, "step": 5e-3, "executor": "serial"}
    with pytest.raises(ValueError, match=r"save must be a folder, such as 'e\.zarr', because"):
        carom.ensemble(die(), 0.1, save=tmp_path / "e.nc", **one)
    odd = carom.ensemble(die(), 0.01, observe=lambda solution: {"z": 1j}, **one)
    with pytest.raises(ValueError, match=r"got complex numbers; save as .zarr"):
        odd.save(tmp_path / "odd.nc")
    pytest.importorskip("zarr")
    (tmp_path / "mine.zarr").mkdir()
    (tmp_path / "mine.zarr" / "notes.txt").write_text("keep me")
    with pytest.raises(ValueError, match="must be an ensemble of carom"):
        thrown.save(tmp_path / "mine.zarr")
    assert (tmp_path / "mine.zarr" / "notes.txt").exists()


def test_a_table_is_varied(thrown):
    """That of an ensemble gives the same runs again, with columns for components."""
    names = [*list(thrown.inputs)[:2], *(f"die.velocity.{axis}" for axis in "xyz")]
    table = thrown.to_pandas()[names]
    again = carom.ensemble(die(), 0.2, step=2e-3, vary=table, observe=look, executor="serial")
    assert same(again, thrown)


def test_a_generator_goes_on():
    def masses(seed):
        given = {"vary": {"die.mass": uniform(0.01, 0.02)}, "step": 5e-3, "runs": 3, "seed": seed}
        return carom.ensemble(die(), 0.01, executor="serial", **given).inputs["die.mass"].tolist()

    assert masses(7) == masses(np.random.default_rng(7))
    generator = np.random.default_rng(7)
    generator.random(2)
    assert masses(generator)[0] == masses(7)[2]
    for wrong in (1.5, None, "seven", -1):
        with pytest.raises(ValueError, match="seed must be"):
            masses(wrong)


def test_processes_take_what_can_be_imported():
    given = {"step": 5e-3, "vary": {"die.mass": [1.0]}, "executor": "processes"}
    with pytest.raises(ValueError, match=r"observe must be what a process can import \(no lambda"):
        carom.ensemble(die(), 0.01, observe=lambda solution: {}, **given)
    with pytest.raises(ValueError, match="scene must be what a process can import"):
        carom.ensemble(lambda mass: die(), 0.01, **{**given, "vary": {"mass": [1.0]}})


def test_a_script_without_a_main_guard(monkeypatch):
    """In the process that imports the script, and in the one that waits for it."""
    monkeypatch.setattr(multiprocessing.current_process(), "_inheriting", True, raising=False)
    with pytest.raises(RuntimeError, match='below `if __name__ == "__main__":`'):
        carom.ensemble(die(), 0.01, step=5e-3, vary={"die.mass": [1.0]}, executor="processes")

    def broken(*task):
        raise BrokenProcessPool

    with pytest.raises(
        RuntimeError, match=r'a process ended .* below `if __name__ == "__main__":`'
    ):
        list(engines.each(iter([()]), broken, "serial", None, lambda: None, []))


@pytest.mark.parametrize("name", ["dask", "distributed"])
def test_dask_is_a_client(name):
    with pytest.raises(ValueError, match=r"a client of dask.*executor=distributed\.Client\(\)"):
        carom.ensemble(die(), 0.01, step=5e-3, vary={"die.mass": [1.0]}, executor=name)
