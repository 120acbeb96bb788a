"""The force of an impact in time, for a stated stiffness of the contact.

With the normal force ``F = k d^n`` at the depth d, d' = -u_n and dp = F dt, the elastic energy is the work that
the normal force has done so far against the motion, U = -int u_n dp, so

    F = k^(1/(n+1)) ((n+1) U)^(n/(n+1)),        t = int dp/F.

In unloading the energy that is left to be given back takes the place of U, and ``k_r = k e^(-2n)`` that of k,
with e^2 the ratio of the works of restitution and compression, by whatever law the impact ended: then F is
continuous. Near both ends p = q^(n+1), because 1/F is singular there (mathematics page, §1.13).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from carom.geometry.thresholds import EPSILON
from carom.impact.thresholds import NO_ENERGY
from carom.scene.stiffness import ABSOLUTE, Stiffness

NODES, TIMES_A_PIECE = 24, 24  # of Gauss's rule between two times; times that are stated on a piece


@dataclass(frozen=True, eq=False)
class ImpactForce:
    """The normal force of an impact over time. Vectors in contact axes: normal, tangent 1, tangent 2.

    Parameters
    ----------
    t : ndarray, shape (K,)
        Times since the first touch [s].
    normal_force, friction_force : ndarray, shapes (K,) and (K, 2)
        Forces [N].
    depth : ndarray, shape (K,)
        Depth of the contact [m]; at the end what unloading leaves, whose energy is lost.
    velocity : ndarray, shape (K, 3)
        Relative velocity [m/s].
    impulse : ndarray, shape (K, 3)
        Impulse so far [N s].
    peak_force : float
        Greatest normal force [N].
    duration, compression_time : float
        Duration of the impact, and of its compression [s].
    """

    t: np.ndarray
    normal_force: np.ndarray
    friction_force: np.ndarray
    depth: np.ndarray
    velocity: np.ndarray
    impulse: np.ndarray
    peak_force: float
    duration: float
    compression_time: float
    _stated: dict[str, Any] = field(default_factory=dict, repr=False)

    def evaluate(self, t) -> np.ndarray:
        """Return the normal force at times within the impact, and 0 before and after it.

        Parameters
        ----------
        t : array_like
            Times since the first touch [s].
        """
        from carom import checks

        times = checks.real_array("t", t, "(...,)")
        found = force_at(times, self.t, self.impulse[:, :1], self.normal_force[:, None])[..., 0]
        return np.where((times >= 0.0) & (times <= self.duration), found, 0.0)


def force_at(times, t, P, F) -> np.ndarray:
    """Return forces (..., k) at times (...): the derivative of the cubic of P(t) between two of the times t.

    Impulses P (T, k) and their slopes F (T, k), the forces, are given at T times.
    """
    i = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(t) - 2)
    h = (t[i + 1] - t[i])[..., None]
    z = (times - t[i])[..., None] / h
    mean = (P[i + 1] - P[i]) / h
    found = F[i] + z * (2.0 * (3.0 * mean - 2.0 * F[i] - F[i + 1]))
    return found + 3.0 * z * z * (F[i] + F[i + 1] - 2.0 * mean)


def peak_force(work, k, n):
    """Return the greatest normal force [N] where compression has done the work [J], at most 0."""
    stored = np.maximum(-np.asarray(work, dtype=float), 0.0)
    return k ** (1.0 / (n + 1.0)) * ((n + 1.0) * stored) ** (n / (n + 1.0))


class Course:
    """Velocity, impulse and work of the normal force over the normal impulse."""

    def __init__(self, W: np.ndarray, u: np.ndarray, mu: float, end: float):
        from carom.impact.api import raise_for
        from carom.impact.course import MOST_PIECES_OF_PATH, PIECE_COLUMNS, trace

        units, rows = np.ones(2), np.zeros((64, PIECE_COLUMNS))
        count = trace(W, u, mu, end, rows, units)
        if count < 0:
            rows = np.zeros((MOST_PIECES_OF_PATH, PIECE_COLUMNS))
            count = trace(W, u, mu, end, rows, units)
            raise_for(max(0, -count))
        self.rows, self.mu, (self.v, self.w) = rows[:count], mu, units
        self.m = W / self.w
        self.unit = self.v / self.w  # of impulses

    @property
    def knots(self) -> np.ndarray:
        """The normal impulses at which the pieces end [N s]."""
        from carom.impact.course import END

        return self.rows[:, END] * self.unit

    def at(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return velocity (K, 3), impulse (K, 3), work (K,) and friction over the normal force (K, 2)."""
        from carom.impact.course import END, KIND
        from carom.impact.resolve import BENT

        place = np.minimum(np.searchsorted(self.knots, p, side="left"), len(self.rows) - 1)
        u, P, work = np.zeros((len(p), 3)), np.zeros((len(p), 3)), np.zeros(len(p))
        ratio = np.zeros((len(p), 2))
        for k in np.unique(place).tolist():
            own, row = place == k, self.rows[k]
            d = np.minimum(p[own] / self.unit, row[END]) - row[3]
            made = self._bent(row, d) if row[KIND] == BENT else self._straight(row, d)
            u[own], P[own], work[own], ratio[own] = made
        return u * self.v, P * self.unit, work * self.v * self.unit, ratio

    def work_around(self, begin: float, way: np.ndarray) -> np.ndarray:
        """Return the work of the normal force on ways (K,) of the normal impulse from one, within a piece."""
        nodes, weights = np.polynomial.legendre.leggauss(NODES)
        there = begin + 0.5 * way[:, None] * (1.0 + nodes)
        u_n = self.at(there.ravel())[0][:, 0].reshape(there.shape)
        return 0.5 * way * (u_n @ weights)

    def _straight(self, row: np.ndarray, d: np.ndarray) -> tuple:
        from carom.impact.course import SLOPE

        along = np.concatenate([[1.0], row[SLOPE]])  # of the impulse by the normal one
        start = np.array([row[2], row[0], row[1]])
        u = start + d[:, None] * (self.m @ along)
        P = np.array([row[3], row[4], row[5]]) + d[:, None] * along
        work = row[7] + 0.5 * d * (start[0] + u[:, 0])
        return u, P, work, np.broadcast_to(row[SLOPE], (len(d), 2))

    def _bent(self, row: np.ndarray, d: np.ndarray) -> tuple:
        from carom.impact.course import Q, R, X, Y

        polynomial = np.polynomial.Polynomial
        x, y, r, q = (polynomial(row[part]) for part in (X, Y, R, Q))
        way, tau = r.integ(), d / row[R][0]
        for _ in range(50):
            step = (way(tau) - d) / r(tau)
            tau = tau - step
            if np.all(np.abs(step) <= 4.0 * EPSILON * np.abs(tau)):
                break
        P1, P2 = (-self.mu * polynomial(row[part][:16]).integ()(tau) for part in (X, Y))
        u1, u2, loss = x(tau), y(tau), self.mu * q.integ()(tau)
        u_n = row[2] + self.m[0, 0] * d + self.m[0, 1] * P1 + self.m[0, 2] * P2
        energy = 0.5 * (d * (row[2] + u_n) + P1 * (row[0] + u1) + P2 * (row[1] + u2))
        size = np.maximum(np.hypot(u1, u2), NO_ENERGY * abs(row[2]))
        ratio = -self.mu * np.column_stack([u1, u2]) / size[:, None]
        impulse = np.column_stack([row[3] + d, row[4] + P1, row[5] + P2])
        return np.column_stack([u_n, u1, u2]), impulse, row[7] + energy + loss, ratio


