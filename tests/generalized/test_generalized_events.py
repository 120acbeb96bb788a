"""Events of systems in coordinates: functions of their states, rest, and the first impact of a contact."""

import numpy as np
import pytest

import carom
from carom import GeneralizedSystem

G = 9.81


def ball():
    """A ball that falls from 1 m on a floor, e = 1/2."""
    system = GeneralizedSystem(
        lambda q: np.eye(2), [0.0, 1.0], [1.0, 0.0], potential=lambda q: G * q[1]
    )
    system.add_contact(
        lambda q: q[1], tangent=lambda q: np.array([1.0, 0.0]), restitution=0.5, friction=0.2,
        name="floor",
    )  # fmt: skip
    return system


def test_a_function_of_the_state():
    def half(t, state):
        assert not state.q.flags.writeable
        return state.q[1] - 0.5

    run = carom.simulate(ball(), 1.0, events=half)
    # after the first impact it rises to 1/4 m
    assert run.t_events[0] == pytest.approx([np.sqrt(1.0 / G)], abs=1e-13)
    state = run.state_events[0][0]
    assert state.q == pytest.approx([np.sqrt(1.0 / G), 0.5], abs=1e-13)
    assert state.v == pytest.approx([1.0, -np.sqrt(G)], abs=1e-12)
    assert state.kinetic_energy + state.potential_energy == pytest.approx(0.5 + G, rel=1e-13)
    same = carom.simulate(ball(), 1.0)
    assert np.array_equal(run.q, same.q)
    assert same.t_events is None


def test_a_terminal_function_and_rest_end_a_run():
    def half(t, state):
        return state.q[1] - 0.5

    half.terminal = True
    run = carom.simulate(ball(), 1.0, events=half)
    assert run.status is carom.Status.STOPPED
    assert run.q[-1, 1] == pytest.approx(0.5, abs=1e-13)
    rests = carom.simulate(ball(), 5.0, events="at rest")
    # bounces end at 3 t0; those below the tolerance are left out
    assert rests.t[-1] == pytest.approx(3.0 * np.sqrt(2.0 / G), abs=1e-3)
    assert np.all(rests.v[-1] == 0.0)


def test_the_first_impact_of_a_contact():
    run = carom.simulate(ball(), 5.0, events="first impact of floor")
    assert run.t[-1] == pytest.approx(np.sqrt(2.0 / G), abs=1e-13)
    assert 'events[0] ("first impact of floor")' in run.message
    with pytest.raises(
        ValueError, match=r"got 'flor'; the system has 'floor'; did you mean 'floor'"
    ):
        carom.simulate(ball(), 5.0, events="first impact of flor")


def test_the_first_impact_of_a_stop_of_a_scene():
    scene = carom.Scene()
    rod = scene.add_body(carom.Box(1, 0.02, 0.02), mass=1, position=(0.5, 0, 0), name="rod")
    hinge = carom.joints.Revolute((0, 0, 0), (0, 1, 0))
    scene.add_joint(hinge, carom.GROUND, rod, name="hinge")
    scene.add_stop("hinge", upper=0.5, restitution=0.3, name="end")
    run = carom.simulate(scene, 5.0, events="first impact of end")
    assert run.status is carom.Status.STOPPED
    assert run["hinge"].coordinate[-1] == pytest.approx(0.5, abs=1e-12)
    assert run["hinge"].rate[-1] < 0.0
