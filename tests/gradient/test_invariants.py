"""What derivatives keep because the motion has a symmetry, or keeps a quantity."""

import numpy as np
import pytest

import carom
from carom.geometry import quaternion

from .thrown import UNEQUAL, throw

STATE = ("die.position", "die.orientation", "die.velocity", "die.angular_velocity")


def tangents(found):
    return np.concatenate([a[0] for a in found.final])


def momentum(run, k, X):
    """Return (m dv, dL) at saved time k, and L: R J R^T w with R of the scene's body axes."""
    R = quaternion.matrix(run.orientation[k, 0])
    I, w = R @ UNEQUAL @ R.T, run.angular_velocity[k, 0]
    L, turn = I @ w, X[3:6]
    dL = I @ X[9:] + np.cross(turn.T, L).T - I @ np.cross(turn.T, w).T
    return 0.016 * X[6:9], dL, L


def form(run, k, X):
    """Return the symplectic form of all pairs of tangents, with right-trivialised attitudes."""
    dp, dL, L = momentum(run, k, X)
    half = X[:3].T @ dp + X[3:6].T @ dL
    turn = X[3:6]
    return (
        half - half.T - np.einsum("k,kab->ab", L, np.cross(turn[:, :, None], turn[:, None], axis=0))
    )


@pytest.mark.parametrize("duration", [0.08, 0.2])
def test_motion_without_losses_is_symplectic(duration):
    # with e = 1 and mu = 0 flight and impacts are canonical maps, the times of the impacts included
    run = throw(inertia=UNEQUAL, mu=0.0, e=1.0, duration=duration)
    X = tangents(carom.sensitivities(run, STATE))
    assert len(run.impacts) == (0 if duration < 0.09 else 2)
    start, end = form(run, 0, np.eye(12)), form(run, -1, X)
    # entries of the form are of the order of those of X times m and J: 1e-10 of their products
    p, L = (np.linalg.norm(a) for a in momentum(run, -1, X)[:2])
    scale = np.linalg.norm(X[:3]) * p + np.linalg.norm(X[3:6]) * L
    np.testing.assert_allclose(end, start, rtol=0, atol=1e-9 * scale)
    assert np.linalg.norm(start) > 1e-4 * scale


def test_energy_of_elastic_motion_is_kept_by_all_neighbours():
    run = throw(inertia=UNEQUAL, mu=0.0, e=1.0)
    X = tangents(carom.sensitivities(run, STATE))

    def slope(k, X):
        dp, dL, L = momentum(run, k, X)
        R = quaternion.matrix(run.orientation[k, 0])
        w = run.angular_velocity[k, 0]
        # dE = v . m dv + w . (dL - dtheta x L) + m g dz
        return (
            run.velocity[k, 0] @ dp
            + w @ (dL - np.cross(X[3:6].T, L).T)
            + 0.016 * 9.81 * X[2]
            + 0 * R[0, 0]
        )

    start = slope(0, np.eye(12))
    np.testing.assert_allclose(slope(-1, X), start, rtol=0, atol=1e-9 * np.max(np.abs(start)))


@pytest.mark.parametrize("mu", [0.2, 1.2])
def test_the_vertical_is_an_axis_of_symmetry(mu):
    # all turned about z, or shifted along the floor: the end is turned and shifted too
    run = throw(inertia=UNEQUAL, mu=mu)
    X = tangents(carom.sensitivities(run, STATE))
    z = np.array([0.0, 0.0, 1.0])

    def generator(k):
        motion = run.position, run.velocity, run.angular_velocity
        x, v, w = (np.cross(z, a[k, 0]) for a in motion)
        return np.concatenate([x, z, v, w])

    size = np.linalg.norm(X, axis=1)
    assert np.all(
        np.abs(X @ generator(0) - generator(-1)) <= 1e-9 * size * np.linalg.norm(generator(0))
    )
    np.testing.assert_allclose(X[:, :2], np.eye(12)[:, :2], atol=1e-9)


def test_the_later_run_is_one_of_the_same_family():
    # a change of the start along the motion is a change of time: X f(0) = f(T), impacts come earlier by 1
    run = throw(inertia=UNEQUAL)
    found = carom.sensitivities(run, STATE)
    X = tangents(found)

    def field(k):
        R = quaternion.matrix(run.orientation[k, 0])
        I, w = R @ UNEQUAL @ R.T, run.angular_velocity[k, 0]
        spin = -np.linalg.solve(I, np.cross(w, I @ w))
        return np.concatenate([run.velocity[k, 0], w, [0, 0, -9.81], spin])

    np.testing.assert_allclose(found.impact_time @ field(0), -1.0, rtol=1e-9)
    size = np.linalg.norm(X, axis=1) * np.linalg.norm(field(0))
    # attitudes of the run at its end are off by its error of integration
    assert np.all(np.abs(X @ field(0) - field(-1)) <= 1e-8 * size)
    np.testing.assert_allclose(found.impulse @ field(0), 0.0, atol=1e-9)


def test_mirrored_throws_have_mirrored_derivatives():
    def run(side):
        scene = carom.Scene()
        floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
        turn = quaternion.exp([0.3 * side, 0.5, 0.2 * side])
        body = scene.add_body(
            carom.Box(0.1, 0.06, 0.04), mass=0.3, position=(0, 0.01 * side, 0.2), orientation=turn,
            velocity=(0.5, 0.2 * side, -1), angular_velocity=(4 * side, 3, -2 * side), name="die",
        )  # fmt: skip
        scene.add_contact(body, floor, restitution=0.5, friction=0.3, impact_law="stronge")
        return carom.sensitivities(carom.simulate(scene, 0.3, step=1e-3), STATE)

    # y -> -y: vectors change their second component, axial ones the first and third
    polar, axial = np.array([1, -1, 1]), np.array([-1, 1, -1])
    flip = np.concatenate([polar, axial, polar, axial])
    one, other = run(1.0), run(-1.0)
    assert len(one.impact_time) >= 2
    X = tangents(one)
    np.testing.assert_allclose(
        flip[:, None] * tangents(other) * flip, X, rtol=0, atol=1e-9 * np.max(np.abs(X))
    )
    np.testing.assert_allclose(other.impact_time * flip, one.impact_time, rtol=0, atol=1e-10)