def force_in_time(
    stated: dict[str, Any], impulse, works, k: float, n: float, knots: int = TIMES_A_PIECE
) -> ImpactForce:
    """Return the force of an impact.

    Parameters
    ----------
    stated : W, u and mu, by the names of an `ImpactRecord`
    impulse : normal impulses of compression and of the whole [N s]
    works : of the normal force in compression, at most 0, and in restitution [J]
    k, n : stiffness and exponent
    knots : number of times that are stated on each piece of the path
    """
    W = np.asarray(stated["inverse_mass"], dtype=float)
    u0, mu = np.asarray(stated["relative_velocity_before"], dtype=float), float(stated["friction"])
    (p_c, end), (work_c, work_r) = impulse, works
    course = Course(W, u0, mu, end)
    gives_back = end > p_c * (1.0 + NO_ENERGY) and work_r > NO_ENERGY * -work_c
    e_n = (work_r / -work_c) ** n if gives_back else 0.0  # e^(2n)

    t, p, F = [0.0], [0.0], [0.0]
    times = [0.0]
    for force, size, marks in _phases(course, (p_c, end), works, (k, e_n), n):
        _follow(force, size, _fine(marks, knots), n, (t, p, F))
        times.append(t[-1])
    if not np.all(np.isfinite(t)):
        raise ValueError(
            "the contact opens within the impact and closes again (a jam by strong friction), so that no "
            "single spring has its force"
        )
    made = np.array(p)
    u, P, _, ratio = course.at(made)
    forces, peak = np.array(F), float(peak_force(work_c, k, n))
    depth = (forces / k) ** (1.0 / n)
    if e_n > 0.0:
        later = np.arange(len(t)) > np.searchsorted(t, times[1])
        soft = k / e_n
        depth[later] = (
            (peak / k) ** (1.0 / n)
            - (peak / soft) ** (1.0 / n)
            + (forces[later] / soft) ** (1.0 / n)
        )
    return ImpactForce(
        t=np.array(t), normal_force=forces, friction_force=forces[:, None] * ratio, depth=depth, velocity=u,
        impulse=P, peak_force=peak, duration=t[-1], compression_time=times[1],
        _stated={**stated, "k": k, "exponent": n},
    )  # fmt: skip


