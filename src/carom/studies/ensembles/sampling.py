"""Values for the runs of an ensemble, drawn from distributions: at random, or evenly spread."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

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


def draw(vary: Mapping, runs: int | None, seed: int, sampling: str) -> dict[str, np.ndarray]:
    """Return an array for each name in `vary`, with its first axis over the runs.

    Parameters
    ----------
    vary : mapping
        For each name an array whose first axis is over the runs; a SciPy distribution (any object with `ppf`)
        for a number in each run; a list of distributions and numbers for a vector in each run; or
        `UniformOrientation()`.
    runs : int or None
        Number of runs; None if `vary` has an array.
    seed : int
        Seed of the random number generator.
    sampling : {"random", "sobol", "halton", "latin"}
        Independent points, or points that fill the space of all drawn numbers evenly (scipy.stats.qmc).
    """
    checks.choice("sampling", sampling, SAMPLING)
    drawn = {name: _columns(name, spec) for name, spec in vary.items()}
    if runs is not None:
        runs = checks.integer("runs", runs, least=1)
    given = {name: _given(name, spec) for name, spec in vary.items() if not drawn[name]}
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
    total = sum(drawn.values())
    points = _points(runs, total, seed, sampling) if total else np.zeros((runs, 0))
    found, first = {}, 0
    for name, spec in vary.items():
        u = points[:, first : first + drawn[name]]
        first += drawn[name]
        found[name] = given[name] if name in given else _through(spec, u)
    return found


def _columns(name: str, spec) -> int:
    """Return the number of uniform random numbers that a specification needs; 0 for an array."""
    if hasattr(spec, "ppf"):
        return getattr(spec, "columns", 1)
    if isinstance(spec, (list, tuple)) and any(hasattr(part, "ppf") for part in spec):
        for part in spec:
            if not hasattr(part, "ppf"):
                checks.number(f"a number in vary[{name!r}]", part)
        return sum(hasattr(part, "ppf") for part in spec)
    return 0


def _given(name: str, spec) -> np.ndarray:
    """Return the values of a given array, checked."""
    if name.endswith("orientation"):
        spec = quaternions(f"vary[{name!r}]", spec)
    try:
        return checks.real_array("values", spec, "")
    except ValueError:
        raise ValueError(
            f"vary[{name!r}] must be an array with an axis over the runs, a SciPy distribution, or a list of "
            f"distributions and numbers, got {checks.shown(spec)}"
        ) from None


def _points(runs: int, total: int, seed: int, sampling: str) -> np.ndarray:
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
    if isinstance(spec, (list, tuple)):
        columns = iter(u.T)
        return np.stack(
            [
                p.ppf(next(columns)) if hasattr(p, "ppf") else np.full(len(u), float(p))
                for p in spec
            ],
            axis=1,
        )
    return np.asarray(spec.ppf(u if getattr(spec, "columns", 1) > 1 else u[:, 0]), dtype=float)
