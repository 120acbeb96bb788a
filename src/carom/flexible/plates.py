"""Modes of a free rectangular plate (Kirchhoff) by the method of Ritz, with Legendre polynomials."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

from carom import arguments, checks
from carom.flexible.modes import Modes
from carom.flexible.sections import material
from carom.flexible.thresholds import TAIL

MORE = 10  # degrees of the polynomials beyond the number of half waves, at first
MOST = 2500  # polynomials


@arguments.known
def plate(
    length: float,
    width: float,
    thickness: float,
    density: float,
    young: float,
    poisson: float = 0.3,
    modes: int = 8,
    damping: float = 0.0,
) -> Modes:
    """Return the bending modes of a free rectangular plate in the x-y plane of its body.

    Parameters
    ----------
    length, width, thickness : float
        Along x, y and z [m].
    density : float
        [kg/m^3]
    young : float
        Young's modulus [Pa].
    poisson : float
        Poisson's ratio. Default .3.
    modes : int
        How many, of the lowest frequencies, at most 200. Default 8.
    damping : float
        Damping ratio of all modes. Default 0.

    Returns
    -------
    Modes
        Those of Kirchhoff's plate, by a Ritz basis of products of polynomials, whose degrees grow until the
        highest ones have no part in the shapes: frequencies to 1e-7, from above. Those of a free square plate
        are 13.468, 19.596, 24.270, 34.801 times sqrt(D / (rho h)) / (2 pi a^2) for the ratio .3, with
        D = E h^3 / (12 (1 - nu^2)) (Leissa, The free vibration of rectangular plates, 1973, has 13.489, 19.789,
        24.432, 35.024, which are upper bounds).

    Raises
    ------
    ValueError
        If an argument is outside its range, or `modes` are too many for a plate so narrow.
    """
    a, b, h = (
        checks.length(n, v)
        for n, v in (("length", length), ("width", width), ("thickness", thickness))
    )
    density, young = material(density, young)
    nu = checks.number("poisson", poisson, above=-1, most=0.5)
    count = checks.integer("modes", modes, least=1, most=200)
    rigidity, mass = young * h**3 / (12.0 * (1.0 - nu**2)), density * a * b * h
    # half waves along each side up to the highest mode, by Weyl's law for the area
    per = math.sqrt(count * 4.0 / (math.pi * a * b))
    degrees = [MORE + math.ceil(side * per) for side in (a, b)]
    while True:
        if degrees[0] * degrees[1] > MOST:
            raise ValueError(
                f"modes must be fewer for sides of {a:g} and {b:g} m, which would need more than {MOST} "
                f"polynomials, got {count}; of a narrow strip take flexible.beam"
            )
        square, c = _ritz(degrees, (2.0 / a, 2.0 / b), nu, count)
        # share of the last two degrees along each side: even and odd shapes have one each
        tails = [np.sum(c[-2:] ** 2, axis=(0, 1)).max(), np.sum(c[:, -2:] ** 2, axis=(0, 1)).max()]
        if max(tails) <= TAIL:
            break
        degrees = [d + 4 + d // 4 if tail > TAIL else d for d, tail in zip(degrees, tails)]
    c *= 2.0 / math.sqrt(mass)
    inertia = mass / 12.0 * np.array([b * b + h * h, a * a + h * h, a * a + b * b])
    w = np.sqrt(rigidity / (density * h) * square)
    return Modes(
        w / (2.0 * np.pi), damping, mass, partial(_shapes, (2.0 / a, 2.0 / b), c), inertia=inertia
    )


def _shapes(scale, c: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return the displacements (P, 3, n) at points (P, 3)."""
    (sx, sy), degrees = scale, c.shape[:2]
    s, t, z = points[:, 0] * sx, points[:, 1] * sy, points[:, 2]
    one, two = (_values(v, d) for v, d in zip((s, t), degrees))
    slope, other = (_values(v, d, 1) for v, d in zip((s, t), degrees))
    out = np.zeros((len(points), 3, c.shape[2]))
    out[:, 2] = np.einsum("pi,pj,ijn->pn", one, two, c, optimize=True)
    out[:, 0] = -z[:, None] * sx * np.einsum("pi,pj,ijn->pn", slope, two, c, optimize=True)
    out[:, 1] = -z[:, None] * sy * np.einsum("pi,pj,ijn->pn", one, other, c, optimize=True)
    return out


