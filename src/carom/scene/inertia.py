"""The inertia of a rigid body, checked."""

from __future__ import annotations

import numpy as np

from carom import checks

SLACK = 1e-12  # relative to the largest entry or moment: rounding, not physics
GREATEST = 1e300  # [kg m^2]: sums are finite


def inertia_matrix(value) -> np.ndarray:
    """Return the inertia (3,3) [kg m^2] given by principal moments (3,) or a symmetric (3,3).

    Raises
    ------
    ValueError
        If the inertia is not symmetric, not positive definite, or one principal moment exceeds the sum of
        the other two: no mass distribution has such an inertia.
    """
    shape = checks.real_array("inertia", value, "(3,) or (3, 3)").shape
    if len(shape) == 2:
        matrix = checks.finite_array("inertia", value, (3, 3), unit="kg m^2")
    elif len(shape) == 1:
        matrix = np.diag(checks.finite_array("inertia", value, (3,), unit="kg m^2"))
    else:
        raise ValueError(
            f"inertia must have shape (3,) or (3, 3) [kg m^2], got {checks.shown(value)}"
        )
    if not np.max(np.abs(matrix - matrix.T)) <= SLACK * np.max(np.abs(matrix)):
        raise ValueError(f"inertia must be symmetric, got {checks.shown(value)}")
    if not np.max(np.abs(matrix)) <= GREATEST:
        raise ValueError(
            f"inertia must be at most {GREATEST:g} [kg m^2], so that sums are finite, got {checks.shown(value)}"
        )
    matrix = 0.5 * (matrix + matrix.T)
    small, middle, large = np.linalg.eigvalsh(matrix)
    positive, possible = small > SLACK * large, large <= (small + middle) * (1 + SLACK)
    if positive and possible:
        return matrix
    moments = f"got {value!r} with principal moments {small:.6g}, {middle:.6g}, {large:.6g}"
    if not positive:
        raise ValueError(
            f"inertia must have principal moments above 0 [kg m^2], {moments}; "
            "for a thin rod give a small positive moment about its axis"
        )
    raise ValueError(
        f"inertia must have no principal moment above the sum of the other two, {moments}"
    )
