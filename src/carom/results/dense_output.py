"""The motion of a body between saved states: in closed form in free flight, otherwise a cubic."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.geometry import differential, quaternion, spline

if TYPE_CHECKING:
    from carom.results.assemble import Nodes


NEAR = 1e-6  # of an interval: at this distance from its ends the cubic is as accurate as the states


class Flights(NamedTuple):
    """Times of free flight of a body on which only gravity acts: all except intervals of persistent contact."""

    moments: np.ndarray | None  # (3,); None if they are equal: then a cubic is exact
    starts: np.ndarray  # (M,) starts of the intervals of contact, sorted
    ends: np.ndarray  # (M,) ends of the intervals, sorted

    def cover(self, t0: np.ndarray, t1: np.ndarray) -> np.ndarray:
        """Return whether there is no persistent contact between the times t0 and t1 (K,)."""
        begun = np.searchsorted(self.starts, t1, side="left")
        return begun == np.searchsorted(self.ends, t0, side="right")


def flights(solution) -> list[Flights | None]:
    """Return the flights of each body; None if other forces than gravity act on it."""
    bodies, contacts = solution._run.bodies, solution.contacts
    pairs = solution.pairs
    of_pair = contacts.contact < len(pairs.body)  # the others are stops in joints
    which = contacts.contact[of_pair]
    sides = np.concatenate([pairs.body[which], pairs.other[which]])
    starts, ends = np.tile(contacts.start[of_pair], 2), np.tile(contacts.end[of_pair], 2)
    out: list[Flights | None] = []
    for b in range(len(bodies)):
        if bodies["ballistic"][b] == 0:
            out.append(None)
            continue
        own = sides == b
        moments = None if bodies["isotropic"][b] == 1 else np.array(bodies["inertia"][b])
        out.append(Flights(moments, np.sort(starts[own]), np.sort(ends[own])))
    return out


def curves(solution, times: np.ndarray, side: str):
    """Return position, attitude (of the principal axes) and velocities of all bodies at times (K,).

    The last of the five arrays (K, N) marks the states that are from a cubic between two states.
    """
    known = zip(solution._nodes, solution._flights)
    bodies = [between(node, flies, times, side) for node, flies in known]
    return tuple(np.stack(column, axis=1) for column in zip(*bodies))


def between(node: Nodes, flies: Flights | None, times: np.ndarray, side: str):
    """Return position, attitude and velocities of one body at times (K,), and a mark of states from a cubic."""
    at, pose, left, right = node
    i = np.searchsorted(at, times, side="right" if side == "right" else "left") - 1
    i = np.clip(i, 0, max(len(at) - 2, 0))
    n = np.minimum(i + 1, len(at) - 1)
    start = (pose[i, :3], pose[i, 3:], right[i, :3], right[i, 3:])
    end = (pose[n, :3], pose[n, 3:], left[n, :3], left[n, 3:])
    x, Q, v, w = spline.interpolate(times, at[i], at[n], start, end)
    free = np.zeros(len(times), dtype=bool) if flies is None else flies.cover(at[i], at[n])
    if flies is not None and flies.moments is not None:
        inside = (times > at[i]) & (times < at[n]) & free
        if inside.any():
            ends = [a[inside] for a in (start[1], start[3], end[1], end[3])]
            Q[inside], w[inside] = _along_flight(
                flies.moments, times[inside] - at[i][inside], (at[n] - at[i])[inside], *ends
            )
    last = times == at[-1]
    if side == "right" and np.any(last):
        v[last], w[last] = right[-1, :3], right[-1, 3:]
    margin = NEAR * (at[n] - at[i])
    return x, Q, v, w, ~free & (times - at[i] > margin) & (at[n] - times > margin)


def _along_flight(moments, t, h, Q0, w0, Q1, w1):
    """Return attitude and angular velocity of a body without torque at times t after the start of steps h.

    The flight from the start may miss the state at the end, because of round-off or impulses of a time-stepping
    step. The difference is added as a cubic, as in `carom.geometry.spline`, in the chart of the flight.
    """
    from carom.kinematics.flight_arrays import torque_free

    Q, w = torque_free(moments, Q0, w0, t)
    Qh, wh = torque_free(moments, Q0, w0, h)
    miss = quaternion.between(Qh, Q1)
    W1, Wh = quaternion.rotate_back(Q1, w1), quaternion.rotate_back(Qh, wh)
    rate = differential.apply_inverse(miss, W1 - quaternion.rotate_back(quaternion.exp(miss), Wh))
    s, h = (t / h)[:, None], h[:, None]
    eta = s * s * ((3.0 - 2.0 * s) * miss - (1.0 - s) * h * rate)
    slope = s * (6.0 * (1.0 - s) * miss / h + (3.0 * s - 2.0) * rate)
    turned = quaternion.exp(eta)
    W = differential.apply(eta, slope) + quaternion.rotate_back(
        turned, quaternion.rotate_back(Q, w)
    )
    Q = quaternion.normalize(quaternion.multiply(Q, turned))
    return Q, quaternion.rotate(Q, W)
