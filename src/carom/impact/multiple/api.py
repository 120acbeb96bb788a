"""`resolve_impacts`: solve a multiple impact."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import arguments, checks
from carom.friction.checks import checked_inverse_masses, codes, per_contact
from carom.impact.thresholds import GREATEST_LAYER_RTOL, LAYER_RTOL, LEAST_LAYER_RTOL
from carom.scene.friction import FrictionLaw, isotropic
from carom.scene.restitution import Restitution

if TYPE_CHECKING:
    from carom.impact.multiple.forces import ImpactForces
    from carom.impact.multiple.layout import CornerContacts
    from carom.model.laws import Laws


@dataclass(frozen=True)
class CornerImpact:
    """The result of a multiple impact. The first index is the contact, the next normal, tangent 1, tangent 2.

    Parameters
    ----------
    velocity_after : ndarray, shape (k, 3)
        Relative velocities after the impact [m/s].
    impulse : ndarray, shape (k, 3)
        Impulses [N s]: ``velocity_after = velocity + W impulse``. If contacts are redundant (four corners of a
        box), the sum and the moment of their impulses are determined, but not the single impulses.
    compression_work, restitution_work : ndarray, shape (k,)
        Work of each normal force during loading (at most 0) and unloading (at least 0) [J].
    friction_loss : ndarray, shape (k,)
        Energy dissipated by friction at each contact [J], at least 0; with the law "moreau" it may be a gain.
    energy_change : float
        Change of kinetic energy: compression_work + restitution_work - friction_loss, summed over the contacts
        [J]. It is at most 0, except for a single contact with Newton's law, and with the law "moreau".
    plastic_change : float
        Part of the change in a plastic event [J]: all of it if every restitution is 0, or the remaining energy
        of a body that is trapped, or wedged by friction; 0 if there was no plastic event.
    law_missed : float
        Greatest error of e, as ln(target/reached), if Newton's or Poisson's law cannot hold at some contact; 0
        if all laws hold.
    capped : bool
        Whether the law of a contact requires more energy than the contact has absorbed; the contact then
        returns all that it has absorbed.
    wedged : ndarray of bool, shape (k,)
        Whether friction wedges the contact at the end, so that its law of restitution cannot hold.
    at_once : bool
        Whether the integration through the boundary layer failed, so that the impact was solved as one contact
        problem instead (Newton's law at each contact; Moreau 1988).
    steps, events : int
        Numbers of integration steps, and of changes between open, loading and unloading.
    """

    velocity_after: np.ndarray
    impulse: np.ndarray
    compression_work: np.ndarray
    restitution_work: np.ndarray
    friction_loss: np.ndarray
    energy_change: float
    plastic_change: float
    law_missed: float
    capped: bool
    wedged: np.ndarray
    at_once: bool
    steps: int
    events: int
    #: what was stated
    _stated: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)

    def force(self, stiffness=None) -> ImpactForces:
        """Return the forces of the contacts in time.

        Parameters
        ----------
        stiffness : Stiffness or Hertz, or a sequence of k of them, optional
            Of all contacts or of each, with one exponent. Default: those that were stated. The impact must have
            been solved with their ratios and this exponent, because its result depends on them.

        Returns
        -------
        carom.impact.ImpactForces

        Raises
        ------
        TypeError, ValueError
            If no stiffness in newton is stated, or the impact has no course in time: one contact problem, a
            plastic event, blows one after another.
        """
        from carom.impact.multiple.forces import of_corner

        return of_corner(self, stiffness)


@arguments.known
def resolve_impacts(
    inverse_mass,
    velocity,
    friction,
    restitution,
    law="newton",
    *,
    multiple: str = "simultaneous",
    stiffness=None,
    exponent: float | None = None,
    rtol: float = LAYER_RTOL,
    tangential_restitution=0.0,
) -> CornerImpact:
    """Solve the multiple impact of k closed contacts, one or more of which strike.

    Parameters
    ----------
    inverse_mass : array_like, shape (3 k, 3 k) or (k, 3, k, 3)
        Delassus operator W = G M^-1 G^T of the contacts [1/kg], symmetric, positive semidefinite, often
        singular; rows (n, t1, t2) of each contact.
    velocity : array_like, shape (k, 3)
        Relative velocities before the impact [m/s], normal first. A contact with a negative normal velocity
        strikes; with 0 it touches (bodies at rest on each other); with a positive one it opens, and the other
        contacts may close it again.
    friction : float, carom.Friction, or a sequence of k of them
        Coulomb's coefficient mu, at least 0, or a law of the slip, followed along the impact. One contact
        problem at once (a plastic event, ``"newton"``) has mu at the slip after the impact.
    restitution : float, carom.Restitution, or a sequence of k of them
        Coefficient of restitution e in [0, 1], or a law of the speed of approach. If all e are 0, the impact is
        one plastic event. Otherwise an e below 0.01 is replaced by 0.01.
    law : {"newton", "poisson", "stronge", "moreau"} or a sequence of k of them
        Definition of e: the ratio of normal velocities of each striking contact (default) or of impulses, or
        the square root of the ratio of works of the normal force. With more than one contact, no contact
        returns more energy than it has absorbed. ``"moreau"`` at any of the contacts that strike together: all
        are one contact problem with Newton's law and friction by the slip after, which may add energy; where
        it has no solution, the least e of all holds, or e = 0.
    multiple : {"simultaneous", "sequential", "newton"}
        ``"simultaneous"`` (default): all contacts together through their boundary layers. ``"sequential"``: one
        impact after another, each time the contact that approaches fastest, together with those that approach
        equally fast. This is fast, and exact for a row of balls with e = 1, but in other cases it depends on
        the order. ``"newton"``: one contact problem with Newton's law at each contact (Moreau 1988), or e = 0
        if that would increase the energy. This is the fastest, for crowds; `law` and `stiffness` are not used.
    stiffness : array_like, shape (k,), Stiffness, Hertz, or a sequence of k of them, optional
        Stiffness kappa of the contacts, of which only ratios matter. Default: all equal. If `Stiffness` or
        `Hertz` (with a radius) are given, they have one exponent, and `CornerImpact.force` is known.
    exponent : float
        Exponent p of the normal law N = kappa depth^p, at least 1. Default 1, or that of `stiffness`; Hertz's
        law has 1.5.
    rtol : float
        Relative tolerance of velocities, within [1e-12, 1e-2]. Default 1e-8.
    tangential_restitution : float or array_like, shape (k,)
        e_t in [-1, 1], as for `resolve_impact`, of contacts that stick at their end. Default 0.

    Returns
    -------
    CornerImpact
        Velocities after the impact, impulses and energies.

    Raises
    ------
    ValueError
        If an argument is invalid, or if no method has a result that keeps the contacts apart without a gain
        of energy.

    Notes
    -----
    Mathematics page, part 2. Rigid bodies do not determine how an impact is divided among contacts; the
    stiffness does. **It is physics, not a numerical parameter.** A row of three equal balls that is struck at
    one end (Newton's cradle, e = 1, v = 1) ends with the velocities (-.130, .150, .980) for equal linear
    contacts, and (-.071, .076, .995) for Hertz's law (``exponent=1.5``). The result tends to (0, 0, 1) of the
    textbook if the stiffness decreases along the row (.999999 for a hundredth), or with
    ``multiple="sequential"``. For a stiff second contact it tends to (-1/3, 2/3, 2/3). The balls of a real
    cradle have small gaps, which is the sequential case.

    Contacts that move alike are solved as one: a box that falls flat on its face has the same cost and the same
    result as one contact. A face with m contact points gives the same result for any m if its stiffness is
    divided among them.
    """
    from carom.impact.layout import AT_ONCE, OK
    from carom.impact.multiple.forces import stated_stiffness
    from carom.impact.multiple.layout import (
        CAPPED,
        FINAL_SLIP,
        MESSAGES,
        MULTIPLE,
        NO_RESULT,
        NOT_RESOLVED,
        SIMULTANEOUS,
        MultipleSettings,
    )
    from carom.law.impact_laws import NUMBERS

    u = checks.finite_array("velocity", velocity, (None, 3), "m/s")
    k = len(u)
    if k == 0:
        raise ValueError(f"velocity must have at least one contact, got {checks.shown(velocity)}")
    W = checked_inverse_masses(inverse_mass, k)
    mu = _frictions(friction, k)
    e = _restitutions(restitution, np.maximum(-u[:, 0], 0.0))
    e_t = per_contact("tangential_restitution", tangential_restitution, k, least=-1.0, most=1.0)
    absolute = stated_stiffness("stiffness", stiffness, k)
    if absolute is None:
        kappa = per_contact("stiffness", 1.0 if stiffness is None else stiffness, k, above=0.0)
    else:
        kappa = absolute[0] / absolute[0].max()
        if exponent not in (None, absolute[1]):
            raise ValueError(
                f"exponent must be that of stiffness, {absolute[1]:g}, or None, got {checks.shown(exponent)}"
            )
        exponent = absolute[1]
    numbers = codes("law", law, k, NUMBERS)
    settings = MultipleSettings(
        multiple=MULTIPLE[checks.choice("multiple", multiple, MULTIPLE)],
        rtol=checks.number("rtol", rtol, least=LEAST_LAYER_RTOL, most=GREATEST_LAYER_RTOL),
        exponent=checks.number(
            "exponent", 1.0 if exponent is None else exponent, least=1.0, most=4.0
        ),
    )
    laws = stated_laws(mu, e, numbers, e_t, kappa)
    code, out = solve(W, np.ascontiguousarray(u), laws, settings)
    summary = out.summary[0]
    if code == OK and summary["marks"] & NO_RESULT:
        code = NOT_RESOLVED
    if code != OK:
        raise ValueError(f"the impact could not be solved: {MESSAGES[code]}")
    return CornerImpact(
        velocity_after=out.velocity.reshape(k, 3).copy(),
        impulse=out.impulse.reshape(k, 3).copy(),
        compression_work=out.compression.copy(),
        restitution_work=out.restitution.copy(),
        friction_loss=out.friction.copy(),
        energy_change=float(summary["energy_change"]),
        plastic_change=float(summary["plastic_change"]),
        law_missed=float(summary["miss"]),
        capped=bool(summary["marks"] & CAPPED),
        wedged=out.wedged != 0,
        at_once=bool(summary["marks"] & AT_ONCE),
        steps=int(summary["steps"]),
        events=int(summary["events"]),
        _stated={
            "W": W,
            "velocity": u,
            "laws": laws,
            "settings": settings,
            "kappa": kappa,
            "stiffness": stiffness,
            "course": settings.multiple == SIMULTANEOUS and not summary["marks"] & FINAL_SLIP,
        },
    )


def _frictions(given, k: int):
    """Return the friction of k contacts: numbers, or some laws among them."""
    laws = [given] * k if isinstance(given, FrictionLaw) else given
    if not (isinstance(laws, (list, tuple)) and any(isinstance(one, FrictionLaw) for one in laws)):
        return per_contact("friction", given, k, least=0.0)
    if len(laws) != k:
        raise ValueError(f"friction must be one value or {k} of them, got {checks.shown(given)}")
    return [isotropic(f"friction[{i}]", one) for i, one in enumerate(laws)]


def _restitutions(given, approach: np.ndarray) -> np.ndarray:
    """Return e (k,): numbers, or the values of laws at speeds of approach (k,)."""
    k = len(approach)
    laws = [given] * k if isinstance(given, Restitution) else given
    if not (isinstance(laws, (list, tuple)) and any(isinstance(one, Restitution) for one in laws)):
        return per_contact("restitution", given, k, least=0.0, most=1.0)
    if len(laws) != k:
        raise ValueError(f"restitution must be one value or {k} of them, got {checks.shown(given)}")
    e = [one(v) if isinstance(one, Restitution) else one for one, v in zip(laws, approach)]
    return per_contact("restitution", [float(one) for one in e], k, least=0.0, most=1.0)


def stated_laws(friction, restitution, law, tangential, stiffness) -> Laws:
    """Return the laws of k contacts, in their order, from their columns."""
    from carom.model.laws import LawTable

    laws = LawTable()
    for mu, e, number, e_t, kappa in zip(friction, restitution, law, tangential, stiffness):
        laws.add(mu, e, impact_law=number, tangential_restitution=e_t, stiffness=kappa)
    return laws.arrays()


def solve(W, u, laws, settings, workspace=None):
    """Solve a multiple impact of contacts (k,) with velocities (k, 3) and laws (k,); return code and result."""
    from carom.impact.multiple.layout import new_multiple_result
    from carom.impact.multiple.resolve import resolve_multiple
    from carom.impact.multiple.workspace import new_multiple_workspace

    k = len(u)
    room, out = workspace or new_multiple_workspace(k), new_multiple_result(k)
    contacts = stated_contacts(W, u, laws, settings.multiple)
    return resolve_multiple(k, contacts, laws, settings, room, out), out


def stated_contacts(W, u, laws: Laws, multiple: int) -> CornerContacts:
    """Return contacts with these velocities (k, 3) and laws (k,)."""
    from carom._compiled.record_arrays import table
    from carom.impact.multiple.layout import CORNER_CONTACT, SEQUENTIAL, CornerContacts

    contact, stated = table(CORNER_CONTACT, len(u)), laws.table
    for name in ("friction", "restitution", "stiffness"):
        contact[name] = stated[name]
    contact["law"] = np.arange(len(u))
    contact["pair"] = np.arange(len(u)) if multiple == SEQUENTIAL else 0
    return CornerContacts(contact, W, u.reshape(-1))
