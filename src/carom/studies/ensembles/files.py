"""An ensemble as a Dataset, and in files by their endings: netCDF-4 (HDF5), Zarr, Parquet, CSV."""

from __future__ import annotations

import hashlib
import io
import json
import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import checks
from carom.io.files.convert import RUN, csv_of
from carom.io.files.disk import put, replace_folder
from carom.io.files.layout import Variable
from carom.io.files.sealed import agrees, with_digest
from carom.io.files.writing import hdf5
from carom.studies.ensembles.outcome import Layout, no_outcomes
from carom.studies.ensembles.store import Store, from_file, in_file, is_begun
from carom.studies.ensembles.table import (
    AXES,
    WORDS,
    columns,
    from_columns,
    layout_of,
    messages,
    shapes,
)  # fmt: skip

if TYPE_CHECKING:
    from carom.studies.ensembles.result import Ensemble

FORMAT = "carom ensemble in one file 2"
OLDER = "carom ensemble in one file 1"  # the same without a digest
#: after the HDF5 data, where HDF5 does not read, before the SHA-256 of all bytes
DIGEST = b"\ncarom ensemble, sha256 "
DAMAGED = "it is damaged: its digest does not agree with its {}"
FILES = (*RUN, ".parquet", ".csv")
FACTS = ("carom", "settings", "grid")  # of `Ensemble.about`, in all files
UNITS = {
    "t": "s", "rest_time": "s", "first_impact": "s", "position": "m", "velocity": "m/s",
    "angular_velocity": "rad/s", "kinetic_energy": "J", "impact_loss": "J",
    "friction_loss": "J", "bounce_loss": "J", "load_work": "J",
}  # fmt: skip
DIMS = {3: ("axis", AXES[(3,)]), 4: ("quaternion", AXES[(4,)])}
PARTS = {"bodies": "body", "coordinates": "coordinate"}  # dimensions of states
PREFIXES = {"input:": "inputs", "observed:": "observed"}


def facts_of(ensemble: Ensemble) -> dict[str, str]:
    """Return the attributes of the ensemble, as texts."""
    found = {name: ensemble.about[name] for name in FACTS if name in ensemble.about}
    return {**found, **layout_of(ensemble).fact}


def labelled(ensemble: Ensemble) -> list[Variable]:
    """Return all arrays with their dimensions: the axes of the grid, or `run`."""
    grid = ensemble.grid
    lead = tuple(map(in_file, grid)) or ("run",)
    sizes = tuple(map(len, grid.values())) or (len(ensemble),)

    def one(name, values, dims=(), units=None, text="") -> Variable:
        values = values.reshape(*sizes, *values.shape[1:])
        return Variable(in_file(name), (*lead, *dims), values, units, text or name)

    found = [Variable(in_file(n), (in_file(n),), values, None, n) for n, values in grid.items()]
    found.append(one("run", np.arange(len(ensemble)), text="number of the run"))
    layout = layout_of(ensemble)
    part = PARTS[layout.of]
    found.append(Variable(part, (part,), np.array(layout.names, object), None, layout.of))
    state = {name: (part, *(DIMS[n][0] for n in shape)) for name, shape in layout.fields.items()}
    for dim, labels in DIMS.values():
        if any(dim in dims for dims in state.values()):
            found.append(Variable(dim, (dim,), np.array(labels, object), None, "components"))
    for name in ensemble.outcomes.dtype.names or ():
        values = ensemble.outcomes[name]
        dims = state.get(name, ())
        text = (
            "; ".join(f"{code} {word}" for code, word in WORDS.items()) if name == "status" else ""
        )
        found.append(one(name, values, dims, UNITS.get(name), text))
    found.append(one("message", messages(ensemble)))
    for prefix, folder in PREFIXES.items():
        for name, values in getattr(ensemble, folder).items():
            more = [f"{in_file(name)}_{k}" for k in range(1, values.ndim)]
            found.append(one(f"{prefix}{name}", values, more))
    return found


def to_xarray(ensemble: Ensemble):
    """Return the ensemble as a Dataset."""
    xarray = checks.need("xarray", "to_xarray", "ensemble")
    made = {
        one.name.replace("%2F", "/"): xarray.Variable(
            tuple(map(from_file, one.dims)), one.data, one.attrs
        )
        for one in labelled(ensemble)
    }
    return xarray.Dataset(made, attrs=facts_of(ensemble)).set_coords("run")


