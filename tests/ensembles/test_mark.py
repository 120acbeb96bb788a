"""The mark of a saved ensemble: other for whatever makes other runs, the same in another process."""

import functools
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import carom
from carom.stepping.settings import checked_settings
from carom.studies.ensembles.mark import digest, mark_of
from carom.studies.ensembles.plan import plan_of

VALUES = {"die.position": np.zeros((2, 3))}


def times(factor):
    return lambda t: factor * t


@pytest.mark.plain
def test_the_mark_of_a_function_changes_with_its_code_and_its_numbers():
    table = np.arange(3.0)
    marks = [
        mark_of(f)
        for f in (
            lambda t: t, lambda t: 2 * t, times(2.0), times(3.0), lambda t: t * table[0],
            functools.partial(times, 2.0), functools.partial(times, 3.0), lambda t, a=2.0: t, np.sin,
        )
    ]  # fmt: skip
    assert len(set(marks)) == len(marks)
    assert mark_of(times(2.0)) == mark_of(times(2.0))
    before = mark_of(lambda t: t * table[0])
    table[0] = 5.0
    assert mark_of(lambda t: t * table[0]) != before


def pendulum(stiffness=3.0, friction=None, force=None):
    scene = carom.Scene(gravity=(0, 0, -9.81))
    bob = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.0), name="die")
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 1), (0, 1, 0)), carom.GROUND, bob)
    scene.add_force(carom.forces.JointSpring(hinge, stiffness))
    if friction is not None:
        scene.add_force(carom.forces.JointFriction(hinge, friction))
    if force is not None:
        scene.add_force(carom.forces.JointForce(hinge, force))
    return scene


def mark(scene):
    settings = checked_settings(0.1, 1e-3)
    return digest(plan_of(scene, settings, {}, {}, None)[0], VALUES)


@pytest.mark.plain
def test_the_mark_of_a_scene_changes_with_what_acts_along_joints():
    scenes = [
        pendulum(), pendulum(stiffness=3.1), pendulum(friction=0.1), pendulum(friction=0.2),
        pendulum(force=times(2.0)), pendulum(force=times(3.0)),
    ]  # fmt: skip
    assert len({mark(scene) for scene in scenes}) == len(scenes)
    assert mark(pendulum()) == mark(pendulum())
    assert mark(pendulum(force=times(2.0))) == mark(pendulum(force=times(2.0)))


def test_the_mark_is_the_same_in_another_process():
    code = (
        "from ensembles.test_mark import *; print(mark(pendulum(friction=0.1, force=times(2.0))))"
    )
    here = Path(__file__).parents[1]
    other = subprocess.run(
        [sys.executable, "-c", code], cwd=here, capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONHASHSEED": "7"},
    )  # fmt: skip
    assert other.stdout.strip() == mark(pendulum(friction=0.1, force=times(2.0)))
