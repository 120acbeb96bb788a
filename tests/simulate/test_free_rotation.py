"""Torque-free rotation in closed form: attitude, limits, long flights, bounds."""

import json
from pathlib import Path

import numpy as np
import pytest

import carom
from carom._compiled.decorators import entry
from carom._compiled.record_arrays import table
from carom.geometry import quaternion
from carom.kinematics.flight import point_bound
from carom.kinematics.flight_arrays import torque_free
from carom.model.arrays import BODY
from carom.model.workspace import BODY_WORK
from references.free_rotation import angle_between, free_rotation
from verified import agree, verifies

CASES = json.loads((Path(__file__).parents[1] / "data/free_flight/free_flight.json").read_text())
SEVEN = [{"step": 1.0}, {"step": 1 / 7}, {"step": 1.0, "method": "rk8"}]


@verifies("simulate", "free rotation of 36 bodies", "own integration: Taylor series in 40 digits")
@pytest.mark.parametrize("how", SEVEN, ids=["one step", "seven", "rk8"])
def test_reference_cases(how):
    # 36 bodies, by Taylor series in 40 digits: round-off of a rate is 1e-16 of the angle
    for case in CASES:
        scene, W = carom.Scene(), np.array(case["body_rate"])
        q = quaternion.normalize(np.array(case["orientation"]))
        spin = quaternion.rotate(q, W)
        scene.add_body(mass=1, inertia=case["moments"], orientation=q, angular_velocity=spin)
        T = case["time"]
        a = carom.simulate(scene, T, **{**how, "step": how["step"] * T})
        turn = np.linalg.norm(W) * T
        error = angle_between(a.orientation[-1, 0], case["orientation_end"])
        agree(error, 0.0, atol=1e-14 * (1 + turn))
        W = quaternion.rotate_back(a.orientation[-1, 0], a.angular_velocity[-1, 0])
        known = np.array(case["body_rate_end"], dtype=float)
        assert np.linalg.norm(W - known) < 1e-14 * (1 + turn) * np.linalg.norm(known)


def _unit(rng, n=3):
    a = rng.normal(size=n)
    return a / np.linalg.norm(a)


def _box(a, b, c):
    return np.array([b * b + c * c, a * a + c * c, a * a + b * b]) / 12


def _general(rng):
    p = rng.uniform(0.05, 1.0, 3)  # sums of masses along the axes: the triangle inequality holds
    return p.sum() - p


def _separatrix(J, off, rng):
    """Return rates with d_32 b_3^2 = d_21 b_1^2 (1 + off)."""
    low, middle, high = np.argsort(J)
    d32, d21 = 1 / J[low] - 1 / J[middle], 1 / J[middle] - 1 / J[high]
    b, part = np.zeros(3), rng.uniform(-0.9, 0.9)
    b[[high, low]] = np.sqrt((1 - part**2) / (d32 + d21)) * np.sqrt([d32, d21 * (1 + off)])
    b[middle] = part
    return b * rng.choice([-1, 1], 3) / J


def _axis(rng, k=None):
    return np.eye(3)[rng.integers(3) if k is None else k] * rng.choice([-1, 1])


#: moments and rates of a kind
KINDS = {
    "general": lambda g: (_general(g), _unit(g)),
    "slender": lambda g: (_box(1, *(10 ** g.uniform(-3, -1, 2))), _unit(g)),
    "slender, tumbling": lambda g: ((J := _box(1, *(10 ** g.uniform(-3, -1, 2)))), _unit(g) / J),
    "plate": lambda g: (_box(1, g.uniform(0.3, 1), 10 ** g.uniform(-6, -1)), _unit(g)),
    "triangle": lambda g: (g.uniform(0.1, 1, 2) @ [[1, 0, 1], [0, 1, 1]], _unit(g)),
    "symmetric": lambda g: (g.permutation([1, 1, g.uniform(0.01, 2)]), _unit(g)),
    "symmetric, across": lambda g: (np.array([1, 1, g.uniform(0.01, 2)]), _unit(g) * [1, 1, 0]),
    "nearly symmetric": lambda g: (
        g.permutation([1, 1 + 10 ** g.uniform(-15, -3), g.uniform(0.01, 2)]), _unit(g)
    ),
    "nearly equal": lambda g: (1 + 10 ** g.uniform(-15, -2) * g.normal(size=3), _unit(g)),
    "separatrix": lambda g: ((J := _general(g)), _separatrix(J, 0.0, g)),
    "near it": lambda g: (
        (J := _general(g)), _separatrix(J, g.choice([-1, 1]) * 10 ** g.uniform(-15, -1), g)
    ),
    "principal": lambda g: (_general(g), _axis(g)),
    "middle axis": lambda g: (np.array([1.0, 2.0, 2.5]), _axis(g, 1)),
    "nearly principal": lambda g: (
        _general(g), _axis(g) + 10 ** g.uniform(-15, -3) * g.normal(size=3)
    ),
    "two components": lambda g: (_general(g), _unit(g) * (np.arange(3) != g.integers(3))),
    "tiny": lambda g: (_general(g) * 10 ** g.uniform(-30, -6), _unit(g)),
    "huge": lambda g: (_general(g) * 10 ** g.uniform(6, 30), _unit(g)),
}  # fmt: skip


