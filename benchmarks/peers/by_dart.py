"""DART (dartpy): steps with impulses of a boxed LCP; restitution and friction are coefficients."""

import importlib.metadata

import dartpy as d
import numpy as np
import problems as p

BODY = d.dynamics


def world(dt, gravity=p.G):
    """Return a world."""
    w = d.simulation.World()
    w.setGravity([0, 0, -gravity])
    w.setTimeStep(dt)
    w.getConstraintSolver().setCollisionDetector(d.collision.DARTCollisionDetector())
    return w


def rough(node, mu, e):
    """Let a shape touch."""
    node.createCollisionAspect()
    aspect = node.createDynamicsAspect()
    aspect.setFrictionCoeff(mu)
    aspect.setRestitutionCoeff(e)


def floor(w, mu, z=-1.0):
    """Add a thick floor whose centre is at z."""
    s = BODY.Skeleton(f"floor{z}")
    _, body = s.createWeldJointAndBodyNodePair()
    node = body.createShapeNode(BODY.BoxShape([100, 100, 2]))
    node.setRelativeTranslation([0, 0, z])
    rough(node, mu, 1.0)
    w.addSkeleton(s)


def add(w, shape, inertia, position, velocity=(0, 0, 0), spin=(0, 0, 0), mu=0.0, e=0.0, mass=1.0):
    """Return a free body. Its coordinates are its velocity in its own axes."""
    s = BODY.Skeleton(f"body{w.getNumSkeletons()}")
    joint, body = s.createFreeJointAndBodyNodePair()
    if shape is not None:
        rough(body.createShapeNode(shape), mu, e)
    body.setInertia(BODY.Inertia(mass, np.zeros(3), np.diag(inertia)))
    w.addSkeleton(s)
    place = d.math.Isometry3()
    place.set_translation(np.asarray(position, float))
    joint.setPositions(BODY.FreeJoint.convertToPositions(place))
    joint.setVelocities(np.concatenate([spin, velocity]).astype(float))
    return body


def ball(w, z, velocity, mu=0.0, e=0.0):
    """Return a ball."""
    return add(w, BODY.SphereShape(p.RADIUS), [0.004] * 3, (0, 0, z), velocity, mu=mu, e=e)


def at(body):
    """Return the place of a body."""
    return np.array(body.getTransform().translation())


def rolling(dt):
    w = world(dt)
    floor(w, p.MU)
    body = ball(w, p.RADIUS, (p.SPEED, 0, 0), p.MU)
    took = p.stepped(w.step, dt, p.ROLLS)
    return at(body)[0], took


def fall(dt):
    w = world(dt)
    body = add(w, None, p.inertia(p.HALF), (0, 0, 0), spin=p.SPIN)
    took = p.stepped(w.step, dt, p.FALLS)
    return p.marked(at(body), np.array(body.getTransform().rotation())), took


def stops(dt):
    w = world(dt, 0.0)
    floor(w, 0.0)
    floor(w, 0.0, p.CEILING + 1)
    body = ball(w, p.CEILING / 2, (0, 0, -p.THROWN), e=p.KEEPS)
    took = p.stepped(w.step, dt, p.STOPS)
    return at(body)[2], took


def stick_slip(dt):
    w = world(dt)
    floor(w, p.MU)
    shape = BODY.BoxShape(2 * p.BLOCK)
    body = add(w, shape, p.inertia(p.BLOCK), (p.DRAWN, 0, p.BLOCK[2]), mu=p.MU)

    def step():
        body.addExtForce([-p.SPRING * at(body)[0], 0, 0], [0, 0, 0], False, True)
        w.step()

    took = p.stepped(step, dt, p.SLIDES)
    return at(body)[0], took


def bounce(dt, e):
    w = world(dt)
    floor(w, 0.0)
    body = ball(w, p.RADIUS + p.DROP, (0, 0, 0), e=e)
    took = p.stepped(w.step, dt, p.BOUNCES[e])
    return at(body)[2], took


def pleiades(dt):
    w = world(dt, 0.0)
    stars = [
        add(w, None, [0.01] * 3, (*x, 0), (*v, 0), mass=k + 1.0)
        for k, (x, v) in enumerate(zip(p.STARS, p.FLY, strict=True))
    ]

    def step():
        force = p.pull(np.array([at(body)[:2] for body in stars]))
        for body, f in zip(stars, force, strict=True):
            body.addExtForce([f[0], f[1], 0], [0, 0, 0], False, True)
        w.step()

    took = p.stepped(step, dt, p.YEARS)
    return np.array([at(body)[:2] for body in stars]), took


SOLVE = p.table(rolling, fall, stops, stick_slip, bounce, pleiades)

if __name__ == "__main__":
    version = importlib.metadata.version("dartpy")
    p.main(version, [p.Variant("default", False, (1e-2, 1e-3, 1e-4), SOLVE, {})])