def _ritz(degrees, scale, nu: float, count: int):
    """Return the lowest w^2 rho h / D, and coefficients (degrees, count) of normalised Legendre polynomials.

    The unknowns are polynomials whose second derivatives are orthonormal, so that K is nearly diagonal, and
    1/w^2 are the greatest eigenvalues of M by K: round-off is that of the lowest frequency at any degree. All
    but 1 and s of each side are orthogonal to these, so rigid motions are three unknowns, which are left out.
    """
    (sx, sy), sides, changes = scale, [], []
    for d in degrees:
        change = _bending_polynomials(d)  # rows: coefficients of Legendre polynomials
        sides.append([change @ one @ change.T for one in _line(d)])
        changes.append(change)
    (m0, k1, k2, mix), (n0, l1, l2, nix) = sides
    M = np.kron(m0, n0)
    K = sx**4 * np.kron(k2, n0) + sy**4 * np.kron(m0, l2)
    both = nu * (np.kron(mix, nix.T) + np.kron(mix.T, nix)) + 2.0 * (1.0 - nu) * np.kron(k1, l1)
    K += sx**2 * sy**2 * both
    kept = np.setdiff1d(np.arange(len(K)), [0, 1, degrees[1]])
    M, K = M[np.ix_(kept, kept)], K[np.ix_(kept, kept)]
    unit = 1.0 / np.sqrt(np.diag(K))
    M, K = (unit[:, None] * one * unit for one in (M, K))
    inverse, vectors = eigh(M, K, subset_by_index=(len(K) - count, len(K) - 1))
    c = np.zeros((degrees[0] * degrees[1], count))
    c[kept] = unit[:, None] * vectors[:, ::-1] / np.sqrt(inverse[::-1])  # M = 1
    c = c.reshape(*degrees, count)
    return 1.0 / inverse[::-1], np.einsum(
        "ip,jq,ijn->pqn", changes[0], changes[1], c, optimize=True
    )


def _bending_polynomials(degrees: int) -> np.ndarray:
    """Return polynomials (rows): 1, s, and those whose f'' is a normalised Legendre polynomial.

    P_n integrated twice is P_(n+2)/((2n+1)(2n+3)) - 2 P_n/((2n-1)(2n+3)) + P_(n-2)/((2n-1)(2n+1)); parts
    along 1 and s are left out.
    """
    out = np.zeros((degrees, degrees))
    out[0, 0] = out[1, 1] = 1.0
    size = 1.0 / np.sqrt(np.arange(degrees) + 0.5)  # P_n by the normalised one
    for n in range(degrees - 2):
        a, b, c = 2.0 * n - 1.0, 2.0 * n + 1.0, 2.0 * n + 3.0
        for k, part in ((n + 2, 1.0 / (b * c)), (n, -2.0 / (a * c)), (n - 2, 1.0 / (a * b))):
            if k >= 2:
                out[n + 2, k] = part * size[k] / size[n]
    return out


def _values(s: np.ndarray, degrees: int, order: int = 0) -> np.ndarray:
    """Return the values (k, degrees) of normalised Legendre polynomials, or of a derivative."""
    scale = np.sqrt(np.arange(degrees) + 0.5)
    made = legendre.legder(np.diag(scale), order) if order else np.diag(scale)
    return legendre.legval(s, made).T


def _line(degrees: int):
    """Return the integrals over [-1, 1] of f f, f' f', f'' f'' and f'' f (rows f'') of the polynomials."""
    s, weight = legendre.leggauss(degrees + 2)
    f, f1, f2 = (_values(s, degrees, order) for order in range(3))
    w = weight[:, None]
    return f.T @ (w * f), f1.T @ (w * f1), f2.T @ (w * f2), f2.T @ (w * f)
