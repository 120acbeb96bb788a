"""What rolls, whatever the scene (hypothesis): energy, no slip, frames, order of bodies, idle reactions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import carom
from carom import GROUND, joints
from carom.geometry import quaternion

FEW = settings(max_examples=8, deadline=None, suppress_health_check=list(HealthCheck))
SEEDS = st.integers(0, 10**6)
R = 0.3


def unit(e):
    return e / np.linalg.norm(e)


def scene_of(seed, kind, turn=(1.0, 0.0, 0.0, 0.0), swapped=False):
    """A ball or a disc that rolls on a plate, which swings about a point of the ground; drawn from `seed`."""
    rng = np.random.default_rng(seed)

    def world(a):
        return quaternion.rotate(np.array(turn), np.asarray(a, dtype=float))

    normal, arm = np.array([0.0, 0.0, 1.0]), rng.normal(size=3) * 0.3
    spin, own = rng.normal(size=3), 2.0 * rng.normal(size=3)
    axis = unit(np.array([*rng.normal(size=2), 0.3 * rng.normal()]))
    down = normal - (normal @ axis) * axis if kind == "disc" else normal
    centre = np.array([*0.2 * rng.normal(size=2), 0.0])
    rim = -R * down / np.linalg.norm(down)
    centre[2] = -rim @ normal  # the plate is in z = 0 at the start
    touch = centre + rim
    # the plate turns about `arm`; what rolls has the velocity of the plate where it touches
    speed = np.cross(spin, touch - arm) - np.cross(own, rim)
    plate = dict(mass=3.0, inertia=(0.5, 0.6, 0.9), position=world((0, 0, 0)), orientation=turn)
    plate.update(velocity=world(np.cross(spin, -arm)), angular_velocity=world(spin))
    wheel = dict(mass=1.0, inertia=(0.04, 0.04, 0.04), position=world(centre), orientation=turn)
    wheel.update(velocity=world(speed), angular_velocity=world(own))
    scene = carom.Scene(gravity=world((0.5, -0.3, -9.81)))
    first = scene.add_body(**(wheel if swapped else plate))
    second = scene.add_body(**(plate if swapped else wheel))
    a, b = (second, first) if swapped else (first, second)
    definition = (
        joints.RollingSphere(R, world(normal)) if kind == "ball"
        else joints.RollingDisc(R, world(axis), world(normal))
    )  # fmt: skip
    scene.add_joint(joints.Spherical(world(arm)), GROUND, a)
    scene.add_joint(definition, a, b)
    return scene


def run(*given, **more):
    return carom.simulate(scene_of(*given, **more), 0.1, step=1e-3)


@pytest.mark.parametrize("kind", ["ball", "disc"])
@FEW
@given(seed=SEEDS)
def test_energy_and_contact(kind, seed):
    s = run(seed, kind)
    scale = np.max(s.kinetic_energy) + 1.0
    assert np.max(np.abs(s.ledger.residual)) < 1e-8 * scale
    assert max(np.max(e) for e in s.constraint_errors) < 1e-11


@pytest.mark.parametrize("kind", ["ball", "disc"])
@FEW
@given(seed=SEEDS)
def test_frame_and_order_of_bodies_do_not_matter(kind, seed):
    turn = quaternion.exp(2.0 * unit(np.random.default_rng(seed + 1).normal(size=3)))
    here, there, swapped = (
        run(seed, kind),
        run(seed, kind, turn=turn),
        run(seed, kind, swapped=True),
    )
    size = np.max(np.abs(here.position)) + 1.0
    np.testing.assert_allclose(
        quaternion.rotate(turn, here.position), there.position, atol=1e-9 * size
    )
    np.testing.assert_allclose(here.position, swapped.position[:, ::-1], atol=1e-9 * size)


@pytest.mark.parametrize("kind", ["ball", "disc"])
@FEW
@given(seed=SEEDS)
def test_reactions_do_no_work(kind, seed):
    # the force at the point of contact on the wheel, its opposite on the plate there: no slip, no work
    s = run(seed, kind)
    force = s.joint_reactions[:, 1, :3]
    rolls = s.scene.joints[1].definition
    n = quaternion.rotate(s.orientation[:, 0], rolls.normal)
    if kind == "disc":
        a = quaternion.rotate(s.orientation[:, 1], rolls.axis)
        n = n - np.sum(n * a, axis=1, keepdims=True) * a
    rim = -R * n / np.linalg.norm(n, axis=1, keepdims=True)
    touch = s.position[:, 1] + rim
    v, w = s.velocity, s.angular_velocity
    slip = v[:, 1] + np.cross(w[:, 1], rim)
    slip -= v[:, 0] + np.cross(w[:, 0], touch - s.position[:, 0])
    assert np.max(np.abs(slip)) < 1e-11 * (1.0 + np.max(np.abs(v)))
    power = np.sum(force * slip, axis=1)
    assert np.max(np.abs(power)) < 1e-9 * (1.0 + np.max(np.abs(force)))
