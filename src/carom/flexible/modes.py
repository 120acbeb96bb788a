"""`Modes`: the modes of a flexible body, as data in axes of the body."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.flexible.thresholds import FLAT, SYMMETRIC


@arguments.known
class Modes:
    """Modes of a flexible body, in its axes, whose origin is the mass centre of the undeformed body.

    A place r of the body is displaced by Phi(r) eta, and the coordinates of the modes have unit modal masses:

        eta_k'' + 2 zeta_k w_k eta_k' + w_k^2 eta_k = Phi_k(r)^T F

    for a force F at r, in body axes. So Phi has the unit 1/sqrt(kg). Modes of a free body are about mean axes:
    they move neither its mass centre nor, on the whole, turn it.

    Parameters
    ----------
    frequencies : (n,)
        Frequencies [Hz], above 0.
    damping : (n,) or float
        Damping ratios zeta, at least 0. Default 0.
    mass : float
        Mass of the whole body [kg], above 0. Default 1.
    shapes : callable, or pair of arrays
        ``shapes(points (k, 3)) -> (k, 3, n)``; or places (P, 3) [m] and the displacements (P, 3, n) there,
        between which they are interpolated.
    inertia : (3,) or (3, 3), optional
        Inertia of the undeformed body about its mass centre [kg m^2]. Default: that of the shape of the body.
    supported : bool
        True: the body is held by its supports, and does not move as a whole. Default False.
    participation : (3, n), optional
        Integrals of density times Phi over the body [sqrt(kg)], on which gravity acts; 0 for a free body.
        Default 0.

    Attributes
    ----------
    frequencies, damping : (n,)
    mass : float
    inertia : (3, 3) or None
    supported : bool
    participation : (3, n)

    Raises
    ------
    ValueError
        If a value is outside its range, or shapes return something else than (k, 3, n).

    Examples
    --------
    A tuning fork as one mode of 440 Hz, whose ends move across its axis:

    >>> def fork(points):
    ...     out = np.zeros((len(points), 3, 1))
    ...     out[:, 1, 0] = 10.0 * np.sign(points[:, 1]) * points[:, 0] ** 2
    ...     return out
    >>> modes = carom.Modes([440.0], damping=1e-4, mass=0.05, shapes=fork)
    >>> modes.shapes([(0.1, 0.01, 0)])[0, :, 0]
    array([0. , 0.1, 0. ])
    """

    def __init__(
        self,
        frequencies: ArrayLike,
        damping: ArrayLike = 0.0,
        mass: float = 1.0,
        shapes: Callable[[np.ndarray], Any] | tuple[ArrayLike, ArrayLike] | None = None,
        *,
        inertia: ArrayLike | None = None,
        supported: bool = False,
        participation: ArrayLike | None = None,
    ):
        given = checks.real_array("frequencies", frequencies, "(n,)")
        if given.ndim != 1 or not len(given):
            raise ValueError(
                f"frequencies must have shape (n,), n > 0, got {checks.shown(frequencies)}"
            )
        n = len(given)
        self.frequencies = checks.finite_array("frequencies", given, (n,), "Hz")
        if not np.all(self.frequencies > 0.0):
            raise ValueError(
                "frequencies must be above 0 [Hz], those of rigid motions left out, "
                f"got {checks.shown(frequencies)}"
            )
        ratios = checks.real_array("damping", damping, "() or (n,)")
        self.damping = checks.finite_array(
            "damping", np.full(n, ratios) if ratios.ndim == 0 else ratios, (n,), ""
        )
        if np.any(self.damping < 0.0):
            raise ValueError(f"damping must be at least 0, got {checks.shown(damping)}")
        self.mass = checks.mass("mass", mass)
        self.inertia = None if inertia is None else inertia_of(inertia)
        self.supported = checks.flag("supported", supported)
        self.participation = (
            np.zeros((3, n))
            if participation is None
            else checks.finite_array("participation", participation, (3, n), "")
        )
        self._shapes, self._at = self._checked(shapes, n)
        for one in (self.frequencies, self.damping, self.participation):
            one.setflags(write=False)

    def _checked(self, shapes, n: int):
        if callable(shapes):
            made = np.asarray(checks.call("shapes", shapes, np.zeros((2, 3))))
            if made.shape != (2, 3, n):
                raise ValueError(
                    f"shapes must return (k, 3, {n}) for points (k, 3) and {n} frequencies, "
                    f"got {made.shape} for (2, 3)"
                )
            return shapes, None
        if not (isinstance(shapes, (tuple, list)) and len(shapes) == 2):
            raise ValueError(
                "shapes must be a function of points (k, 3), or places (P, 3) and displacements (P, 3, n), "
                f"got {checks.shown(shapes)}"
            )
        places = places_of("shapes[0]", shapes[0])
        moved = checks.finite_array("shapes[1]", shapes[1], (len(places), 3, n), "")
        return interpolated(places, moved), (places, moved)

    def __len__(self) -> int:
        return len(self.frequencies)

    def __repr__(self) -> str:
        low, high = self.frequencies.min(), self.frequencies.max()
        held = "supported" if self.supported else "free"
        return f"<Modes: {len(self)} of a {held} body of {self.mass:.4g} kg, {low:.4g} to {high:.4g} Hz>"

    def shapes(self, points: ArrayLike) -> np.ndarray:
        """Return the displacements Phi (k, 3, n) [1/sqrt(kg)] at points (k, 3) of the undeformed body [m]."""
        return np.asarray(self._shapes(places_of("points", points)))

    def compliance(self, point: ArrayLike) -> np.ndarray:
        """Return the static compliance (3, 3) [m/N] of a point by its modes: sum of Phi Phi^T / w^2.

        Of a free body it is the deflection about its mean axes, which the whole accelerates with.
        """
        phi = self.shapes(np.reshape(checks.finite_array("point", point, (3,), "m"), (1, 3)))[0]
        return (phi / (2.0 * np.pi * self.frequencies) ** 2) @ phi.T

    def first(self, n: int) -> Modes:
        """Return the `n` modes of the lowest frequencies."""
        n = checks.integer("n", n, least=1, most=len(self))
        kept = np.sort(np.argsort(self.frequencies, kind="stable")[:n])
        given, at = self._shapes, self._at
        shapes = partial(_some, given, kept) if at is None else (at[0], at[1][..., kept])
        return Modes(
            self.frequencies[kept], self.damping[kept], self.mass, shapes,
            inertia=self.inertia, supported=self.supported, participation=self.participation[:, kept],
        )  # fmt: skip

    @classmethod
    def reduce(
        cls, M, K, C=None, *, nodes: ArrayLike, interface: ArrayLike = (), modes: int = 20
    ) -> Modes:
        """Return the modes of matrices of another program; see `carom.flexible.reduction.reduce`."""
        from carom.flexible.reduction import reduce

        return reduce(M, K, C, nodes=nodes, interface=interface, modes=modes)

    def save(self, path: str | Path, points: ArrayLike | None = None) -> None:
        """Save to a file (``.npz``) the data, with the displacements at `points` (P, 3).

        What `load` returns interpolates between these.

        Parameters
        ----------
        path
            The file.
        points : (P, 3), optional
            Places [m]; needed if shapes are a function. Default: those of the data.
        """
        from carom.io.files.disk import put

        if points is None:
            if self._at is None:
                raise ValueError(
                    "points must be given for modes whose shapes are a function, got None"
                )
            points = self._at[0]
        places = places_of("points", points)
        where, file = (
            checks.file_to_write("path", path),
            BytesIO(),
        )  # NumPy would add an ending to the name
        np.savez(
            file, frequencies=self.frequencies, damping=self.damping, mass=self.mass,
            inertia=np.zeros(0) if self.inertia is None else self.inertia, points=places,
            shapes=self.shapes(places), supported=self.supported, participation=self.participation,
        )  # fmt: skip
        put(where, [file.getvalue()])

    @classmethod
    def load(cls, path: str | Path) -> Modes:
        """Return the modes of a file that `save` wrote."""
        where = checks.path("path", path)
        if not where.is_file():
            raise ValueError(f"path must be a file, got {checks.shown(str(where))}")
        try:
            with np.load(where) as data:
                there = {name: data[name] for name in data.files}
        except (ValueError, EOFError, AttributeError, TypeError, BadZipFile) as error:
            raise ValueError(f"path must be a file of Modes, got {path!s}: {error}") from error
        missing = {"frequencies", "mass", "points", "shapes"} - set(there)
        if missing:
            raise ValueError(
                f"path must be a file of Modes, got {path!s} without {sorted(missing)}"
            )
        inertia = there.get("inertia", np.zeros(0))
        return cls(
            there["frequencies"], there.get("damping", 0.0), float(there["mass"]),
            (there["points"], there["shapes"]), inertia=inertia if inertia.size else None,
            supported=bool(there.get("supported", False)), participation=there.get("participation"),
        )  # fmt: skip


def places_of(name: str, value) -> np.ndarray:
    """Return places (k, 3) [m], whose squares are finite."""
    given = checks.vectors(name, value, 3).reshape(-1, 3)
    if not np.all(np.abs(given) <= checks.LENGTHS[1]):
        raise ValueError(
            f"{name} must be at most {checks.LENGTHS[1]:g} [m], got {checks.shown(value)}"
        )
    return given


def inertia_of(value) -> np.ndarray:
    """Return the inertia (3, 3) of principal moments (3,), or of a matrix; a body checks that it can be one."""
    given = checks.real_array("inertia", value, "(3,) or (3, 3)")
    if given.ndim == 1:
        given = np.diag(checks.finite_array("inertia", given, (3,), "kg m^2"))
    made = checks.finite_array("inertia", given, (3, 3), "kg m^2")
    moments = np.linalg.eigvalsh(made)
    if not (np.array_equal(made, made.T) or np.allclose(made, made.T, rtol=SYMMETRIC)) or not (
        moments[0] > 0.0 and moments[2] <= (moments[0] + moments[1]) * (1.0 + SYMMETRIC)
    ):
        raise ValueError(
            "inertia must be symmetric, with moments above 0 of which none is above the sum of the others, "
            f"got {checks.shown(value)}"
        )
    made.setflags(write=False)
    return made


def _some(shapes, kept: np.ndarray, points: np.ndarray) -> np.ndarray:
    return shapes(points)[..., kept]


def _between(made, points: np.ndarray) -> np.ndarray:
    values = made(np.atleast_2d(points))
    return values.reshape(len(values), 3, -1)


def interpolated(places: np.ndarray, moved: np.ndarray):
    """Return the function that interpolates displacements between places.

    Radial cubics with linear terms if the places span space, else linear ones, which need no plane or line.
    """
    from scipy.interpolate import RBFInterpolator

    centred = places - places.mean(axis=0)
    size = np.linalg.svd(centred, compute_uv=False)
    spans = len(places) > 3 and len(size) == 3 and size[2] > FLAT * size[0]
    how: dict[str, Any] = (
        {"kernel": "cubic", "degree": 1} if spans else {"kernel": "linear", "degree": 0}
    )
    made = RBFInterpolator(
        places, moved.reshape(len(places), -1), neighbors=min(60, len(places)), **how
    )
    return partial(_between, made)
