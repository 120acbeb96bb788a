"""`resolve_impact`: solve one frictional impact."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from carom import arguments, checks
from carom.friction.checks import semidefinite
from carom.scene.shown import Shown, hodograph_of
from carom.scene.speed_law import SpeedLaw
from carom.scene.stiffness import ABSOLUTE, Hertz, Stiffness


@dataclass(frozen=True)
class Impact(Shown):
    """The result of an impact. Vectors are in contact axes: normal, tangent 1, tangent 2.

    Of several impacts all are arrays, whose first axes are those of the arguments together; `phases` is an
    array of tuples. Of a plane impact vectors have two components.

    Parameters
    ----------
    velocity_after : ndarray, shape (3,)
        Relative velocity after the impact [m/s].
    impulse : ndarray, shape (3,)
        Impulse of the whole impact [N s].
    compression_impulse : ndarray, shape (3,)
        Impulse up to the end of compression, where the normal velocity is zero [N s]. If strong coupling (a
        jam) makes the bodies approach again, the last such end counts.
    compression_work, restitution_work : float
        Work of the normal force in compression (negative, unless the bodies approach again) and in restitution
        [J].
    friction_loss : float
        Energy dissipated by friction [J], at least 0; with the law "moreau" it may be a gain.
    energy_change : float
        Change of kinetic energy: compression_work + restitution_work - friction_loss [J].
    phases : tuple of str
        Phases of the contact, in order: "slip", "jam" (the normal force makes the bodies approach while they
        slip), then "stick" or "reversal" (slip stops and starts again at once), "wedged".
    wedged : bool
        Whether friction wedges the pair in restitution, so that no impulse separates it (W becomes singular).
        The impact then ends with the velocity reached so far, and its law of restitution does not hold. With
        Poisson's law the impulse of restitution is included, but does not change the velocity.
    """

    velocity_after: np.ndarray
    impulse: np.ndarray
    compression_impulse: np.ndarray
    compression_work: float
    restitution_work: float
    friction_loss: float
    energy_change: float
    phases: tuple[str, ...]
    wedged: bool
    #: what was stated, by the names of an `ImpactRecord`
    _stated: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)

    def _force(self) -> Any:
        if self._stated.get("stiffness") is None:
            return None
        if "force" not in self._stated:
            self._stated["force"] = self.force()
        return self._stated["force"]

    @property
    def peak_force(self) -> Any:
        """Greatest normal force [N], of several impacts an array; NaN as `duration`."""
        from carom.impact.force import peak_force

        stiffness = self._stated.get("stiffness")
        if not with_path(self._stated.get("law", "newton")):
            stiffness = None
        none = np.full(np.shape(self.compression_work), np.nan)
        peak = (
            none if stiffness is None else peak_force(self.compression_work, *stiffness._of(None))
        )
        return float(peak) if np.ndim(peak) == 0 else peak

    @property
    def duration(self) -> float:
        """Duration [s] of a single impact; NaN without a stiffness, or with a law that has no course."""
        force = self._force() if with_path(self._stated.get("law", "newton")) else None
        return np.nan if force is None else force.duration

    def force(self, stiffness: Stiffness | Hertz | None = None) -> Any:
        """Return the force of a single impact in time.

        Parameters
        ----------
        stiffness : Stiffness or Hertz, optional
            Default: that which was stated.

        Returns
        -------
        carom.impact.force.ImpactForce
        """
        from carom.impact.force import of_stated

        return of_stated(
            self._stated, self._stated.get("stiffness") if stiffness is None else stiffness
        )

    def plot(self, **options):
        """Draw the hodograph of the impact, `carom.plots.hodograph`, and return its axes.

        Parameters
        ----------
        **options
            Other arguments of that function, for example ``panel="slip"`` and ``ax``.
        """
        return hodograph_of(self, options)


@arguments.known
def resolve_impact(
    inverse_mass,
    velocity,
    friction,
    restitution,
    law: str = "newton",
    *,
    tangential_restitution: float = 0.0,
    stiffness: Stiffness | Hertz | None = None,
) -> Impact:
    """Solve one impact with Coulomb friction to round-off (Darboux-Keller equation).

    Parameters
    ----------
    inverse_mass : array_like, shape (..., 3, 3) or (..., 2, 2)
        Delassus operator W of the contact [1/kg], symmetric, positive semidefinite, normal first. It is zero
        for a tangential direction in which nothing can move. With (2, 2) the impact is plane: normal and one
        tangent. `carom.contact_inverse_mass` computes it for a body of a scene.
    velocity : array_like, shape (..., 3) or (..., 2)
        Relative velocity before the impact [m/s]; the normal component is first, and negative (approach).
    friction : float or carom.Friction, or array_like of them
        Coulomb coefficient mu, at least 0, or a law of the slip, which is followed along the impact.
    restitution : float or carom.Restitution, or array_like of them
        Coefficient e in [0, 1], or a law of the speed of approach. For 0 the impact ends with compression, with
        every law.
    law : {"newton", "poisson", "stronge", "moreau"}, or array of them
        Definition of e, also by the name `impact_law`: the ratio of normal velocities (kinematic, default), of
        normal impulses (kinetic), or the square root of the ratio of works of the normal force (energetic). The
        three agree if the direction of slip is constant. Newton's law can increase the energy if slip stops or
        reverses; Stronge's never does. ``"moreau"`` is Newton's with friction by the slip after the impact: one
        contact problem (`carom.solve_contacts` with the velocity ``[u_n (1 + e), u_t]``) without a path. It may
        add energy too; works are divided as by a spring, and phases are those after the impact.
    tangential_restitution : float or array_like
        Coefficient e_t in [-1, 1]. Where the impact ends in stick the slip becomes ``-e_t`` times that before,
        as far as the cone of friction and the energy that friction has taken allow, without a gain. 1 is a
        super ball; below 0 slip keeps its direction, and -1 is a smooth surface. Default 0.
    stiffness : Stiffness or Hertz, optional
        Stiffness of the contact, from which `Impact.peak_force`, `.duration` and `.force()` follow. A `Hertz`
        needs its radius. It changes nothing else. Default None.

    Returns
    -------
    Impact
        Velocity after the impact, impulse, energies and phases. If arguments have more axes, many impacts are
        solved, for all of them together by the rules of NumPy (broadcasting).

    Raises
    ------
    ValueError
        If an argument is invalid, shapes do not go together, or no impulse stops the approach: W is singular,
        friction wedges the pair, and `velocity` has a component that no impulse changes (for example that of a
        driver).

    Notes
    -----
    Mathematics page, §1.9 and §1.10. Slip is integrated by its Taylor series. When it stops, the contact sticks
    if friction suffices; otherwise slip starts again in the only direction that leads away from rest.

    Examples
    --------
    A sphere of 1 kg strikes the ground at 1 m/s and slips at 1 m/s; its tangential W is 7/2 of the normal one:

    >>> impact = carom.resolve_impact(np.diag([1.0, 3.5, 3.5]), (-1.0, 1.0, 0.0), friction=0.1, restitution=0.5)
    >>> print(impact.velocity_after, impact.impulse, impact.phases)
    [0.5   0.475 0.   ] [ 1.5  -0.15  0.  ] ('slip',)

    In the plane, for three coefficients of friction; with the last two it sticks:

    >>> mu = np.array([0.1, 0.2, 0.3])
    >>> impact = carom.resolve_impact(np.diag([1.0, 3.5]), (-1.0, 1.0), friction=mu, restitution=0.5)
    >>> print(impact.velocity_after[:, 1], impact.phases[2])
    [0.475 0.    0.   ] ('slip', 'stick')
    """
    from carom.impact import layout as o
    from carom.impact.resolve import resolve
    from carom.impact.tangential import return_slip

    given = inverse_mass, velocity, friction, restitution, law
    if stiffness is not None:
        checks.instance("stiffness", stiffness, ABSOLUTE)
        stiffness._of(None)
    if _are_many(*given, tangential_restitution):
        from carom.impact.many import resolve_many

        many = resolve_many(*given, tangential_restitution)
        if stiffness is not None:
            many._stated["stiffness"] = stiffness
        return many
    W, u, mu, e, number = checked_impact(inverse_mass, velocity, friction, restitution, law)
    e_t = checked_tangential(tangential_restitution)
    out = np.zeros(o.SIZE)
    raise_for(resolve(W, u, mu, e, number, out))
    if e_t != 0.0:
        return_slip(W, u, mu, e_t, out)
    stated = {
        "inverse_mass": W, "relative_velocity_before": u, "friction": mu, "restitution": e, "law": law,
        "stiffness": stiffness,
    }  # fmt: skip
    return Impact(
        velocity_after=out[o.VELOCITY : o.VELOCITY + 3].copy(),
        impulse=out[o.IMPULSE : o.IMPULSE + 3].copy(),
        compression_impulse=out[o.COMPRESSION : o.COMPRESSION + 3].copy(),
        compression_work=float(out[o.WORK_C]),
        restitution_work=float(out[o.WORK_R]),
        friction_loss=float(out[o.FRICTION_LOSS]),
        energy_change=float(out[o.ENERGY_CHANGE]),
        phases=phase_names(int(out[o.PHASES])),
        wedged=int(out[o.PHASES]) & o.WEDGED != 0,
        _stated=stated,
    )


def _are_many(inverse_mass, velocity, *numbers) -> bool:
    """Return whether arguments have more axes than those of one impact, are of a plane one, or laws."""
    cores = ((inverse_mass, 2), (velocity, 1), *((one, 0) for one in numbers))
    try:
        more = any(np.ndim(value) > axes for value, axes in cores)
        by_law = any(isinstance(value, SpeedLaw) for value, _ in cores)
        return more or by_law or np.shape(inverse_mass) == (2, 2)
    except Exception:  # whatever is no array is refused by its name, as a part of one impact
        return False


def checked_impact(inverse_mass, velocity, friction, restitution, law):
    """Return the arguments of an impact in the form of the kernels; raise ValueError if they are invalid."""
    from carom.law.impact_laws import NUMBERS

    W = checked_inverse_mass(inverse_mass)
    u = checks.finite_array("velocity", velocity, (3,), "m/s")
    checks.number(
        "velocity[0] (normal velocity, approach is negative)", float(u[0]), below=0.0, unit="m/s"
    )
    mu = checks.number("friction", friction, least=0.0)
    e = checks.number("restitution", restitution, least=0.0, most=1.0)
    return W, u, mu, e, NUMBERS[checks.choice("law", law, NUMBERS)]


def with_path(law: str) -> bool:
    """Return whether a law follows the impact over its impulse, and does not only state what is after it."""
    from carom.law.impact_laws import NUMBERS, WITHOUT_PATH

    return NUMBERS.get(law) not in WITHOUT_PATH


def need_path(what: str, law: str) -> None:
    """Raise ValueError if the course of an impact is asked for whose law has none."""
    if not with_path(law):
        raise ValueError(
            f"{what} must be of an impact with a course over its impulse, got impact_law={law!r}, which states "
            "only the velocities after it; the other laws have one"
        )


def checked_tangential(given) -> float:
    """Return e_t; raise ValueError unless it is from -1 to 1."""
    return checks.number("tangential_restitution", given, least=-1.0, most=1.0)


def checked_inverse_mass(inverse_mass) -> np.ndarray:
    """Return W as a symmetric array; raise ValueError unless W >= 0 and W_nn > 0."""
    W = checks.finite_array("inverse_mass", inverse_mass, (3, 3), "1/kg")
    checks.number("inverse_mass[0, 0] (normal)", W[0, 0], above=0.0, unit="1/kg")
    return semidefinite(W)


def raise_for(code: int) -> None:
    """Raise ValueError with the message for the code of a kernel, unless the code is 0."""
    from carom.impact.layout import MESSAGES, OK

    if code != OK:
        raise ValueError(f"the impact could not be solved: {MESSAGES[code]}")


def phase_names(mask: int) -> tuple[str, ...]:
    """Return the phases of a bit mask, in the order in which they are passed."""
    from carom.impact.layout import PHASE_JAM, PHASE_RESTART, PHASE_SLIP, PHASE_STICK, WEDGED

    names = (
        (PHASE_SLIP, "slip"), (PHASE_JAM, "jam"), (PHASE_RESTART, "reversal"),
        (PHASE_STICK, "stick"), (WEDGED, "wedged"),
    )  # fmt: skip
    return tuple(name for bit, name in names if mask & bit)
