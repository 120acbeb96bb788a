"""An ensemble on disk: a Zarr group that grows by whole parts, and can be gone on with.

A part is there when its `status` is: that is written last. So whatever an interruption leaves behind, what
can be read is right, and what cannot is done again.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from carom.ensembles.outcome import PENDING, outcome_type
from carom.ensembles.plan import Part

FORMAT = "carom ensemble 1"


def _zarr():
    try:
        import zarr
    except ImportError as error:
        raise ImportError(
            'save needs the package zarr; try: pip install "carom[ensemble]"'
        ) from error
    return zarr


class Store:
    """The arrays of an ensemble under a path."""

    def __init__(self, path, group: Any):
        self.path, self.group = Path(path), group

    @classmethod
    def make(cls, path, inputs: dict[str, np.ndarray], bodies: int, chunk: int, about: dict):
        """Return a new store, nothing of which has been done."""
        zarr = _zarr()
        path = Path(path)
        if path.exists() and (not path.is_dir() or any(path.iterdir())):
            raise FileExistsError(
                f"save: {path} is there and is no ensemble of carom; give another path"
            )
        group = zarr.open_group(str(path), mode="w")
        runs = len(next(iter(inputs.values())))
        for name, values in inputs.items():
            _array(group, f"inputs/{name}", values.shape, values.dtype, chunk)[:] = values
        kind = outcome_type(bodies)
        for name in kind.names or ():
            base, shape = kind[name].base, kind[name].shape
            fill = PENDING if name == "status" else (0 if base.kind == "i" else np.nan)
            _array(group, f"outcomes/{name}", (runs, *shape), base, chunk, fill)
        group.attrs.update({**about, "format": FORMAT, "chunk": chunk, "bodies": bodies})
        return cls(path, group)

    @classmethod
    def open(cls, path):
        """Return a store that is there; refuse what is none."""
        zarr = _zarr()
        if not Path(path).exists():
            raise FileNotFoundError(f"{path} is not there; an ensemble is saved with save=")
        try:
            group = zarr.open_group(str(path), mode="r+")
            known = group.attrs.get("format")
        except Exception as error:
            raise ValueError(
                f"{path} must be an ensemble of carom, but cannot be read: {error}"
            ) from None
        if known != FORMAT:
            raise ValueError(f"{path} must be of format {FORMAT!r}, got {known!r}")
        return cls(path, group)

    @property
    def chunk(self) -> int:
        """Runs in a part."""
        return int(self.group.attrs["chunk"])

    @property
    def about(self) -> dict:
        """What was noted when the store was made."""
        return dict(self.group.attrs)

    def done(self) -> np.ndarray:
        """Return which runs have been made (runs,)."""
        return np.asarray(self.group["outcomes/status"][:]) != PENDING

    def write(self, part: Part) -> None:
        """Write a part, its status last."""
        rows = slice(part.first, part.first + len(part.outcomes))
        for name, values in part.observed.items():
            key = f"observed/{name}"
            if key not in self.group:
                runs = self.group["outcomes/status"].shape[0]
                _array(self.group, key, (runs, *values.shape[1:]), values.dtype, self.chunk)
            self.group[key][rows] = values
        if part.failures:
            folder = self.path / "failures"
            folder.mkdir(exist_ok=True)
            text = json.dumps({str(k): message for k, message in part.failures.items()})
            (folder / f"{part.first}.json").write_text(text, encoding="utf-8")
        names = [name for name in part.outcomes.dtype.names or () if name != "status"]
        for name in [*names, "status"]:
            self.group[f"outcomes/{name}"][rows] = part.outcomes[name]

    def inputs(self) -> dict[str, np.ndarray]:
        """Return the values that differed."""
        return {name: np.asarray(a[:]) for name, a in sorted(self._arrays("inputs"))}

    def observed(self) -> dict[str, np.ndarray]:
        """Return what was observed."""
        return {name: np.asarray(a[:]) for name, a in sorted(self._arrays("observed"))}

    def _arrays(self, folder: str):
        return list(self.group[folder].arrays()) if folder in self.group else []

    def outcomes(self) -> np.ndarray:
        """Return the rows of all runs."""
        runs = self.group["outcomes/status"].shape[0]
        rows = np.zeros(runs, dtype=outcome_type(int(self.group.attrs["bodies"])))
        for name in rows.dtype.names or ():
            known = f"outcomes/{name}" in self.group  # an older carom has no `energy_error`
            rows[name] = self.group[f"outcomes/{name}"][:] if known else np.nan
        return rows

    def failures(self) -> dict[int, str]:
        """Return the messages of the runs that did not reach their end."""
        found: dict[int, str] = {}
        for file in sorted((self.path / "failures").glob("*.json")):
            found.update({int(k): v for k, v in json.loads(file.read_text("utf-8")).items()})
        return dict(sorted(found.items()))


def _array(group, key: str, shape, kind, chunk: int, fill: float = 0):
    return group.create_array(
        key, shape=shape, dtype=kind, chunks=(min(chunk, shape[0]), *shape[1:]), fill_value=fill
    )