def _phases(
    course: Course, impulse, works, stiffness: tuple[float, float], n: float
) -> list[tuple]:
    """Return compression, and restitution if there is any: each a force, a size of impulse and marks in q.

    p = p_c q^(n+1) in compression and end - p = (end - p_c) q^(n+1) in restitution. The works are integrated
    from both ends close to them, because differences would be round-off there.
    """
    (p_c, end), (work_c, work_r), (k, e_n) = impulse, works, stiffness
    ends, power = course.knots, 1.0 / (n + 1.0)

    def loading(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        p = p_c * q ** (n + 1.0)
        stored, first = np.maximum(-course.at(p)[2], 0.0), p <= ends[0]
        stored[first] = -course.work_around(0.0, p[first])
        return p, k**power * ((n + 1.0) * stored) ** (n * power)

    def unloading(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        ahead = (end - p_c) * q ** (n + 1.0)
        p = end - ahead
        left = np.maximum(work_r - (course.at(p)[2] - work_c), 0.0)
        last = p >= max(p_c, ends[-2] if len(ends) > 1 else 0.0)
        left[last] = -course.work_around(end, -ahead[last])
        return p, (k / e_n) ** power * ((n + 1.0) * left) ** (n * power)

    inside = ends[(ends > 0.0) & (ends < p_c)]
    marks = np.concatenate([[0.0], (inside / p_c) ** power, [1.0]])
    phases = [(loading, p_c, marks)]
    if e_n > 0.0:
        inside = ends[(ends > p_c) & (ends < end)]
        marks = np.concatenate([[1.0], ((end - inside) / (end - p_c)) ** power, [0.0]])
        phases.append((unloading, end - p_c, marks))
    return phases


def _fine(marks: np.ndarray, knots: int) -> np.ndarray:
    """Return the ends of pieces, each divided into parts."""
    parts = [np.linspace(a, b, knots + 1)[1:] for a, b in pairwise(marks) if a != b]
    return np.concatenate([marks[:1], *parts])


def _follow(force, size: float, marks: np.ndarray, n: float, rows) -> None:
    """Add times, impulses and forces at the marks in q, by Gauss's rule between them."""
    t, p, F = rows
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    middle, half = 0.5 * (marks[1:] + marks[:-1]), 0.5 * (marks[1:] - marks[:-1])
    q = middle[:, None] + half[:, None] * nodes
    with np.errstate(divide="ignore"):
        slope = size * (n + 1.0) * q**n / force(q.ravel())[1].reshape(q.shape)
    t += (t[-1] + np.cumsum(np.abs(half) * (slope @ weights))).tolist()
    there, forces = force(marks[1:])
    p += there.tolist()
    F += forces.tolist()


def duration(stated: dict[str, Any], impulse, works, k: float, n: float) -> float:
    """Return the duration of an impact [s], as `force_in_time` does."""
    return force_in_time(stated, impulse, works, k, n, knots=1).duration


def of_stated(stated: dict[str, Any], stiffness) -> ImpactForce:
    """Return the force of an impact that is solved once more from what was stated.

    Raises
    ------
    TypeError, ValueError
        If the stiffness is none, or the friction of the impact is no number.
    """
    from carom import checks
    from carom.impact.api import need_path, resolve_impact

    hint = "; the stiffness of the bodies, not one relative to those of other contacts"
    checks.instance("stiffness", stiffness, ABSOLUTE, hint)
    names = "inverse_mass", "relative_velocity_before", "friction", "restitution", "law"
    given = [stated[name] for name in names]
    if np.ndim(given[1]) != 1 or not all(isinstance(one, (int, float)) for one in given[2:4]):
        raise ValueError("the impact must be a single one with numbers as friction and restitution")
    if not np.isfinite(given[2] + given[3]):
        raise ValueError(
            "the impact must have one number as friction and one as restitution, got a law, anisotropic "
            "friction, or parts of a body with different materials"
        )
    need_path("the force in time", str(given[4]))
    solved = resolve_impact(*given)
    impulses = float(solved.compression_impulse[0]), float(solved.impulse[0])
    works = solved.compression_work, solved.restitution_work
    return force_in_time(stated, impulses, works, *stiffness._of(None))


def of_record(record, stiffness) -> ImpactForce:
    """Return the force of an impact of a run, of a stop of an angle the torque."""
    from carom import checks

    if record.together > 1:
        raise ValueError(
            f"the impact must be a single one, got a part of one with {record.together} closed points; "
            "Solution.impact_forces(k) has the forces of all"
        )
    if record.unit != "m/s":
        checks.instance(
            "stiffness", stiffness, (Stiffness,), " [N m/rad^exponent], of a stop of an angle"
        )
    names = "inverse_mass", "relative_velocity_before", "friction", "restitution", "law"
    stated = {name: getattr(record, name) for name in names}
    plain = {n: v.item() if isinstance(v, np.generic) else v for n, v in stated.items()}
    return of_stated(plain, stiffness)
