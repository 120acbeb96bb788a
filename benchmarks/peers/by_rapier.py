"""rapier (single precision): restitution and friction are coefficients; settings are its defaults."""

import importlib.metadata

import numpy as np
import problems as p
import rapier3d as r

LOW = r.CoefficientCombineRule.MIN


def world(dt, gravity=p.G):
    """Return a world."""
    made = r.PhysicsWorld(gravity=(0, 0, -gravity))
    made.integration_parameters.dt = dt
    return made


def rough(shape, mu=0.0, e=0.0):
    """Return a shape with its coefficients."""
    shape = shape.friction(mu).restitution(e)
    return shape.friction_combine_rule(LOW).restitution_combine_rule(LOW)


def add(w, shape, position, velocity=(0, 0, 0), spin=(0, 0, 0), mu=0.0, e=0.0):
    """Return a body of 1 kg."""
    body = r.RigidBody.dynamic().translation(tuple(map(float, position)))
    body = body.linvel(tuple(map(float, velocity))).angvel(tuple(map(float, spin)))
    body = body.can_sleep(False).allow_fast_rotation(True).gyroscopic_forces(True)
    return w.rigid_bodies[w.add_body(body, [rough(shape, mu, e)] if shape else [])]


def floor(w, mu=0.0, e=0.0, ceiling=False):
    """Add a floor, and a ceiling."""
    w.add_body(r.RigidBody.fixed(), [rough(r.Collider.halfspace((0, 0, 1)), mu, e)])
    if ceiling:
        top = r.RigidBody.fixed().translation((0.0, 0.0, p.CEILING))
        w.add_body(top, [rough(r.Collider.halfspace((0, 0, -1)), mu, e)])


def ball():
    """Return the shape of a ball of 1 kg."""
    return r.Collider.ball(p.RADIUS).mass(1.0)


def at(body):
    """Return the place of a body."""
    t = body.translation
    return np.array([t.x, t.y, t.z])


def rolling(dt):
    w = world(dt)
    floor(w, p.MU)
    b = add(w, ball(), (0, 0, p.RADIUS), (p.SPEED, 0, 0), mu=p.MU)
    took = p.stepped(w.step, dt, p.ROLLS)
    return at(b)[0], took


def fall(dt):
    w = world(dt)
    b = add(w, r.Collider.cuboid(*map(float, p.HALF)).mass(1.0), (0, 0, 0), spin=p.SPIN)
    took = p.stepped(w.step, dt, p.FALLS)
    q = b.rotation
    return p.marked(at(b), p.matrix(q.w, q.i, q.j, q.k)), took


def stops(dt):
    w = world(dt, 0.0)
    floor(w, 0, p.KEEPS, ceiling=True)
    b = add(w, ball(), (0, 0, p.CEILING / 2), (0, 0, -p.THROWN), e=p.KEEPS)
    took = p.stepped(w.step, dt, p.STOPS)
    return at(b)[2], took


def stick_slip(dt):
    w = world(dt)
    floor(w, p.MU)
    b = add(w, r.Collider.cuboid(*map(float, p.BLOCK)).mass(1.0), (p.DRAWN, 0, p.BLOCK[2]), mu=p.MU)

    def step():
        b.reset_forces()
        b.add_force((-p.SPRING * b.translation.x, 0.0, 0.0), True)
        w.step()

    took = p.stepped(step, dt, p.SLIDES)
    return at(b)[0], took


def bounce(dt, e):
    w = world(dt)
    floor(w, 0, e)
    b = add(w, ball(), (0, 0, p.RADIUS + p.DROP), e=e)
    took = p.stepped(w.step, dt, p.BOUNCES[e])
    return at(b)[2], took


def pleiades(dt):
    w = world(dt, 0.0)
    stars = []
    for k, (x, v) in enumerate(zip(p.STARS, p.FLY, strict=True)):
        shape = r.Collider.ball(0.01).mass(k + 1.0)
        shape = shape.collision_groups(r.InteractionGroups(r.Group.GROUP_1, r.Group.GROUP_2))
        stars.append(add(w, shape, (*x, 0), (*v, 0)))

    def step():
        force = p.pull(np.array([at(b)[:2] for b in stars]))
        for b, f in zip(stars, force, strict=True):
            b.reset_forces()
            b.add_force((float(f[0]), float(f[1]), 0.0), True)
        w.step()

    took = p.stepped(step, dt, p.YEARS)
    return np.array([at(b)[:2] for b in stars]), took


SOLVE = p.table(rolling, fall, stops, stick_slip, bounce, pleiades)

if __name__ == "__main__":
    version = importlib.metadata.version("rapier3d")
    p.main(version, [p.Variant("default", False, (1e-2, 1e-3, 1e-4), SOLVE, {})])
