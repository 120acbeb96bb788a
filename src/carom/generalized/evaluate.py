"""The compiled functions of a system, and their evaluation at single states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom._compiled.user_functions import Functions
from carom.generalized.autoparallel import return_map, run_along
from carom.generalized.layout import ActiveSet, Coordinates, new_active_set, new_work
from carom.generalized.motion import look
from carom.generalized.step import project_rates
from carom.status import Status

if TYPE_CHECKING:
    from carom.generalized.system import GeneralizedSystem

STAGES = 12


@dataclass(frozen=True)
class Look:
    """The quantities of a system at one state that an event needs."""

    M: np.ndarray  # (n, n)
    c: np.ndarray  # (n,) Gamma(v, v), first kind
    load: np.ndarray  # (n,)
    phi: np.ndarray  # (h,)
    A: np.ndarray  # (k, n)
    A_rate: np.ndarray  # (k,)
    gap: np.ndarray  # (C,)
    G: np.ndarray  # (C, 3, n)
    G_rate: np.ndarray  # (C, 3)
    acceleration: np.ndarray  # (n,) with the active contacts
    status: int


class Evaluation:
    """Compiled functions of a system and workspace to call them with."""

    def __init__(self, system: GeneralizedSystem, drop: float = 1e-8):
        model, contacts = system._model, system.contacts
        n, C = system.coordinates, len(contacts)
        self.n = n
        self.functions = Functions()
        self.raised: BaseException | None = None
        addresses = model.addresses(self.functions)
        self.system = Coordinates(
            np.array(addresses, dtype=np.int64),
            np.array([n, model.holonomic, model.rows, C], dtype=np.int64),
            np.array([one.friction for one in contacts]),
            drop,
        )
        self.work = new_work(n, model.holonomic, model.rows, C, STAGES)
        self.none_active = new_active_set(C)

    def look(self, q, v=None, t: float = 0.0, active: ActiveSet | None = None) -> Look:
        """Return all quantities at a state."""
        x = np.concatenate([q, np.zeros(self.n) if v is None else v])
        code = look(self.system, self.none_active if active is None else active, t, x, self.work)
        self.failed()
        w = self.work
        seen = (w.M, w.c, w.loads[1:-1], w.phi, w.A, w.A_rate, w.gap, w.G, w.G_rate, w.a)
        return Look(*(array.copy() for array in seen), status=code)

    def failed(self) -> None:
        """Raise the error that a function of the user's has raised."""
        error, self.functions.failed = self.functions.failed, None
        if error is not None:
            self.raised = error
            raise error

    def christoffel(self, q) -> np.ndarray:
        """Return Gamma^k_ij, from Gamma(v, v) of all pairs of directions."""
        n = self.n
        e, quadratic = np.eye(n), {}
        for i in range(n):
            for j in range(i + 1):
                quadratic[i, j] = self.look(q, e[i] + e[j] if i != j else e[i]).c
        first = np.zeros((n, n, n))
        for i in range(n):
            for j in range(i + 1):
                one = quadratic[i, j]
                if i != j:
                    one = 0.5 * (one - quadratic[i, i] - quadratic[j, j])
                first[:, i, j] = first[:, j, i] = one
        return np.linalg.solve(self.look(q).M, first.reshape(n, -1)).reshape(n, n, n)

    def autoparallel(self, q, v, parts):
        """Return the end (q, v) of an autoparallel."""
        x = np.concatenate([q, v])
        code = run_along(self.system, 0.0, x, parts, self.work)
        self.failed()
        if code != 0:
            raise ValueError(f"the autoparallel could not be integrated: {Status(code).message}")
        return x[: self.n], x[self.n :]

    def return_map(self, q, contact: int):
        """Return coordinates on the surface of a contact."""
        x = np.concatenate([q, np.zeros(self.n)])
        self.look(q)
        tolerance = 1e-15 * float(self.work.gap_scale[contact])
        for _ in range(20):
            steps, code = return_map(
                self.system, self.none_active, 0.0, x, contact, tolerance, self.work
            )
            self.failed()
            if steps < 0 or code != 0:
                raise ValueError(
                    f"position must be nearer to the contact, got {q!r}: the return map did not converge"
                )
            if self.system.size[1] == 0 or steps == 0:
                break
            code = project_rates(self.system, self.none_active, 0.0, x, self.work)
            if code != 0:
                raise ValueError(f"position must be nearer to the contact: {Status(code).message}")
        return x[: self.n].copy()
