"""Files that are none of a run, and savings that fail: what is said, and what is left."""

import shutil
import sys

import h5py
import pytest

import carom
from carom.files import writing
from files.compare import differences
from simulate.scenes import die

LOADERS = (carom.Solution.load, carom.resume)


@pytest.fixture
def path(thrown, tmp_path):
    """The file of a run."""
    thrown.save(tmp_path / "run.nc")
    return tmp_path / "run.nc"


@pytest.mark.parametrize("load", LOADERS)
def test_no_file(load, tmp_path):
    with pytest.raises(FileNotFoundError, match=r"got '.*none\.nc': there is none"):
        load(tmp_path / "none.nc")


@pytest.mark.parametrize("load", LOADERS)
def test_another_kind_of_file(load, tmp_path):
    (tmp_path / "a.nc").write_text("time,x\n0,1\n")
    with pytest.raises(
        ValueError, match=r"a\.nc': it is not HDF5.*allowed is a file that Solution\.save"
    ):
        load(tmp_path / "a.nc")
    with pytest.raises(ValueError, match="it is a folder"):
        load(tmp_path)
    with h5py.File(tmp_path / "b.h5", "w") as file:
        file["x"] = [1.0, 2.0]
    with pytest.raises(ValueError, match=r"b\.h5': it is HDF5, but not from carom"):
        load(tmp_path / "b.h5")


@pytest.mark.parametrize("part", [0.0, 0.01, 0.5, 0.99])
def test_truncated(part, path):
    whole = path.read_bytes()
    path.write_bytes(whole[: int(part * len(whole))])
    with pytest.raises(ValueError, match=r"path must be a file of a run, got '.*run\.nc': it is "):
        carom.Solution.load(path)


def test_newer_format(path):
    with h5py.File(path, "a") as file:
        file.attrs["carom_format"] = 2
        file.attrs["source"] = "carom 9.9"
    with pytest.raises(
        ValueError, match=r"format 1 or older, got .* in format 2, written by carom 9\.9"
    ):
        carom.Solution.load(path)


@pytest.mark.parametrize(
    "lost", ["position", "impact_law", "scene", "records/snapshot_v0", "records", "held_point"]
)
def test_lost_part(lost, path):
    with h5py.File(path, "a") as file:
        del file[lost]
    with pytest.raises(ValueError, match=r"run\.nc': a part of it is missing or broken \(KeyError"):
        carom.Solution.load(path)


@pytest.mark.parametrize("text", ["{", "[]", '{"gravity": [0, 0, -9.81]}'])
def test_broken_scene(text, path):
    with h5py.File(path, "a") as file:
        file["scene"][()] = text
    with pytest.raises(ValueError, match="a part of it is missing or broken"):
        carom.Solution.load(path)


def test_broken_options(path):
    with h5py.File(path, "a") as file:
        file.attrs["options"] = '{"heaps": 3}'
    with pytest.raises(ValueError, match=r"missing or broken .*heaps"):
        carom.Solution.load(path)


def test_unknown_attribute_is_no_matter(thrown, path):
    with h5py.File(path, "a") as file:
        file.attrs["note"] = "measured on a Monday"
    assert differences(carom.Solution.load(path), thrown) == []


@pytest.mark.parametrize("save", ["no/run.nc", "."])
def test_nowhere_to_save(save, thrown, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match="path must be the path of a file in a folder that exists"):
        thrown.save(save)
    with pytest.raises(ValueError, match="save must be the path of a file in a folder that exists"):
        carom.simulate(die(), 0.1, step=0.01, save=save)
    with pytest.raises(ValueError, match="save_seconds must be finite and at least 0"):
        carom.simulate(die(), 0.1, step=0.01, save="run.nc", save_seconds=-1)


def full(*arguments):
    """In the place of what writes to the disk."""
    raise OSError("no space left on device")


def test_saving_that_fails_leaves_the_old_file(thrown, path, monkeypatch):
    before = path.read_bytes()

    monkeypatch.setattr(writing, "_write_all", full)
    with pytest.raises(OSError, match="no space left"):
        thrown.save(path)
    assert path.read_bytes() == before
    assert [p.name for p in path.parent.iterdir()] == ["run.nc"]


@pytest.mark.parametrize(
    ("package", "use"),
    [
        ("h5netcdf", lambda run, path: run.save(path)),
        ("h5netcdf", lambda run, path: carom.Solution.load(path)),
        ("h5netcdf", lambda run, path: carom.simulate(die(), 0.1, step=0.01, save=path)),
        ("xarray", lambda run, path: run.to_xarray()),
        ("pandas", lambda run, path: run.to_pandas()),
    ],
)
def test_without_its_packages(package, use, thrown, path, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ImportError, match=rf'{package}: pip install "carom\[files\]"'):
        use(thrown, path)


def test_a_copy_is_the_same(thrown, path, tmp_path):
    shutil.copy(path, tmp_path / "copy.nc")
    assert differences(carom.Solution.load(str(tmp_path / "copy.nc")), thrown) == []


def test_a_full_disk_does_not_end_a_run(thrown, path, monkeypatch):
    monkeypatch.setattr(writing, "_write_all", full)
    with (
        pytest.warns(RuntimeWarning, match="could not be saved to .* and goes on: no space left"),
        pytest.raises(carom.SimulationError, match="ended and could not be saved") as lost,
    ):
        carom.simulate(die(), 0.25, step=5e-3, save=path, save_seconds=0.0)
    assert differences(lost.value.solution, thrown) == []
    with pytest.warns(RuntimeWarning, match="ended and could not be saved"):
        kept = carom.simulate(die(), 0.25, step=5e-3, save=path, throw=False)
    assert kept.success
    assert differences(carom.Solution.load(path), thrown) == []  # what was there before
