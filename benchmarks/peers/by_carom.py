"""carom: settings are `rtol`, all else its defaults; the time is that of `carom.simulate`, checks included."""

import time

import numba
import numpy as np
import problems as p

import carom
from carom import forces


def timed(scene, duration, rtol):
    """Return the run and its processor time."""
    begin = time.process_time()
    run = carom.simulate(scene, duration, rtol=rtol, save_at=duration, throw=False)
    return run, time.process_time() - begin


def ball(z, velocity=(0, 0, 0), gravity=p.G, mu=0.0, e=0.0):
    """Return a scene of a ball on a floor."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    scene.add_body(carom.Sphere(p.RADIUS), mass=1.0, position=(0, 0, z), velocity=velocity)
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.set_contact_default(friction=mu, restitution=e)
    return scene


def rolling(rtol):
    run, took = timed(ball(p.RADIUS, (p.SPEED, 0, 0), mu=p.MU), p.ROLLS, rtol)
    return run.position[-1, 0, 0], took


def fall(rtol):
    scene = carom.Scene(gravity=(0, 0, -p.G))
    scene.add_body(carom.Box(*2 * p.HALF), mass=1.0, angular_velocity=p.SPIN)
    run, took = timed(scene, p.FALLS, rtol)
    return p.marked(run.position[-1, 0], p.matrix(*run.orientation[-1, 0])), took


def stops(rtol):
    scene = ball(p.CEILING / 2, (0, 0, -p.THROWN), gravity=0, e=p.KEEPS)
    scene.add_half_space((0, 0, p.CEILING), (0, 0, -1))
    run, took = timed(scene, p.STOPS, rtol)
    return run.position[-1, 0, 2], took


def stick_slip(rtol):
    scene = carom.Scene(gravity=(0, 0, -p.G))
    z = p.BLOCK[2]
    block = scene.add_body(carom.Box(*2 * p.BLOCK), mass=1.0, position=(p.DRAWN, 0, z))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.set_contact_default(friction=p.MU, restitution=0)
    scene.add_force(forces.Spring(p.SPRING, (-10, 0, z), (p.DRAWN, 0, z), rest_length=10.0), block)
    run, took = timed(scene, p.SLIDES, rtol)
    return run.position[-1, 0, 0], took


def bounce(rtol, e):
    run, took = timed(ball(p.RADIUS + p.DROP, e=e), p.BOUNCES[e], rtol)
    return run.position[-1, 0, 2], took


@numba.njit
def pull(t, states):
    """Return the forces on the stars."""
    wrench = np.zeros((7, 6))
    for i in range(7):
        for j in range(i):
            d = states[j, :3] - states[i, :3]
            f = (i + 1) * (j + 1) / (d @ d) ** 1.5 * d
            wrench[i, :3] += f
            wrench[j, :3] -= f
    return wrench


def pleiades(rtol):
    scene = carom.Scene(gravity=(0, 0, 0))
    stars = [
        scene.add_body(carom.Sphere(0.01), mass=k + 1.0, position=(*x, 0), velocity=(*v, 0))
        for k, (x, v) in enumerate(zip(p.STARS, p.FLY, strict=True))
    ]
    for k, star in enumerate(stars):
        for other in stars[:k]:
            scene.ignore_contact(star, other)
    scene.add_force(forces.UserForce(stars, pull))
    run, took = timed(scene, p.YEARS, rtol)
    return run.position[-1, :, :2], took


SOLVE = {
    "rolling": rolling, "free fall": fall, "stops": stops, "stick-slip": stick_slip,
    "bounce e=0.5": lambda rtol: bounce(rtol, 0.5), "bounce e=1": lambda rtol: bounce(rtol, 1.0),
    "Pleiades": pleiades,
}  # fmt: skip

if __name__ == "__main__":
    settings = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10)
    p.main(carom.__version__, [p.Variant("default", True, settings, SOLVE, {})])
