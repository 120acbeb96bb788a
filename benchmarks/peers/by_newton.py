"""Newton (single precision, on its CPU device; it is made for a GPU): XPBD, with restitution as an option."""

import time

import newton
import numpy as np
import problems as p
import warp as wp

wp.config.quiet = True


def shape(mu, e):
    """Return the coefficients of a shape."""
    return newton.ModelBuilder.ShapeConfig(
        density=0.0, mu=mu, restitution=e, mu_torsional=0.0, mu_rolling=0.0, margin=0.0, gap=2e-3
    )


class World:
    """A model that is being built, and then run."""

    def __init__(self, gravity=p.G):
        self.made = newton.ModelBuilder(up_axis=newton.Axis.Z, gravity=(0.0, 0.0, -gravity))
        self.starts = []

    def add(self, position, inertia, velocity=(0, 0, 0), spin=(0, 0, 0), mass=1.0):
        """Return the number of a body."""
        self.starts.append([*velocity, *spin])
        return self.made.add_body(
            xform=wp.transform(tuple(map(float, position)), wp.quat_identity()), mass=mass,
            inertia=wp.mat33(*np.diag(inertia).ravel()), lock_inertia=True,
        )  # fmt: skip

    def run(self, dt, duration, force=None):
        """Return the poses (n, 7) at the end, and processor time."""
        model = self.made.finalize()
        model.joint_qd.assign(np.array(self.starts, np.float32).ravel())
        solver = newton.solvers.SolverXPBD(
            model, iterations=10, enable_restitution=True, rigid_contact_restitution_iterations=2
        )
        now, then, control = model.state(), model.state(), model.control()
        newton.eval_fk(model, model.joint_q, model.joint_qd, now)
        touching = newton.CollisionPipeline(model) if model.shape_count else None
        contacts = touching.contacts() if touching else None
        begin = time.process_time()
        for _ in range(round(duration / dt)):
            now.clear_forces()
            if force is not None:
                now.body_f.assign(force(now.body_q.numpy()))
            if touching:
                touching.collide(now, contacts)
            solver.step(now, then, control, contacts, dt)
            now, then = then, now
        return now.body_q.numpy().astype(float), time.process_time() - begin


def floor(w, mu=0.0, e=0.0, ceiling=False):
    """Add a floor, and a ceiling."""
    w.made.add_ground_plane(cfg=shape(mu, e))
    if ceiling:
        above = wp.transform((0.0, 0.0, p.CEILING + 1.0), wp.quat_identity())
        w.made.add_shape_box(-1, xform=above, hx=5.0, hy=5.0, hz=1.0, cfg=shape(mu, e))


def ball(w, z, velocity, mu=0.0, e=0.0):
    """Add a ball."""
    body = w.add((0, 0, z), [0.004] * 3, velocity)
    w.made.add_shape_sphere(body, radius=p.RADIUS, cfg=shape(mu, e))


def rolling(dt):
    w = World()
    floor(w, p.MU)
    ball(w, p.RADIUS, (p.SPEED, 0, 0), p.MU)
    q, took = w.run(dt, p.ROLLS)
    return q[0, 0], took


def fall(dt):
    w = World()
    w.add((0, 0, 0), p.inertia(p.HALF), spin=p.SPIN)
    q, took = w.run(dt, p.FALLS)
    return p.marked(q[0, :3], p.matrix(q[0, 6], *q[0, 3:6])), took


def stops(dt):
    w = World(0.0)
    floor(w, 0.0, p.KEEPS, ceiling=True)
    ball(w, p.CEILING / 2, (0, 0, -p.THROWN), e=p.KEEPS)
    q, took = w.run(dt, p.STOPS)
    return q[0, 2], took


def stick_slip(dt):
    w = World()
    floor(w, p.MU)
    body = w.add((p.DRAWN, 0, p.BLOCK[2]), p.inertia(p.BLOCK))
    hx, hy, hz = map(float, p.BLOCK)
    w.made.add_shape_box(body, hx=hx, hy=hy, hz=hz, cfg=shape(p.MU, 0.0))

    def force(q):
        return np.array([[-p.SPRING * q[0, 0], 0, 0, 0, 0, 0]], np.float32)

    q, took = w.run(dt, p.SLIDES, force)
    return q[0, 0], took


def bounce(dt, e):
    w = World()
    floor(w, 0.0, e)
    ball(w, p.RADIUS + p.DROP, (0, 0, 0), e=e)
    q, took = w.run(dt, p.BOUNCES[e])
    return q[0, 2], took


def pleiades(dt):
    w = World(0.0)
    for k, (x, v) in enumerate(zip(p.STARS, p.FLY, strict=True)):
        w.add((*x, 0), [0.01] * 3, (*v, 0), mass=k + 1.0)

    def force(q):
        f = np.zeros((7, 6), np.float32)
        f[:, :2] = p.pull(q[:, :2].astype(float))
        return f

    q, took = w.run(dt, p.YEARS, force)
    return q[:, :2], took


SOLVE = {
    "rolling": rolling, "free fall": fall, "stops": stops, "stick-slip": stick_slip,
    "bounce e=0.5": lambda dt: bounce(dt, 0.5), "bounce e=1": lambda dt: bounce(dt, 1.0), "Pleiades": pleiades,
}  # fmt: skip

if __name__ == "__main__":
    p.main(newton.__version__, [p.Variant("XPBD", False, (1e-2, 1e-3), SOLVE, {})])
