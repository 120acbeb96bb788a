"""`impact_derivative`: derivatives of one frictional impact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom import arguments
from carom.impact.api import checked_impact


class ByInputs(NamedTuple):
    """Derivatives of a vector (3,) in contact axes by the inputs of an impact."""

    #: (3, 3, 3): a symmetric change dW changes the vector by einsum("ijk,jk", D, dW)
    inverse_mass: np.ndarray
    velocity: np.ndarray  #: (3, 3) derivatives by the velocity
    friction: np.ndarray  #: (3,) derivatives by mu; one-sided (from above) if it is 0
    restitution: np.ndarray  #: (3,) derivatives by e; one-sided (from above) if it is 0


class ImpactDerivative(NamedTuple):
    """Derivatives of an impact."""

    impulse: ByInputs  #: derivatives of the impulse
    velocity_after: ByInputs  #: derivatives of the relative velocity after the impact
    error: float  #: estimate of the relative error of `impulse`


@arguments.known
def impact_derivative(
    inverse_mass, velocity, friction: float, restitution: float, law: str = "newton"
) -> ImpactDerivative:
    """Differentiate `carom.resolve_impact` by all its arguments.

    Parameters
    ----------
    inverse_mass, velocity, friction, restitution, law
        As for `carom.resolve_impact`.

    Returns
    -------
    ImpactDerivative
        The derivatives of the impulse and of the velocity after the impact.

    Raises
    ------
    ValueError
        If an argument is invalid as for `carom.resolve_impact`; or if the impact has no derivative: slip starts
        from rest, or the impact is on the boundary between two courses (slip to the end, stick, reversal).

    Notes
    -----
    Mathematics page, §5.2.
    """
    from carom.studies.gradient.blow import UPPER, blow

    W, u, mu, e, number = checked_impact(inverse_mass, velocity, friction, restitution, law)
    found = blow(W, u, mu, e, number)
    if found is None:
        raise ValueError("the impact could not be solved: W becomes singular during it")
    if found.kink:
        raise ValueError(f"the impact must have a derivative, got one where {found.kink}")
    by_mass = np.zeros((3, 3, 3))
    for k, (i, j) in enumerate(UPPER):
        by_mass[:, i, j] = by_mass[:, j, i] = found.d[:3, k] * (1.0 if i == j else 0.5)
    impulse = ByInputs(by_mass, found.d[:3, 6:9], found.d[:3, 9], found.d[:3, 10])
    # u+ = u + W P
    direct = np.einsum("ij,k->ijk", np.eye(3), found.impulse)
    after = [np.einsum("ij,j...->i...", W, d) for d in impulse]
    after[0] = after[0] + 0.5 * (direct + direct.transpose(0, 2, 1))
    after[1] = after[1] + np.eye(3)
    return ImpactDerivative(impulse, ByInputs(*after), found.error)
