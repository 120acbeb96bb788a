"""Mechanisms of the tests, as scenes; and a few words to look at their motion."""

import numpy as np

import carom
from carom import GROUND, Scene, joints

G = 9.81


def about(axis, angle):
    """Return the quaternion of a turn by `angle` about a unit `axis`."""
    return np.array([np.cos(0.5 * angle), *(np.sin(0.5 * angle) * np.asarray(axis, float))])


def matrix(q):
    """Return the rotation matrix of a unit quaternion."""
    w, x, y, z = q
    hat = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2.0 * w * hat + 2.0 * hat @ hat


def pendulum(kind="Distance", flip=False):
    """Simple pendulum of length 1 m, released from (-1, 0) in the plane z = 0, gravity along -y.

    A point mass on a rod without mass, or a body on a hinge or ball joint whose centre is at half
    the way and whose inertia makes up for it: (J + m d^2)/(m d) = 1 for d = 1/2, J = 1/4. Its
    axis then points along the same angle.
    """
    scene = Scene(gravity=(0, -G, 0))
    far = 1.0 if kind == "Distance" else 0.5
    scene.add_body(mass=1.0, inertia=[0.25] * 3, position=(-far, 0, 0), name="bob")
    definition = {
        "Distance": joints.Distance((0, 0, 0), (-1, 0, 0)),
        "Revolute": joints.Revolute((0, 0, 0), (0, 0, -1 if flip else 1)),
        "Spherical": joints.Spherical((0, 0, 0)),
    }[kind]
    scene.add_joint(definition, GROUND, scene["bob"], name="pivot")
    return scene


def chain(count, *, axis=(0, 1, 0), angles=None, gravity=(0, 0, -G), order=None, flips=()):
    """Chain of uniform rods (1 m, 1 kg) with hinges along y, released along x or at `angles`.

    `order` is the order in which joints are added; those in `flips` name the child first.
    """
    scene = Scene(gravity=gravity)
    angles = np.zeros(count) if angles is None else angles
    at, bodies, anchors = np.zeros(3), [], []
    for k, angle in enumerate(angles):
        along = np.array([np.cos(angle), 0.0, -np.sin(angle)])
        anchors.append(at)
        bodies.append(
            scene.add_body(
                mass=1.0,
                inertia=[1e-3, 1 / 12, 1 / 12],
                position=at + 0.5 * along,
                orientation=about((0, 1, 0), angle),
                name=f"rod{k}",
            )
        )
        at = at + along
    for k in range(count) if order is None else order:
        pair = (GROUND if k == 0 else bodies[k - 1], bodies[k])
        if k in flips and k > 0:
            pair = pair[::-1]
        scene.add_joint(joints.Revolute(anchors[k], axis), *pair, name=f"hinge{k}")
    return scene


def four_bar(count=2, angle=0.0, speed=1.0):
    """Parallelogram chain (IFToMM A02): `count` + 1 upright bars, `count` bars across their tips.

    All bars 1 m, 1 kg, uniform; gravity along -y. The upright ones lean by `angle` towards +x, which
    grows at `speed` [rad/s]. Bars are "up0", "up1", ... and "across0", ...
    """
    scene = Scene(gravity=(0, -G, 0))
    rod = dict(mass=1.0, inertia=[1 / 12, 1e-3, 1 / 12])  # along its own y
    hinge, feet = np.array([0.0, 0.0, 1.0]), np.arange(count + 1.0)[:, None] * [1.0, 0.0, 0.0]
    along = np.array([np.sin(angle), np.cos(angle), 0.0])
    swing = speed * np.array([np.cos(angle), -np.sin(angle), 0.0])
    for k, foot in enumerate(feet):
        up = scene.add_body(
            position=foot + 0.5 * along, orientation=about(hinge, -angle), velocity=0.5 * swing,
            angular_velocity=-speed * hinge, name=f"up{k}", **rod,
        )  # fmt: skip
        scene.add_joint(joints.Revolute(foot, hinge), GROUND, up, name=f"foot{k}")
    for k in range(count):
        bar = scene.add_body(
            position=feet[k] + along + [0.5, 0, 0], orientation=about(hinge, -np.pi / 2),
            velocity=swing, name=f"across{k}", **rod,
        )  # fmt: skip
        for n in (k, k + 1):
            joint = joints.Revolute(feet[n] + along, hinge)
            scene.add_joint(joint, scene[f"up{n}"], bar, name=f"pin{k}{n}")
    return scene


def run(scene, duration, step, **more):
    """Simulate, saving the ends only."""
    more.setdefault("save_every", 10**9)
    return carom.simulate(scene, duration, step=step, **more)


def orders(errors):
    """Measured orders of errors at steps that are halved."""
    errors = np.asarray(errors)
    return np.log2(errors[:-1] / errors[1:])
