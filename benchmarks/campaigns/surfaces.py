"""Bodies on surfaces and materials as they are: laws of friction and restitution, belts, parts, rails, throws.

A scene is one of `GROUNDS` with some of `BODIES` and one material for all pairs, of `frictions` and `laws`. A
new kind of ground or of body is one more function in its list.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from scipy.interpolate import CubicSpline

import carom
from campaigns import belts, draw, frictions, laws, slides
from campaigns.case import Case
from carom.model.moving_surfaces import field_at
from carom.scene.bodies import HalfSpace
from carom.scene.friction import FrictionLaw, TableFriction, bound_of

DURATION = 0.4  # [s]
#: by which a force may leave its cone, as a part of the normal force, and of the greatest
CONE = 1e-6
#: of the greatest speed: slower slip is about to stop or to turn, and has the law of its step
SLOW = 1e-6


def case(seed: int) -> Case:
    """Return number `seed`: grounds, bodies and steps in turn, the rest at random."""
    rng = np.random.default_rng([22, seed])
    ground = tuple(GROUNDS)[seed % len(GROUNDS)]
    bodies = tuple(BODIES)[seed // len(GROUNDS) % len(BODIES)]
    step = draw.STEPS[seed // (len(GROUNDS) * len(BODIES)) % 3]
    tilt = rng.uniform(0.0, 0.4) * (rng.random() < 0.3)
    scene = carom.Scene(gravity=9.81 * np.array([np.sin(tilt), 0.0, -np.cos(tilt)]))
    GROUNDS[ground](scene, 10.0 ** rng.uniform(-1.5, 0.7), rng)
    law = material(rng)
    bounds = [greatest(law["friction"]), *BODIES[bodies](scene, rng)]
    scene.set_contact_default(**law, combine="max")
    one = law["friction"] if len(bounds) == 1 and len(scene.bodies) == 1 else None
    label = {"kind": ground, "bodies": bodies, "step": step, "tilt": tilt}
    label |= {"impact_law": law["impact_law"], "material": repr(law)}
    return Case(scene, DURATION, step, label, lambda s: beyond_cone(s, max(bounds), one))


def greatest(mu: float | FrictionLaw) -> float:
    """Return the greatest coefficient of a law."""
    return max(mu.values) if isinstance(mu, TableFriction) else bound_of(mu)


def material(rng) -> dict:
    """Return the properties of all pairs: numbers, or laws of the speed."""
    e = rng.choice([0.0, rng.uniform(0.0, 0.95)]) if rng.random() < 0.5 else laws.restitution(rng)
    return {
        "friction": rng.uniform(0.0, 1.2) if rng.random() < 0.4 else frictions.friction(rng),
        "restitution": e,
        "tangential_restitution": rng.uniform(-1.0, 1.0) if rng.random() < 0.4 else 0.0,
        "rolling_friction": rng.choice([0.0, 1e-3]),
        "pivoting_friction": rng.choice([0.0, 1e-3]),
        "impact_law": draw.LAWS[rng.integers(3)],
    }


def floor(scene: carom.Scene, speed: float, rng) -> None:
    """A floor at rest, of a half-space, or of a slab with a step."""
    if rng.random() < 0.5:
        scene.add_half_space((0, 0, 0), (0, 0, 1))
        return
    scene.add_static(carom.Box(6, 6, 0.2), position=(0, 0, -0.1))
    scene.add_static(carom.Box(6, 1, 0.04), position=(0, 0.6, 0.02))


def belt(kind: str, scene: carom.Scene, speed: float, rng) -> None:
    """A surface of the campaign of belts."""
    belts.surfaces(scene, kind, speed, rng)


def corner(scene: carom.Scene, speed: float, rng) -> None:
    """A belt that carries towards a wall, which moves too."""
    scene.add_half_space((0, 0, 0), (0, 0, 1), surface_velocity=(speed, 0, 0))
    scene.add_half_space((0.8, 0, 0), (-1, 0, 0), surface_velocity=(0, 0, rng.normal() * speed))


def stopping(scene: carom.Scene, speed: float, rng) -> None:
    """A belt that starts, stops and turns back, by a spline of measured speeds."""
    knots = np.linspace(0.0, DURATION, 6)
    speeds = np.outer(rng.uniform(-1.0, 1.0, 6) * (rng.random(6) < 0.7), (speed, 0.0, 0.0))
    scene.add_half_space((0, 0, 0), (0, 0, 1), surface_velocity=CubicSpline(knots, speeds))


def thrown(scene: carom.Scene, rng) -> tuple:
    """Throw one to three bodies."""
    shape = draw.shape(rng.choice(draw.SHAPES), 0.1, rng)
    for k in range(int(rng.integers(1, 4))):
        scene.add_body(
            shape, mass=10.0 ** rng.uniform(-1, 1), position=(*(0.1 * rng.normal(size=2)), 0.25 + 0.3 * k),
            orientation=draw.attitude(rng), velocity=rng.normal(size=3),
            angular_velocity=5.0 * rng.normal(size=3),
        )  # fmt: skip
    return ()


def laid(scene: carom.Scene, rng) -> tuple:
    """Lay a body with a flat face down, with or without speed."""
    body = slides.prism(int(rng.integers(3, 9)), 0.1, rng)
    low = float(min(point[2] for point in body.points)) - body.radius
    speed = rng.choice([0.0, 1.0]) * rng.normal(size=3)
    scene.add_body(
        body, mass=10.0 ** rng.uniform(-1, 1), position=(0, 0, -low + 1e-4), velocity=(*speed[:2], 0),
        angular_velocity=(0, 0, speed[2]),
    )  # fmt: skip
    return ()


def piled(scene: carom.Scene, rng) -> tuple:
    """Pile up two or three boxes."""
    z = 1e-4
    for _ in range(int(rng.integers(2, 4))):
        a, b, c = rng.uniform(0.05, 0.2, 3)
        place = *rng.uniform(-0.02, 0.02, 2), z + 0.5 * c
        scene.add_body(carom.Box(a, b, c), mass=10.0 ** rng.uniform(-1, 1), position=place)
        z += c + 1e-4
    return ()


def by_parts(scene: carom.Scene, rng) -> tuple:
    """Drop a body of two materials."""
    bounds = rng.uniform(0.0, 1.0, 3)
    for part in (*scene.half_spaces, *scene.statics):
        scene.replace(part.name, material=carom.Material(rng.uniform(0.0, 0.9), bounds[2]))
    parts = [
        carom.Part(
            carom.Box(*rng.uniform(0.06, 0.1, 3)), (x, 0, 0), material=carom.Material(0.3, mu)
        )
        for x, mu in zip((-0.05, 0.05), bounds[:2])
    ]
    scene.add_body(
        carom.Compound(parts), mass=10.0 ** rng.uniform(-1, 1), position=(0, 0, rng.uniform(0.12, 0.4)),
        orientation=draw.attitude(rng, 0.5), velocity=rng.normal(size=3),
        angular_velocity=2.0 * rng.normal(size=3),
    )  # fmt: skip
    return tuple(bounds)


def on_rail(scene: carom.Scene, rng) -> tuple:
    """Let a ball run along a closed curve, with friction, and throw a body to it."""
    angles = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
    around = np.c_[0.5 * np.cos(angles), 0.4 * np.sin(angles), rng.uniform(0.2, 0.4, 8)]
    curve = carom.curves.Spline(around, closed=True)
    start = rng.uniform(0.0, curve.length)
    bead = scene.add_body(
        carom.Sphere(0.05), mass=1.0, position=curve.point(start),
        velocity=2.0 * rng.normal() * curve.tangent(start),
    )  # fmt: skip
    rail = scene.add_joint(
        carom.joints.PointOnCurve(curve, anchor=bead.position), carom.GROUND, bead
    )
    scene.add_force(carom.forces.JointFriction(rail, frictions.friction(rng)))
    scene.add_body(
        draw.shape(rng.choice(draw.SHAPES), 0.1, rng), mass=10.0 ** rng.uniform(-1, 1),
        position=(0, 0, 0.25), velocity=rng.normal(size=3), angular_velocity=5.0 * rng.normal(size=3),
    )  # fmt: skip
    return ()


#: what bodies meet, each ``(scene, speed, rng)``; all are level with z = 0
GROUNDS = {
    "floor": floor, "corner": corner, "stopping belt": stopping,
    **{kind: partial(belt, kind) for kind in belts.KINDS},
}  # fmt: skip
#: what moves, each ``(scene, rng)``; it returns the coefficients of materials of its own
BODIES = {"thrown": thrown, "laid": laid, "piled": piled, "parts": by_parts, "rail": on_rail}


def beyond_cone(s: carom.Solution, bound: float, law: float | FrictionLaw | None) -> float:
    """Return how far forces of persistent contact are beyond their cone, by what is allowed.

    The greatest coefficient bounds all. If one law is in force and no time-stepping step has the slip of its
    start, what sticks has the static coefficient, and what slips that of its own slip.
    """
    forces = s.forces
    normal, rubbing = forces.force[:, 0], np.hypot(forces.force[:, 1], forces.force[:, 2])
    if not len(normal):
        return 0.0
    excess = np.maximum(rubbing - bound * normal, -normal)
    allowed = CONE * (normal + np.max(normal))
    if law is not None and not s.stats.get("whole_steps", 0):
        speed = slip(s)
        slipping = (forces.mode == "slipping") & (speed > SLOW * np.max(np.abs(s.velocity)))
        mu = law(np.nan_to_num(speed)) if isinstance(law, FrictionLaw) else law
        excess = np.maximum(excess, np.where(slipping, np.abs(rubbing - mu * normal), 0.0))
        held = forces.mode == "sticking"
        excess = np.maximum(excess, np.where(held, rubbing - bound_of(law) * normal, -np.inf))
    return float(np.max(excess / np.where(allowed > 0.0, allowed, 1.0)))


def slip(s: carom.Solution) -> np.ndarray:
    """Return the speed of slip (M,) of the points with forces; NaN where they are not on a half-space."""
    forces = s.forces
    made = np.full(len(forces), np.nan)
    for k, (row, contact, body) in enumerate(zip(forces.saved, forces.contact, forces.body)):
        part, place = s.scene.fixed[s.pairs.plane[contact]], forces.point[k]
        if not isinstance(part, HalfSpace):
            continue
        spin = s.angular_velocity[row, body]
        u = s.velocity[row, body] + np.cross(spin, place - s.position[row, body])
        if part.moves:
            velocity, spin = field_at(part, s.t[row])[:2]
            u = u - velocity - np.cross(spin, place)
        made[k] = np.linalg.norm(u - (u @ part.normal) * part.normal)
    return made
