"""Stand-ins for a scene: the attributes that the baselines read, and nothing else."""

from types import SimpleNamespace

import numpy as np

SIGNS = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], dtype=float)


def _scene(shape, mass, inertia, restitution, friction, state):
    body = SimpleNamespace(shape=shape, mass=mass, inertia=np.array(inertia, float), **state)
    ground = SimpleNamespace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
    contact = SimpleNamespace(
        body=body, half_space=ground, restitution=restitution, friction=friction
    )
    return SimpleNamespace(bodies=[body], contacts=[contact], gravity=(0.0, 0.0, -9.81))


def sphere(restitution, *, radius=0.1, drop=0.4, friction=0.0, velocity=(0, 0, 0), spin=(0, 0, 0)):
    state = dict(
        position=(0.0, 0.0, radius + drop), orientation=(1.0, 0.0, 0.0, 0.0),
        velocity=velocity, angular_velocity=spin,
    )  # fmt: skip
    shape = SimpleNamespace(radius=radius, vertices=np.zeros((0, 3)))
    return _scene(shape, 1.0, 0.4 * radius**2 * np.eye(3), restitution, friction, state)


def die(friction, *, restitution=0.5, spin=(0.0, 10.0, 0.0), edge=0.02, mass=0.016):
    """The paper's die: planar motion for the spin about y."""
    state = dict(
        position=(0.0, 0.0, 0.3), orientation=(1.0, 0.0, 0.0, 0.0),
        velocity=(0.5, 0.0, -0.5), angular_velocity=spin,
    )  # fmt: skip
    shape = SimpleNamespace(vertices=0.5 * edge * SIGNS)
    return _scene(shape, mass, mass * edge**2 / 6.0 * np.eye(3), restitution, friction, state)
