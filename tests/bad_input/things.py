"""Scenes, runs and files that the calls are made with."""

import functools
import types

import numpy as np

import carom
from carom import joints
from carom.studies import identify

W = np.diag([1.0, 3.5, 3.5])
TETRAHEDRON = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
XML = """<mujoco><worldbody><body name="hand" mocap="true"/>
<body pos="0 0 1"><joint name="j" type="hinge" axis="0 1 0"/>
<geom type="sphere" size="0.1" mass="1"/></body></worldbody>
<actuator><motor name="m" joint="j"/></actuator><sensor><jointpos name="q" joint="j"/></sensor>
<keyframe><key name="k" qpos="0.1"/></keyframe></mujoco>"""


def tetrahedron(folder):
    """The path of a file of a mesh in the format OFF."""
    rows = [" ".join(map(str, corner)) for corner in TETRAHEDRON]
    rows += [f"3 {a} {b} {c}" for a, b, c in FACES]
    path = folder / "solid.off"
    path.write_text("\n".join(["OFF", "4 4 6", *rows, ""]))
    return path


def parts():
    """A scene with two bodies, a plane and a hinge, and its parts by name."""
    scene = carom.Scene()
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5), name="ball")
    box = scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0, 0, 1.5), name="box")
    hinge = scene.add_joint(joints.Revolute((0, 0, 2), (0, 1, 0)), carom.GROUND, box, name="hinge")
    slide = scene.add_joint(joints.Prismatic((1, 0, 0)), carom.GROUND, ball, name="slide")
    return types.SimpleNamespace(**locals())


def thrown():
    """A ball above a plane, with a contact."""
    scene = carom.Scene()
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.15), name="ball")
    scene.add_contact(ball, floor, restitution=0.5, friction=0.1)
    return scene


def pushed():
    """A run of the ball with a force."""
    scene = thrown()
    scene.add_force(carom.forces.Force((0, 0, 1)), "ball", name="push")
    run = carom.Run(scene, step=0.01)
    run.advance()
    return run


def switched():
    """A run of the ball with a force that may be switched off."""
    scene = thrown()
    scene.add_force(carom.forces.Force((0, 0, 1)), "ball", name="push")
    scene.switch("push")
    run = carom.Run(scene, step=0.01)
    run.advance()
    return run


@functools.cache
def solution():
    return carom.simulate(thrown(), 0.15, step=0.01)


@functools.cache
def sensitivities():
    return carom.sensitivities(solution(), "ball.position")


@functools.cache
def layer():
    return carom.impact_layer(W, (-1.0, 1.0, 0.0), 0.1, 0.5, penetration=0.5, width=1e-6)


@functools.cache
def runs():
    vary = {"ball.velocity": np.zeros((2, 3))}
    return carom.ensemble(thrown(), 0.02, step=0.01, vary=vary, executor="serial")


@functools.cache
def model():
    return carom.load_model(XML)


@functools.cache
def swing():
    return carom.simulate(model().scene, 0.02, step=0.01)


@functools.cache
def driven():
    """A slider that is driven and pushed."""
    scene = carom.Scene()
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, velocity=(1.0, 0, 0), name="ball")
    slide = scene.add_joint(carom.joints.Prismatic((1, 0, 0)), carom.GROUND, ball)
    scene.add_constraint(carom.constraints.Driver(slide, rate=1.0), name="drive")
    scene.add_force(carom.forces.Force((0, 0, 1)), ball, name="push")
    return carom.simulate(scene, 0.02, step=0.01)


def oscillator():
    system = carom.GeneralizedSystem(
        lambda q: np.eye(1), [0.5], [0.0], potential=lambda q: 0.5 * float(q @ q)
    )
    system.add_contact(lambda q: q[0], restitution=0.5, name="wall")
    return system


@functools.cache
def one_oscillator():
    return oscillator()


@functools.cache
def oscillation():
    return carom.simulate(one_oscillator(), 0.02, step=0.01)


def recording():
    t = np.linspace(0.0, 0.04, 5)
    position = np.zeros((5, 3)) + [0, 0, 0.4] - np.outer(0.5 * 9.81 * t**2, [0, 0, 1])
    return identify.Recording(t, position, np.tile([1.0, 0, 0, 0], (5, 1)), name="throw")


def samples():
    made = recording()
    return dict(position=made.position[:, 0], orientation=made.orientation[:, 0])


def of_nothing(*given):
    return 0.0


def saved(folder):
    path = folder / "saved.nc"
    if not path.exists():
        solution().save(path)
    return path


def kept(folder):
    path = folder / "runs"
    if not path.exists():
        vary = {"ball.velocity": np.zeros((2, 3))}
        carom.ensemble(thrown(), 0.02, step=0.01, vary=vary, executor="serial", save=path)
    return path
