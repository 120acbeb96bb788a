"""A solution as an xarray Dataset, as pandas tables, and as files of these: one for each table."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom import checks
from carom.io.files.disk import put
from carom.io.files.layout import EVENT, HELD, IMPACT, INTERVAL, LEDGER
from carom.io.files.variables import attributes, labelled
from carom.results.names import contact_names

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

#: short names of the columns of a body
BODY = {
    "position": ("x", "y", "z"),
    "orientation": ("qw", "qx", "qy", "qz"),
    "velocity": ("vx", "vy", "vz"),
    "angular_velocity": ("wx", "wy", "wz"),
}
ENDS = {"axis": ("x", "y", "z"), "contact_axis": ("n", "t1", "t2")}


class Frames(NamedTuple):
    """The tables of a run, each a `pandas.DataFrame`, in SI units. `Solution.to_pandas` makes them."""

    bodies: pd.DataFrame
    """One row for each saved time, columns (body, quantity): ``bodies["die"].z`` is a height over time.
    The quantities are x, y, z, the quaternion qw, qx, qy, qz, and the velocities vx, vy, vz and wx, wy, wz.
    ``bodies.stack(0)`` is the long form."""
    energy: pd.DataFrame
    """One row for each saved time: kinetic and potential energy, and the entries of the ledger [J]."""
    impacts: pd.DataFrame
    """One row for each point of each impact. Vectors are columns ``impulse_n``, ``impulse_t1``, ...,
    ``point_x``, ...; contact, body and other (the half-space or body that it strikes) are names."""
    events: pd.DataFrame
    """One row for each event: time, kind, contact."""
    contacts: pd.DataFrame
    """One row for each interval of persistent contact: contact, feature, start, end, mode."""
    forces: pd.DataFrame
    """One row for each active point and saved time: time, contact, body, other, mode, point, force."""


def to_xarray(solution) -> xr.Dataset:
    """Return the whole solution as a Dataset."""
    xarray = checks.need("xarray", "to_xarray", "files")
    variables = {
        one.name: xarray.Variable(one.dims, one.data, one.attrs) for one in labelled(solution)
    }
    return xarray.Dataset(variables, attrs=attributes(solution))


def to_pandas(solution) -> Frames:
    """Return the tables of a solution."""
    pandas = checks.need("pandas", "to_pandas", "files")
    scene = solution.scene
    contacts = contact_names(scene, solution.pairs).name.astype(object)
    bodies = np.array([body.name for body in scene.bodies], dtype=object)
    time = pandas.Index(solution.t, name="time")
    blocks = [getattr(solution, name) for name in BODY]
    names = [(body, q) for body in bodies for columns in BODY.values() for q in columns]
    motion = np.concatenate(blocks, axis=2).reshape(len(time), -1)
    columns = pandas.MultiIndex.from_tuples(names, names=["body", "quantity"])
    energy = {"kinetic": solution.kinetic_energy, "potential": solution.potential_energy}
    energy |= {name: getattr(solution.ledger, name) for name in LEDGER}
    tables = [
        _expanded(columns, table)
        for columns, table in (
            (IMPACT, solution.impacts), (EVENT, solution.events), (INTERVAL, solution.contacts),
            (HELD, solution.forces),
        )
    ]  # fmt: skip
    for table in tables:
        table["contact"] = contacts[table["contact"]]
    for name in ("body", "other", "unit"):
        tables[0][name] = getattr(solution.impacts, name).astype(object)
    forces = {"time": solution.t[tables[3].pop("saved")], **tables[3]}
    forces["body"] = bodies[forces["body"]]
    other = forces["other"]
    forces["other"] = np.where(other < 0, "", bodies[other]) if len(other) else other.astype(object)
    frames = (pandas.DataFrame(table) for table in (*tables[:3], forces))
    return Frames(
        pandas.DataFrame(motion, index=time, columns=columns),
        pandas.DataFrame(energy, index=time),
        *frames,
    )


def _expanded(columns: dict, table) -> dict[str, np.ndarray]:
    """Return columns of a table, one for each component of a vector."""
    out = {}
    for name, (dims, _, _) in columns.items():
        data = getattr(table, name)
        if not dims:
            out[name] = data
        elif len(dims) == 1:
            for k, end in enumerate(ENDS[dims[0]]):
                out[f"{name}_{end}"] = data[:, k]
        else:
            ends = ENDS["contact_axis"]
            out |= {
                f"{name}_{a}_{b}": data[:, i, j]
                for i, a in enumerate(ends)
                for j, b in enumerate(ends)
            }
    return out


#: suffixes of files that hold all of a run, and of those that hold a table of it
RUN, TABLES = (".nc", ".h5", ".hdf5"), (".csv", ".parquet")


def is_table(path: Path) -> bool:
    """Return whether a file name is that of a table; refuse a name without a known suffix."""
    if path.suffix.lower() in TABLES:
        return True
    if path.suffix.lower() in RUN:
        return False
    raise ValueError(
        f"path must end in {', '.join(RUN)} (the whole run) or in {' or '.join(TABLES)} (its tables), got "
        f"{str(path)!r}"
    )


def write_tables(path: Path, solution) -> None:
    """Write the motion of the bodies to `path`, and the other tables beside it: ``run.impacts.csv``, ..."""
    kind = path.suffix.lower()
    if kind == ".parquet":
        checks.need("pyarrow", "saving as .parquet", "parquet")
    for name, frame in to_pandas(solution)._asdict().items():
        if name in ("bodies", "energy"):  # the time is a column as others are
            frame = frame.reset_index()
        if name == "bodies":
            frame.columns = [".".join(filter(None, pair)) for pair in frame.columns]
        where = path if name == "bodies" else path.with_suffix(f".{name}{path.suffix}")
        put(where, [_bytes(frame, kind)])


def _bytes(frame, kind: str) -> bytes:
    if kind == ".csv":
        return frame.to_csv(index=False).encode()
    out = io.BytesIO()
    frame.to_parquet(out, engine="pyarrow", index=False)
    return out.getvalue()
