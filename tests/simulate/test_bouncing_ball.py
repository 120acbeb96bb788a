"""A ball that bounces on a plane: impact times, speeds, heights, the Zeno time, rest."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from simulate.scenes import LAWS, G, ball, bounce_times, event_times, total, zeno_time
from verified import agree, verifies

STEPS = (0.5, 0.1, 0.03, 0.01, 0.001)


@verifies("add_half_space", "$t_{k+1} = t_k + 2 t_1 e^k$, speeds $e^{k-1} g t_1$", "closed form")
@verifies("simulate(step=)", "impacts of a ball at the same times for any step", "closed form")
@pytest.mark.few(4)
@pytest.mark.parametrize("e", [1.0, 0.8])
@pytest.mark.parametrize("step", [0.5, 0.1, 0.013, 1e-3, 1e-4])
def test_times_and_speeds_of_impacts(e, step):
    # t_1 = sqrt(2h/g), t_k+1 = t_k + 2 t_1 e^k; approach speed e^(k-1) g t_1: for any step,
    # also one longer than a flight. (A step in which all bounces end resolves none of them.)
    count = 5 if e == 1 else 3
    duration = 2.6 if e == 1 else min(1.2, zeno_time(e) - step)
    a = carom.simulate(ball(e), duration, step=step)
    expected = bounce_times(count, e)
    expected = expected[expected < duration]
    agree(a.impacts.time, expected, atol=1e-12)
    speed = np.sqrt(2 * G * 0.4) * e ** np.arange(len(expected))
    agree(-a.impacts.relative_velocity_before[:, 0], speed, atol=1e-11)
    agree(a.impacts.relative_velocity_after[:, 0], e * speed, atol=1e-11)
    # dE = -m/2 (1 - e^2) v^2
    loss = -0.5 * (1 - e**2) * speed**2
    agree(a.impacts.energy_change, loss, atol=1e-11)


@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_a_hundred_elastic_impacts_keep_the_energy(method):
    a = carom.simulate(ball(1.0), 57.2, step=0.01, method=method)
    assert len(a.impacts) == 100
    np.testing.assert_allclose(total(a), 1.0, rtol=0, atol=1e-10)
    # 100 flights: rounding of t, of some 1e-14 each, adds up
    np.testing.assert_allclose(a.impacts.time, bounce_times(100, 1.0), rtol=0, atol=1e-10)


@verifies("Sphere", "heights $h e^{2k}$", "closed form")
def test_heights():
    # The apex after impact k is at h e^(2k), half-way between impacts k and k + 1.
    a = carom.simulate(ball(0.8), 2.5, step=0.01)
    t = a.impacts.time
    x, _, v, _ = a.evaluate(0.5 * (t[1:] + t[:-1]))
    agree(x[:, 0, 2] - 0.1, 0.4 * 0.64 ** np.arange(1.0, len(t)), atol=1e-9)
    agree(v[:, 0, 2], 0.0, atol=1e-9)


@pytest.mark.few(5)
@pytest.mark.parametrize("e", [0.5, 0.8, 0.9])
@pytest.mark.parametrize("step", STEPS)
def test_rest_at_the_zeno_time(e, step):
    # t_1 (1 + e)/(1 - e), met to within one step; then it is still, to the last bit.
    a = carom.simulate(ball(e), zeno_time(e) + 2 * step + 0.1, step=step)
    (held,) = event_times(a, "held")
    assert zeno_time(e) - step <= held <= zeno_time(e)
    rest = a.t >= held
    assert np.all(a.velocity[rest] == 0.0)
    assert np.all(a.angular_velocity[rest] == 0.0)
    assert np.ptp(a.position[rest], axis=0).max() == 0.0
    assert a.position[-1, 0, 2] == pytest.approx(0.1, abs=1e-13)
    np.testing.assert_array_equal(a.contact_mode[rest], 2)
    # N = m g
    np.testing.assert_allclose(a.contact_force[rest, 0], [[G, 0, 0]] * rest.sum(), atol=1e-13)
    # what was not resolved is no more than the energy of the last bounce that was
    last = a.impacts.relative_velocity_after[-1, 0]
    assert a.ledger.bounces[-1] == pytest.approx(-0.5 * last**2, rel=1e-9)
    np.testing.assert_allclose(a.ledger.residual, 0.0, rtol=0, atol=1e-13 * a.total_energy[0])


@pytest.mark.plain
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_plastic_impact_holds_at_once(method):
    # e = 0: one impact at t_1, all kinetic energy is lost, the ball stays.
    a = carom.simulate(ball(0.0), 0.4, step=0.05, method=method)
    t1 = np.sqrt(0.8 / G)
    np.testing.assert_allclose(a.impacts.time, [t1], rtol=0, atol=1e-13)
    np.testing.assert_allclose(event_times(a, "held"), [t1], rtol=0, atol=1e-13)
    assert a.impacts.energy_change[0] == pytest.approx(-0.4 * G, rel=1e-13)
    assert np.all(a.velocity[a.t > t1] == 0.0)


@pytest.mark.parametrize("law", LAWS)
def test_the_law_of_restitution_does_not_matter(law):
    # W_nt = 0: Newton's, Poisson's and Stronge's laws agree.
    scene = ball(0.7, 0.1, law=law, velocity=(1, 0, 0))
    a = carom.simulate(scene, 1.2, step=0.01)
    b = carom.simulate(ball(0.7, 0.1, velocity=(1, 0, 0)), 1.2, step=0.01)
    np.testing.assert_allclose(a.position, b.position, rtol=0, atol=1e-12)
    assert set(a.impacts.law) == {law}


@settings(max_examples=15, deadline=None)
@given(
    e=st.floats(0.0, 0.95), height=st.floats(1e-3, 10.0), step=st.sampled_from(STEPS),
    radius=st.floats(1e-3, 10.0), mass=st.floats(1e-6, 1e6),
)  # fmt: skip
def test_every_ball_comes_to_rest(e, height, step, radius, mass):
    # Any size, mass, height: every impact on time, held within one step of the Zeno time.
    end = zeno_time(e, height)
    a = carom.simulate(
        ball(e, height=height, radius=radius, mass=mass), end + step, step=step, save_every=1000
    )
    expected = bounce_times(len(a.impacts), e, height)
    # a gap is known to the round-off of the coordinates, its time to that by the speed of the impact
    speed = np.sqrt(2.0 * G * height) * e ** np.arange(len(a.impacts))
    known = 8.0 * np.finfo(float).eps * (radius + height) / np.maximum(speed, 1e-300)
    assert np.all(np.abs(a.impacts.time - expected) <= 1e-10 * end + known)
    (held,) = event_times(a, "held")
    assert end - step <= held <= end * (1 + 1e-10)
    assert np.all(a.velocity[-1] == 0.0)
