"""Systems from functions, compiled or plain, and what happens when one of them fails."""

import numba
import numpy as np
import pytest
from coordinate_systems import double_pendulum

import carom
from carom import GeneralizedSystem

START = dict(position=[-1.3, 0.5], velocity=[0.0, 0.0])


@numba.extending.register_jitable
def filled(shape, values):
    """Return an array of these numbers. (`np.array` of lists takes Numba seconds to compile.)"""
    out = np.empty(shape)
    for k, value in enumerate(values):
        out.flat[k] = value
    return out


def metric(q):
    c = 0.5 * np.cos(q[0] - q[1])
    return filled((2, 2), (4 / 3, c, c, 1 / 3))


def potential(q):
    return -9.81 * (1.5 * np.cos(q[0]) + 0.5 * np.cos(q[1]))


def gap(q):
    return -0.2 - np.sin(q[0]) - np.sin(q[1])


def tangent(q):
    return np.sin(q)


def metric_derivative(q):
    s = 0.5 * np.sin(q[0] - q[1])
    return np.array([[[0, -s], [-s, 0]], [[0, s], [s, 0]]])


def potential_gradient(q):
    return 9.81 * np.array([1.5 * np.sin(q[0]), 0.5 * np.sin(q[1])])


def gap_gradient(q):
    return -np.cos(q)


def pendulum(wrap=lambda f: f, **more):
    system = GeneralizedSystem(wrap(metric), potential=wrap(potential), **START, **more)
    system.add_contact(
        wrap(gap), tangent=wrap(tangent), restitution=0.5, friction=0.3, impact_law="stronge"
    )
    return system


@pytest.fixture(scope="module")
def exact():
    system, x, z, rate = double_pendulum(**START)
    system.add_contact(
        -0.2 - x, tangent=rate(z), restitution=0.5, friction=0.3, impact_law="stronge"
    )
    return carom.simulate(system, 1.0, step=1e-2)


@pytest.mark.parametrize("wrap", [lambda f: f, numba.njit], ids=["plain", "compiled"])
def test_central_differences_do_as_exact_derivatives(exact, wrap):
    run = carom.simulate(pendulum(wrap), 1.0, step=1e-2)
    assert len(run.impacts) == len(exact.impacts) == 1
    np.testing.assert_allclose(run.q, exact.q, rtol=0, atol=1e-10)
    np.testing.assert_allclose(run.impacts.impulse, exact.impacts.impulse, rtol=0, atol=1e-10)


def test_given_derivatives_are_used(exact):
    system = GeneralizedSystem(
        metric, potential=potential, metric_derivative=metric_derivative,
        potential_gradient=potential_gradient, **START,
    )  # fmt: skip
    system.add_contact(
        gap, gap_gradient=gap_gradient, tangent=tangent, restitution=0.5, friction=0.3,
        impact_law="stronge",
    )  # fmt: skip
    run = carom.simulate(system, 1.0, step=1e-2)
    np.testing.assert_allclose(run.q, exact.q, rtol=0, atol=1e-13)


@pytest.mark.plain
def test_constraint_and_rows_from_functions():
    # A bob on a rod of length 1 in Cartesian coordinates: tension does no work, phi stays at round-off; and
    # the same constraint given as a row on the velocities.
    common = dict(potential=lambda q: 9.81 * q[1], position=[0.6, -0.8], velocity=[0.8, 0.6])
    by_phi = GeneralizedSystem(
        lambda q: np.eye(2), constraint=lambda q: [q[0] ** 2 + q[1] ** 2 - 1], **common
    )
    by_row = GeneralizedSystem(lambda q: np.eye(2), rows=lambda q: [[q[0], q[1]]], **common)
    one, two = (carom.simulate(system, 0.3, step=5e-3) for system in (by_phi, by_row))
    np.testing.assert_allclose(np.hypot(*one.q.T), 1.0, rtol=0, atol=1e-15)
    np.testing.assert_allclose(two.q, one.q, rtol=0, atol=1e-8)
    np.testing.assert_allclose(one.total_energy, one.total_energy[0], rtol=0, atol=1e-8)


