"""What is shown of a run: moments and poses, and where in the world it all takes place."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

MOST = 5000  # frames, if nothing else is asked for
VALUES = 3_000_000  # numbers of all poses together: 12 MB before packing
SMOOTH = 600  # about as many frames has a run with fewer saved times, so that nothing jerks


class Frames(NamedTuple):
    """Poses of N bodies at F moments; between them straight lines and steady turns are good enough."""

    time: np.ndarray  #: (F,) [s]
    position: np.ndarray  #: (F, N, 3) mass centres, world [m]
    orientation: np.ndarray  #: (F, N, 4) body to world, (w, x, y, z)


class Place(NamedTuple):
    """Where the motion takes place, and from where it is best looked at."""

    centre: np.ndarray  #: (3,) of the box around all bodies at all moments [m]
    radius: float  #: of a ball around that box [m]
    up: np.ndarray  #: (3,) unit vector against gravity
    side: np.ndarray  #: (3,) unit vector, horizontal: from the centre to the eye


def frames_of(solution, most: int = MOST) -> Frames:
    """Return the moments to show: saved times, thinned to `most`, and those of impacts.

    A run with few saved times is filled up from `Solution.evaluate`, which knows what is between them.
    Many bodies have fewer frames, so that the poses stay below 3 million numbers.
    """
    most = max(2, min(most, max(200, VALUES // (7 * solution.position.shape[1]))))
    times, saved = solution.t, len(solution.t)
    if saved > most:
        times = times[np.unique(np.linspace(0, saved - 1, most).round().astype(int))]
    elif saved > 1 and (between := min(SMOOTH, most) // saved) > 1:
        places = np.arange((saved - 1) * between + 1) / between
        times = np.interp(places, np.arange(saved), times)
    times = np.union1d(times, _moments_of_impacts(solution.impacts, most // 2))
    return Frames(times, *_poses(solution, times))


def _poses(solution, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (F, N, 3) and orientations (F, N, 4): saved ones, others between them."""
    row = np.searchsorted(solution.t, times)
    new = solution.t[row] != times
    x, Q = solution.position[row], solution.orientation[row]
    if np.any(new):
        x[new], Q[new] = solution.evaluate(times[new])[:2]
    return x, Q


def _moments_of_impacts(impacts, most: int) -> np.ndarray:
    """Return the times of the strongest impacts: there the way has a corner."""
    strongest = np.argsort(-np.linalg.norm(impacts.impulse, axis=1), kind="stable")
    return impacts.time[strongest[:most]]


def place_of(solution, frames: Frames, sizes: np.ndarray, fixed: list[np.ndarray]) -> Place:
    """Return where the motion takes place.

    `sizes` (N,) are radii of the bodies [m]; `fixed` are points (3,) of the ground that are to be seen too.
    """
    least = np.min(frames.position - sizes[:, None], axis=(0, 1))
    greatest = np.max(frames.position + sizes[:, None], axis=(0, 1))
    least, greatest = np.min([least, *fixed], axis=0), np.max([greatest, *fixed], axis=0)
    radius = max(0.5 * float(np.linalg.norm(greatest - least)), 1e-9)
    gravity = solution.scene.gravity
    pull = float(np.linalg.norm(gravity))
    up = -gravity / pull if pull > 0.0 else np.array([0.0, 0.0, 1.0])
    return Place(0.5 * (least + greatest), radius, up, _side(frames.position, up))


def _side(position: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Return from where to look: across a motion that stays in an upright plane, else from a corner."""
    east = np.eye(3)[np.argmin(np.abs(up))]
    east -= (east @ up) * up
    east /= np.linalg.norm(east)
    north = np.cross(up, east)
    ways = (position - position[0]).reshape(-1, 3)
    flat = np.stack([ways @ east, ways @ north])
    turns, axes = np.linalg.eigh(flat @ flat.T)
    if turns[1] > 0.0 and turns[0] < 1e-4 * turns[1]:
        across = axes[0, 0] * east + axes[1, 0] * north
        front = -north + 0.01 * east  # of the two sides the one from which x goes to the right
        return across if across @ front > 0.0 else -across
    return 0.6 * east - 0.8 * north


def poses_at(frames: Frames, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (N, 3) and orientations (N, 4) at a time: straight lines and steady turns."""
    time = frames.time
    k = int(np.clip(np.searchsorted(time, t, side="right") - 1, 0, max(len(time) - 2, 0)))
    n = min(k + 1, len(time) - 1)
    s = float(np.clip((t - time[k]) / (time[n] - time[k]), 0.0, 1.0)) if n > k else 0.0
    p, q = frames.orientation[k], frames.orientation[n]
    cosine = np.sum(p * q, axis=1, keepdims=True)
    q = np.where(cosine < 0.0, -q, q)  # the same attitude, by the shorter way
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    sine = np.where(angle > 1e-4, np.sin(angle), 1.0)
    first = np.where(angle > 1e-4, np.sin((1.0 - s) * angle) / sine, 1.0 - s)
    second = np.where(angle > 1e-4, np.sin(s * angle) / sine, s)
    turned = first * p + second * q
    x = (1.0 - s) * frames.position[k] + s * frames.position[n]
    return x, turned / np.linalg.norm(turned, axis=1, keepdims=True)