def to_pandas(ensemble: Ensemble):
    """Return the ensemble as a table."""
    pandas = checks.need("pandas", "to_pandas", "files")
    return pandas.DataFrame(columns(ensemble), index=pandas.RangeIndex(len(ensemble), name="run"))


def save(path: Path, ensemble: Ensemble) -> None:
    """Write an ensemble by the ending of its path."""
    kind = path.suffix.lower()
    if kind not in (*FILES, ".zarr"):
        raise ValueError(
            f"path must end in .zarr, {', '.join(RUN)} or .parquet (which can be loaded), or in .csv, got "
            f"{str(path)!r}"
        )
    if kind == ".zarr":
        _save_zarr(path, ensemble)
    elif kind in RUN:
        _save_netcdf(path, ensemble)
    else:
        if kind == ".parquet":
            checks.need("pyarrow", "saving as .parquet", "parquet")
        frame = to_pandas(ensemble)
        if kind == ".csv":
            put(path, [csv_of(frame)])
            return
        known = {"format": FORMAT, "about": facts_of(ensemble), "layout": shapes(ensemble)}
        known["digest"] = _digest_of(vars(ensemble))
        frame.attrs = {"carom": json.dumps(known)}
        out = io.BytesIO()
        frame.to_parquet(out, engine="pyarrow")
        put(path, [out.getvalue()])


def load(path: Path) -> dict[str, Any]:
    """Return the fields of the ensemble in a file.

    Raises
    ------
    FileNotFoundError, ValueError
        If there is no such file, or it is not a file of an ensemble.
    """
    if not path.exists():
        raise FileNotFoundError(f"{path} does not exist; Ensemble.save makes such a file")
    kind = path.suffix.lower()
    if kind == ".csv":
        raise ValueError(f"path must be a file that can be loaded, got the table {str(path)!r}")
    if kind == ".parquet":
        checks.need("pyarrow", "loading .parquet", "parquet")
        checks.need("pandas", "loading .parquet", "parquet")
    else:
        checks.need("h5netcdf", "loading an ensemble", "files")
    try:
        return _load_parquet(path) if kind == ".parquet" else _load_netcdf(path)
    except Exception as error:  # a damaged file may cause any error of a decoder
        raise ValueError(
            f"path must be an ensemble of carom, got {str(path)!r}, which cannot be read as one: {error!r}"
        ) from error


def _save_zarr(path: Path, ensemble: Ensemble) -> None:
    from carom.studies.ensembles.mark import digest
    from carom.studies.ensembles.plan import Part

    if path.exists():
        Store.open(path)  # only an ensemble is replaced
    new = path.with_name(f".{path.name}.part")
    shutil.rmtree(new, ignore_errors=True)
    about: dict[str, Any] = facts_of(ensemble)
    if ensemble._plan is not None:
        about["digest"] = digest(ensemble._plan, ensemble.inputs)
    elif "digest" in ensemble.about:
        about["digest"] = ensemble.about["digest"]
    chunk = 64
    store = Store.make(new, ensemble.inputs, layout_of(ensemble), chunk, about)
    for first in range(0, len(ensemble), chunk):
        rows = slice(first, first + chunk)
        said = {k: text for k, text in ensemble.failures.items() if first <= k < first + chunk}
        seen = {name: values[rows] for name, values in ensemble.observed.items()}
        store.write(Part(first, ensemble.outcomes[rows], said, seen))
    replace_folder(new, path)


def _save_netcdf(path: Path, ensemble: Ensemble) -> None:
    checks.need("h5netcdf", "saving an ensemble", "files")
    variables, flags = [], []
    for one in labelled(ensemble):
        if one.data.dtype.kind == "c":
            raise ValueError(
                f"{one.name!r} must be real to be saved in netCDF, got complex numbers; save as .zarr"
            )
        if one.data.dtype.kind == "b":
            flags.append(one.name)
            one = one._replace(data=one.data.astype(np.int8))
        variables.append(one)
    facts = {k: text for k, text in facts_of(ensemble).items() if k in ("carom", "settings")}
    attributes = {**facts, "format": FORMAT, "flags": json.dumps(flags)}
    put(path, with_digest([hdf5(variables, attributes)[0], DIGEST]))


