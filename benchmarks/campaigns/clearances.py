"""Joints with clearance: pins between free bodies, in pendulums, cranks and drawers, and balls in sockets."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case
from carom import GROUND, constraints, forces, joints
from carom.geometry import quaternion

KINDS = "free", "pendulum", "crank", "drawer", "socket"
#: of the clearance, or of the size: how far a pin may be beyond its bush
BEYOND = 1e-6


def case(seed: int) -> Case:
    """Return clearance number `seed`."""
    rng = np.random.default_rng([47, seed])
    step, kind = draw.STEPS[seed % 3], str(rng.choice(KINDS))
    play = {
        "radial": 10.0 ** rng.uniform(-4.5, -2), "restitution": float(rng.choice([0.0, 0.3, 0.8, 1.0])),
        "impact_law": str(rng.choice(["newton", "poisson", "stronge"])),
    }  # fmt: skip
    if kind != "socket":
        # with friction Newton's law may give energy, and says so
        rubs = play["impact_law"] != "newton" or play["restitution"] == 0.0
        play["friction"] = float(rng.choice([0.0, 0.0, 0.1, 0.3, 0.8])) if rubs else 0.0
        play["radius"] = float(rng.choice([0.0, 0.01]))
        if rng.random() < 0.4:
            play["length"] = float(rng.uniform(0.02, 0.2))
        if rng.random() < 0.3:
            play["axial"] = 10.0 ** rng.uniform(-4, -2)
    scene = carom.Scene(gravity=(0, 0, -9.81) if rng.random() < 0.7 else (0, 0, 0))
    duration = _MAKERS[kind](scene, rng, play)
    names = [stop.name for stop in scene.stops]

    def off(s: carom.Solution) -> float:
        """Return how far a pin is beyond its bush, by what is allowed."""
        return max(-float(np.min(s[name].gap)) for name in names) / (BEYOND * play["radial"])

    return Case(scene, duration, step, {"kind": kind, "step": step, **play}, off)


def _body(scene, rng, position, **motion):
    size = 10.0 ** rng.uniform(-1.5, -0.5)
    shape = carom.Box(size, size * rng.uniform(0.3, 1.0), size * rng.uniform(0.3, 1.0))
    return scene.add_body(shape, mass=10.0 ** rng.uniform(-1, 1), position=position, **motion)


def _turn(rng) -> np.ndarray:
    return quaternion.exp(rng.normal(size=3))


def _free(scene, rng, play) -> float:
    """Two bodies that turn in each other's arms."""
    a = _body(
        scene, rng, (0.05, 0, 0), orientation=_turn(rng), angular_velocity=3.0 * rng.normal(size=3)
    )
    b = _body(scene, rng, (0, 0.05, 0), angular_velocity=3.0 * rng.normal(size=3))
    scene.add_joint(joints.Clearance((0, 0, 0), rng.normal(size=3), **play), a, b)
    return 0.5


def _pendulum(scene, rng, play) -> float:
    """A body that hangs by a loose pin, thrown; in space or in a plane."""
    body = _body(scene, rng, (0.1, 0, -0.1), angular_velocity=(0, 5.0 * rng.normal(), 0))
    if rng.random() < 0.5:
        scene.add_joint(joints.Planar((0, 1, 0)), GROUND, body)
        play.pop("axial", None)
    scene.add_joint(joints.Clearance((0, 0, 0), (0, 1, 0), **play), GROUND, body)
    return 0.5


def _crank(scene, rng, play) -> float:
    """A slider-crank that a motor drives, with a loose pin between rod and slider."""
    a, l = 0.05, float(rng.uniform(0.08, 0.2))
    play.pop("length", None)
    play.pop("axial", None)
    parts = [
        scene.add_body(mass=m, inertia=np.full(3, 1e-3 * m), position=(x, 0, 0), name=name)
        for name, m, x in (("crank", 0.3, a / 2), ("rod", 0.2, a + l / 2), ("slider", 0.15, a + l))
    ]
    crank, rod, slider = parts
    axle = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, crank)
    scene.add_joint(joints.Revolute((a, 0, 0), (0, 1, 0)), crank, rod)
    scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, slider)
    scene.add_joint(joints.Clearance((a + l, 0, 0), (0, 1, 0), **play), rod, slider)
    turn = float(rng.uniform(5, 60))

    def motion(t):
        turned = turn * t
        return turned - np.sin(turned), turn * (1.0 - np.cos(turned)), turn**2 * np.sin(turned)

    scene.add_constraint(constraints.Driver(axle, motion=motion))
    return 2.0 * 2.0 * np.pi / turn


def _drawer(scene, rng, play) -> float:
    """A drawer in a guide with play, pushed beside its middle."""
    play["length"] = float(rng.uniform(0.1, 0.5))
    play.pop("axial", None)
    body = _body(scene, rng, (0, 0, 0))
    scene.add_joint(joints.Planar((0, 0, 1)), GROUND, body)
    scene.add_joint(joints.Clearance((0, 0, 0), (1, 0, 0), **play), GROUND, body)
    at = (0, float(rng.uniform(0, 0.5)), 0)
    scene.add_force(forces.Force((float(rng.uniform(0.5, 20.0)), 0, 0), at), body)
    return 0.5


def _socket(scene, rng, play) -> float:
    """A body that hangs by a ball in a socket."""
    body = _body(scene, rng, (0.1, 0, -0.1), angular_velocity=3.0 * rng.normal(size=3))
    scene.add_joint(joints.Clearance((0, 0, 0), **play), GROUND, body)
    return 0.5


_MAKERS = {
    "free": _free,
    "pendulum": _pendulum,
    "crank": _crank,
    "drawer": _drawer,
    "socket": _socket,
}
