"""Uncertainty of fitted parameters, by bootstrap over recordings on a quadratic surface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.studies.identify.evaluate import Evaluator

#: fewest recordings that are resampled: the spread over K of them has a relative standard error of
#: 1/sqrt(2 (K - 1)), 0.32 for six
FEWEST = 6
DESIGNS = 6
ROUGH = 1e-9  # least curvature, relative to the largest, of a surface with a minimum


class Uncertainty(NamedTuple):
    """Bootstrap samples of the parameters."""

    centre: np.ndarray  #: (p,) minimum of the surface of all recordings
    samples: np.ndarray  #: (B, p) minima of the resampled surfaces
    reach: np.ndarray  #: (p,) half width of the region in which the surface is fitted
    #: (p,) part of the samples at the edge of the region; the true spread is larger
    at_edge: np.ndarray


def bootstrap(evaluate: Evaluator, resamples: int, seed: int | np.random.Generator) -> Uncertainty:
    """Return the spread of the minimum over bootstrap samples of the recordings (with replacement).

    Around the best point 2 p^2 + 1 points are evaluated, and a quadratic function is fitted to the objective of
    each recording. The mean of sampled quadratic functions is again quadratic, so no more simulations are
    needed. The region of the points is adapted to the spread: about three standard deviations to each side.
    """
    space = evaluate.space
    p, reach = space.start.size, 0.5 * space.step
    best = evaluate.points[evaluate.best]
    for _ in range(DESIGNS):
        reach = np.minimum(reach, 0.5 * (space.upper - space.lower))
        centre = np.clip(best, space.lower + reach, space.upper - reach)
        points = [centre + reach * z for z in design(p)]
        rows = np.array([evaluate.values[evaluate.number(x)] for x in points])
        coefficients = np.linalg.lstsq(quadratic_terms(design(p)), rows, rcond=None)[0]
        middle, samples = _minima(coefficients, resamples, seed)
        at_edge = np.mean(np.abs(samples) >= 1.0 - 1e-9, axis=0)
        spread = np.std(samples, axis=0)
        result = Uncertainty(centre + reach * middle, centre + reach * samples, reach, at_edge)
        wide, narrow = at_edge > 0.05, spread < 0.1
        if not np.any(wide | narrow):
            break
        smaller = np.where(narrow, np.maximum(3.0 * spread, 0.1), 1.0)
        reach = reach * np.where(wide, 3.0, smaller)
        best = np.where(wide, result.centre, best)
    return result


def design(p: int) -> np.ndarray:
    """Return points (2 p^2 + 1, p) that fix a quadratic: the centre, on each axis, and on each pair of axes."""
    points = [np.zeros(p)]
    for i in range(p):
        for s in (1.0, -1.0):
            points.append(s * np.eye(p)[i])
            points.extend(s * np.eye(p)[i] + r * np.eye(p)[j] for j in range(i) for r in (1, -1))
    return np.array(points)


def quadratic_terms(z: np.ndarray) -> np.ndarray:
    """Return the columns 1, z_i, z_i z_j (i <= j) of points z (m, p)."""
    i, j = np.triu_indices(z.shape[1])
    return np.concatenate([np.ones((len(z), 1)), z, z[:, i] * z[:, j]], axis=1)


def _minima(
    coefficients: np.ndarray, resamples: int, seed: int | np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Return the minima, within [-1, 1], for all recordings, (p,), and for each draw, (B, p)."""
    generator = np.random.default_rng(seed)
    count = coefficients.shape[1]
    draws = generator.multinomial(count, np.full(count, 1.0 / count), size=resamples) / count
    return minimum(coefficients.mean(axis=1)), np.array(
        [minimum(coefficients @ weights) for weights in draws]
    )


def minimum(c: np.ndarray) -> np.ndarray:
    """Return the minimum of a quadratic with coefficients c in the cube [-1, 1]^p."""
    from scipy.optimize import minimize

    p = int((np.sqrt(8.0 * c.size + 1.0) - 3.0) / 2.0)
    i, j = np.triu_indices(p)
    slope, curvature = c[1 : p + 1], np.zeros((p, p))
    curvature[i, j] = c[p + 1 :]
    curvature = curvature + curvature.T
    values = np.linalg.eigvalsh(curvature)
    if values[0] > ROUGH * np.max(np.abs(values)):
        inner = np.linalg.solve(curvature, -slope)
        if np.all(np.abs(inner) <= 1.0):
            return inner
    scale = np.max(np.abs(curvature)) + np.max(np.abs(slope))

    def fun(z):
        return (slope @ z + 0.5 * z @ curvature @ z) / scale

    def gradient(z):
        return (slope + curvature @ z) / scale

    starts = np.concatenate([np.zeros((1, p)), np.clip(-np.sign(slope), -1, 1)[None]])
    found = [
        minimize(fun, s, jac=gradient, method="L-BFGS-B", bounds=[(-1.0, 1.0)] * p) for s in starts
    ]
    return min(found, key=lambda f: f.fun).x
