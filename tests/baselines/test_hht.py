"""HHT-alpha in the free phase: order, exactness where it is exact, numerical damping."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hht import hht_alpha

ONE = np.eye(1)


def pendulum(t, q, v):
    return -9.81 * np.sin(q)


def pendulum_slopes(t, q, v):
    return np.diag(-9.81 * np.cos(q)), np.zeros((1, 1))


@pytest.mark.parametrize("alpha", [0.0, 0.05, 0.2, 1 / 3])
def test_order_two_on_a_pendulum(alpha):
    """thetadd = -g sin(theta) from rest at 1.5 rad, against DOP853 to 1e-12."""
    exact = solve_ivp(
        lambda t, y: [y[1], -9.81 * np.sin(y[0])], (0, 1), [1.5, 0.0], "DOP853",
        rtol=1e-12, atol=1e-12,
    ).y[:, -1]  # fmt: skip
    errors = []
    for h in (0.02, 0.01, 0.005):
        run = hht_alpha(
            ONE, pendulum, [1.5], [0.0], 1.0, step=h, alpha=alpha, jacobian=pendulum_slopes
        )
        errors.append(np.abs([run.position[-1, 0], run.velocity[-1, 0]] - exact).max())
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx(2.0, abs=0.15)


def test_numerical_jacobian_gives_the_same():
    given = run = hht_alpha(
        ONE, pendulum, [1.5], [0.0], 1.0, step=0.02, jacobian=pendulum_slopes
    )  # fmt: skip
    run = hht_alpha(ONE, pendulum, [1.5], [0.0], 1.0, step=0.02)
    np.testing.assert_allclose(run.position, given.position, atol=1e-11)


def test_flight_is_exact():
    """Constant force: z = z0 + v0 t - g t^2/2 for every alpha; the last step is shortened."""
    for alpha in (0.0, 1 / 3):
        run = hht_alpha(
            2 * np.eye(3), lambda t, q, v: np.array([0, 0, -19.62]), [0, 0, 1], [1, 0, 2], 0.25,
            step=0.1, alpha=alpha,
        )  # fmt: skip
        np.testing.assert_allclose(run.t, [0, 0.1, 0.2, 0.25])
        exact = 1 + 2 * run.t - 0.5 * 9.81 * run.t**2
        np.testing.assert_allclose(run.position[:, 2], exact, rtol=1e-14)
        np.testing.assert_allclose(run.position[:, 0], run.t, atol=1e-15)


def test_spring_keeps_energy_at_alpha_zero_and_loses_it_else():
    """Trapezoidal rule: energy of a linear spring is exact. alpha > 0 damps, fast springs most."""

    def energy_left(alpha, stiffness):
        run = hht_alpha(
            ONE, lambda t, q, v: -stiffness * q, [1.0], [0.0], 5.0, step=0.05, alpha=alpha
        )
        return (run.velocity[-1, 0] ** 2 + stiffness * run.position[-1, 0] ** 2) / stiffness

    assert energy_left(0.0, 1e4) == pytest.approx(1.0, abs=1e-10)
    slow, fast = energy_left(0.1, 10.0), energy_left(0.1, 1e4)
    assert fast < 1e-3 < 0.9 < slow < 1.0
    assert energy_left(0.3, 10.0) < slow


def test_damped_coupled_spring_uses_both_slopes():
    """M qdd = -K q - C v, two coordinates, against the matrix exponential."""
    from scipy.linalg import expm

    M = np.array([[2.0, 0.3], [0.3, 1.0]])
    K, C = np.array([[30.0, -10.0], [-10.0, 20.0]]), np.array([[0.4, 0.1], [0.1, 0.2]])
    run = hht_alpha(M, lambda t, q, v: -K @ q - C @ v, [1, 0], [0, -1], 1.0, step=1e-3)
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    exact = expm(A) @ [1, 0, 0, -1]
    np.testing.assert_allclose(
        [*run.position[-1], *run.velocity[-1]], exact, atol=6e-5
    )  # ~ w^2 h^2
    assert run.iterations.max() <= 2


def test_failure_is_a_value():
    """A force without a solution in the step: the run ends with a sentence, up to there."""
    run = hht_alpha(ONE, lambda t, q, v: 1e9 * np.sign(0.5 - t - v), [0.0], [0.0], 1.0, step=0.1)
    assert not run.success
    assert "did not converge" in run.message
    assert np.all(np.isfinite(run.position))


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("alpha", dict(alpha=0.5)), ("step", dict(step=0.0)), ("duration", dict(duration=-1.0)),
        ("mass", dict(mass=np.eye(2))), ("velocity", dict(velocity=[0.0, 1.0])),
        ("position", dict(position=[np.nan])), ("force", dict(force=lambda t, q, v: [1.0, 2.0])),
    ],
)  # fmt: skip
def test_bad_input_names_the_argument(name, change):
    given = dict(
        mass=ONE, force=pendulum, position=[0.0], velocity=[0.0], duration=1.0, step=0.1
    )  # fmt: skip
    with pytest.raises(ValueError, match=name):
        hht_alpha(**(given | change))
