"""`solve_contacts`: solve the contact problem of many frictional contacts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom import arguments, checks
from carom.friction.checks import checked_inverse_masses, codes, per_contact
from carom.friction.thresholds import HEADING_ERROR

KINDS = {"coulomb": 0, "sliding": 1, "sticking": 2}


@dataclass(frozen=True)
class ContactSolution:
    """Impulses of k contacts, and their errors. Vectors are in contact axes: normal, tangent 1, tangent 2.

    Parameters
    ----------
    impulse : ndarray, shape (k, 3)
        Impulses p [N s].
    velocity : ndarray, shape (k, 3)
        Velocities w = W p + (velocity without impulses) [m/s].
    residual : float
        Greatest residual of a contact [m/s]: the natural map
        ``|p - P_K(p - rho (w + mu |w_t| e_n))| / rho``, ``rho = 3 / trace W_ii``.
    penetration_speed : float
        Greatest ``-w_n``, at least 0 [m/s].
    cone_violation : float
        Greatest ``|p_t| - mu p_n`` or ``-p_n``, at least 0 [N s].
    complementarity : float
        Greatest ``|p_n w_n|`` [J].
    iterations : int
        Number of Newton steps and sweeps; 0 for one contact, which is solved in closed form.
    converged : bool
        Whether the residual is below 1e-10 of the greatest entry of the given velocity, plus 50 times the
        round-off of the greatest ``(|W| |p|)_i``. In most problems it is at round-off.
    message : str
        A sentence about the convergence.
    """

    impulse: np.ndarray
    velocity: np.ndarray
    residual: float
    penetration_speed: float
    cone_violation: float
    complementarity: float
    iterations: int
    converged: bool
    message: str


@arguments.known
def solve_contacts(
    inverse_mass, velocity, friction, *, kind="coulomb", heading=None, start=None
) -> ContactSolution:
    r"""Solve for the impulses of k plastic contacts with Coulomb friction, ``0 <= p_n _|_ w_n >= 0``.

    Parameters
    ----------
    inverse_mass : array_like, shape (3k, 3k) or (k, 3, k, 3)
        Delassus operator W of the contacts [1/kg], symmetric, positive semidefinite, rows (normal, tangent 1,
        tangent 2) of each contact. It may be singular: four corners of a box have rank 6 of 12. Numbers of a
        file do: up to 1e-5 of the greatest entry it may be asymmetric, and is made symmetric; and eigenvalues
        may be down to -1e-5 of the greatest, for which twice the least is taken from the diagonal.
    velocity : array_like, shape (3k,) or (k, 3)
        Relative velocities without the impulses [m/s]; approach is negative.
    friction : float or array_like, shape (k,)
        Coulomb's coefficient mu of each contact, at least 0.
    kind : str or sequence of k str, default "coulomb"
        "coulomb": ``|p_t| <= mu p_n``, opposite to w_t if the contact slips. "sliding": the direction of slip
        is known, ``p_t = -mu p_n heading``. "sticking": w_t = 0, with any tangential impulse.
    heading : array_like, shape (k, 2), optional
        Directions for "sliding", unit vectors or zero (no friction). Default: zero.
    start : array_like, shape (3k,) or (k, 3), optional
        Initial impulses of the iteration [N s], for example those of a similar problem. Default: zero.

    Returns
    -------
    ContactSolution
        The impulses. If the iteration does not converge, the best impulses found, with ``converged`` False.

    Raises
    ------
    ValueError
        If an argument is invalid.

    Notes
    -----
    Mathematics page, §3.2. One contact is solved exactly. Several contacts are solved by a semi-smooth Newton
    method on the equations of Alart and Curnier [1]_ with a proximal term. If it does not converge, it starts
    again from Gauss-Seidel sweeps, or from a strong proximal term that is then reduced. The residual is that of
    the form of de Saxce [2]_.
    Impulses are in general not unique. If Newton's method converges at once, the impulses of least norm (in
    units in which all contacts have the same effective mass) are returned: four equal ones for a box at rest on
    a face. For large friction, velocities can also differ between solutions; for one contact the solution
    nearest to stick is returned. For large friction there may be no solution.

    References
    ----------
    .. [1] P. Alart, A. Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353-375.
    .. [2] G. de Saxce, Z.-Q. Feng, Math. Comput. Model. 28 (1998) 225-245.

    Examples
    --------
    A block of 1 kg slides at 1 m/s, and an impulse of 0.1 N s presses it down:

    >>> solution = carom.solve_contacts(np.eye(3), (-0.1, 1.0, 0.0), 0.5)
    >>> solution.impulse
    array([[ 0.1 , -0.05,  0.  ]])
    """
    from carom.friction.layout import MESSAGES, SOLVED, ContactProblem, new_contact_work
    from carom.friction.residual import measure
    from carom.friction.solve import solve_cones

    c = _triples("velocity", velocity, None, "m/s")
    k = len(c) // 3
    W = checked_inverse_masses(inverse_mass, k)
    mu = per_contact("friction", friction, k, least=0.0)
    code = codes("kind", kind, k, KINDS)
    direction = _heading(heading, k)
    p = np.zeros(3 * k) if start is None else _triples("start", start, k, "N s")
    problem = ContactProblem(W=W, c=c, mu=mu, kind=code, heading=direction)
    with np.errstate(over="ignore", invalid="ignore"):  # the status reports a failure
        status, residual, iterations = solve_cones(k, problem, p, new_contact_work(k))
        _, _, penetration, violation, product = measure(k, problem, p)
        velocity = W @ p + c
    return ContactSolution(
        impulse=(p + 0.0).reshape(k, 3),  # no -0
        velocity=velocity.reshape(k, 3),
        residual=float(residual),
        penetration_speed=float(penetration),
        cone_violation=float(violation),
        complementarity=float(product),
        iterations=int(iterations),
        converged=bool(status == SOLVED),
        message=MESSAGES[int(status)],
    )


def _triples(name: str, value, k: int | None, unit: str) -> np.ndarray:
    """Return `value`, of either shape, with shape (3k,)."""
    rows = checks.real_array(name, value, "(3k,) or (k, 3)").ndim == 2
    array = checks.finite_array(
        name, value, (k, 3) if rows else (None if k is None else 3 * k,), unit
    )
    if array.size % 3 or not array.size:
        raise ValueError(f"{name} must have shape (3k,) or (k, 3), got shape {array.shape}")
    return array.reshape(-1)


def _heading(value, k: int) -> np.ndarray:
    if value is None:
        return np.zeros((k, 2))
    heading = checks.finite_array("heading", value, (k, 2))
    length = np.linalg.norm(heading, axis=1)
    wrong = (length > 0.0) & (np.abs(length - 1.0) > HEADING_ERROR)
    if np.any(wrong):
        raise ValueError(
            f"heading must be unit vectors or zero, got {heading[wrong][0]} of length "
            f"{length[wrong][0]:.9g}"
        )
    return heading
