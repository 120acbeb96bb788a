"""Laws of friction in own coordinates: stick-slip in closed form, a slide and impacts by other computations."""

import numpy as np
import pytest
import sympy as sp
from coordinate_systems import symbols
from scipy.integrate import solve_ivp

import carom
from carom import Friction, GeneralizedSystem

G = 9.81
LAWS = (
    Friction(0.4, 0.25),
    Friction(0.5, 0.2, speed=0.3),
    Friction.table([0.0, 1.0, 3.0], [0.2, 0.5, 0.3]),
)


def block(
    law, forces=(0.0, -G), position=(0.0, 0.0), velocity=(0.0, 0.0), time=None, restitution=0.0
):
    """Return a particle of 1 kg over the floor z = 0, with forces along x and z."""
    q, v = symbols("x z")
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.eye(2), forces=[f(*q) if callable(f) else f for f in forces], time=time,
        position=position, velocity=velocity,
    )  # fmt: skip
    system.add_contact(q[1], tangent=v[0], restitution=restitution, friction=law)
    return system


@pytest.mark.parametrize("tolerance", [1e-6, 1e-10])
def test_stick_slip(tolerance):
    # pulled by a spring whose other end moves at the speed V
    law, k, V, t = Friction(0.4, 0.25), 100.0, 0.1, sp.Symbol("t")
    system = block(law, (lambda x, z: k * (V * t - x), -G), time=t)
    w, D = np.sqrt(k), (law.static - law.kinetic) * G / k
    slips = (2 * np.pi - 2 * np.arctan(D * w / V)) / w
    period, start = 2 * D / V + slips, law.static * G / (k * V)
    run = carom.simulate(system, start + 3.5 * period, rtol=tolerance, atol=tolerance)
    # a slip that ends is a parabola in time: its end is known to the root of the tolerance
    stop = 10 * np.sqrt(tolerance)
    times = [run.events.time[run.events.kind == kind] for kind in ("slips", "sticks")]
    assert times[0] == pytest.approx(start + period * np.arange(4), abs=30 * tolerance)
    assert times[1][-3:] == pytest.approx(start + slips + period * np.arange(3), abs=stop)
    assert run.evaluate(times[0])[0][:, 0] == pytest.approx(
        V * times[0] - law.static * G / k, abs=30 * tolerance
    )
    assert np.max(np.abs(run.ledger.residual)) < 10 * tolerance


@pytest.mark.parametrize("law", LAWS)
def test_a_slide_to_rest(law):
    def stops(t, y):
        return y[1]

    stops.terminal = True
    exact = solve_ivp(
        lambda t, y: (y[1], -G * float(law(max(y[1], 0.0)))), (0, 9), (0, 2.0), events=stops,
        rtol=1e-12, atol=1e-13, method="DOP853",
    )  # fmt: skip
    run = carom.simulate(block(law, velocity=(2.0, 0.0)), 2.0, rtol=1e-10, atol=1e-10)
    # the end of a slip, a parabola in time: 8e-8 s
    assert run.events.time[run.events.kind == "sticks"] == pytest.approx(exact.t[-1:], abs=1e-6)
    assert run.q[-1, 0] == pytest.approx(exact.y[0, -1], abs=1e-9)


@pytest.mark.parametrize(("pull", "moves"), [(0.3, False), (0.41, True)])
def test_a_push_between_both_coefficients(pull, moves):
    run = carom.simulate(block(LAWS[0], (pull * G, -G)), 1.0, rtol=1e-9, atol=1e-9)
    assert run.q[-1, 0] == pytest.approx(0.5 * (pull - 0.25) * G if moves else 0.0, abs=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_impacts_of_one_and_of_two_contacts(law):
    # an impact of one contact, and of a particle in a corner: as `resolve_impacts` has it
    run = carom.simulate(block(law, (0, 0), (0, 1), (1.5, -2.0), restitution=0.6), 1.0)
    W, u = np.diag([1.0, 1.0, 0.0]), np.array([[-2.0, 1.5, 0.0]])
    one = carom.resolve_impacts(W, u, law, 0.6)
    assert run.v[-1] == pytest.approx(one.velocity_after[0, [1, 0]], abs=1e-12)
    q, v = symbols("x y z")
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.eye(3), position=[1, 0, 1], velocity=[-1.0, 0.4, -1.0]
    )
    for i, j in ((2, 0), (0, 2)):
        system.add_contact(q[i], tangent=[v[j], v[1]], restitution=0.6, friction=law)
    run = carom.simulate(system, 1.5)
    rows = np.eye(3)[[2, 0, 1, 0, 2, 1]]
    both = carom.resolve_impacts(rows @ rows.T, (rows @ [-1.0, 0.4, -1.0]).reshape(2, 3), law, 0.6)
    assert len(run.impacts) == 2
    assert rows @ run.v[-1] == pytest.approx(both.velocity_after.ravel(), abs=1e-7)
    assert run.impacts.friction_loss.sum() > 0.0
