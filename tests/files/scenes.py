"""Scenes of the tests of files: one with every part that there is, and small ones to run."""

import numpy as np
from scipy.interpolate import CubicSpline

import carom
from carom import constraints, forces, joints

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
SKEW = np.array(
    [0.3, -0.7, 0.61]
)  # a direction whose unit vector changes when it is normalised again


def shapes():
    """One of each shape."""
    rng = np.random.default_rng(5)
    box = carom.Box(0.1, 0.2, 0.3, radius=0.02)
    turn = np.array([0.9, 0.1, -0.3, 0.2])
    turn /= np.linalg.norm(turn)
    dumbbell = carom.Compound(
        [(carom.Sphere(0.1), (0, 0, 0.2)), (box, (0.01, 0, -0.2), turn)], masses=(1, 2)
    )
    return [
        carom.Sphere(0.1), box, carom.Capsule(0.1, 0.3), carom.Cylinder(0.1, 0.2),
        carom.Disc(0.2, 0.1), carom.Ellipsoid(0.1, 0.2, 0.3), carom.Convex(rng.normal(size=(30, 3))),
        carom.Mesh(TETRAHEDRON, FACES), dumbbell, None,
    ]  # fmt: skip


def joint_definitions(at):
    """One of each joint, at a point."""
    across = np.cross(SKEW, (0, 0, 1))
    return [
        joints.Revolute(at, SKEW), joints.Spherical(at), joints.Fixed(), joints.Prismatic(SKEW),
        joints.Cylindrical(at, SKEW), joints.Screw(at, SKEW, 0.1),
        joints.Universal(at, SKEW, across), joints.Planar(SKEW), joints.PointOnLine(at, SKEW),
        joints.PointOnPlane(at, SKEW), joints.Distance(at, np.add(at, 1)),
        joints.KnifeEdge(at, (1, 0.2, 0)), joints.RollingSphere(0.1),
        joints.RollingDisc(0.1, SKEW),
    ]  # fmt: skip


def push(t, q, rate):
    """A force along a coordinate."""
    return -0.1 * rate


def pull(t, states):
    """Forces on one body."""
    return np.zeros((1, 6))


def everything():
    """A scene with every kind of part, not to be run."""
    scene = carom.Scene(gravity=(0.1, 0.2, -9.7))
    rubber = carom.Material(0.3, 0.7, rolling_friction=1e-3)
    ground = scene.add_half_space((0, 0, -2), SKEW, material=rubber, name="ground")
    bodies = []
    for k, shape in enumerate(shapes()):
        inertia = None if shape else np.array([[2, 0.3, 0], [0.3, 3, 0.1], [0, 0.1, 4.0]])
        orientation = np.array([0.9, 0.1 * k, -0.3, 0.2])
        bodies.append(
            scene.add_body(
                shape, mass=1.0 + k / 3, inertia=inertia, position=(5.0 * k, 0.1, 4),
                orientation=orientation / np.linalg.norm(orientation), velocity=SKEW * k,
                material=rubber,
            )
        )  # fmt: skip
    made = [
        scene.add_joint(definition, carom.GROUND, bodies[-1] if k < 12 else bodies[0])
        for k, definition in enumerate(joint_definitions((0.1, 0.2, 4.0)))
    ]
    frames = {"parent_frame": (SKEW, (1, 0, 0, 0)), "child_frame": ((0, 0, 1), (1, 0, 0, 0))}
    made.append(scene.add_joint(made[0].definition, bodies[1], bodies[2], **frames))
    for definition in (
        forces.Spring(3.0, (0, 0, 0), SKEW, damping=0.1), forces.Torque(SKEW, follow=True),
        forces.Force(SKEW, (0, 0, 1)), forces.Bushing((3, 4), axis=SKEW),
        forces.CurveSpring((0, 0, 0), SKEW, [[0.1, 0.2, 0.4], [0.0, 1.0, 1.5]]),
    ):  # fmt: skip
        scene.add_force(definition, bodies[3])
    scene.add_force(forces.JointSpring(made[0], 2.0, 0.1, 0.3))
    scene.add_force(forces.JointForce(made[0], push), name="motor")
    scene.add_force(forces.JointFriction(made[3], 0.2))
    scene.add_force(forces.JointInertia(made[3], 0.3))
    scene.add_force(forces.UserForce(bodies[4], pull), name="wind")
    scene.add_constraint(constraints.Gear(made[0], made[14], -1 / 3))
    scene.add_constraint(constraints.Coupling({made[3]: 0.1, (made[4], 1): 2.0}))
    scene.add_constraint(constraints.Driver(made[0], motion=CubicSpline([0, 1, 2], [0, 1, 0])))
    scene.add_stop(made[0], upper=0.7, restitution=0.3)
    scene.add_contact(bodies[0], ground, restitution=1 / 3, friction=0.1, name="own")
    scene.ignore_contact(bodies[1], ground)
    scene.set_contact_default(friction=0.3, combine={"friction": "geometric"})
    return scene


def pendulum(links=2):
    """A chain of rods that hangs from the ground and swings, with a spring and a stop at its first hinge."""
    scene, parent, hinges = carom.Scene(), carom.GROUND, []
    for k in range(links):
        rod = scene.add_body(
            carom.Box(0.5, 0.02, 0.03), mass=0.4, position=(0.5 * k + 0.25, 0, 0), name=f"rod{k}"
        )
        hinge = joints.Revolute((0.5 * k, 0, 0), (0, 1, 0))
        hinges.append(scene.add_joint(hinge, parent, rod, name=f"hinge{k}"))
        parent = rod
    scene.add_force(forces.JointSpring(hinges[0], 0.2, 0.01))
    scene.add_stop(hinges[0], upper=1.2, restitution=0.5, name="stop")
    return scene


def slider():
    """A block that is thrown onto a plane, slides and comes to rest: contact that stays."""
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    block = scene.add_body(
        carom.Box(0.2, 0.1, 0.05), mass=0.5, position=(0, 0, 0.03), velocity=(1, 0.2, 0),
        name="block",
    )  # fmt: skip
    scene.add_contact(block, ground, restitution=0.2, friction=0.3)
    return scene


def pile(count=10):
    """Balls that fall into a corner on each other: a heap."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_half_space((0, 0, 0), (1, 0, 0))
    scene.add_half_space((0, 0, 0), (0, 1, 0))
    rng = np.random.default_rng(3)
    for k in range(count):
        place = (0.12 + 0.05 * rng.random(), 0.12 + 0.05 * rng.random(), 0.11 + 0.21 * k)
        scene.add_body(carom.Sphere(0.1), mass=1.0, position=place)
    scene.set_contact_default(restitution=0.1, friction=0.4)
    return scene
