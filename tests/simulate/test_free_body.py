"""A free rigid body: energy, momentum, order of the paper's method, axes."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import carom
from simulate.scenes import matrix, product, turn

J, W0 = np.array([1.0, 2.0, 3.0]), np.array([0.3, 2.0, 0.2])  # rotation near the unstable axis


def top(inertia=J, spin=W0, gravity=(0, 0, 0), **body):
    scene = carom.Scene(gravity=gravity)
    scene.add_body(mass=1.5, inertia=inertia, angular_velocity=spin, **body)
    return scene


def exact_top(t, inertia=J, spin=W0):
    """Attitude and world angular velocity: Euler's equations and dQ/dt = Q (0, W)/2, to 1e-13."""

    def rate(_, y):
        Q, W = y[:4], y[4:]
        return np.concatenate(
            [0.5 * product(Q, np.array([0, *W])), -np.cross(W, inertia * W) / inertia]
        )

    start = np.concatenate([[1.0, 0, 0, 0], spin])
    y = solve_ivp(rate, (0, t), start, rtol=1e-13, atol=1e-14, method="DOP853").y[:, -1]
    return y[:4], matrix(y[:4]) @ y[4:]


def attitude_error(a, exact):
    """Distance of the last rotation from the exact one, in the Frobenius norm."""
    return np.linalg.norm(matrix(a.orientation[-1, 0]) - matrix(exact))


def momentum(a, inertia):
    """Spatial angular momentum at saved times."""
    R = np.array([matrix(q) for q in a.orientation[:, 0]])
    return np.einsum("tij,j,tkj,tk->ti", R, inertia, R, a.angular_velocity[:, 0])


@pytest.mark.parametrize(
    ("method", "step", "tolerance"),
    [("rk4", 0.01, 1e-12), ("rk4", 0.1, 1e-12), ("paper", 0.01, 1e-12)],
)
def test_invariants_over_many_steps(method, step, tolerance):
    # T = w.Jw/2 and L = R J R^T w are constant. rk4 keeps them over a flight; the block iteration
    # of the paper's scheme leaves a round-off of 1e-15 a step, all of one sign.
    a = carom.simulate(top(), 1e5 * step, step=step, method=method, save_every=500)
    energy = a.kinetic_energy / a.kinetic_energy[0] - 1
    assert np.max(np.abs(energy)) < tolerance
    L = momentum(a, J)
    assert np.max(np.abs(L - L[0])) < tolerance * np.linalg.norm(L[0])
    np.testing.assert_allclose(np.linalg.norm(a.orientation, axis=-1), 1.0, rtol=0, atol=1e-14)


@settings(max_examples=10, deadline=None)
@example(moments=(0.5, 0.25, 1.0), spin=(1.0, 1.4e-180, 0.0), method="rk4")
@example(moments=(1.0, 1.0, 0.5), spin=(0.0, 0.0, 1.4e-180), method="rk4")
@given(
    moments=st.tuples(*[st.floats(0.1, 1.0)] * 3),
    spin=st.tuples(*[st.floats(-3.0, 3.0)] * 3),
    method=st.sampled_from(["rk4", "paper"]),
)
def test_energy_and_momentum_of_any_body(moments, spin, method):
    # Moments that meet the triangle inequality: J_1 = b + c and so on. Any spin, 2000 steps. Squares of what
    # is smaller than 1e-154 are zero.
    b = np.array(moments)
    inertia = b.sum() - b
    a = carom.simulate(top(inertia, spin), 20, step=0.01, method=method, save_every=50)
    tolerance, tiny = 1e-12 if method == "rk4" else 2e-10, 1e-150
    assert np.ptp(a.kinetic_energy) <= tolerance * a.kinetic_energy[0] + tiny
    L = momentum(a, inertia)
    assert np.max(np.abs(L - L[0])) <= tolerance * np.linalg.norm(L[0]) + tiny


def test_order_of_the_paper_method():
    exact, spin = exact_top(5.0)
    angle, speed = [], []
    for h in (0.05, 0.025, 0.0125):
        a = carom.simulate(top(), 5.0, step=h, method="paper")
        angle.append(attitude_error(a, exact))
        speed.append(np.max(np.abs(a.angular_velocity[-1, 0] - spin)))
    for errors in (angle, speed):
        slopes = np.log2(np.array(errors[:-1]) / errors[1:])
        assert slopes[-1] == pytest.approx(2, abs=0.1), (slopes, errors)


def test_errors_of_the_paper_method():
    # 3.0e-2, 7.5e-3, 1.9e-3 at h = .1, .05, .025 (two digits are printed).
    exact, _ = exact_top(5.0)
    for h, error in ((0.1, 3.0e-2), (0.05, 7.5e-3), (0.025, 1.9e-3)):
        a = carom.simulate(top(), 5.0, step=h, method="paper")
        R, R1 = matrix(a.orientation[-1, 0]), matrix(exact)
        assert error / 2 < np.linalg.norm(R - R1) < error * 2