@pytest.mark.few(6)
@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_body(kind):
    # start in the body's axes, so that rates of 1e-15 beside 1 are given exactly; turned by about 3 rad, what
    # grows from round-off near the middle axis is 1e-16 exp(3)
    rng = np.random.default_rng(list(kind.encode()))
    for _ in range(6):
        J, W = KINDS[kind](rng)
        speed = 10 ** rng.uniform(-3, 3)
        W = speed * W / np.linalg.norm(W)
        t = rng.choice([-1, 1]) * rng.uniform(1, 4) / speed
        q = np.eye(4)[rng.integers(4)]
        w = quaternion.rotate(q, W)
        times = np.linspace(0, t, 40)
        Q, spins = torque_free(J, np.tile(q, (40, 1)), np.tile(w, (40, 1)), times)
        fastest = np.max(np.linalg.norm(spins, axis=1))
        known = free_rotation(J, q, w, t, fastest)
        assert angle_between(Q[-1], known) < 2e-14 * max(1, fastest / speed), (J, W, t)
        np.testing.assert_allclose(Q[0], q, rtol=0, atol=3e-16)


def _states(J, w):
    return J, np.array([[1.0, 0, 0, 0]]), np.array([w], dtype=float)


@pytest.mark.parametrize(
    "J", [(0.3, 0.7, 0.9), (1e-3, 1, 1 - 1e-4), (1, 1, 1.7), (1, 1 + 1e-9, 1.7), (0.4, 0.6, 1)]
)
def test_long_flight(J):
    # ten thousand radians at once, and in two parts that know nothing of each other
    whole, spin = torque_free(*_states(J, (0.3, 0.8, 0.5)), np.array([1e4]))
    middle = torque_free(*_states(J, (0.3, 0.8, 0.5)), np.array([4321.0]))
    end, other = torque_free(J, *middle, np.array([1e4 - 4321.0]))
    assert angle_between(whole[0], end[0]) < 1e-11  # 1e-15 a radian
    np.testing.assert_allclose(other, spin, rtol=0, atol=1e-10)


@verifies("simulate", "$10^5$ steps of free rotation are one", "invariant")
def test_short_steps_do_not_drift():
    # 10^5 steps of 10 microseconds and one of a second give the same state, whatever was tried on the way
    J, w = np.array([0.1, 0.92, 1.0]), (3.0, 40.0, 20.0)
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_body(mass=1, inertia=J, angular_velocity=w)
    a = carom.simulate(scene, 1.0, step=1e-5, save_every=1000)
    known, spin = torque_free(*_states(J, w), np.array([1.0]))
    assert angle_between(a.orientation[-1, 0], known[0]) < 1e-13
    agree(a.angular_velocity[-1], spin, atol=1e-11)
    R = quaternion.matrix(a.orientation[:, 0])
    L = np.einsum("tij,j,tkj,tk->ti", R, J, R, a.angular_velocity[:, 0])
    agree(L, L[0], atol=1e-13 * np.linalg.norm(L[0]))
    agree(np.ptp(a.kinetic_energy), 0.0, atol=1e-13 * a.kinetic_energy[0])


def test_steps_of_many_turns():
    # a slender body at 2000 rad/s, 40 rad a step: the same as at a tenth of the step
    ends = []
    for step in (0.02, 0.002):
        scene = carom.Scene()
        scene.add_body(carom.Box(0.3, 0.01, 0.008), mass=1, angular_velocity=(1500, 800, 1000))
        a = carom.simulate(scene, 0.4, step=step)
        assert a.success
        ends.append(a.orientation[-1, 0])
    assert angle_between(*ends) < 1e-12


@entry
def bound(bodies, Q, w, memory):
    return point_bound(bodies[0], Q, w, memory[0])


def test_no_point_is_accelerated_more_than_the_bound():
    # §1.6 rests on it. And it is sharp: no more than four times what occurs
    rng = np.random.default_rng(3)
    body, memory = table(BODY, 1), table(BODY_WORK, 1)
    for kind in KINDS:
        J, W = KINDS[kind](rng)
        W = W / np.linalg.norm(W)
        body.inertia[0] = J
        most = bound(body, (1.0, 0.0, 0.0, 0.0), tuple(W.tolist()), memory)
        t = np.linspace(0, 60, 1000)
        Q, w = torque_free(J, np.tile([1.0, 0, 0, 0], (1000, 1)), np.tile(W, (1000, 1)), t)
        W = quaternion.rotate_back(Q, w)
        rate = np.cross(J * W, W) / J
        S = np.zeros((1000, 3, 3))  # W x (W x r) + W' x r
        for a in (0, 1, 2):
            e = np.broadcast_to(np.eye(3)[a], W.shape)
            S[:, :, a] = np.cross(W, np.cross(W, e)) + np.cross(rate, e)
        seen = np.max(np.linalg.norm(S, ord=2, axis=(1, 2)))
        assert seen <= most * (1 + 1e-12), kind
        assert most < 4 * seen, kind
