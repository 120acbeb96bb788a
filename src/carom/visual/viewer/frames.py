"""The frames of a viewer: times and poses, and the region of the motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.visual.bodies import Outline, moving

MOST_FRAMES = 5000  # frames, if nothing else is asked for
VALUES = 3_000_000  # numbers of all poses together: 12 MB before packing
FLAT = 1e-4  # part of the square of the displacements that leaves a plane, up to which it is one
NEAR = 0.5  # of the width of what moves: so near is what rests and is shown in full
SMOOTH = 600  # about as many frames has a run with fewer saved times, so that nothing jerks


class Frames(NamedTuple):
    """Poses of N bodies in F frames; straight lines and steady rotations suffice between them."""

    time: np.ndarray  #: (F,) [s]
    position: np.ndarray  #: (F, N, 3) mass centres, world [m]
    orientation: np.ndarray  #: (F, N, 4) body to world, (w, x, y, z)


class Place(NamedTuple):
    """The region of the motion, and the best direction of view."""

    centre: np.ndarray  #: (3,) of the box around all bodies at all moments [m]
    radius: float  #: of a ball around that box [m]
    up: np.ndarray  #: (3,) unit vector against gravity
    side: np.ndarray  #: (3,) unit vector, level: from the centre to the eye
    lift: float  #: angle of the eye above the level [rad]


def frames_of(solution, most: int = MOST_FRAMES) -> Frames:
    """Return the frames to show, at `times_of`."""
    return frames_at(solution, times_of(solution, most))


def times_of(solution, most: int = MOST_FRAMES) -> np.ndarray:
    """Return the times to show: saved ones, thinned out to `most`, and those of impacts.

    If a run has few saved times, `Solution.evaluate` gives states between them. With many bodies there are
    fewer frames, so that the poses are at most 3 million numbers.
    """
    most = max(2, min(most, max(200, VALUES // (7 * solution.position.shape[1]))))
    times, saved = thinned(solution.t, most), len(solution.t)
    if 1 < saved <= most and (between := min(SMOOTH, most) // saved) > 1:
        places = np.arange((saved - 1) * between + 1) / between
        times = np.interp(places, np.arange(saved), times)
    return np.union1d(times, moments_of_impacts(solution.impacts, most // 2))


def thinned(times: np.ndarray, most: int) -> np.ndarray:
    """Return at most `most` of some times, evenly chosen."""
    last = len(times) - 1
    return times[np.unique(np.linspace(0, last, min(last + 1, most)).round().astype(int))]


def frames_at(solution, times: np.ndarray) -> Frames:
    """Return the poses at some times."""
    return Frames(times, *_poses(solution, times))


def _poses(solution, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (F, N, 3) and orientations (F, N, 4): saved ones, others between them."""
    row = np.searchsorted(solution.t, times)
    new = solution.t[row] != times
    x, Q = solution.position[row], solution.orientation[row]
    if np.any(new):
        x[new], Q[new] = solution._curve(times[new])[:2]
    return x, Q


def moments_of_impacts(impacts, most: int) -> np.ndarray:
    """Return the times of the strongest impacts, where paths have corners."""
    strongest = np.argsort(-np.linalg.norm(impacts.impulse, axis=1), kind="stable")
    return impacts.time[strongest[:most]]


def place_of(solution, frames: Frames, outlines: list[Outline], fixed: list[np.ndarray]) -> Place:
    """Return the region of the motion.

    Parameters
    ----------
    outlines : (N,)
        Extents of the bodies.
    fixed
        Points (3,) of the ground that must be visible too.
    """
    boxes = np.array([_box(frames, b, outline) for b, outline in enumerate(outlines)])  # (N, 2, 3)
    seen = moving(frames.position, frames.orientation)
    if np.any(seen):  # and of what rests only that which is as small as all that moves, and near it
        low, high = boxes[seen, 0].min(axis=0), boxes[seen, 1].max(axis=0)
        far = NEAR * (high - low).max()
        seen |= np.all((boxes[:, 0] > low - far) & (boxes[:, 1] < high + far), axis=1)
    else:
        seen[:] = True
    low = np.min([*fixed, *boxes[seen, 0]], axis=0)
    high = np.max([*fixed, *boxes[seen, 1]], axis=0)
    radius = max(0.5 * float(np.linalg.norm(high - low)), 1e-9)
    up = _up(solution.scene.gravity, frames.position)
    return Place(0.5 * (low + high), radius, up, *_view(frames.position, up))


def _box(frames: Frames, b: int, outline: Outline) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest and the highest coordinates (3,) of a body over the run."""
    reached = [
        frames.position[:, b] + quaternion.rotate(frames.orientation[:, b], point)
        for point in outline.points
    ]
    return np.min(reached, axis=(0, 1)) - outline.size, np.max(reached, axis=(0, 1)) + outline.size


def _up(gravity: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Return the direction against gravity; without it one in the plane of the motion, or z."""
    pull = float(np.linalg.norm(gravity))
    if pull > 0.0:
        return -gravity / pull
    shifts = (position - position[0]).reshape(-1, 3)
    turns, axes = np.linalg.eigh(shifts.T @ shifts)
    flat = turns[1] > 0.0 and turns[0] < FLAT * turns[1]
    normal = axes[:, 0] if flat else np.array([1.0, 0.0, 0.0])
    up = np.array([0.0, 1.0, 0.0] if abs(normal[2]) > 0.7 else [0.0, 0.0, 1.0])
    up -= (up @ normal) * normal
    return up / np.linalg.norm(up)


def _view(position: np.ndarray, up: np.ndarray) -> tuple[np.ndarray, float]:
    """Return direction and elevation of the view: across a vertical plane, or down on a horizontal one."""
    east = np.eye(3)[np.argmin(np.abs(up))]
    east -= (east @ up) * up
    east /= np.linalg.norm(east)
    north = np.cross(up, east)
    shifts = (position - position[0]).reshape(-1, 3)
    level = np.stack([shifts @ east, shifts @ north])
    turns, axes = np.linalg.eigh(level @ level.T)
    if turns[1] > 0.0 and turns[0] < FLAT * turns[1]:
        across = axes[0, 0] * east + axes[1, 0] * north
        front = -north + 0.01 * east  # of the two sides the one from which x goes to the right
        return (across if across @ front > 0.0 else -across), 0.3
    down = np.sum((shifts @ up) ** 2) < 0.01 * np.sum(turns)
    return 0.6 * east - 0.8 * north, 0.9 if down else 0.3


def poses_at(frames: Frames, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (N, 3) and orientations (N, 4) at a time: straight lines and steady turns."""
    time = frames.time
    k = int(np.clip(np.searchsorted(time, t, side="right") - 1, 0, max(len(time) - 2, 0)))
    n = min(k + 1, len(time) - 1)
    s = float(np.clip((t - time[k]) / (time[n] - time[k]), 0.0, 1.0)) if n > k else 0.0
    x = (1.0 - s) * frames.position[k] + s * frames.position[n]
    return x, quaternion.interpolate(frames.orientation[k], frames.orientation[n], s)
