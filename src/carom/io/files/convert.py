"""A solution as an xarray Dataset, as pandas tables, and as files of these: one for each table."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom import checks
from carom.io.files.disk import put
from carom.io.files.layout import EVENT, HELD, IMPACT, INTERVAL, JOINT_IMPULSE, LEDGER
from carom.io.files.variables import attributes, has_reactions, labelled
from carom.results.exerted import rows_of
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
WRENCH = ("fx", "fy", "fz", "tx", "ty", "tz")
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
    joints: pd.DataFrame
    """One row for each saved time, columns (joint, quantity): ``joints["hinge"].coordinate``. The quantities
    are coordinate and rate (with an index if there are several: ``coordinate[0]``), force fx, fy, fz and torque
    tx, ty, tz."""
    applied_forces: pd.DataFrame
    """One row for each saved time, columns (force, quantity): fx, fy, fz and tx, ty, tz on the body, value
    (along a coordinate of a joint, or the tension of a spring) and power. The name of a user's force that acts
    on several bodies is followed by that of the body: ``drag.die``."""
    joint_impulses: pd.DataFrame
    """One row for each joint and impact: time, impact, joint, impulse, angular impulse."""


def to_xarray(solution, degrees: bool = False) -> xr.Dataset:
    """Return the whole solution as a Dataset."""
    xarray, degrees = checks.need("xarray", "to_xarray", "files"), checks.flag("degrees", degrees)
    found = labelled(solution, degrees=degrees)
    variables = {one.name: xarray.Variable(one.dims, one.data, one.attrs) for one in found}
    return xarray.Dataset(variables, attrs=attributes(solution))


def to_pandas(solution, degrees: bool = False) -> Frames:
    """Return the tables of a solution."""
    pandas, degrees = checks.need("pandas", "to_pandas", "files"), checks.flag("degrees", degrees)
    scene = solution.scene
    contacts = contact_names(scene, solution.pairs).name.astype(object)
    bodies = np.array([body.name for body in scene.bodies], dtype=object)
    time = pandas.Index(solution.t, name="time")

    def series(kind: str, columns: dict[tuple[str, str], np.ndarray]) -> pd.DataFrame:
        of = pandas.MultiIndex.from_tuples(list(columns), names=[kind, "quantity"])
        data = np.stack(list(columns.values()), axis=1) if columns else np.zeros((len(time), 0))
        return pandas.DataFrame(data, index=time, columns=of if columns else None)

    motion = {
        (body.name, q): getattr(solution, name)[:, body.index, k]
        for body in scene.bodies
        for name, columns in BODY.items()
        for k, q in enumerate(columns)
    }
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
    known = has_reactions(solution)
    impulses = _expanded(JOINT_IMPULSE, solution.joint_impulses) if known else {}
    if impulses:
        impulses["joint"] = solution.joint_impulses.name.astype(object)
    return Frames(
        bodies=series("body", motion),
        energy=pandas.DataFrame(energy, index=time),
        impacts=pandas.DataFrame(tables[0]),
        events=pandas.DataFrame(tables[1]),
        contacts=pandas.DataFrame(tables[2]),
        forces=pandas.DataFrame(forces),
        joints=series("joint", _joints(solution, degrees, known)),
        applied_forces=series("force", _applied(solution) if known else {}),
        joint_impulses=pandas.DataFrame(impulses),
    )


def _joints(solution, degrees: bool, known: bool) -> dict[tuple[str, str], np.ndarray]:
    """Return coordinates and rates of joints, and where they are known force and torque."""
    out = {}
    for joint in solution.scene.joints:
        pair = solution.joint_coordinates(joint, degrees=degrees)
        for name, values in zip(("coordinate", "rate"), pair):
            many = values.shape[1] > 1
            for k, column in enumerate(values.T):
                out[joint.name, f"{name}[{k}]" if many else name] = column
        if known:
            parts = solution.joint_reactions[:, joint.index].T
            out |= {(joint.name, name): one for name, one in zip(WRENCH, parts)}
    return out


def _applied(solution) -> dict[tuple[str, str], np.ndarray]:
    """Return what forces exert."""
    rows, data = rows_of(solution.scene), solution._exerted
    several = {row.force for k, row in enumerate(rows) if k and row.force is rows[k - 1].force}
    names = [f"{f.name}.{b.name}" if f in several else f.name for f, b in rows]
    columns = (*WRENCH, "value", "power")
    return {
        (name, column): data[:, i, k]
        for i, name in enumerate(names)
        for k, column in enumerate(columns)
    }


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
        if frame.columns.empty or (name == "joint_impulses" and not solution.scene.joints):
            continue  # of parts that the scene does not have
        if frame.index.name == "time":  # a column as others are
            frame = frame.reset_index()
        if frame.columns.nlevels > 1:
            frame.columns = [".".join(filter(None, pair)) for pair in frame.columns]
        where = path if name == "bodies" else path.with_suffix(f".{name}{path.suffix}")
        put(where, [_bytes(frame, kind)])


def _bytes(frame, kind: str) -> bytes:
    if kind == ".csv":
        return csv_of(frame, index=False)
    out = io.BytesIO()
    frame.to_parquet(out, engine="pyarrow", index=False)
    return out.getvalue()


def csv_of(frame, index: bool = True) -> bytes:
    """Return a table as CSV; words that a spreadsheet would take for a formula begin with an apostrophe."""
    words = frame.select_dtypes(exclude="number").columns
    frame = frame.assign(**{name: frame[name].map(_no_formula) for name in words})
    return frame.rename(columns=_no_formula).to_csv(index=index).encode()


def _no_formula(cell):
    """Return a cell; a word that begins with = + - @ or a control character with an apostrophe before it."""
    return (
        f"'{cell}"
        if isinstance(cell, str) and cell[:1] in ("=", "+", "-", "@", "\t", "\r")
        else cell
    )
