"""Drawing shapes, attitudes and contact laws at random."""

from __future__ import annotations

import numpy as np

import carom

LAWS = ("newton", "poisson", "stronge")
STEPS = (1e-3, 5e-3, 20e-3)
#: ten kinds of shapes
SHAPES = (
    "box", "rod", "plate", "sphere", "capsule", "cylinder", "coin", "ellipsoid", "convex", "compound",
)  # fmt: skip


def shape(kind: str, size: float, rng) -> carom.Sphere:
    """Return a shape of that kind; `size` is about half its largest extent [m]."""
    part = rng.uniform(0.3, 1.0, 3)
    if kind == "box":
        return carom.Box(*(2.0 * size * part))
    if kind == "rod":
        return carom.Box(2.0 * size, *(2.0 * size * rng.uniform(0.01, 0.1, 2)))
    if kind == "plate":
        return carom.Box(2.0 * size, 2.0 * size * part[0], 2.0 * size * rng.uniform(0.01, 0.05))
    if kind == "sphere":
        return carom.Sphere(size)
    if kind == "capsule":
        return carom.Capsule(size * 0.5 * part[0], size * 2.0 * part[1])
    if kind == "cylinder":
        return carom.Cylinder(size * part[0], 2.0 * size * part[1])
    if kind == "coin":
        return carom.Cylinder(size, 2.0 * size * rng.uniform(0.01, 0.1))
    if kind == "ellipsoid":
        return carom.Ellipsoid(*(size * rng.uniform(0.15, 1.0, 3)))
    if kind == "convex":
        points = rng.normal(size=(int(rng.integers(4, 13)), 3))
        return carom.Convex(
            size
            * points
            / np.linalg.norm(points, axis=1)[:, None]
            * rng.uniform(0.5, 1.0, (len(points), 1))
        )
    other = carom.Sphere(0.3 * size) if rng.random() < 0.5 else carom.Box(*(0.6 * size * part))
    return carom.Compound(
        [(carom.Box(*(size * part)), (0, 0, 0)), (other, size * rng.uniform(-0.6, 0.6, 3))]
    )


def attitude(rng, special: float = 0.15) -> np.ndarray:
    """Return a unit quaternion, uniform; sometimes no turn, or a quarter of one about an axis."""
    if rng.random() < special:
        q = np.array([(1, 0, 0, 0), (1, 1, 0, 0), (1, 0, 1, 0), (1, 0, 0, 1)])[rng.integers(4)]
        return q / np.linalg.norm(q)
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)


def thrown(scene: carom.Scene, shape, height: float, rng) -> carom.Body:
    """Add a body at this height, with velocities of its fall, and a spin that turns it up to ten times."""
    speed = np.sqrt(2.0 * 9.81 * height)
    return scene.add_body(
        shape, mass=10.0 ** rng.uniform(-3, 1), position=(0, 0, height), orientation=attitude(rng),
        velocity=speed * rng.normal(size=3) * (1, 1, 0.3),
        angular_velocity=rng.normal(size=3) * rng.uniform(0.0, 10.0) * speed / height,
    )  # fmt: skip


def contact(rng, law: str | None = None) -> dict:
    """Return restitution, friction and law: also the ends of their ranges."""
    e = (0.0, 1.0, rng.uniform(0.0, 1.0), rng.uniform(0.0, 1.0))[rng.integers(4)]
    mu = (0.0, rng.uniform(0.0, 0.5), rng.uniform(0.0, 1.5), rng.uniform(0.0, 1.5))[rng.integers(4)]
    return {"restitution": e, "friction": mu, "impact_law": law or LAWS[rng.integers(3)]}