@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_axes_of_inertia_do_not_matter(method):
    # The same body in other body axes: J' = S J S^T, R' = R S^T, with S the turn of the axes.
    S = turn((1, 2, -1), 0.8)
    matrix_s = matrix(S)
    inverse = S * (1, -1, -1, -1)
    start = turn((0, 1, 1), 0.4)
    spin = matrix(start) @ W0
    step = 1e-3  # the order-4 error depends on the axes; it is 1e-13 here
    a = carom.simulate(top(J, spin, orientation=start), 1, step=step, method=method)
    other = top(matrix_s @ np.diag(J) @ matrix_s.T, spin, orientation=product(start, inverse))
    b = carom.simulate(other, 1, step=step, method=method)
    np.testing.assert_allclose(b.angular_velocity, a.angular_velocity, rtol=0, atol=1e-11)
    for k in (0, 100, -1):
        expected = matrix(a.orientation[k, 0]) @ matrix_s.T
        np.testing.assert_allclose(matrix(b.orientation[k, 0]), expected, rtol=0, atol=1e-11)
    np.testing.assert_allclose(b.kinetic_energy, a.kinetic_energy, rtol=1e-11)


@pytest.mark.plain
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_equal_moments_and_free_fall_are_exact(method):
    # w constant, R = exp(t hat w) R_0; x = x_0 + v_0 t + g t^2/2: exact, at any step.
    g, v0, w0 = np.array([0.3, 0.1, -9.0]), np.array([1.0, 2.0, 3.0]), np.array([3.0, -2.0, 5.0])
    scene = top((2, 2, 2), w0, g, velocity=v0, position=(1, 0, 0))
    a = carom.simulate(scene, 1.0, step=0.25, method=method)
    t = a.t[:, None]
    np.testing.assert_allclose(a.position[:, 0], [1, 0, 0] + v0 * t + g * t * t / 2, rtol=1e-13)
    np.testing.assert_allclose(a.velocity[:, 0], v0 + g * t, rtol=1e-13)
    np.testing.assert_allclose(a.angular_velocity[:, 0], w0 + 0 * t, rtol=1e-13)
    R = matrix(turn(w0, np.linalg.norm(w0)))
    np.testing.assert_allclose(matrix(a.orientation[-1, 0]), R, rtol=0, atol=1e-13)


def test_dzhanibekov():
    # J = (1, 2, 3), w0 = (.01, 1, .01) in body axes; elliptic functions: period 39.10573419728772.
    a = carom.simulate(top(spin=(0.01, 1, 0.01)), 50, step=0.01)
    for t, expected in (
        (10, (-0.8745734378911099, 0.4849961873410055, 0.5050012205479226)),
        (50, (-0.9999644885993882, 0.013077520412161397, 0.5773875008633967)),
    ):
        k = round(t / 0.01)
        W = matrix(a.orientation[k, 0]).T @ a.angular_velocity[k, 0]
        np.testing.assert_allclose(W, expected, rtol=0, atol=1e-7)


def test_constant_torque_about_a_principal_axis():
    # J_3 dw/dt = M, theta = M t^2 / (2 J_3), and the work of the torque is in the ledger.
    scene = top(spin=(0, 0, 0))
    scene.add_force(carom.forces.Torque((0, 0, 0.6)), scene.bodies[0])
    a = carom.simulate(scene, 2.0, step=0.01)
    np.testing.assert_allclose(a.angular_velocity[:, 0, 2], 0.2 * a.t, rtol=0, atol=1e-13)
    assert 2 * np.arcsin(a.orientation[-1, 0, 3]) == pytest.approx(0.4, abs=1e-9)
    assert a.ledger.loads[-1] == pytest.approx(0.5 * 3 * 0.4**2, rel=1e-12)
    np.testing.assert_allclose(a.ledger.residual, 0, atol=1e-14)


def test_nearly_equal_moments_turn_smoothly():
    """The attitude is linear in small differences d of the moments, but for d^2 (w t)^2 = 1e-13."""
    ends, Q = [], np.array([0.3, 0.5, -0.4, 0.7]) / np.sqrt(0.99)
    for d in (3e-7, 4.5e-7, 6e-7):
        scene = carom.Scene(gravity=(0, 0, 0))
        moments = 1.7e-3 * np.array([1.0, 1.0 + d, 1.0 - d])
        spin = {"orientation": Q, "angular_velocity": (2.3, -0.1, -3.0)}
        scene.add_body(mass=1.0, inertia=moments, position=(0, 0, 0), **spin)
        ends.append(carom.simulate(scene, 0.2, step=5e-4).orientation[-1, 0])
    assert np.max(np.abs(ends[0] - 2.0 * ends[1] + ends[2])) < 2e-13
    assert np.max(np.abs(ends[1] - ends[0])) > 1e-9
