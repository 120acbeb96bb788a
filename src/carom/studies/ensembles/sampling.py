"""Values for the runs of an ensemble: drawn at random or evenly spread, on a grid, or given."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.geometry.attitude import quaternions

SAMPLING = ("random", "sobol", "halton", "latin")


class UniformOrientation:
    """The uniform distribution over all orientations, as unit quaternions (w, x, y, z).

    Three uniform numbers give an orientation: Shoemake, *Uniform random rotations*, Graphics Gems III (1992).
    """

    columns = 3  #: uniform numbers used for each orientation

    def ppf(self, u: np.ndarray) -> np.ndarray:
        """Return the quaternions (n, 4) for points `u` (n, 3) of the unit cube."""
        u = checks.finite_array("u", u, (None, self.columns))
        if not np.all((u >= 0.0) & (u <= 1.0)):
            raise ValueError(f"u must be points of the unit cube, got {checks.shown(u)}")
        near, far = np.sqrt(1.0 - u[:, 0]), np.sqrt(u[:, 0])
        a, b = 2.0 * np.pi * u[:, 1], 2.0 * np.pi * u[:, 2]
        Q = np.stack([far * np.cos(b), near * np.sin(a), near * np.cos(a), far * np.sin(b)], axis=1)
        return Q / np.linalg.norm(Q, axis=1, keepdims=True)

    def __repr__(self) -> str:
        return "UniformOrientation()"


class Grid:
    """Values of one name on a grid: an ensemble makes all combinations with those of other grids.

    Parameters
    ----------
    values : array_like, shape (n,)
        Numbers, or words (``["newton", "stronge"]``). In a list for a vector, as in
        ``[Grid(speeds), 0.0, Grid(heights)]``, a grid is one of its components.
    """

    def __init__(self, values: ArrayLike):
        words = _words(values)
        self.values = checks.finite_array("values", values, (None,)) if words is None else words
        if not len(self.values):
            raise ValueError(f"values must be at least one, got {checks.shown(values)}")
        if len(np.unique(self.values)) < len(self.values):
            raise ValueError(f"values must be different, got {checks.shown(values)}")

    def __repr__(self) -> str:
        return f"Grid({self.values.tolist()})"


def _words(values) -> np.ndarray | None:
    """Return a sequence of words as an array (n,); None if it is not one."""
    try:
        words = isinstance(values, (list, tuple, np.ndarray)) and len(values) > 0
        if not (words and all(isinstance(one, str) for one in values)):
            return None
    except TypeError:  # an array without an axis
        return None
    return np.array(list(values))


class _Rows(NamedTuple):
    """A component that is on a grid: it stands among distributions, and needs no random number."""

    values: np.ndarray
    columns: int = 0

    def ppf(self, u) -> np.ndarray:
        """Return the values of all runs."""
        return self.values


def as_mapping(vary) -> Mapping:
    """Return the varied values by name, also that of a `pandas.DataFrame` with one row for each run."""
    if hasattr(vary, "columns") and hasattr(vary, "iloc"):
        return {name: vary[name].tolist() for name in vary.columns}
    return vary


def on_grid(vary: Mapping, runs: int | None) -> tuple[dict, dict[str, np.ndarray], int | None]:
    """Return `vary` with arrays over all runs in the place of grids, the axes of the grid, and the runs.

    The last axis runs fastest. Axes have the names of what is varied, or of its component:
    ``"die.velocity.x"``.
    """
    axes = {}
    for name, spec in vary.items():
        for end, part in zip(_ends(spec), spec if isinstance(spec, (list, tuple)) else [spec]):
            if isinstance(part, Grid):
                axes[f"{name}{end}"] = part.values
    if not axes:
        return dict(vary), axes, runs
    shape = tuple(map(len, axes.values()))
    count = math.prod(shape)
    if runs is not None and checks.integer("runs", runs, least=1) != count:
        sizes = f"{count}, the number of combinations of the grid" if len(shape) > 1 else count
        raise ValueError(f"runs must be left out, or {sizes}, got {runs}")
    places = np.indices(shape).reshape(len(shape), -1)
    rows = {name: values[place] for (name, values), place in zip(axes.items(), places)}
    made = {}
    for name, spec in vary.items():
        if isinstance(spec, (list, tuple)):
            ends = [f"{name}{end}" for end in _ends(spec)]
            spec = [_Rows(rows[end]) if end in rows else part for end, part in zip(ends, spec)]
        made[name] = rows.get(name, spec)
    return made, axes, count


def _ends(spec) -> Sequence[str]:
    """Return the ends of the names of components, or one that is empty."""
    if not isinstance(spec, (list, tuple)):
        return ("",)
    return [f".{axis}" for axis in "xyz"] if len(spec) == 3 else [f".{k}" for k in range(len(spec))]


def draw(
    vary: Mapping, runs: int | None, seed: int | np.random.Generator, sampling: str
) -> dict[str, np.ndarray]:
    """Return an array for each name in `vary`, with its first axis over the runs.

    Parameters
    ----------
    vary : mapping
        For each name an array whose first axis is over the runs; a SciPy distribution (any object with `ppf`)
        for a number in each run; a list of distributions, numbers and arrays over the runs for a vector in
        each run; or `UniformOrientation()`.
    runs : int or None
        Number of runs; None if `vary` has an array.
    seed : int or Generator
        Seed of the random number generator.
    sampling : {"random", "sobol", "halton", "latin"}
        Independent points, or points that fill the space of all drawn numbers evenly (scipy.stats.qmc).
    """
    checks.choice("sampling", sampling, SAMPLING)
    drawn = {name: _columns(name, spec) for name, spec in vary.items()}
    if runs is not None:
        runs = checks.integer("runs", runs, least=1)
    given = {name: _given(name, spec) for name, spec in vary.items() if drawn[name] is None}
    for name, values in given.items():
        if values.ndim == 0:
            raise ValueError(
                f"vary[{name!r}] must have an axis over the runs, got {checks.shown(vary[name])}"
            )
        if runs is not None and len(values) != runs:
            raise ValueError(
                f"vary[{name!r}] must have {runs} values, one for each run, got {len(values)} with runs={runs}"
            )
        runs = len(values)
    if runs is None:
        raise ValueError("runs must be given if vary has no array, got None")
    if runs < 1:
        raise ValueError(f"vary must have at least one run, got arrays of length {runs}")
    total = sum(count or 0 for count in drawn.values())
    points = _points(runs, total, seed, sampling) if total else np.zeros((runs, 0))
    found, first = {}, 0
    for name, spec in vary.items():
        count = drawn[name] or 0
        u = points[:, first : first + count]
        first += count
        found[name] = given[name] if name in given else _through(spec, u)
    return found


def _columns(name: str, spec) -> int | None:
    """Return the number of uniform random numbers that a specification needs; None for an array."""
    if hasattr(spec, "ppf"):
        return getattr(spec, "columns", 1)
    if isinstance(spec, (list, tuple)) and any(hasattr(part, "ppf") for part in spec):
        for part in spec:
            if not hasattr(part, "ppf"):
                checks.number(f"a number in vary[{name!r}]", part)
        return sum(getattr(part, "columns", 1) for part in spec if hasattr(part, "ppf"))
    return None


def _given(name: str, spec) -> np.ndarray:
    """Return the values of a given array, checked."""
    if name.endswith("orientation"):
        spec = quaternions(f"vary[{name!r}]", spec)
    words = _words(spec)
    if words is not None:
        return words
    try:
        return checks.real_array("values", spec, "")
    except ValueError:
        raise ValueError(
            f"vary[{name!r}] must be an array with an axis over the runs, a SciPy distribution, a Grid, or a "
            f"list of these and numbers for a vector, got {checks.shown(spec)}"
        ) from None


def _points(runs: int, total: int, seed: int | np.random.Generator, sampling: str) -> np.ndarray:
    """Return points (runs, total) of the open unit cube."""
    if sampling == "random":
        points = np.random.default_rng(seed).random((runs, total))
    else:
        from scipy.stats import qmc

        engines = {"sobol": qmc.Sobol, "halton": qmc.Halton, "latin": qmc.LatinHypercube}
        engine = engines[sampling](total, rng=np.random.default_rng(seed))
        # balanced for powers of two: draw the next power, and use the first points
        if sampling == "sobol":
            points = engine.random_base2(max(0, (runs - 1).bit_length()))[:runs]
        else:
            points = engine.random(runs)
    return np.clip(points, 0.5 * np.finfo(float).eps, 1.0 - np.finfo(float).eps)


def _through(spec, u: np.ndarray) -> np.ndarray:
    if not isinstance(spec, (list, tuple)):
        return np.asarray(spec.ppf(u if getattr(spec, "columns", 1) > 1 else u[:, 0]), dtype=float)
    columns, parts = iter(u.T), []
    for part in spec:
        if not hasattr(part, "ppf"):
            parts.append(np.full(len(u), float(part)))
        else:
            parts.append(part.ppf(next(columns) if getattr(part, "columns", 1) else None))
    return np.stack(parts, axis=1)
