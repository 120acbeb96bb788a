"""Slides, rolls and throws over random floors of level pieces, compared with the same motion on a half-space.

python benchmarks/level_floors.py 200               200 cases
python benchmarks/level_floors.py 1 --first 77      one again
python benchmarks/level_floors.py 50 --step-up      with one piece that stands out: the body must strike it
"""

from __future__ import annotations

import argparse
import faulthandler
import time
import warnings
from collections import defaultdict
from itertools import pairwise

import numpy as np

import carom
from carom.geometry import quaternion

HALF, LOW = 3.0, 0.15  # half side of a floor, least size of a piece [m]
FLOORS = ("tiles", "bricks", "squares of two prisms", "random prisms", "compound")
BODIES = (
    "box", "rounded box", "prism", "cylinder, standing", "cylinder, lying", "capsule", "sphere",
    "ellipsoid", "compound", "table",
)  # fmt: skip
MOTIONS = ("slide", "slide with spin", "throw")


def polygons(kind: str, rng) -> list[np.ndarray]:
    """Return the pieces of a floor, as convex polygons (n, 2)."""
    if kind == "random prisms":
        from scipy.spatial import Delaunay

        rim = np.linspace(-HALF, HALF, 7)
        edge = [(x, y) for x in rim for y in rim if max(abs(x), abs(y)) == HALF]
        points = np.array([*edge, *rng.uniform(-0.95 * HALF, 0.95 * HALF, (60, 2))])
        return [points[corners] for corners in Delaunay(points).simplices]
    out = []
    sides = np.linspace(-HALF, HALF, int(rng.integers(6, 16)))
    for low, high in pairwise(sides):
        cuts = np.linspace(-HALF, HALF, int(rng.integers(6, 16)))
        if kind == "bricks":
            cuts[1:-1] = np.sort(rng.uniform(-HALF, HALF, len(cuts) - 2))
        elif kind != "compound":
            cuts = sides
        for a, b in pairwise(cuts):
            q = np.array([(low, a), (high, a), (high, b), (low, b)])
            out += [q[[0, 1, 2]], q[[0, 2, 3]]] if kind.startswith("squares") else [q]
    return out


def add_floor(scene, kind: str, place, up: float, rng) -> None:
    """Add a floor whose top is the plane of `place`; with `up`, the piece nearest to x = 0.8 m stands out."""
    yaw = rng.uniform(0.0, 90.0) * (rng.random() < 0.5)
    turn, parts, pieces = carom.euler("z", yaw), [], polygons(kind, rng)
    flat = [np.append(0.5 * (p.min(axis=0) + p.max(axis=0)), 0.0) for p in pieces]
    at = quaternion.rotate(np.array(turn), np.array(flat))
    raised = int(np.argmin(np.hypot(at[:, 0] - 0.8, at[:, 1])))
    for k, polygon in enumerate(pieces):
        thick, middle, height = rng.uniform(0.1, 0.4), flat[k][:2], up * (k == raised)
        if len(polygon) == 4:
            x, y = np.ptp(polygon, axis=0)
            part, centre = carom.Box(x, y, thick), np.array([*middle, height - 0.5 * thick])
        else:
            part = carom.Convex([(x, y, z) for x, y in polygon for z in (height - thick, height)])
            centre = part.centroid
        parts.append((part, quaternion.rotate(np.array(turn), centre)))
    if kind == "compound":
        whole = carom.Compound([(part, centre, turn) for part, centre in parts])
        shift = parts[0][1] - whole.pieces[0].position
        scene.add_static(
            whole, position=place[0] + quaternion.rotate(place[1], shift), orientation=place[1]
        )
        return
    for part, centre in parts:
        scene.add_static(
            part, position=place[0] + quaternion.rotate(place[1], centre),
            orientation=quaternion.multiply(place[1], np.array(turn)),
        )  # fmt: skip


def body(kind: str, rng):
    """Return a shape, and an orientation in which it lies on the plane."""
    x, y, z = rng.uniform(0.1, 0.4, 3)
    still = np.array([1.0, 0.0, 0.0, 0.0])
    across = np.array(carom.euler("y", 90))
    if kind == "box":
        return carom.Box(x, y, z), still
    if kind == "rounded box":
        return carom.Box(x, y, z, radius=0.02), still
    if kind == "prism":
        angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, 3)) * 0.1 + 2.0 * np.pi / 3.0 * np.arange(3)
        base = x * np.c_[np.cos(angles), np.sin(angles)]
        return carom.Convex([(*p, h) for p in base for h in (0.0, z)]), still
    if kind == "cylinder, standing":
        return carom.Cylinder(0.5 * x, z), still
    if kind == "cylinder, lying":
        return carom.Cylinder(0.3 * x, y), across
    if kind == "capsule":
        return carom.Capsule(0.3 * x, y), across
    if kind == "sphere":
        return carom.Sphere(0.5 * x), still
    if kind == "ellipsoid":
        return carom.Ellipsoid(0.5 * x, 0.5 * y, 0.5 * z), still
    if kind == "compound":
        return carom.Compound(
            [(carom.Box(x, y, z), (0, 0, 0)), (carom.Box(y, x, z), (0.5 * (x + y), 0, 0))]
        ), still
    legs = [((0.5 * x * i, 0.5 * y * j, -0.5 * z)) for i in (-1, 1) for j in (-1, 1)]
    top = (carom.Box(x + 0.04, y + 0.04, 0.02), (0, 0, 0.01))
    return carom.Compound([top, *((carom.Box(0.03, 0.03, z), leg) for leg in legs)]), still