def _load_netcdf(path: Path) -> dict[str, Any]:
    import h5netcdf

    data = memoryview(path.read_bytes())
    sealed = bytes(data[-len(DIGEST) - 65 : -65]) == DIGEST
    if sealed and not agrees(data):  # before HDF5 reads it: it crashes on some damaged files
        raise ValueError(DAMAGED.format("bytes"))
    with h5netcdf.File(io.BytesIO(data), "r") as file:
        _check_format(str(file.attrs["format"]), sealed)
        flags = json.loads(str(file.attrs["flags"]))
        lead = file.variables["status"].dimensions
        arrays = {name: _values(one[...]) for name, one in file.variables.items()}
        about = {
            name: str(file.attrs[name]) for name in ("carom", "settings") if name in file.attrs
        }
    runs = arrays["status"].size
    rows = {
        name: values.reshape(runs, *values.shape[len(lead) :]) if name not in lead else values
        for name, values in arrays.items()
        if name not in (*PARTS.values(), "axis", "quaternion")
    }
    layout = next(
        Layout(tuple(arrays[part].tolist()), of) for of, part in PARTS.items() if part in arrays
    )
    about |= layout.fact
    if lead != ("run",):
        about["grid"] = json.dumps({from_file(name): arrays[name].tolist() for name in lead})
    outcomes = no_outcomes(runs, layout)
    for name in outcomes.dtype.names or ():
        outcomes[name] = rows[name]
    said = enumerate(rows["message"].tolist())
    fields = {
        "about": about,
        "outcomes": outcomes,
        "failures": {k: text for k, text in said if text},
    }
    for prefix, folder in PREFIXES.items():
        fields[folder] = {
            from_file(name).removeprefix(prefix): values.astype(bool) if name in flags else values
            for name, values in rows.items()
            if name.startswith(prefix)
        }
    return fields


def _values(values) -> np.ndarray:
    """Return an array of a file; words as such."""
    values = np.asarray(values)
    if values.dtype.kind not in "OSU":
        return values
    words = [one.decode() if isinstance(one, bytes) else one for one in values.ravel().tolist()]
    return np.array(words, dtype=str).reshape(values.shape)


def _load_parquet(path: Path) -> dict[str, Any]:
    import pandas

    frame = pandas.read_parquet(path, engine="pyarrow")
    known = json.loads(frame.attrs["carom"])
    found = {name: np.array(frame[name].tolist()) for name in frame.columns}
    fields = from_columns(found, known["layout"], known["about"])
    _check_format(known["format"], "digest" in known)
    if "digest" in known and _digest_of(fields) != known["digest"]:
        raise ValueError(DAMAGED.format("numbers"))
    return fields


def _check_format(form: str, sealed: bool) -> None:
    if form != (FORMAT if sealed else OLDER):
        raise ValueError(
            f"it is of format {form!r} {'with' if sealed else 'without'} a digest, not {FORMAT!r}"
        )


def _digest_of(fields: dict[str, Any]) -> str:
    """Return the SHA-256 of all numbers and words of an ensemble, as they are before and after a file."""
    one, found = SimpleNamespace(**fields), hashlib.sha256()
    outcomes = {name: one.outcomes[name] for name in one.outcomes.dtype.names}
    for table in (outcomes, one.inputs, one.observed):
        for name, values in sorted(table.items()):
            kind = values.dtype.kind
            found.update(f"{name} {kind} {values.shape}".encode())
            if kind in "fc":  # files may keep another NaN
                values = np.where(np.isnan(values), np.full_like(values, np.nan), values)
            if kind in "OSU":
                found.update(json.dumps(values.tolist()).encode())
            else:
                found.update(np.ascontiguousarray(values).tobytes())
    said = [one.about.get(name, "") for name in ("carom", "settings")]
    words = [said, list(layout_of(one).names), json.loads(one.about.get("grid", "{}"))]
    words.append(sorted((int(k), str(text)) for k, text in one.failures.items()))
    found.update(json.dumps(words).encode())
    return found.hexdigest()


def check_folder(save: Path) -> None:
    """Refuse the name of a file for outcomes that are written during the runs."""
    if save.suffix.lower() in FILES and not is_begun(save):
        raise ValueError(
            f"save must be a folder, such as {save.with_suffix('.zarr').name!r}, because outcomes are written "
            f"during the runs, got {str(save)!r}; Ensemble.save writes a file at the end"
        )
