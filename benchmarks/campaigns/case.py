"""One random case, how it is run, and what is measured of the result."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

import carom
from carom.collision.api import nearest_points
from carom.generalized import GeneralizedSolution
from carom.geometry import quaternion
from carom.model.contact_rows import touching_pairs
from carom.scene.friction import bound_of

#: what a run may break at most: depth by size; energy gained, and without a name, by the energy exchanged;
#: an impulse by that which throws a free mass back
DEPTH, GAIN, UNNAMED, IMPULSE = 1e-9, 1e-6, 1e-4, 1e4
#: of the size of energies: their round-off; saved times at which bodies are looked at that overlap
ROUND_OFF, LOOKS = 1e-13, 40
PARTS = 10  # of the way between two corners, at whose ends the depth in curved ground is looked at


@dataclass
class Case:
    """A scene, or a system in coordinates, to be run, with a line that says what it is."""

    scene: Any
    duration: float
    step: float
    label: dict = field(default_factory=dict)
    #: how far a solution is from what bodies that cannot pass through each other may do: at most 1
    off: Callable[[carom.Solution], float] | None = None
    #: greatest penetration of a solution, where shapes do not tell it
    deep: Callable[[Any], float] | None = None


@dataclass
class Outcome:
    """What a run gave. Energies are parts of the largest that the run exchanged."""

    status: str
    reached: float  # part of the duration
    seconds: float  # processor time
    residual: float  # greatest energy without a name
    gained: float  # greatest rise of a line of the ledger that must not rise
    depth: float  # greatest penetration at a saved time, by size of the body: of the ground, of each other
    slip_residual: float  # greatest held_residual by the greatest speed
    impulse: float  # greatest normal impulse, by that which throws a free mass 1/W_nn back
    impacts: int
    wedged: int  # impacts that ended so
    whole: int  # steps taken whole
    warned: int  # sentences in `solution.warnings`
    off: float  # `Case.off`
    trials: int


def wrong(row: dict) -> list[str]:
    """Return what is wrong with an outcome, in words."""
    ends = ("SUCCESS", "BLOCKED") if row.get("blocks") else ("SUCCESS",)
    found = [] if row["status"] in ends else [row["status"]]
    found += [] if row["depth"] <= DEPTH else ["penetrates"]
    found += [] if row["off"] <= 1.0 else ["passes through"]
    if not row["gained"] <= GAIN:
        found.append("gains, said" if row["warned"] else "gains, silent")
    found += [] if row["impulse"] <= IMPULSE else ["absurd impulse"]
    if not row["residual"] <= UNNAMED:
        found.append("unnamed energy, said" if row["warned"] else "unnamed energy, silent")
    return found


def speeds(s: carom.Solution, step: float) -> float:
    """Return the greatest speed of a run."""
    speed = float(np.max(np.linalg.norm(s.velocity, axis=2), initial=0.0))
    return max(speed, step * float(np.linalg.norm(s.scene.gravity)))


def run(case: Case, tolerances: bool = False) -> Outcome:
    """Run a case with its step, or by the default tolerances, and measure the result."""
    how = {} if tolerances else {"step": case.step}
    begin = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        s = carom.simulate(case.scene, case.duration, throw=False, **how)
    spent = time.process_time() - begin
    deep = case.deep(s) if case.deep is not None else max(depth(s.scene, s), overlap(s.scene, s))
    s = s._of_scene if isinstance(s, GeneralizedSolution) else s
    scale, least = exchanged(s, case.step), ROUND_OFF * size(s)
    energies = {
        "impacts": s.ledger.impacts,
        "friction": s.ledger.friction,
        "bounces": s.ledger.bounces,
    }
    laws = [*case.scene.contacts, *filter(None, [getattr(case.scene, "contact_default", None)])]
    if any(law.impact_law in ("newton", "moreau") and bound_of(law.friction) > 0.0 for law in laws):
        del energies["impacts"]  # these laws may gain energy by themselves
    return Outcome(
        status=s.status.name,
        reached=float(s.t[-1] / case.duration),
        seconds=spent,
        residual=max(0.0, float(np.max(np.abs(s.ledger.residual))) - least) / scale,
        gained=max(0.0, max((rise(line) for line in energies.values()), default=0.0) - least)
        / scale,
        depth=deep,
        slip_residual=float(np.max(s.held_residual)) / max(speeds(s, case.step), 1e-300),
        impulse=impulse(s),
        impacts=len(s.impacts),
        wedged=int(np.sum(s.impacts.wedged)),
        whole=int(s.stats.get("whole_steps", 0)),
        warned=len(s.warnings),
        off=0.0 if case.off is None else case.off(s),
        trials=int(s.stats["trial_steps"]),
    )


def exchanged(s: carom.Solution, step: float) -> float:
    """Return the largest energy exchanged [J]: kinetic, potential against the start, a line of the ledger.

    Where nothing moves it is the round-off of the energies, and of speeds: 1e-11 m in a step.
    """
    potential = s.potential_energy - s.potential_energy[0]
    largest = max(
        np.max(s.kinetic_energy), np.max(np.abs(potential)), np.max(np.abs(s.ledger.loads))
    )
    size = np.max(s.kinetic_energy + np.abs(s.potential_energy))
    mass = sum(float(body.mass) for body in s.scene.bodies)
    still = 0.5 * mass * (1e-11 / step) ** 2
    return max(float(largest), 1e-13 * float(size), still)


def size(s: carom.Solution) -> float:
    """Return the size of what the energies are made of [J], which their round-off goes with."""
    weight = np.array([body.mass for body in s.scene.bodies]) * np.linalg.norm(s.scene.gravity)
    lifted = np.linalg.norm(s.position, axis=2) @ weight
    return float(np.max(s.kinetic_energy) + np.max(lifted))


def impulse(s: carom.Solution) -> float:
    """Return the greatest normal impulse of one point, by that which would throw a free mass 1/W_nn back."""
    worst = 0.0
    for row in s.impacts:
        speed = float(np.linalg.norm(row.relative_velocity_before))
        if speed > 0.0 and row.together == 1:
            worst = max(worst, float(row.impulse[0] * row.inverse_mass[0, 0] / (2.0 * speed)))
    return worst


def rise(line: np.ndarray) -> float:
    """Return the greatest rise of what must not rise."""
    return float(np.max(np.diff(line, prepend=0.0), initial=0.0))


def depth(scene: carom.Scene, s: carom.Solution) -> float:
    """Return how far bodies get into the half-spaces that they touch, by their size, by their support alone."""
    worst = 0.0
    pairs = touching_pairs(scene)
    planes = len(scene.half_spaces)  # static bodies follow them
    for b, plane in {(b, p) for b, p in zip(pairs.body, pairs.plane) if 0 <= p < planes}:
        shape, ground = scene.bodies[b].shape, scene.half_spaces[plane]
        if shape is None:
            continue
        height = (s.position[:, b] - ground.point) @ ground.normal
        near = height < shape.size  # others are above it as they are
        normal = np.asarray(ground.normal, dtype=float)
        down = quaternion.rotate_back(s.orientation[near, b], -normal)
        reach = np.array([shape.support(d) @ d for d in down])
        worst = max(worst, float(np.max(reach - height[near], initial=0.0)) / shape.size)
    return worst


def overlap(scene: carom.Scene, s: carom.Solution) -> float:
    """Return how far bodies get into each other, by the size of the smaller, at up to LOOKS saved times."""
    worst = 0.0
    pairs = touching_pairs(scene)
    rows = np.unique(np.linspace(0, len(s.t) - 1, LOOKS).astype(int))
    for a, b in {(a, b) for a, b in zip(pairs.body, pairs.other) if b >= 0}:
        shapes = scene.bodies[a].shape, scene.bodies[b].shape
        if None in shapes:
            continue
        smaller = min(shape.size for shape in shapes)
        reach = sum(shape.size for shape in shapes)
        for k in rows:
            x, q = s.position[k], s.orientation[k]
            if np.linalg.norm(x[a] - x[b]) < reach:
                gap = nearest_points(shapes[0], (x[a], q[a]), shapes[1], (x[b], q[b])).gap
                worst = max(worst, -gap / smaller)
    return worst


def points_of(piece) -> np.ndarray:
    """Return points of the core of a piece: its corners, and some on the ways between any two."""
    corners = np.asarray(piece.corners)
    i, j = np.triu_indices(len(corners), 1)
    shares = np.linspace(0.0, 1.0, PARTS + 1)[1:-1, None, None]
    between = (1.0 - shares) * corners[i] + shares * corners[j]
    return np.concatenate([corners, between.reshape(-1, 3)])


def as_row(family: str, seed: int, case: Case, outcome: Outcome) -> dict:
    """Return what is written down of a case."""
    return {"family": family, "seed": seed, **case.label, **asdict(outcome)}