def test_force_does_work():
    # A damped oscillator: work of the damper is the loss of energy.
    system = GeneralizedSystem(
        lambda q: [[1.0]], [1.0], [0.0], potential=lambda q: 8.0 * q[0] ** 2,
        force=lambda t, q, v: [-0.4 * v[0]],
    )  # fmt: skip
    run = carom.simulate(system, 1.0, step=1e-2)
    w = np.sqrt(16.0 - 0.04)
    exact = np.exp(-0.2 * run.t) * (np.cos(w * run.t) + 0.2 / w * np.sin(w * run.t))
    np.testing.assert_allclose(run.q[:, 0], exact, rtol=0, atol=2e-7)
    assert run.ledger.loads[-1] < -0.5
    assert np.max(np.abs(run.ledger.residual)) < 2e-6


def test_an_error_of_a_function_is_the_cause():
    def fails(q):
        if q[0] > -1.0:
            raise RuntimeError("beyond -1")
        return potential(q)

    system = GeneralizedSystem(metric, potential=fails, **START)
    with pytest.raises(
        carom.SimulationError, match=r"function .potential. raised RuntimeError: beyond -1 at t = "
    ) as caught:
        carom.simulate(system, 1.0, step=1e-2)
    assert isinstance(caught.value.__cause__, RuntimeError)
    assert "beyond -1" in str(caught.value.__cause__)
    assert np.all(caught.value.solution.q[:, 0] <= -1.0)


def test_an_error_at_an_event_is_the_cause_too():
    def fails(t, q, v):
        if v[0] > 0.0:
            raise RuntimeError("upwards")
        return [-9.81]

    system = GeneralizedSystem(lambda q: [[1.0]], [1.0], [0.0], force=fails)
    system.add_contact(lambda q: q[0], restitution=0.5)
    run = carom.simulate(system, 1.0, step=1e-2, throw=False)
    assert run.status is carom.Status.FUNCTION_FAILED
    assert "upwards" in run.message
    assert np.sqrt(2 / 9.81) - 1e-2 <= run.t[-1] <= np.sqrt(2 / 9.81)


def test_ctrl_c_within_a_function():
    def stops(t, q, v):
        if t > 0.5:
            raise KeyboardInterrupt
        return [0.0]

    system = GeneralizedSystem(lambda q: [[1.0]], [1.0], [1.0], force=stops)
    run = carom.simulate(system, 1.0, step=1e-2, throw=False)
    assert run.status is carom.Status.INTERRUPTED
    assert run.t[-1] == pytest.approx(0.5)


def test_a_gap_that_is_no_number_ends_the_run():
    system = GeneralizedSystem(lambda q: [[1.0]], [1.0], [-1.0])
    system.add_contact(lambda q: np.nan if q[0] < 0.5 else q[0] + 1.0, restitution=0.5)
    run = carom.simulate(system, 1.0, step=1e-2, throw=False)
    assert run.status is carom.Status.FUNCTION_FAILED
    assert run.message.startswith("The function 'gap of contact 0' returned nan at t = 0.5")


def test_motion_that_diverges_ends_with_a_status():
    system = GeneralizedSystem(lambda q: [[1.0]], [1.0], [1.0], force=lambda t, q, v: [v[0] ** 3])
    with np.errstate(all="ignore"):  # v = 1/sqrt(1 - 2 t)
        run = carom.simulate(system, 5.0, step=1e-2, throw=False)
    assert run.status is carom.Status.NOT_FINITE
    assert np.all(np.isfinite(run.q))


def test_a_potential_that_is_no_number_ends_the_run():
    # Free fall with its gradient given: from -.1 on its energies are not known.
    system = carom.GeneralizedSystem(
        lambda q: np.eye(1), [0.0], [0.0],
        potential=lambda q: 9.81 * q[0] if q[0] > -0.1 else np.nan,
        potential_gradient=lambda q: np.array([9.81]),
    )  # fmt: skip
    s = carom.simulate(system, 0.2, step=0.01, throw=False)
    assert s.status is carom.Status.FUNCTION_FAILED
    assert s.message.startswith("The function 'potential' returned nan at t = 0.14")
    assert np.all(s.q[:-1] > -0.1)
