"""Files that are none of a run, and savings that fail: what is said, and what is left."""

import errno
import os
import shutil
import subprocess
import sys

import h5py
import numpy as np
import pytest

import carom
from carom.io.files import disk, sealed, writing
from carom.io.files.scene_data import Encoder
from files.compare import differences
from files.made_up import rewrite
from simulate.scenes import die

LOADERS = (carom.Solution.load, carom.resume)


@pytest.mark.parametrize("load", LOADERS)
def test_no_file(load, tmp_path):
    with pytest.raises(FileNotFoundError, match=r"got '.*none\.nc': it does not exist"):
        load(tmp_path / "none.nc")


@pytest.mark.parametrize("load", LOADERS)
def test_another_kind_of_file(load, tmp_path):
    (tmp_path / "a.nc").write_text("time,x\n0,1\n")
    with pytest.raises(
        ValueError, match=r"a\.nc': it is not HDF5.*give a file that Solution\.save"
    ):
        load(tmp_path / "a.nc")
    with pytest.raises(ValueError, match="it is a folder"):
        load(tmp_path)
    with h5py.File(tmp_path / "b.h5", "w") as file:
        file["x"] = [1.0, 2.0]
    with pytest.raises(ValueError, match=r"b\.h5': it is HDF5 without the end that carom writes"):
        load(tmp_path / "b.h5")


@pytest.mark.parametrize("part", [0.0, 0.01, 0.5, 0.99])
def test_truncated(part, path):
    whole = path.read_bytes()
    path.write_bytes(whole[: int(part * len(whole))])
    with pytest.raises(ValueError, match=r"path must be a file of a run, got '.*run\.nc': it is "):
        carom.Solution.load(path)


def test_newer_format(path, monkeypatch):
    newer = sealed.FORMAT + 1
    monkeypatch.setattr(sealed, "FORMAT", newer)
    rewrite_as_it_is = path.read_bytes()[: -sealed.LENGTH]
    line = (sealed.BEFORE % (newer, 0)).encode()
    digest = sealed.hashlib.sha256(rewrite_as_it_is + line).hexdigest()
    path.write_bytes(rewrite_as_it_is + line + f"{digest}\n".encode())
    monkeypatch.undo()
    with pytest.raises(
        ValueError, match=rf"in format {newer - 1}, got .* in format {newer}: update"
    ):
        carom.Solution.load(path)


@pytest.mark.parametrize("lost", ["position", "records/snapshot_v0", "held_point"])
def test_lost_part(lost, path):
    rewrite(path, lambda index: index["arrays"].pop(lost) and None)
    with pytest.raises(ValueError, match=r"run\.nc': a part of it is missing or broken \(KeyError"):
        carom.Solution.load(path)


def test_turns_of_joints_that_are_not_there(saved, tmp_path):
    """Rows of a run that goes on have a place for each angle of the scene, and no other."""
    path = tmp_path / "run.nc"
    path.write_bytes(saved["swung"])
    rewrite(path, lambda index: index["sizes"].update(turn=index["sizes"]["turn"] - 1))
    with pytest.raises(ValueError, match=r"it has \d angles of joints, and the scene \d"):
        carom.Solution.load(path)


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
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_saving_that_fails_leaves_the_old_file(thrown, path, monkeypatch):
    before = path.read_bytes()
    monkeypatch.setattr(disk.os, "fsync", full)
    with pytest.raises(OSError, match=r"No space left on device; nothing was written.*run\.nc"):
        thrown.save(path)
    assert path.read_bytes() == before
    assert [p.name for p in path.parent.iterdir()] == ["run.nc"]


def writes_nothing(file, one, create=writing._create):
    """A bug: zeros in the place of the numbers."""
    numbers = one.data.dtype.kind == "f"
    return create(file, one._replace(data=np.zeros_like(one.data)) if numbers else one)


def test_hdf5_that_fails(thrown, path, monkeypatch):
    def fails(*arguments):
        raise RuntimeError("Unable to flush file's cached information")

    monkeypatch.setattr(writing, "_create", fails)
    with pytest.raises(OSError, match=r"run\.nc' could not be written and is unchanged: HDF5"):
        thrown.save(path)
    monkeypatch.setattr(writing, "_create", writes_nothing)
    with pytest.raises(OSError, match="HDF5 has not written 'time' as it was given"):
        thrown.save(path)
    monkeypatch.undo()
    assert differences(carom.Solution.load(path), thrown) == []


@pytest.mark.parametrize(
    ("package", "use"),
    [
        ("h5netcdf", lambda run, path: run.save(path)),
        ("h5netcdf", lambda run, path: carom.simulate(die(), 0.1, step=0.01, save=path)),
        ("xarray", lambda run, path: run.to_xarray()),
        ("pandas", lambda run, path: run.to_pandas()),
    ],
)
def test_without_its_packages(package, use, thrown, path, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ImportError, match=rf'{package}; .*\n\n    pip install "carom\[files\]"'):
        use(thrown, path)


def test_a_copy_is_the_same(thrown, path, tmp_path):
    shutil.copy(path, tmp_path / "copy.nc")
    assert differences(carom.Solution.load(str(tmp_path / "copy.nc")), thrown) == []


def test_a_full_disk_does_not_end_a_run(thrown, path, monkeypatch):
    monkeypatch.setattr(disk.os, "fsync", full)
    with (
        pytest.warns(
            RuntimeWarning, match="could not be saved to .* and continues: .*No space left"
        ),
        pytest.raises(
            carom.SimulationError, match="ended, but its result could not be saved"
        ) as lost,
    ):
        carom.simulate(die(), 0.25, step=5e-3, save=path, save_seconds=0.0)
    assert differences(lost.value.solution, thrown) == []
    with pytest.warns(RuntimeWarning, match="ended, but its result could not be saved"):
        kept = carom.simulate(die(), 0.25, step=5e-3, save=path, throw=False)
    assert kept.success
    assert differences(carom.Solution.load(path), thrown) == []  # what was there before


def test_what_no_file_can_hold_is_refused_first(tmp_path, monkeypatch):
    def refuses(*arguments):
        raise TypeError("a value cannot be written to a file")

    steps = []
    monkeypatch.setattr(Encoder, "part", refuses)
    with pytest.raises(TypeError, match="cannot be written to a file"):
        carom.simulate(
            die(),
            0.25,
            step=5e-3,
            save=tmp_path / "run.nc",
            progress=lambda *done: steps.append(done),
        )
    assert steps == []


def test_loading_needs_no_hdf5(thrown, path):
    code = """
import sys
for name in ("h5py", "h5netcdf", "xarray"):
    sys.modules[name] = None
import carom
print(len(carom.Solution.load(sys.argv[1]).t))
"""
    command = [sys.executable, "-c", code, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert int(done.stdout) == len(thrown.t)
