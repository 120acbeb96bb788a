"""`GeneralizedSystem`: a system in user-defined coordinates."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.generalized.stated import CoordinateContact
from carom.generalized.thresholds import SYMMETRY
from carom.scene.friction import FrictionLaw, bound_of
from carom.scene.registry import Registry
from carom.scene.restitution import Restitution

if TYPE_CHECKING:
    from carom.generalized.evaluate import Evaluation


@arguments.known
class GeneralizedSystem:
    r"""A system in generalised coordinates: metric, forces, constraints and contacts (paper, Eqs. (1), (6)).

    .. math:: M_{kj} (\dot v^j + \Gamma^j_{il} v^i v^l) = Q_k - \partial_k V + \lambda_R a^R_k,
       \qquad T = \tfrac12 M_{ij} v^i v^j, \quad v = \dot q

    with the Christoffel affinities of the metric M, constraints phi(q) = 0 and a(q) v = 0. Pass it to
    `carom.simulate` like a scene. The arguments of this constructor are functions; those of `from_sympy` are
    expressions.

    Parameters
    ----------
    metric : callable
        ``metric(q) -> (n, n)``, symmetric, positive definite. Kinetic energy is ``v M v / 2``.
    position, velocity : array_like, shape (n,)
        Initial coordinates and their initial rates.
    potential : callable, optional
        ``potential(q) -> float`` [J].
    force : callable, optional
        ``force(t, q, v) -> (n,)``: generalised forces without a potential.
    constraint : callable, optional
        ``constraint(q) -> (h,)``: functions phi that the constraints keep zero.
    rows : callable, optional
        ``rows(q) -> (k, n)``: nonholonomic constraints ``rows(q) v = 0``.
    metric_derivative, potential_gradient, constraint_jacobian : callable, optional
        Functions that return the derivatives: ``(n, n, n)`` with the index of the derivative first, ``(n,)``,
        and ``(h, n)``. Default: central differences of order 4. Their error is about 1e-12 for functions that
        vary on a scale of 1 of each coordinate (1e-10 for second derivatives of constraints); see the notes.
    scale : float or (n,), optional
        Size of each coordinate in its unit, above 0, in which `rtol` and `atol` of `simulate` are measured.
        Default 1.

    Raises
    ------
    ValueError
        If a shape is wrong, a number is not finite, or the metric at the start is not symmetric and positive
        definite.
    TypeError
        If a function is not callable.

    Notes
    -----
    Functions compiled by ``numba.njit`` are called directly from the compiled loop; plain functions are called
    through Python, which takes about 10 microseconds per call. The steps of the differences are
    ``7.4e-4 max(scale, |q|)``: state a `scale` on which the functions vary, or give the derivatives.

    The coordinates must be regular during the whole run. If they become singular (as at the pole of a sphere),
    the run ends with `Status.SINGULAR_METRIC`.
    """

    def __init__(
        self,
        metric: Callable,
        position,
        velocity,
        *,
        potential: Callable | None = None,
        force: Callable | None = None,
        constraint: Callable | None = None,
        rows: Callable | None = None,
        metric_derivative: Callable | None = None,
        potential_gradient: Callable | None = None,
        constraint_jacobian: Callable | None = None,
        scale: ArrayLike = 1.0,
    ):
        given = dict(
            metric=metric, potential=potential, force=force, constraint=constraint, rows=rows,
            metric_derivative=metric_derivative, potential_gradient=potential_gradient,
            constraint_jacobian=constraint_jacobian,
        )  # fmt: skip
        for name, one in given.items():
            checks.function(name, one, optional=name != "metric")
        q = checks.finite_array("position", position, (None,))
        v = checks.finite_array("velocity", velocity, (None,))
        if not len(q) == len(v) > 0:
            raise ValueError(
                f"position and velocity must have one length, at least 1, got {len(q)} and {len(v)}"
            )
        from carom.generalized.functional import FunctionalModel

        self._start(FunctionalModel(q, v, given), q, v, scale)

    @classmethod
    @arguments.known
    def from_sympy(
        cls,
        coordinates: Sequence,
        velocities: Sequence | None = None,
        *,
        kinetic_energy=None,
        metric=None,
        potential=0,
        forces: Sequence | None = None,
        constraints: Sequence = (),
        rates: Sequence = (),
        parameters: Mapping | None = None,
        time=None,
        position,
        velocity,
        scale: ArrayLike = 1.0,
    ) -> GeneralizedSystem:
        """Make a system from SymPy expressions; all derivatives are exact, and the expressions are compiled.

        Parameters
        ----------
        coordinates : sequence of n symbols, or functions of time such as ``dynamicsymbols("q")``
            The coordinates.
        velocities : sequence of n symbols, optional
            Rates of the coordinates. Default for functions of time: their derivatives.
        kinetic_energy : expression
            Kinetic energy [J], a quadratic form in the velocities. Give it or `metric`.
        metric : (n, n) matrix of expressions
            Metric M. Give it or `kinetic_energy`.
        potential : expression in the coordinates
            Potential energy [J]. Default 0.
        forces : sequence of n expressions, optional
            Generalised forces without a potential, in time, coordinates and velocities.
        constraints : sequence of expressions in the coordinates
            Expressions that the holonomic constraints keep zero.
        rates : sequence of expressions, linear in the velocities
            Expressions that the nonholonomic constraints keep zero.
        parameters : mapping of symbol to number, optional
            Values of the other symbols.
        time : symbol, optional
            Symbol of the time.
        position, velocity : array_like, shape (n,)
            Initial coordinates and velocities.
        scale : float or (n,), optional
            Size of each coordinate in its unit, as for `GeneralizedSystem`. Default 1.

        Raises
        ------
        ImportError
            If SymPy is missing (``pip install "carom[sympy]"``).
        ValueError
            If an expression has a symbol without a value, or does not have the required form.
        """
        from carom.generalized.symbolic import SymbolicModel

        model = SymbolicModel(
            coordinates, velocities, kinetic_energy, metric, potential, forces, constraints, rates,
            parameters, time,
        )  # fmt: skip
        q = checks.finite_array("position", position, (model.n,))
        v = checks.finite_array("velocity", velocity, (model.n,))
        system = cls.__new__(cls)
        system._start(model, q, v, scale)
        return system

    def _start(self, model, q, v, scale) -> None:
        if isinstance(scale, (int, float, np.number)):
            scale = np.full(model.n, checks.number("scale", scale, above=0.0))
        self.scale = checks.finite_array("scale", scale, (model.n,))
        if not np.all(self.scale > 0.0):
            raise ValueError(f"scale must be above 0, got {checks.shown(scale)}")
        self._model: Any = model
        self._parts, self._made = Registry("system"), None
        self.position, self.velocity = q, v
        M = checks.finite_array("metric at position", model.metric_at(q), (model.n, model.n))
        if not np.allclose(M, M.T, rtol=0, atol=SYMMETRY * np.max(np.abs(M))):
            raise ValueError(f"metric must be symmetric, got {M.tolist()} at the start")
        if not np.linalg.eigvalsh(M)[0] > 0.0:
            raise ValueError(f"metric must be positive definite, got {M.tolist()} at the start")

    @arguments.known
    def set_state(self, position, velocity) -> None:
        """Set the initial coordinates and velocities, each (n,)."""
        self.position = self._at(position)
        self.velocity = checks.finite_array("velocity", velocity, (self.coordinates,))

    def _as_it_is(self) -> GeneralizedSystem:
        """Return a copy that does not change when this system gets a contact or another state."""
        made = object.__new__(type(self))
        vars(made).update(vars(self), _parts=self._parts.copied())
        return made

    def _changed(self, state: dict, laws: dict[str, dict]) -> GeneralizedSystem:
        """Return a copy with another `position` or `velocity`, and other fields of contacts by their names."""
        made = self._as_it_is()
        made.set_state(**{"position": self.position, "velocity": self.velocity, **state})
        made._parts = Registry("system")
        for contact in self.contacts:
            other = replace(contact, **laws.get(contact.name, {}))
            self._check_friction(other, self._model.has_tangent(other.index))
            made._parts.add(other)
        return made

    @staticmethod
    def _check_friction(contact: CoordinateContact, tangent: bool) -> None:
        """Refuse friction without a tangent."""
        if bound_of(contact.friction) > 0.0 and not tangent:
            raise ValueError(
                f"friction needs a tangent, got friction {checks.shown(contact.friction)} without one"
            )

    def __getitem__(self, name: str) -> CoordinateContact:
        """Return the contact with this name.

        Raises
        ------
        KeyError
            If there is none.
        """
        found: Any = self._parts[name]
        return found

    def __getstate__(self) -> dict:
        """Return what a pickle has; compiled functions are made again."""
        return {**vars(self), "_made": None}

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        """Names of the coordinates: of their symbols, or ``"0"``, ``"1"``, ... in a system of functions."""
        return tuple(self._model.names)

    def _apart(self) -> GeneralizedSystem:
        """Return a copy with compiled functions of its own, for another thread; its own copies share them."""
        made = self._as_it_is()
        made._made = None
        made.evaluation()
        return made

    @property
    def coordinates(self) -> int:
        """Number n of coordinates."""
        return self._model.n

    @property
    def contacts(self) -> tuple[CoordinateContact, ...]:
        """All contacts, in the order in which they were added."""
        return self._parts.parts(CoordinateContact)

    @arguments.known
    def add_contact(
        self,
        gap,
        *,
        tangent=None,
        gap_gradient: Callable | None = None,
        restitution: float | Restitution,
        friction: float | FrictionLaw = 0.0,
        impact_law: str = "newton",
        tangential_restitution: float = 0.0,
        name: str | None = None,
    ) -> CoordinateContact:
        """Add a contact: a gap that impacts and contact forces keep from becoming negative.

        Parameters
        ----------
        gap : expression or callable ``gap(q) -> float``
            Gap of the contact [m], positive while the contact is open. Its rate and `tangent` must be speeds of
            the same point, because friction relates the forces along both.
        tangent : expression, or two; or callable ``tangent(q) -> (n,)`` or ``(2, n)``, optional
            One or two tangential speeds of the point, linear in the velocities; a function returns the rows
            that multiply the velocities. Two speeds must have perpendicular directions. Default: none, without
            friction.
        gap_gradient : callable, optional
            ``gap_gradient(q) -> (n,)``, only for a system of functions. Default: central differences.
        restitution : float or Restitution
            Coefficient of restitution e, in [0, 1], or its law, a function of the speed of approach.
        friction : float or Friction
            Coulomb's friction coefficient, at least 0, or its law, a function of the slip. Default 0.
        impact_law : {"newton", "poisson", "stronge", "moreau"}
            As for `carom.resolve_impact`.
        tangential_restitution : float
            e_t in [-1, 1], as for `carom.resolve_impact`. Default 0.
        name : str, optional
            Name of the contact. Default ``"contact k"``.

        Raises
        ------
        ValueError
            If an argument is invalid, or `friction` is given without `tangent`.
        """
        name = f"contact {len(self.contacts)}" if name is None else name
        index, name = self._parts.new(CoordinateContact, name, "contact")
        contact = CoordinateContact(
            name, restitution, friction, impact_law, tangential_restitution, index
        )
        self._check_friction(contact, tangent is not None)
        self._model.add_contact(gap, gap_gradient, tangent)
        self._made = None
        return self._parts.add(contact)

    def evaluation(self) -> Evaluation:
        """Return the compiled functions of the system, for evaluation at single states."""
        if self._made is None:
            from carom.generalized.evaluate import Evaluation

            self._made = Evaluation(self)
        return self._made

    def _look(self, position):
        return self.evaluation().look(self._at(position))

    def metric(self, position) -> np.ndarray:
        """Return M (n, n) at coordinates (n,)."""
        return self._look(position).M.copy()

    def christoffel(self, position) -> np.ndarray:
        r"""Return the affinities :math:`\Gamma^k_{ij}` (n, n, n), k first, at `position` (n,)."""
        return self.evaluation().christoffel(self._at(position))

    def gaps(self, position) -> np.ndarray:
        """Return the gaps (C,) of all contacts at coordinates (n,)."""
        return self._look(position).gap.copy()

    def autoparallel(self, position, velocity) -> tuple[np.ndarray, np.ndarray]:
        """Return the end (q, v) of the autoparallel from `position` with `velocity`, after a time of 1.

        The autoparallel is a geodesic of the metric, ``q'' + Gamma(q', q') = 0``. It is integrated
        to 1e-13 of the coordinates by SciPy's `solve_ivp`.

        Raises
        ------
        ValueError
            If an argument is invalid, or the metric becomes singular.
        """
        v = checks.finite_array("velocity", velocity, (self.coordinates,))
        return self.evaluation().autoparallel(self._at(position), v)

    def return_map(self, position, contact: CoordinateContact | str) -> np.ndarray:
        """Return the coordinates that the return map gives: there the gap of a contact is zero.

        The return map follows an autoparallel that ends normal (in the metric) to the surface of zero gap and
        satisfies the constraints (paper, contact detection; mathematics page, §4.2).

        Raises
        ------
        ValueError
            If the system has no such contact, `position` is not finite, or the map does not converge.
        """
        index = self._parts.member("contact", contact, (CoordinateContact,)).index
        return self.evaluation().return_map(self._at(position), index)

    def _at(self, position) -> np.ndarray:
        return checks.finite_array("position", position, (self.coordinates,))

    def __repr__(self) -> str:
        return (
            f"<GeneralizedSystem: {self.coordinates} coordinates, {self._model.rows} constraints, "
            f"{len(self.contacts)} contacts>"
        )
