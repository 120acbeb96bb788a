"""Scenes whose values are varied; importable by worker processes."""

import carom


def die(friction=0.2):
    scene = carom.Scene(gravity=(0, 0, -9.81))
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    body = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.1), velocity=(0.5, 0, -0.5),
        angular_velocity=(0, 10, 0), name="die",
    )  # fmt: skip
    scene.add_contact(body, ground, restitution=0.5, friction=friction)
    return scene


def pendulum(friction=0.0):
    """Two rods with a ball that strikes a wall; friction in the first hinge [N m]."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    wall = scene.add_half_space(point=(-0.1, 0, 0), normal=(1, 0, 0), name="wall")
    first = scene.add_body(
        mass=1.0, inertia=(1e-3, 0.02, 0.02), position=(0.25, 0, 0), name="first"
    )
    second = scene.add_body(
        carom.Sphere(0.05),
        mass=1.0,
        inertia=(1e-3, 0.02, 0.02),
        position=(0.75, 0, 0),
        name="second",
    )
    hinge = carom.joints.Revolute((0, 0, 0), (0, 1, 0))
    upper = scene.add_joint(hinge, carom.GROUND, first)
    scene.add_joint(carom.joints.Revolute((0.5, 0, 0), (0, 1, 0)), first, second)
    if friction > 0.0:
        scene.add_force(carom.forces.JointFriction(upper, friction))
    scene.add_contact(second, wall, restitution=0.6, friction=0.1)
    return scene


def two_balls(gap=0.01, friction=0.3):
    """Two balls, one above the other, over a floor; as a function of values."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    low = scene.add_body(carom.Sphere(0.05), mass=1.0, position=(0, 0, 0.05 + gap), name="low")
    high = scene.add_body(
        carom.Sphere(0.05), mass=0.5, position=(0.01, 0, 0.16 + 2 * gap), name="high"
    )
    for ball in (low, high):
        scene.add_contact(ball, floor, restitution=0.5, friction=friction)
    scene.add_contact(high, low, restitution=0.5, friction=friction)
    return scene
