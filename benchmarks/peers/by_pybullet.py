"""PyBullet: sequential impulses, with the settings that its maintainer gives for restitution (bullet3#3094).

Maximal coordinates, no warm start, split impulses, no slop, contactProcessingThreshold 0.
"""

import importlib.metadata

import numpy as np
import problems as p
import pybullet as b


def world(dt, gravity=p.G):
    """Start a world."""
    b.resetSimulation()
    b.setGravity(0, 0, -gravity)
    b.setPhysicsEngineParameter(
        fixedTimeStep=dt, numSubSteps=0, numSolverIterations=50, restitutionVelocityThreshold=0.0,
        warmStartingFactor=0, useSplitImpulse=True, contactSlop=0, enableConeFriction=False,
        deterministicOverlappingPairs=1,
    )  # fmt: skip


def plane(mu, z=0.0, q=(0, 0, 0, 1)):
    """Add a plane."""
    made = b.createMultiBody(
        0, b.createCollisionShape(b.GEOM_PLANE), -1, (0, 0, z), q, useMaximalCoordinates=True
    )
    b.changeDynamics(made, -1, restitution=1.0, lateralFriction=mu, contactProcessingThreshold=0)


def add(shape, position, velocity=(0, 0, 0), spin=(0, 0, 0), e=0.0, mass=1.0):
    """Return a body."""
    made = b.createMultiBody(mass, shape, -1, tuple(position), useMaximalCoordinates=True)
    b.changeDynamics(
        made, -1, restitution=e, lateralFriction=1.0, linearDamping=0, angularDamping=0, spinningFriction=0,
        rollingFriction=0, contactProcessingThreshold=0,
    )  # fmt: skip
    b.resetBaseVelocity(made, tuple(velocity), tuple(spin))
    return made


def ball():
    """Return the shape of a ball."""
    return b.createCollisionShape(b.GEOM_SPHERE, radius=p.RADIUS)


def box(half):
    """Return the shape of a box."""
    return b.createCollisionShape(b.GEOM_BOX, halfExtents=list(half))


def at(body):
    """Return the place of a body."""
    return np.array(b.getBasePositionAndOrientation(body)[0])


def rolling(dt):
    world(dt)
    plane(p.MU)
    body = add(ball(), (0, 0, p.RADIUS), (p.SPEED, 0, 0))
    took = p.stepped(b.stepSimulation, dt, p.ROLLS)
    return at(body)[0], took


def fall(dt):
    world(dt)
    body = add(box(p.HALF), (0, 0, 0), spin=p.SPIN)
    took = p.stepped(b.stepSimulation, dt, p.FALLS)
    place, (x, y, z, w) = b.getBasePositionAndOrientation(body)
    return p.marked(place, p.matrix(w, x, y, z)), took


def stops(dt):
    world(dt, 0.0)
    plane(0.0)
    plane(0.0, p.CEILING, (1, 0, 0, 0))
    body = add(ball(), (0, 0, p.CEILING / 2), (0, 0, -p.THROWN), e=p.KEEPS)
    took = p.stepped(b.stepSimulation, dt, p.STOPS)
    return at(body)[2], took


def stick_slip(dt):
    world(dt)
    plane(p.MU)
    body = add(box(p.BLOCK), (p.DRAWN, 0, p.BLOCK[2]))

    def step():
        x = at(body)
        b.applyExternalForce(body, -1, (-p.SPRING * x[0], 0, 0), tuple(x), b.WORLD_FRAME)
        b.stepSimulation()

    took = p.stepped(step, dt, p.SLIDES)
    return at(body)[0], took


def bounce(dt, e):
    world(dt)
    plane(0.0)
    body = add(ball(), (0, 0, p.RADIUS + p.DROP), e=e)
    took = p.stepped(b.stepSimulation, dt, p.BOUNCES[e])
    return at(body)[2], took


def pleiades(dt):
    world(dt, 0.0)
    stars = []
    for k, (x, v) in enumerate(zip(p.STARS, p.FLY, strict=True)):
        shape = b.createCollisionShape(b.GEOM_SPHERE, radius=0.01)
        stars.append(add(shape, (*x, 0), (*v, 0), mass=k + 1.0))
        b.setCollisionFilterGroupMask(stars[-1], -1, 0, 0)

    def step():
        x = np.array([at(body) for body in stars])
        for body, f, place in zip(stars, p.pull(x[:, :2]), x, strict=True):
            b.applyExternalForce(body, -1, (f[0], f[1], 0), tuple(place), b.WORLD_FRAME)
        b.stepSimulation()

    took = p.stepped(step, dt, p.YEARS)
    return np.array([at(body)[:2] for body in stars]), took


SOLVE = p.table(rolling, fall, stops, stick_slip, bounce, pleiades)

if __name__ == "__main__":
    b.connect(b.DIRECT)
    version = importlib.metadata.version("pybullet")
    p.main(version, [p.Variant("default", False, (1e-2, 1e-3, 1e-4), SOLVE, {})])
