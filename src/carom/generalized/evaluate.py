"""The functions of a system at single states: its geometry."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from carom._compiled.decorators import entry
from carom._compiled.record_arrays import table
from carom.generalized.scene import OwnModel
from carom.generalized.thresholds import ARC_ERROR, RETURN_ERROR, RETURN_GOAL, SYSTEM_DROP
from carom.kinematics.own_functions import (
    find_constraints,
    find_gaps,
    find_inertia,
    find_loads,
)
from carom.model.arrays import STATE
from carom.model.own_coordinates import OwnCoordinates, forget_state

if TYPE_CHECKING:
    from carom.generalized.system import GeneralizedSystem


@entry
def look(own, state, t):
    """Find all quantities at a state."""
    find_inertia(own, state, True)
    find_loads(own, state, t)
    find_constraints(own, state, True)
    find_gaps(own, state, True)


class Evaluation:
    """Compiled functions of a system and workspace to call them with."""

    def __init__(self, system: GeneralizedSystem):
        self.n, self.model = (
            system._model.n,
            OwnModel(system._model, len(system.contacts), system.scale),
        )
        self.own = self.model.arrays(SYSTEM_DROP, np.ones(self.n))
        self.state = table(STATE, self.n)

    def look(self, x, t: float = 0.0) -> OwnCoordinates:
        """Return all quantities at (q, v), or at (q, 0) for q; raise the error of a user-defined function."""
        x = np.append(x, np.zeros(2 * self.n - len(x)))
        self.state["x"][:, 0], self.state["v"][:, 0] = np.split(x, 2)
        forget_state(self.own)
        look(self.own, self.state, t)
        error, self.model.functions.failed = self.model.functions.failed, None
        if error is not None:
            raise error
        return self.own

    def christoffel(self, q) -> np.ndarray:
        """Return Gamma^k_ij, from 4 Gamma(v, w) = Gamma(v + w, v + w) - Gamma(v - w, v - w)."""
        n, e = self.n, np.eye(self.n)

        def bend(v):
            return self.look(np.append(q, v)).c.copy()

        first = [[bend(a + b) - bend(a - b) for b in e] for a in e]  # (i, j, k)
        first = 0.25 * np.moveaxis(np.array(first), 2, 0).reshape(n, -1)
        return np.linalg.solve(self.own.M, first).reshape(n, n, n)

    def autoparallel(self, q, v):
        """Return the end (q, v) of an autoparallel: the motion without loads, constraints and contacts."""
        from scipy.integrate import solve_ivp

        def rate(t, x):
            seen = self.look(x)
            if not np.all(np.isfinite(seen.inertia)):
                raise ValueError(
                    "the autoparallel could not be integrated: the metric is not finite"
                )
            try:
                return np.append(x[self.n :], -np.linalg.solve(seen.M, seen.c))
            except np.linalg.LinAlgError as error:
                raise ValueError(
                    "the autoparallel could not be integrated: the metric is singular"
                ) from error

        start = np.concatenate([q, v])
        found = solve_ivp(rate, (0.0, 1.0), start, "DOP853", rtol=ARC_ERROR, atol=ARC_ERROR)
        if not found.success:
            raise ValueError(f"the autoparallel could not be integrated: {found.message}")
        q, v = np.split(found.y[:, -1], 2)
        return q, v

    def return_map(self, q, contact: int):
        """Return coordinates q_e on the surface of a contact, and of the constraints.

        With rho the gap and the constraints, the autoparallel from q_e to q begins at a right angle to these
        surfaces in the metric:

            q = Exp_{q_e}(M^-1 (d rho)^T kappa),   rho(q_e) = 0
        """
        from scipy.optimize import root

        n = self.n

        def surfaces(at):
            seen = self.look(at)
            rows = np.vstack([seen.G[contact, :1], seen.A[: len(seen.phi)]])
            return np.append(seen.gap[contact], seen.phi), rows, np.linalg.solve(seen.M, rows.T)

        def misses(unknowns):
            at, kappa = unknowns[:n], unknowns[n:]
            rho, _, normals = surfaces(at)
            return np.append(self.autoparallel(at, normals @ kappa)[0] - q, rho)

        rho, rows, normals = surfaces(q)
        kappa = np.linalg.lstsq(rows @ normals, rho)[0]
        # what `root` returns is not worked out from its code: that takes a seventh of the check of types
        search = cast("Any", root)
        found = search(misses, np.append(q - normals @ kappa, kappa), tol=RETURN_GOAL)
        if not np.max(np.abs(found.fun)) <= RETURN_ERROR * max(1.0, np.max(np.abs(q))):
            raise ValueError(
                f"position must be nearer to the contact, got {q!r}: the return map did not converge"
            )
        return found.x[:n]
