"""How far a run is from another sequence of contact: at each impact, and between impacts.

A margin is a number that is zero at the change, with its derivative (mathematics page, VIII.3).
"""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion
from carom.gradient.blow import AT_REST, Blow
from carom.gradient.body import Moving, cross, fly
from carom.gradient.result import Margin
from carom.gradient.saltation import Strike
from carom.impact import layout as o

FEWEST = 24  # looks at a flight, and looks a turn
A_TURN = 12


def vertex_gaps(system, row, body: Moving) -> np.ndarray:
    """Return the gaps of all vertices of a row of contacts to its half-space."""
    n = row.axes[0]
    return (
        n @ body.x
        - row.offset
        - row.radius
        + system.vertices[row.first : row.last] @ (body.R.T @ n)
    )


def gap_gradient(n: np.ndarray, arm: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Return n . (dx + dtheta x arm) (P,) of a pose tangent (6, P)."""
    return n @ (pose[:3] + cross(pose[3:], arm))


def of_impact(system, row, place, tied, bodies, done: Strike, hit: Blow, u, W, k, d_mu):
    """Return the margins of an impact: approach, course of slip, other vertices, time since the last one."""
    t, speed = bodies[0].t, float(np.linalg.norm(u))
    found = [
        Margin(t, k, "the approach of the impact, which would graze or miss", float(-u[0]), "m/s",
               float(-u[0]) / speed, -done.before[0])
    ]  # fmt: skip
    found += _course(done, hit, u, W, k, t, speed, float(row.friction), d_mu)
    for b, body in enumerate(bodies):
        number = int(row.body) if b == 0 else int(row.other)
        pose = done.poses[6 * b : 6 * b + 6]
        size = float(system.bodies.extent[number])
        for other in system.contacts:
            if other.body != number or other.touches != 0:
                continue
            cores = system.vertices[other.first : other.last]
            gaps = vertex_gaps(system, other, body)
            rates = other.axes[0] @ body.v + np.cross(body.w, cores @ body.R.T) @ other.axes[0]
            own = other.number == row.number and row.touches == 0
            skip = np.zeros(len(cores), dtype=bool)
            if own:
                skip = np.any(np.all(cores[:, None] == tied[None], axis=2), axis=1)
            # those that go away do not strike next
            gaps = np.where(skip | (rates >= 0.0), np.inf, gaps)
            i = int(np.argmin(gaps))
            if np.isfinite(gaps[i]):
                gradient = gap_gradient(other.axes[0], body.R @ cores[i], pose)
                what = f"vertex {i}, which is about to strike at the same time"
                found.append(
                    Margin(t, k, what, float(gaps[i]), "m", float(gaps[i]) / size, gradient)
                )
    return found


def _course(done: Strike, hit: Blow, u, W, k, t, speed, mu, d_mu):
    """Return how far slip is from stopping, from not stopping, and from starting again."""
    found = []
    after = u + W @ hit.impulse
    slip = float(np.hypot(after[1], after[2]))
    if not hit.phases & (o.STICK | o.RESTART):
        if hit.phases & o.SLIP and slip > AT_REST * speed:
            gradient = (after[1:] / slip) @ done.after[1:]
            what = "slip left at the end of the impact, which would stick"
            found.append(Margin(t, k, what, slip, "m/s", slip / speed, gradient))
        return found
    if hit.slip_end >= 0.0:
        left = float(hit.impulse[0]) - hit.slip_end
        gradient = (hit.d[0] - hit.d[3]) @ done.inputs
        what = "impulse after slip has stopped, without which it slips to the end"
        found.append(Margin(t, k, what, left, "N s", left / float(hit.impulse[0]), gradient))
    ratio, d_ratio = _stick_ratio(W, done.inputs)
    need = float(np.hypot(*ratio))
    value = mu - need
    gradient = d_mu - (ratio / need) @ d_ratio if need > 0.0 else d_mu
    what = "friction beyond what holds the point" if value > 0.0 else "friction short of stick"
    relative = abs(value) / max(mu, need)
    found.append(Margin(t, k, what, abs(value), "", relative, np.sign(value) * gradient))
    return found


def _stick_ratio(W, inputs):
    """Return the tangential impulse that holds the point, per normal one, and its derivative."""
    a, B = W[1:, 0], W[1:, 1:]
    ratio = -np.linalg.solve(B, a)
    dB = np.array([[inputs[3], inputs[4]], [inputs[4], inputs[5]]])
    return ratio, -np.linalg.solve(B, inputs[1:3] + np.einsum("ijp,j->ip", dB, ratio))


def of_end(k: int, d_time: np.ndarray, time: float, end: float) -> list[Margin]:
    """Return how near the last impact is to the end of the run, beyond which it would not happen."""
    left = end - time
    what = "time from the last impact to the end of the run"
    return [Margin(time, k, what, left, "s", left / end, -d_time)]


def of_flight(system, solution, b: int, body: Moving, until: float) -> list[Margin]:
    """Return the margin of the nearest miss of a flight: the least gap within it, or at the end of the run."""
    rows = [c for c in system.contacts if c.body == b and c.touches == 0]
    if not rows or not until > body.t:
        return []
    turns = float(np.linalg.norm(body.w)) * (until - body.t) / (2 * np.pi)
    times = np.linspace(body.t, until, int(FEWEST + A_TURN * turns) + 1)
    x, Q, _, _ = solution.evaluate(times)
    R = quaternion.matrix(quaternion.multiply(Q[:, b], solution._run.compiled.to_principal[b]))
    best, last = None, float(solution.t[-1])
    size = float(system.bodies.extent[b])
    for row in rows:
        n = row.axes[0]
        cores = system.vertices[row.first : row.last]
        heights = x[:, b] @ n - row.offset - row.radius
        gaps = heights[:, None] + np.einsum("i,tik,vk->tv", n, R, cores)
        # within the flight where it is least there, and at the end of the run while it falls
        inner = (gaps[1:-1] < gaps[:-2]) & (gaps[1:-1] <= gaps[2:])
        look = np.full(gaps.shape, np.inf)
        look[1:-1][inner] = gaps[1:-1][inner]
        if until == last:
            falls = gaps[-1] < gaps[-2]
            look[-1, falls] = gaps[-1, falls]
        i, v = np.unravel_index(int(np.argmin(look)), look.shape)
        if np.isfinite(look[i, v]) and (best is None or look[i, v] < best[0]):
            best = (float(look[i, v]), int(i), int(v), row, gaps[:, v])
    if best is None:
        return []
    _, i, v, row, gaps = best
    n, core, at_end = row.axes[0], system.vertices[row.first + v], i == len(times) - 1
    time = times[i]
    if not at_end:
        bend = gaps[i + 1] - 2.0 * gaps[i] + gaps[i - 1]
        time -= 0.5 * (gaps[i + 1] - gaps[i - 1]) / bend * (times[1] - times[0])
    there = fly(body, float(time))
    arm = there.R @ core
    gap = float(n @ (there.x + arm) - row.offset - row.radius)
    place = "at the end of the run" if at_end else "in passing"
    what = f"vertex {v}, which has not struck {place}"
    gradient = gap_gradient(n, arm, there.X[:6])
    return [Margin(float(time), -1, what, gap, "m", abs(gap) / size, gradient)]
