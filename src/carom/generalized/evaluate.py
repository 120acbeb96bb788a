"""The functions of a system at single states: its geometry."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from carom._compiled.decorators import entry
from carom._compiled.record_arrays import table
from carom.generalized.scene import SystemFunctions
from carom.generalized.thresholds import ARC_ERROR, RETURN_ERROR, RETURN_GOAL
from carom.kinematics.chart import (
    find_constraints,
    find_gaps,
    find_inertia,
    find_loads,
)
from carom.model.arrays import STATE
from carom.model.chart import Chart, forget_state

if TYPE_CHECKING:
    from carom.generalized.system import GeneralizedSystem


@entry
def look(chart, state, t):
    """Find all quantities at a state."""
    find_inertia(chart, state, True)
    find_loads(chart, state, t)
    find_constraints(chart, state, True)
    find_gaps(chart, state, True)


class Evaluation:
    """Compiled functions of a system and workspace to call them with."""

    def __init__(self, system: GeneralizedSystem):
        self.n = system._model.n
        self.model = SystemFunctions(system._model, len(system.contacts), system.scale)
        self.chart = self.model.arrays(0.0)
        self.state = table(STATE, self.n)

    def look(self, x, t: float = 0.0) -> Chart:
        """Return all quantities at (q, v), or at (q, 0) for q; raise the error of a user-defined function.

        They are in the units of the user, where a run has them by the sizes of the coordinates.
        """
        chart, scale = self.chart, self.chart.scale
        q, v = np.split(np.append(x, np.zeros(2 * self.n - len(x))), 2)
        self.state["x"][:, 0], self.state["v"][:, 0] = q / scale, v / scale
        forget_state(chart)
        look(chart, self.state, t)
        for covector in (chart.M, chart.M.T, chart.c, chart.load, chart.A, chart.G):
            covector /= scale
        error, self.model.functions.failed = self.model.functions.failed, None
        if error is not None:
            raise error
        return chart

    def christoffel(self, q) -> np.ndarray:
        """Return Gamma^k_ij, from 4 Gamma(v, w) = Gamma(v + w, v + w) - Gamma(v - w, v - w)."""
        n, e = self.n, np.eye(self.n)

        def bend(v):
            return self.look(np.append(q, v)).c.copy()

        first = [[bend(a + b) - bend(a - b) for b in e] for a in e]  # (i, j, k)
        first = 0.25 * np.moveaxis(np.array(first), 2, 0).reshape(n, -1)
        return np.linalg.solve(self.chart.M, first).reshape(n, n, n)

    def autoparallel(self, q, v):
        """Return the end (q, v) of an autoparallel: the motion without loads, constraints and contacts."""
        from scipy.integrate import solve_ivp

        def rate(t, x):
            here = self.look(x)
            if not np.all(np.isfinite(here.inertia)):
                raise ValueError(
                    "the autoparallel could not be integrated: the metric is not finite"
                )
            try:
                return np.append(x[self.n :], -np.linalg.solve(here.M, here.c))
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
            here = self.look(at)
            rows = np.vstack([here.G[contact, :1], here.A[: len(here.phi)]])
            return np.append(here.gap[contact], here.phi), rows, np.linalg.solve(here.M, rows.T)

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