class Case:
    """Case number `seed`: kinds in turn, the rest at random."""

    def __init__(self, seed: int, up: float = 0.0):
        self.seed, self.up = seed, up
        self.floor = FLOORS[seed % len(FLOORS)]
        self.body = BODIES[seed // len(FLOORS) % len(BODIES)]
        self.motion = MOTIONS[seed // (len(FLOORS) * len(BODIES)) % len(MOTIONS)]
        if up:
            self.motion = "slide"

    def scene(self, flat: bool) -> carom.Scene:
        """Return the scene, on the floor or on a half-space."""
        rng = np.random.default_rng([31, self.seed])
        turned = rng.random() < 0.3
        Q = rng.normal(size=4) if turned else np.array([1.0, 0.0, 0.0, 0.0])
        place = rng.normal(size=3) * turned, Q / np.linalg.norm(Q)
        tilt = 0.0 if rng.random() < 0.6 or self.up else rng.uniform(0.0, 0.3)
        down = 9.81 * np.array([np.sin(tilt), 0.0, -np.cos(tilt)])
        scene = carom.Scene(gravity=quaternion.rotate(place[1], down))
        shape, lying = body(self.body, rng)
        yaw = np.array(carom.euler("z", 0.0 if rng.random() < 0.3 else rng.uniform(0.0, 360.0)))
        pose = quaternion.multiply(yaw, lying)
        low = float(
            shape.support(quaternion.rotate_back(pose, np.array([0, 0, -1.0])))
            @ quaternion.rotate_back(pose, np.array([0, 0, -1.0]))
        )
        x = np.array([0.0, 0.0, low])
        v = np.append(rng.normal(size=2), 0.0)
        v *= rng.uniform(0.3, 2.5) / np.linalg.norm(v)
        w = np.zeros(3)
        if self.up:
            v, x = np.array([2.0, 0.0, 0.0]), x - (0.5, 0.0, 0.0)
        if self.motion == "slide with spin":
            w = np.array([0.0, 0.0, rng.normal() * 4.0])
        if self.motion == "throw":
            pose = rng.normal(size=4)
            pose /= np.linalg.norm(pose)
            x, w = x + (0, 0, shape.size - low + rng.uniform(0.02, 0.2)), rng.normal(size=3) * 4.0
        mu, e = rng.uniform(0.0, 0.6) * (rng.random() < 0.8), rng.uniform(0.0, 0.8)
        mu = min(mu, 0.05) if self.up else mu
        scene.add_body(
            shape, mass=rng.uniform(0.5, 3.0), position=place[0] + quaternion.rotate(place[1], x),
            orientation=quaternion.multiply(place[1], pose),
            velocity=quaternion.rotate(place[1], v), angular_velocity=quaternion.rotate(place[1], w),
        )  # fmt: skip
        scene.set_contact_default(restitution=e, friction=mu)
        if flat:
            scene.add_half_space(place[0], quaternion.rotate(place[1], np.array([0, 0, 1.0])))
        else:
            add_floor(scene, self.floor, place, self.up, rng)
        return scene

    def run(self, flat: bool, rtol: float):
        """Return the solution and the processor time."""
        scene, start = self.scene(flat), time.process_time()
        saved = np.linspace(0.0, 0.8, 41)
        s = carom.simulate(scene, 0.8, save_at=saved, rtol=rtol, throw=False)
        return s, time.process_time() - start


def compare(case: Case, rtol: float) -> dict:
    """Return how a run on the floor differs from that on a half-space."""
    plane, _ = case.run(True, rtol)
    floor, seconds = case.run(False, rtol)
    count = min(len(plane.t), len(floor.t))
    off = np.abs(plane.position[:count] - floor.position[:count]).max(axis=(1, 2))
    return {
        "off": off.max(), "first": float(plane.t[np.argmax(off > 1e-9)]) if off.max() > 1e-9 else np.nan,
        "status": (plane.status.name, floor.status.name), "impacts": (len(plane.impacts), len(floor.impacts)),
        "trials": (plane.stats["trial_steps"], floor.stats["trial_steps"]), "seconds": seconds,
    }  # fmt: skip


def main() -> None:
    """Run cases and print those that differ, then a table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("count", type=int)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--rtol", type=float, default=1e-8)
    parser.add_argument("--step-up", action="store_true")
    parser.add_argument("--budget", type=float, default=1e9)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    table, begin = defaultdict(list), time.time()
    for seed in range(given.first, given.first + given.count):
        if time.time() - begin > given.budget:
            break
        faulthandler.dump_traceback_later(900, exit=True)
        case = Case(seed, 1e-3 if given.step_up else 0.0)
        r = compare(case, given.rtol)
        table[case.body, case.motion].append(r["off"])
        if given.step_up:
            wrong = r["impacts"][1] == 0
        else:
            wrong = not r["off"] <= 1e-9 or r["seconds"] > 1.0 or r["status"][0] != r["status"][1]
        if wrong or given.count == 1:
            print(seed, case.floor, "|", case.body, "|", case.motion, r, flush=True)
    for key, off in sorted(table.items()):
        print(key, len(off), f"median {np.median(off):.0e}, most {np.max(off):.0e}", flush=True)


if __name__ == "__main__":
    main()
