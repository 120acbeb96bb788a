"""The methods of a solution that hand it to files and to other libraries."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    import xarray as xr

    from carom.io.files.convert import Frames


class Portable:
    """Saving, loading and converting a `Solution`; needs ``carom[files]``."""

    def save(self, path: str | os.PathLike) -> None:
        """Write the run to a file, whose suffix says what: all of it, or tables.

        ``.nc`` and ``.h5``: all of the run in one netCDF-4 (HDF5) file, which needs no carom to be read, with
        labelled dimensions, units, the tables of impacts, events and persistent contacts, the ledger,
        reactions and coordinates of joints, the scene as JSON, settings, options, version and citation. The
        file appears when it is complete, in the place of what was there, and has a digest of all its bytes.
        (How to: keep results in files.)

        ``.csv`` and ``.parquet``: the tables of `to_pandas`. The motion of the bodies goes to this file
        (columns ``time``, ``die.x``, ...), the others beside it, as ``run.impacts.csv``. `load` does not read
        them.

        Parameters
        ----------
        path : str or path
            In a folder that exists, with one of these suffixes (or ``.hdf5``).

        Raises
        ------
        ImportError
            Without h5netcdf (``.nc``), pandas (tables), pyarrow (``.parquet``).
        OSError
            If it cannot be written, as on a full disk; what was there is as it was.
        ValueError
            If the folder is not there, or the suffix is another one.
        """
        from carom.io.files.writing import save

        save(path, self)

    @classmethod
    def load(
        cls, path: str | os.PathLike, *, functions: Mapping[str, Callable] | None = None
    ) -> Self:
        """Return the solution that a file holds, bit for bit the one that was saved.

        No damaged file is read: a digest of all its bytes is checked first. No other file is read, whatever it
        says, and no code is run.

        Also of a run that was killed or stopped, up to the last saving; `status` is ``INTERRUPTED`` then (see
        `resume`). What a solution works out on demand, as between saved times, is worked out alike.

        Parameters
        ----------
        path : str or path
        functions : mapping, optional
            Functions of the user's that the scene has, which no file can hold: ``"part.field"`` (as in
            ``"motor.force"``) to function. Where they are left out `scene` has placeholders that raise an
            error when they are called; all that was saved is there without them.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ValueError
            If the file is foreign, damaged, changed, or of another version of the format; if a function is none
            of the scene's.
        """
        from carom import checks
        from carom.io.files.reading import read

        where = checks.path("path", path)
        if functions is not None and not isinstance(functions, Mapping):
            raise ValueError(
                f"functions must be a mapping from names, got {checks.shown(functions)}"
            )
        fields = read(where, functions)
        cached = fields.pop("cached")
        solution = cls(**fields)
        vars(solution).update(cached)
        return solution

    def simulate(
        self,
        duration: float,
        *,
        progress: bool | Callable[[float, float], None] | None = None,
        throw: bool = True,
    ) -> Self:
        """Go on from the end of the run, as if it had been longer from the start, bit for bit.

        This solution stays as it is. States are saved as often as before, with the settings of the run.

        Parameters
        ----------
        duration : float
            Time to simulate from here on [s].
        progress, throw
            As of `simulate`.

        Returns
        -------
        Solution
            Of the whole time, from the start.

        Raises
        ------
        ValueError
            If the run failed, or functions of its scene are missing (those of a file).
        SimulationError
            If it fails later on and `throw` is True.
        """
        from carom.io.files.resume import go_on

        return go_on(self, duration, progress, throw)

    def to_xarray(self) -> xr.Dataset:
        """Return all of the run as an `xarray.Dataset`: what `save` writes, and `xarray.open_dataset` reads.

        Dimensions time, body, axis, quaternion; impact, event, interval and held (tables), contact,
        contact_axis; joint, coordinate and row where there are some. Each variable has ``units`` and a
        ``long_name``.

        Raises
        ------
        ImportError
            Without xarray.
        """
        from carom.io.files.convert import to_xarray

        return to_xarray(self)

    def to_pandas(self) -> Frames:
        """Return the run as six tables (`pandas.DataFrame`), a named tuple.

        ``bodies`` (saved times down, columns body and quantity), ``energy``, ``impacts``, ``events``,
        ``contacts`` and ``forces``; bodies and contacts by name, vectors as one column a component.

        Raises
        ------
        ImportError
            Without pandas.
        """
        from carom.io.files.convert import to_pandas

        return to_pandas(self)
