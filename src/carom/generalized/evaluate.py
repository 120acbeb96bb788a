"""The compiled functions of a system, and their evaluation at single states."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from carom._compiled.record_arrays import table
from carom._compiled.user_functions import Functions
from carom.dynamics.methods import make_method
from carom.generalized import layout as o
from carom.generalized.motion import look
from carom.generalized.step import move_freely
from carom.generalized.thresholds import RETURN_ERROR, RETURN_GOAL, SYSTEM_DROP
from carom.model.laws import laws_of
from carom.options import Options
from carom.status import Status

if TYPE_CHECKING:
    from carom.generalized.system import GeneralizedSystem

STAGES = 12
PARTS = 64  # steps of order 4 along the arc of a return map: the error of a great circle of 1 rad is 2e-10


class Evaluation:
    """Compiled functions of a system and workspace to call them with."""

    def __init__(self, system: GeneralizedSystem, drop: float = SYSTEM_DROP):
        model, laws = system._model, laws_of(system.contacts)
        self.n, self.functions = model.n, Functions()
        addresses, parts = (
            np.array(one, dtype=np.int64) for one in model.addresses(self.functions)
        )
        sizes = model.n, model.holonomic, model.rows, len(laws.table)
        self.system = o.Coordinates(addresses, parts.reshape(-1, 3), *sizes, laws, drop)
        self.work = o.new_work(self.system, STAGES)
        self.none_active = table(o.CONTACT, len(laws.table))

    def compute(self, x, t: float) -> int:
        """Compute all quantities at a state (q, v) without active contacts, into `work`; return a status."""
        code = look(self.system, self.none_active, t, x, self.work)
        return Status.FUNCTION_FAILED if self.functions.failed is not None else code

    def look(self, x, t: float = 0.0) -> o.Work:
        """Return `work` at (q, v), or at (q, 0) for q; raise the error of a user-defined function."""
        self.compute(np.append(x, np.zeros(2 * self.n - len(x))), t)
        self.failed()
        return self.work

    def failed(self) -> None:
        """Raise the error that a function of the user's has raised."""
        error, self.functions.failed = self.functions.failed, None
        if error is not None:
            raise error

    def christoffel(self, q) -> np.ndarray:
        """Return Gamma^k_ij, from 4 Gamma(v, w) = Gamma(v + w, v + w) - Gamma(v - w, v - w)."""
        n, e = self.n, np.eye(self.n)

        def bend(v):
            return self.look(np.append(q, v)).c.copy()

        first = [[bend(a + b) - bend(a - b) for b in e] for a in e]  # (i, j, k)
        first = 0.25 * np.moveaxis(np.array(first), 2, 0).reshape(n, -1)
        return np.linalg.solve(self.work.M, first).reshape(n, n, n)

    def autoparallel(self, q, v, parts):
        """Return the end (q, v) of an autoparallel: the motion without loads, constraints and contacts."""
        x, part = np.concatenate([q, v]), self.system.part.copy()
        part[o.OF_METRIC + 1 :] = 0
        free = self.system._replace(
            address=self.system.address * [1, 0, 0, 0], part=part, holonomic=0, rows=0, contacts=0
        )
        work, method = o.new_work(free, STAGES), make_method("rk4", Options())
        code = move_freely(o.Motion(free, method, table(o.CONTACT, 0), work), x, parts)
        self.failed()
        if code != 0:
            raise ValueError(f"the autoparallel could not be integrated: {Status(code).message}")
        return x[: self.n], x[self.n :]

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
            return np.append(self.autoparallel(at, normals @ kappa, PARTS)[0] - q, rho)

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
