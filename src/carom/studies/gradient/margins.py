"""Margins of a run: its distances from other sequences of contact, at each impact and between impacts.

A margin is a number that is zero where the sequence changes, with its derivative (mathematics page, §5.3).
"""

from __future__ import annotations

import numpy as np

from carom.impact import layout as o
from carom.model.contact_kinds import has_vertices
from carom.model.laws import law_of
from carom.studies.gradient.blow import AT_REST, Blow
from carom.studies.gradient.body import Moving, cross, fly, path
from carom.studies.gradient.result import Margin
from carom.studies.gradient.saltation import Strike

FEWEST_SAMPLES = 24  # samples of a flight; to these are added A_TURN samples for each rotation
A_TURN = 12
MISSES = 6  # greatest number of near misses of a flight
ROUGHLY = 1e-8  # accuracy of near misses, which are only warnings


def half_space_rows(system, b: int):
    """Return the contacts of vertices of a body with half-spaces."""
    contacts = system.contacts
    return contacts[(contacts.body == b) & has_vertices(contacts)]


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
    """Return the margins of an impact: of the approach, of the phases of slip, and of other vertices."""
    t, speed = bodies[0].t, float(np.linalg.norm(u))
    found = [
        Margin(t, k, "speed of approach: at 0 the body grazes or misses", float(-u[0]), "m/s",
               float(-u[0]) / speed, -done.before[0])
    ]  # fmt: skip
    found += _course(done, hit, u, W, k, t, speed, float(law_of(system, row).friction), d_mu)
    for b, body in enumerate(bodies):
        number = int(row.body) if b == 0 else int(row.other)
        pose = done.poses[6 * b : 6 * b + 6]
        size = float(system.bodies.extent[number])
        for other in half_space_rows(system, number):
            cores = system.vertices[other.first : other.last]
            gaps = vertex_gaps(system, other, body)
            rates = other.axes[0] @ body.v + np.cross(body.w, cores @ body.R.T) @ other.axes[0]
            own = other.number == row.number and has_vertices(row)
            skip = np.zeros(len(cores), dtype=bool)
            if own:
                skip = np.any(np.all(cores[:, None] == tied[None], axis=2), axis=1)
            # vertices that move away do not strike next
            gaps = np.where(skip | (rates >= 0.0), np.inf, gaps)
            i = int(np.argmin(gaps))
            if np.isfinite(gaps[i]):
                gradient = gap_gradient(other.axes[0], body.R @ cores[i], pose)
                what = f"gap of vertex {i}, which approaches too"
                found.append(
                    Margin(t, k, what, float(gaps[i]), "m", float(gaps[i]) / size, gradient)
                )
    return found


def _course(done: Strike, hit: Blow, u, W, k, t, speed, mu, d_mu):
    """Return the margins of slip: to stopping, to not stopping, and to starting again."""
    found = []
    after = u + W @ hit.impulse
    slip = float(np.hypot(after[1], after[2]))
    if not hit.phases & (o.PHASE_STICK | o.PHASE_RESTART):
        if hit.phases & o.PHASE_SLIP and slip > AT_REST * speed:
            gradient = (after[1:] / slip) @ done.after[1:]
            what = "slip at the end of the impact: at 0 it sticks"
            found.append(Margin(t, k, what, slip, "m/s", slip / speed, gradient))
        return found
    if hit.slip_end >= 0.0:
        left = float(hit.impulse[0]) - hit.slip_end
        gradient = (hit.d[0] - hit.d[3]) @ done.inputs
        what = "impulse after the end of slip: at 0 it slips to the end"
        found.append(Margin(t, k, what, left, "N s", left / float(hit.impulse[0]), gradient))
    ratio, d_ratio = _stick_ratio(W, done.inputs)
    need = float(np.hypot(*ratio))
    value = mu - need
    gradient = d_mu - (ratio / need) @ d_ratio if need > 0.0 else d_mu
    what = (
        "friction above the limit of stick" if value > 0.0 else "friction below the limit of stick"
    )
    relative = abs(value) / max(mu, need)
    found.append(Margin(t, k, what, abs(value), "", relative, np.sign(value) * gradient))
    return found


def _stick_ratio(W, inputs):
    """Return the tangential impulse of stick divided by the normal impulse, and its derivative."""
    a, B = W[1:, 0], W[1:, 1:]
    ratio = -np.linalg.solve(B, a)
    dB = np.array([[inputs[3], inputs[4]], [inputs[4], inputs[5]]])
    return ratio, -np.linalg.solve(B, inputs[1:3] + np.einsum("ijp,j->ip", dB, ratio))


def of_end(k: int, d_time: np.ndarray, time: float, end: float) -> list[Margin]:
    """Return the margin of the last impact: its time before the end of the run."""
    left = end - time
    what = "time from the last impact to the end of the run"
    return [Margin(time, k, what, left, "s", left / end, -d_time)]


def of_flight(system, b: int, body: Moving, until: float, at_end: bool) -> list[Margin]:
    """Return the margins of near misses: least gaps within a flight, and gaps at the end of the run."""
    rows = half_space_rows(system, b)
    if not len(rows) or not until > body.t:
        return []
    turns = float(np.linalg.norm(body.w)) * (until - body.t) / (2 * np.pi)
    times = np.linspace(body.t, until, int(FEWEST_SAMPLES + A_TURN * turns) + 1)
    x, R = path(body, times)
    size = float(system.bodies.extent[b])
    near = []
    for row in rows:
        cores = system.vertices[row.first : row.last]
        heights = x @ row.axes[0] - row.offset - row.radius
        gaps = heights[:, None] + np.einsum("i,tik,vk->tv", row.axes[0], R, cores)
        # minima within the flight, and the end of the run if the gap decreases there
        inner = (gaps[1:-1] < gaps[:-2]) & (gaps[1:-1] <= gaps[2:])
        look = np.full(gaps.shape, np.inf)
        look[1:-1][inner] = gaps[1:-1][inner]
        if at_end:
            falls = gaps[-1] < gaps[-2]
            look[-1, falls] = gaps[-1, falls]
        least = np.argmin(look, axis=0)
        for v, i in enumerate(least):
            if look[i, v] < size:
                near.append((look[i, v], times, int(i), v, row, gaps[:, v]))
    near.sort(key=lambda miss: miss[0])
    return [_miss(system, body, size, *miss[1:]) for miss in near[:MISSES]]


def _miss(system, body: Moving, size: float, times, i: int, v: int, row, gaps) -> Margin:
    """Return the margin of a vertex with the least gap at sample i, within the flight or at its end."""
    n, core, time = row.axes[0], system.vertices[row.first + v], times[i]
    how = "comes near and leaves"
    if i == len(times) - 1:
        how = "falls as the run ends"
    else:  # minimum of the parabola through three samples; the time need not be exact
        bend = gaps[i + 1] - 2.0 * gaps[i] + gaps[i - 1]
        time -= 0.5 * (gaps[i + 1] - gaps[i - 1]) / bend * (times[1] - times[0])
    there = fly(body, float(time), ROUGHLY)
    arm = there.R @ core
    gap = float(n @ (there.x + arm) - row.offset - row.radius)
    gradient = gap_gradient(n, arm, there.X[:6])
    what = f"gap of vertex {v}, which {how}"
    return Margin(float(time), -1, what, gap, "m", abs(gap) / size, gradient)
