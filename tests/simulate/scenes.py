"""Scenes of the tests of whole runs, and a few closed forms. SI units."""

import numpy as np

import carom

G = 9.81
LAWS = ("newton", "poisson", "stronge")


def on_plane(body, *, gravity=(0, 0, -G), point=(0, 0, 0), normal=(0, 0, 1), contact=None):
    """A scene of one body, given by the arguments of `add_body`, above one plane."""
    scene = carom.Scene(gravity=gravity)
    ground = scene.add_half_space(point, normal)
    part = scene.add_body(body.pop("shape"), **body)
    scene.add_contact(part, ground, **(contact or {"friction": 0.0}))
    return scene


def ball(e=0.8, mu=0.0, height=0.4, radius=0.1, law="newton", mass=1.0, **body):
    """A ball whose lowest point is at `height` over the plane z = 0."""
    return on_plane(
        {"shape": carom.Sphere(radius), "mass": mass, "position": (0, 0, height + radius), **body},
        contact={"restitution": e, "friction": mu, "impact_law": law},
    )


def die(spin=(0, 10, 0), mu=0.05, e=0.5, law="newton", **body):
    """The die of the paper: edge 20 mm, 16 g, thrown from 0.3 m."""
    start = {
        "shape": carom.Box(0.02, 0.02, 0.02),
        "mass": 0.016,
        "position": (0, 0, 0.3),
        "velocity": (0.5, 0, -0.5),
        "angular_velocity": spin,
    }
    contact = {"restitution": e, "friction": mu, "impact_law": law}
    return on_plane({**start, **body}, contact=contact)


def bounce_times(count, e, height=0.4):
    """Times of impacts of a ball dropped from rest: t_1 = sqrt(2h/g), then t_1 2 e^k later each."""
    first = np.sqrt(2 * height / G)
    return first + np.concatenate([[0.0], np.cumsum(2 * first * e ** np.arange(1.0, count))])


def zeno_time(e, height=0.4):
    """The time at which a ball dropped from rest has bounced infinitely often."""
    return np.sqrt(2 * height / G) * (1 + e) / (1 - e)


def total(a):
    """Energies at saved times, relative to the first."""
    return a.total_energy / a.total_energy[0]


def event_times(solution, kind):
    """Times of the events of one kind."""
    return solution.events.time[solution.events.kind == kind]


def turn(axis, angle):
    """Unit quaternion of a turn about an axis."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    return np.concatenate([[np.cos(angle / 2)], np.sin(angle / 2) * axis])


def matrix(q):
    """Rotation matrix of a unit quaternion."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def product(a, b):
    """Product of two quaternions."""
    return np.concatenate(
        [[a[0] * b[0] - a[1:] @ b[1:]], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])]
    )
