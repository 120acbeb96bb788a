"""A surface phi(x, y, z) = 0 of a function of the user's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import keep
from carom.scene import expressions
from carom.scene.surface_definition import SurfaceDefinition

if TYPE_CHECKING:
    from carom._compiled.user_functions import Functions

TRIED_POINTS = (
    200  # points of the box at which a function is checked, and from which the surface is found
)
WAYS_TO_SURFACE = 20  # by Newton's method, along the gradient, from there to the surface
STEP = 1e-5  # of differences, relative to the box
AGREE = 1e-4  # greatest error of derivatives that are given, relative to the greatest ones
FLAT = 1e-9  # least slope on the surface, relative to the greatest one
SPARE = 1.25  # curvature and slope between the points may be greater
TINY = 1e-300  # of squares of slopes, which divide
MOST_SURFACES = 100  # surfaces whose compiled functions are kept
#: numbers of a function: its value, gradient and Hessian (3, 3)
RESULTS = 13


@arguments.known
@dataclass(frozen=True, init=False, eq=False, repr=False)
class Surface(SurfaceDefinition):
    """The surface phi(x, y, z) = 0 of a function, with free space where phi is above 0.

    Parameters
    ----------
    function : callable
        ``function(x, y, z)`` returns phi, of any unit. Without derivatives it must also take symbols of SymPy,
        by which they are derived: arithmetic, and functions of SymPy such as ``sympy.sin`` in place of
        ``math.sin``. It is then compiled.
    bounds : (2, 3)
        Lowest and highest x, y and z [m] of the box in which the function is checked and the surface drawn, in
        axes of the surface. The surface has no end: beyond the box it goes on as the function does, unchecked,
        and a run with a contact there says so.
    gradient, hessian : callable, optional
        ``gradient(x, y, z)`` (3,) and ``hessian(x, y, z)`` (3, 3), both or none. With them all three are called
        as they are.

    Raises
    ------
    ValueError
        If phi is not finite in the box, has no zero there or one without a slope, derivatives do not agree
        with differences, or there are none.

    Notes
    -----
    phi must have continuous second derivatives near the surface. Where it is 0 its gradient must not be. That
    it grows as the distance does is best, but not needed.

    Examples
    --------
    A bowl of radius 0.5:

    >>> bowl = carom.surfaces.Surface(
    ...     lambda x, y, z: 0.25 - x**2 - y**2 - z**2, bounds=[(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)])
    >>> bowl
    Surface(<lambda>, bounds [-0.5 -0.5 -0.5] to [0.5 0.5 0.5] m)
    """

    function: Callable[[Any, Any, Any], Any]
    bounds: np.ndarray
    gradient: Callable | None
    hessian: Callable | None
    bend: float = 0.0
    steepest: float = 1.0
    kind = "function"

    def __init__(
        self,
        function: Callable[[Any, Any, Any], Any],
        bounds: ArrayLike,
        gradient: Callable | None = None,
        hessian: Callable | None = None,
    ):
        checks.function("function", function)
        checks.function("gradient", gradient, optional=True)
        checks.function("hessian", hessian, optional=True)
        if (gradient is None) != (hessian is None):
            raise ValueError(
                "gradient and hessian must be given both or not at all, got "
                f"{checks.shown(gradient)} and {checks.shown(hessian)}"
            )
        bounds = checks.finite_array("bounds", bounds, (2, 3), "m")
        if not np.all(bounds[1] > bounds[0]):
            raise ValueError(
                "bounds must be (lowest, highest) corners of a box with sides above 0, got "
                f"{checks.shown(bounds.tolist())}"
            )
        keep(self, function=function, bounds=bounds, gradient=gradient, hessian=hessian)
        self._check()

    def __repr__(self) -> str:
        name = getattr(self.function, "__name__", type(self.function).__name__)
        return f"Surface({name}, bounds {self.bounds[0]} to {self.bounds[1]} m)"

    @property
    def size(self) -> float:
        """A length of the surface [m]: half the diagonal of its box."""
        return 0.5 * float(np.linalg.norm(self.bounds[1] - self.bounds[0]))

    @property
    def lengths(self) -> tuple[float, ...]:
        """The bound of its hollow curvatures [1/m]."""
        return (self.bend,)

    @property
    def numbers(self) -> np.ndarray:
        """Room for a point and the numbers of the function there, for kernels."""
        return np.zeros(3 + RESULTS)

    def write(self, row) -> None:
        """Write the address of the function to a row of kernels."""
        row.address = address_of(self)[1]

    def _check(self) -> None:
        """Find bounds of curvature and slope; refuse a function that is no surface in the box."""
        evaluate, (low, high) = evaluator(self), self.bounds
        places = low + (high - low) * np.random.default_rng(0).random((TRIED_POINTS, 3))
        found = np.array([check_at(self, evaluate, x) for x in places])
        if self.gradient is not None:
            self._compare(evaluate, places[:20], found[:20])
        steepest, values = np.max(np.linalg.norm(found[:, 1:4], axis=1)), found[:, 0]
        for _ in range(WAYS_TO_SURFACE):
            slope = found[:, 1:4]
            step = -found[:, :1] / np.maximum(np.sum(slope**2, axis=1, keepdims=True), TINY) * slope
            places = np.clip(places + step, low, high)
            found = np.array([check_at(self, evaluate, x) for x in places])
        size = np.linalg.norm(found[:, 1:4], axis=1)
        away = np.abs(found[:, 0]) / np.maximum(size, TINY)
        on = (away < STEP * 2.0 * self.size) & (size > FLAT * steepest)
        n = found[on, 1:4] / size[on, None]
        ends = [
            [check_at(self, evaluate, x)[0] for x in places[on] + k * STEP * self.size * n]
            for k in (-10.0, 10.0)
        ]
        if not np.any(np.sign(ends[0]) * np.sign(ends[1]) < 0.0):
            raise ValueError(
                "function must be 0 on a surface within the bounds, above 0 on one side and below 0 on the "
                "other, with a gradient; got none such, and values from "
                f"{values.min():.3g} to {values.max():.3g}"
            )
        flat = np.eye(3) - n[:, :, None] * n[:, None, :]
        shape = -flat @ found[on, 4:].reshape(-1, 3, 3) @ flat / size[on, None, None]
        bend = max(float(np.max(np.linalg.eigvalsh(shape))), 0.0)
        keep(self, bend=SPARE * bend, steepest=SPARE * float(max(steepest, np.max(size))))

    def _compare(self, evaluate: Callable, places: np.ndarray, found: np.ndarray) -> None:
        """Refuse derivatives that do not agree with central differences."""
        step = STEP * (self.bounds[1] - self.bounds[0])
        offsets = np.diag(step)
        ahead, behind = (
            np.array([[evaluate(x + sign * offset)[:4] for offset in offsets] for x in places])
            for sign in (1.0, -1.0)
        )
        rates = (ahead - behind) / (2.0 * step[:, None])  # (K, direction, value or gradient)
        for name, given, found_ in (
            ("gradient", found[:, 1:4], rates[:, :, 0]),
            ("hessian", found[:, 4:].reshape(-1, 3, 3), rates[:, :, 1:]),
        ):
            error, most = np.abs(given - found_), max(np.abs(given).max(), np.abs(found_).max())
            if not np.max(error) <= AGREE * most:
                k = int(np.argmax(error.reshape(len(places), -1).max(axis=1)))
                of = "function" if name == "gradient" else "gradient"
                raise ValueError(
                    f"{name} must be the derivative of {of}, got {checks.shown(given[k].tolist())} at "
                    f"{checks.shown(places[k].tolist())}, where differences are "
                    f"{checks.shown(found_[k].round(6).tolist())}"
                )


def written(surface: Surface) -> Callable:
    """Return ``f(t, x, out)``, which writes value, gradient and Hessian of a function for symbols."""
    sp: Any = checks.need("sympy", "Surface(function) without derivatives", "sympy")
    x = sp.symbols("x y z", real=True)
    try:
        given = surface.function(*x)
    except RuntimeError:
        raise
    except Exception as error:
        raise ValueError(
            "function must take symbols of SymPy (with sympy.sin in place of math.sin, sympy.Piecewise in "
            "place of if), or gradient and hessian must be given; with symbols it raised "
            f"{type(error).__name__}: {error}"
        ) from None
    phi = expressions.of("what function(x, y, z) returns for symbols", given)
    other = sorted(map(str, phi.free_symbols.difference(x)))
    if other:
        raise ValueError(f"function must be of x, y and z only, got one of {', '.join(other)}")
    slope = [sp.diff(phi, one) for one in x]
    terms = [phi, *slope, *(sp.diff(one, other) for one in slope for other in x)]
    return expressions.written("surface", terms, list(x), sp.Dummy("t"))


def joined(surface: Surface) -> Callable:
    """Return ``f(t, x)``, the value, gradient and Hessian of three functions in one array."""
    parts: Any = ("function", ()), ("gradient", (3,)), ("hessian", (3, 3))

    def numbers(t, x):
        at = x.tolist()
        found = [
            _shaped(name, checks.call(name, getattr(surface, name), *at), shape)
            for name, shape in parts
        ]
        return np.concatenate(found)

    return numbers


@lru_cache(maxsize=MOST_SURFACES)
def code_of(surface: Surface) -> tuple[Callable, bool]:
    """Return ``f(t, x, out)`` and True of a function for symbols, of all others ``f(t, x)`` and False."""
    if surface.gradient is not None:
        return joined(surface), False
    try:
        return written(surface), True
    except RuntimeError:  # a file does not have the function: this is raised where it is called
        return lambda t, x: surface.function(*x), False


@lru_cache(maxsize=MOST_SURFACES)
def address_of(surface: Surface) -> tuple[Functions, Any]:
    """Return the functions of a surface for kernels, and the address of the one that they call."""
    from carom._compiled.user_functions import Functions

    (code, is_written), made = code_of(surface), Functions()
    given = (3,), (RESULTS,), f"the function of {surface!r}"
    return made, made.written(code, *given) if is_written else made.address(code, *given)


def evaluator(surface: Surface) -> Callable[[np.ndarray], np.ndarray]:
    """Return a function of a point (3,), with value, gradient and Hessian in one array."""
    code, is_written = code_of(surface)

    def numbers(x):
        if not is_written:
            return code(0.0, x)
        out = np.empty(RESULTS)
        code(0.0, x.tolist(), out)
        return out

    return numbers


def check_at(surface: Surface, evaluate: Callable, x: np.ndarray) -> np.ndarray:
    """Return the numbers of the function at a point, if they are finite."""
    try:
        out = evaluate(x)
    except (ArithmeticError, ValueError) as error:  # of `math` at a pole or beyond a domain
        if surface.gradient is not None:
            raise
        out, what = np.full(RESULTS, np.nan), str(error)
    else:
        what = str(out[~np.isfinite(out)][:1])
    if not np.all(np.isfinite(out)):
        raise ValueError(
            "function must be finite where bodies are, with its first and second derivatives, got "
            f"{what} at {checks.shown(x.tolist())}"
        )
    return out


def _shaped(name: str, value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return what one of three functions returned, as a list of numbers."""
    array = checks.real_array(f"{name}(x, y, z)", value, str(shape))
    if array.shape != shape:
        raise ValueError(f"{name}(x, y, z) must have shape {shape}, got shape {array.shape}")
    return array.ravel()
