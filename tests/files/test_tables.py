"""The suffix of a file decides what is written: all of a run, tables, or nothing."""

import numpy as np
import pandas as pd
import pytest

import carom
from simulate.scenes import die


def same(read, written):
    """All digits are there; readers may round the last."""
    np.testing.assert_allclose(read, written, rtol=1e-14, atol=0)


def test_csv(slid, tmp_path):
    slid.save(tmp_path / "run.csv")
    names = [
        "run.csv",
        *(f"run.{n}.csv" for n in ("contacts", "energy", "events", "forces", "impacts")),
    ]
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(names)
    motion = pd.read_csv(tmp_path / "run.csv")
    same(motion["time"], slid.t)
    same(motion["block.vz"], slid.velocity[:, 0, 2])
    impacts = pd.read_csv(tmp_path / "run.impacts.csv")
    assert set(impacts.contact) == {"block-ground"}
    same(impacts.impulse_n, slid.impacts.impulse[:, 0])
    energy = pd.read_csv(tmp_path / "run.energy.csv")
    same(energy.kinetic, slid.kinetic_energy)


def test_parquet(slid, tmp_path):
    pytest.importorskip("pyarrow")
    slid.save(tmp_path / "run.parquet")
    motion = pd.read_parquet(tmp_path / "run.parquet")
    np.testing.assert_array_equal(motion["block.vz"], slid.velocity[:, 0, 2])
    assert len(pd.read_parquet(tmp_path / "run.impacts.parquet")) == len(slid.impacts)


@pytest.mark.parametrize("name", ["run", "run.txt", "run.mat", "run.pickle"])
def test_other_suffixes_are_refused(slid, tmp_path, name):
    ends = r"must end in \.nc, \.h5, \.hdf5"
    with pytest.raises(ValueError, match=rf"path {ends} .*\.csv or \.parquet.*, got '.*{name}'"):
        slid.save(tmp_path / name)
    with pytest.raises(ValueError, match=rf"save {ends}, got '.*{name}'"):
        carom.simulate(die(), 0.1, step=0.01, save=tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_no_table_is_written_as_a_run_goes(tmp_path):
    with pytest.raises(
        ValueError, match=r"save must end in .*; tables are .* Solution\.save\('.*x\.csv'\)"
    ):
        carom.simulate(die(), 0.1, step=0.01, save=tmp_path / "x.csv")
