"""The two examples of the paper as scenes, and their runs (each computed once)."""

from __future__ import annotations

from functools import cache

import numpy as np

import carom

GRAVITY = 9.81  # [m/s^2]
DROP = 0.4  # gap of the sphere at the start [m]
SPHERE_DELTA = 0.8  # penetration ratio of the first example
EDGE, MASS = 0.02, 0.016  # the die [m], [kg]
DIE_E, DIE_DELTA = 0.5, 0.2
FRICTIONS = (0.05, 0.20)
SPINS = {"planar": (0.0, 10.0, 0.0), "spatial": (10.0, 10.0, 0.0)}
STEP = 1e-3  # [s]


def sphere(restitution: float) -> carom.Scene:
    """Section 4.1: a sphere dropped from 0.4 m."""
    scene = carom.Scene(gravity=(0, 0, -GRAVITY))
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    ball = scene.add_body(
        shape=carom.Sphere(0.1), mass=1.0, position=(0, 0, DROP + 0.1), name="ball"
    )
    scene.add_contact(ball, ground, restitution=restitution, friction=0.0)
    return scene


def die(
    height: float = 0.3, velocity=(0.5, 0, -0.5), spin=SPINS["planar"], *, friction=0.2,
    restitution=DIE_E, inertia=None, gravity=GRAVITY, law="newton",
) -> carom.Scene:  # fmt: skip
    """Section 4.2: a die, thrown above a table."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    cube = scene.add_body(
        carom.Box(EDGE, EDGE, EDGE), mass=MASS, inertia=inertia, position=(0, 0, height),
        velocity=velocity, angular_velocity=spin, name="die",
    )  # fmt: skip
    scene.add_contact(cube, ground, restitution=restitution, friction=friction, impact_law=law)
    return scene


@cache
def sphere_run(restitution: float, method: str = "paper", duration: float = 3.0) -> carom.Solution:
    """Run the sphere."""
    options = carom.Options(penetration=SPHERE_DELTA)
    scene = sphere(restitution)
    return carom.simulate(scene, duration, step=STEP, method=method, options=options)


@cache
def die_run(
    friction: float, kind: str, method: str = "paper", duration: float = 0.45, layer_steps: int = 2
) -> carom.Solution:
    """Run the die, for 0.45 s by default: before it comes to rest on several corners at once."""
    options = carom.Options(penetration=DIE_DELTA, layer_steps=layer_steps)
    scene = die(spin=SPINS[kind], friction=friction)
    return carom.simulate(scene, duration, step=STEP, method=method, options=options)


def with_jumps(solution: carom.Solution, end: float | None = None):
    """Return t, position, attitude, velocity, angular velocity of body 0, with jumps at impacts."""
    end = solution.t[-1] if end is None else end
    impacts = solution.impacts.time[solution.impacts.time < end]
    saved = solution.t[solution.t <= end]
    saved = saved[~np.isin(saved, impacts)]
    smooth, before = solution.evaluate(saved), solution.evaluate(impacts, side="left")
    after = solution.evaluate(impacts, side="right")
    t = np.concatenate([saved, impacts, impacts])
    order = np.lexsort((np.repeat((0, 1, 2), (len(saved), len(impacts), len(impacts))), t))
    columns = (np.concatenate(parts)[order, 0] for parts in zip(smooth, before, after))
    return t[order], *columns


def after_first_impact(run: carom.Solution) -> np.ndarray:
    """Return (v, w) (6,) of body 0 after its first impact."""
    _, _, v, w = run.evaluate(run.impacts.time[0])
    return np.concatenate([v[0], w[0]])
