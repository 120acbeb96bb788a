"""Methods of a solution that save, load, continue and convert it."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from carom import arguments

if TYPE_CHECKING:
    import xarray as xr

    from carom.io.files.convert import Frames


class Portable:
    """Methods that save, load, continue and convert a `Solution`; they need ``carom[files]``."""

    @arguments.known
    def save(self, path: str | os.PathLike) -> None:
        """Write the run to a file: the whole run or its tables, depending on the suffix.

        ``.nc`` and ``.h5``: the whole run in one netCDF-4 (HDF5) file, which can be read without carom. It has
        labelled dimensions, units, the tables of impacts, events and persistent contacts, the energy ledger,
        reactions and coordinates of joints, the scene as JSON, settings, options, version, citation, and a
        digest of all its bytes. The complete file replaces an old file of the same name in one operation.
        (How to: keep results in files.)

        ``.csv`` and ``.parquet``: the tables of `to_pandas`. The motion of the bodies is in this file (columns
        ``time``, ``die.x``, ...), the other tables are in files beside it, such as ``run.impacts.csv``. `load`
        cannot read these files.

        Parameters
        ----------
        path : str or path
            Path with one of these suffixes (or ``.hdf5``), in a folder that exists.

        Raises
        ------
        ImportError
            If a package is missing: h5netcdf (``.nc``), pandas (tables), pyarrow (``.parquet``).
        OSError
            If the file cannot be written, for example on a full disk; an old file then stays unchanged.
        ValueError
            If the folder does not exist, or the suffix is not one of these.
        """
        from carom.io.files.writing import save

        save(path, self)

    @classmethod
    @arguments.known
    def load(
        cls, path: str | os.PathLike, *, functions: Mapping[str, Callable] | None = None
    ) -> Self:
        """Return the solution in a file, bit for bit equal to the one that was saved.

        The digest of all bytes is checked first, and a damaged file is refused. Loading runs no code from the
        file and opens no other file.

        The file of a run that was killed or interrupted can be loaded too: the solution ends at the last
        saving, and its `status` is ``INTERRUPTED`` (see `resume`). Results that are computed on demand, such as
        states between saved times, are also equal.

        Parameters
        ----------
        path : str or path
            Path of the file.
        functions : mapping, optional
            User-defined functions of the scene, which a file cannot contain: ``"part.field"`` (for example
            ``"motor.force"``) to function. If they are left out, the `scene` has placeholders that raise an
            error when they are called; all saved results are available without them.

        Raises
        ------
        FileNotFoundError
            If the file does not exist.
        ValueError
            If the file is not a file of a run, is damaged or changed, or has another version of the format; or
            if the scene has no such function.
        """
        from carom import checks

        where = checks.path("path", path)
        if functions is not None and not isinstance(functions, Mapping):
            raise ValueError(
                f"functions must be a mapping from names, got {checks.shown(functions)}"
            )
        return cls._load(where, functions)

    @classmethod
    def _load(
        cls, path: Path, functions: Mapping[str, Callable] | None = None, system: Any = None
    ) -> Self:
        """Return the solution in a file: of a scene, or of a system in coordinates, which is given."""
        from carom.io.files.reading import read

        fields = read(path, functions, system)
        cached = fields.pop("cached")
        solution = cls(**fields)
        vars(solution).update(cached)
        return solution

    @arguments.known
    def simulate(
        self,
        duration: float,
        *,
        progress: bool | Callable[[float, float], None] | None = None,
        throw: bool = True,
    ) -> Self:
        """Continue the run from its end; the result is bit for bit that of one longer run.

        This solution is not changed. The settings of the run stay the same, and states are saved as often as
        before. If the run has no given ``step``, one longer run may choose other steps: then both agree within
        their tolerances only.

        Parameters
        ----------
        duration : float
            Additional time to simulate [s].
        progress, throw
            As for `simulate`.

        Returns
        -------
        Solution
            Solution for the whole time, from the start.

        Raises
        ------
        ValueError
            If the run failed, or a run from a file lacks user-defined functions of its scene.
        SimulationError
            If the continued run fails and `throw` is True.
        """
        from carom.io.files.resume import go_on

        return go_on(self, duration, progress, throw)

    @arguments.known
    def to_xarray(self, *, degrees: bool = False) -> xr.Dataset:
        """Return the whole run as an `xarray.Dataset`, as `save` writes it and `xarray.open_dataset` reads it.

        Its dimensions are time, body, axis, quaternion, contact, contact_axis; impact, event, interval and held
        (for the tables); and joint, coordinate, joint_impulse, applied (forces), row and user_event
        (`t_events`) if there are any. Each variable has the attributes ``units`` and ``long_name``.

        Parameters
        ----------
        degrees : bool
            Whether coordinates of joints that are angles are in degrees. Default False: radians.

        Raises
        ------
        ImportError
            If xarray is missing.
        """
        from carom.io.files.convert import to_xarray

        return to_xarray(self, degrees)

    @arguments.known
    def to_pandas(self, *, degrees: bool = False) -> Frames:
        """Return the run as a named tuple of nine tables (`pandas.DataFrame`).

        The tables are ``bodies`` (one row for each saved time, columns for body and quantity), ``energy``,
        ``impacts``, ``events``, ``contacts``, ``forces`` (of contacts), ``joints``, ``applied_forces`` and
        ``joint_impulses``. Parts are given by name, and vectors have one column for each component.

        Parameters
        ----------
        degrees : bool
            Whether coordinates of joints that are angles are in degrees. Default False: radians.

        Raises
        ------
        ImportError
            If pandas is missing.
        """
        from carom.io.files.convert import to_pandas

        return to_pandas(self, degrees)
