"""Several impacts at once: `resolve_impacts`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom import checks
from carom.friction.checks import checked_inverse_masses, per_contact


@dataclass(frozen=True)
class CornerImpact:
    """What a multiple impact did. Contacts in the first index, then normal, tangent 1, tangent 2.

    Parameters
    ----------
    velocity_after : ndarray, shape (k, 3)
        Relative velocities after the impact [m/s].
    impulse : ndarray, shape (k, 3)
        Impulses [N s]. ``velocity_after = velocity + W impulse``. Where contacts are redundant (four corners
        of a box) their sum and moment are determined, not their shares.
    compression_work, restitution_work : ndarray, shape (k,)
        Work of each normal force while the contact loads (not positive) and unloads (not negative) [J].
    friction_loss : ndarray, shape (k,)
        Energy dissipated by friction at each contact, not negative [J].
    energy_change : float
        Change of kinetic energy: the sum of the three above, never positive but for a single contact with
        Newton's law [J].
    plastic_change : float
        Part of it that a plastic event took: all of it where every restitution is 0, or the rest of a
        body that is trapped (0 if there was none) [J].
    law_missed : float
        Greatest difference of e reached from e asked for, as ln(target/reached), where Newton's or Poisson's
        law could not be met; 0 where all are met.
    capped : bool
        Whether somewhere the law asks for more energy than the contact took: it gives back all, not more.
    wedged : ndarray of bool, shape (k,)
        Where friction holds a contact at rest at the end: its law of restitution could not be met.
    at_once : bool
        Whether the boundary layer could not be passed, and the impact was solved as one contact problem instead
        (Newton's law at each contact; Moreau 1988).
    steps, events : int
        Steps of integration, and changes between open, loading and unloading.
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


def resolve_impacts(
    inverse_mass,
    velocity,
    friction,
    restitution,
    law="newton",
    *,
    multiple: str = "simultaneous",
    stiffness=None,
    exponent: float = 1.0,
    rtol: float = 1e-8,
) -> CornerImpact:
    """Resolve the impact of k contacts that are closed together, while one or more of them strike.

    Parameters
    ----------
    inverse_mass : array_like, shape (3 k, 3 k) or (k, 3, k, 3)
        W = G M^-1 G^T of the contacts [1/kg], symmetric, positive semidefinite, often singular; rows (n, t1,
        t2) of each contact.
    velocity : array_like, shape (k, 3)
        Relative velocities before [m/s], normal first. Negative normal: the contact strikes; 0: it touches
        (bodies at rest on each other); positive: it opens, and may be closed again by the others.
    friction, restitution : float or array_like, shape (k,)
        Coulomb coefficient mu, at least 0, and coefficient e in [0, 1]. Where all e are 0 the
        impact is one plastic event. Otherwise an e below 0.01 is taken as 0.01.
    law : {"newton", "poisson", "stronge"} or a sequence of k of them
        What e compares: normal velocities of each contact that strikes (default), impulses, or works of
        the normal force. For more than one contact no law gives back more energy than it took.
    multiple : {"simultaneous", "sequential", "newton"}
        All contacts together through their boundary layers (default), or blow by blow, each time the contact
        that approaches fastest, with those that approach equally fast: quick, exact for a row of balls with
        e = 1, but else dependent on the order.
        "newton": one contact problem for all, Newton's law at each (Moreau 1988), or e = 0 where that would
        raise the energy: quickest, for crowds; `law` and `stiffness` play no part.
    stiffness : array_like, shape (k,), optional
        Stiffness kappa of the contacts; with ``exponent=1`` only ratios matter. Default: all equal.
    exponent : float
        p of the normal law N = kappa depth^p, at least 1. Default 1; 1.5 is Hertz's.
    rtol : float
        Relative error of velocities, within [1e-12, 1e-2]. Default 1e-8.

    Returns
    -------
    CornerImpact

    Raises
    ------
    ValueError
        If an argument is not as above.

    Notes
    -----
    Mathematics page, part 2. The normals of rigid bodies do not say how an impact divides among contacts: the
    stiffness does. **It is physics, not a numerical parameter.** A row of three equal balls struck at one end
    (Newton's cradle, e = 1, v = 1) ends with (-.130, .150, .980) for equal linear contacts, with (-.071, .076,
    .995) for Hertz's (``exponent=1.5``), and tends to the (0, 0, 1) of the textbook as stiffness falls
    along the row (.999999 for a hundredth), or by ``multiple="sequential"``. For a stiff second contact it
    tends to (-1/3, 2/3, 2/3). A real cradle's balls do not quite touch, which is the sequential case.

    Contacts that move alike are solved as one: a box that falls flat on its face costs and gives
    exactly what one contact does. A surface that is carried by m points gives the same for any m if its
    stiffness is divided among them.
    """
    from carom.impact.laws import NUMBERS
    from carom.impact.multiple.layout import (
        AT_ONCE,
        CAPPED,
        MESSAGES,
        MULTIPLE,
        OK,
        CornerContacts,
        MultipleSettings,
        new_multiple_result,
        new_multiple_workspace,
    )
    from carom.impact.multiple.resolve import resolve_multiple

    u = checks.finite_array("velocity", velocity, (None, 3), "m/s")
    k = len(u)
    if k == 0:
        raise ValueError(f"velocity must have at least one contact, got {checks.shown(velocity)}")
    W = checked_inverse_masses(inverse_mass, k)
    mu = per_contact("friction", friction, k, least=0.0)
    e = per_contact("restitution", restitution, k, least=0.0, most=1.0)
    kappa = per_contact("stiffness", 1.0 if stiffness is None else stiffness, k, above=0.0)
    names = [law] * k if isinstance(law, str) else checks.listed("law", law, "names")
    if len(names) != k:
        raise ValueError(f"law must be one name or {k} of them, got {checks.shown(law)}")
    numbers = np.array([NUMBERS[checks.choice("law", name, NUMBERS)] for name in names])
    settings = MultipleSettings(
        multiple=MULTIPLE[checks.choice("multiple", multiple, MULTIPLE)],
        rtol=checks.number("rtol", rtol, least=1e-12, most=1e-2),
        exponent=checks.number("exponent", exponent, least=1.0, most=4.0),
    )
    out = new_multiple_result(k)
    workspace = new_multiple_workspace(k)
    velocities = np.ascontiguousarray(u).reshape(-1)
    pair = np.arange(k) if multiple == "sequential" else np.zeros(k, dtype=np.int64)
    contacts = CornerContacts(k, 0, W, velocities, mu, e, numbers, kappa, pair)
    code = resolve_multiple(contacts, settings, workspace, out)
    if code != OK:
        raise ValueError(f"the impact was not resolved: {MESSAGES[code]}")
    summary = out.summary[0]
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
    )
