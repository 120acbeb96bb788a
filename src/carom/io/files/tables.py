"""Tables of a run as CSV or Parquet, one file for each table."""

from __future__ import annotations

import io
from pathlib import Path

from carom.io.files.convert import to_pandas
from carom.io.files.disk import put
from carom.io.files.needs import need

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
        need("pyarrow", "saving as .parquet", "parquet")
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
