"""The die of the paper: first impacts in the plane and in space, against independent numbers."""

import numpy as np
import pytest

import carom
from carom.bench.problems import planar_die
from simulate.scenes import ball, die
from verified import agree, verifies

PLANE, SPACE = (0, 10, 0), (10, 10, 0)

# Computed with another program: located impacts, Darboux-Keller equations to 1e-10.
T1 = {PLANE: 0.1962109919039642, SPACE: 0.19562152409119055}
CENTRE = {
    PLANE: (0.0981054959519821, 0, 0.013058118896004417),
    SPACE: (0.09781076204559527, 0, 0.014485773680940728),
}
ARM = {
    PLANE: (0.005430058093410457, 0, -0.013058118896004417),
    SPACE: (-0.006714252038185839, 0.006714252038185839, -0.014485773680940705),
}
AFTER = {  # v+, w+ by Newton's law
    (PLANE, 0.05): ((0.36614761224992054, 0, 0.2522179244236997), (0, -181.8299665210707, 0)),
    (PLANE, 0.2): ((-0.10488040090907003, 0, 0.599572173967462), (0, -117.86117584362255, 0)),
    (SPACE, 0.05): (
        (0.528582186666511, -0.06272212605815143, -0.9055736833059023),
        (148.7989569187888, 156.21710845141385, 3.4383623646579426),
    ),
    (SPACE, 0.2): (
        (0.6788630482492963, -0.2637696250296857, -0.6876893043398027),
        (127.05798791390659, 145.50704974286865, 8.551262343046687),
    ),
}


@verifies(
    "simulate",
    "first impact of the paper's die, in the plane and in space",
    "own integration: located impacts, Darboux and Keller's equation to 1e-10",
)
@pytest.mark.few(6)
@pytest.mark.parametrize(("spin", "mu"), AFTER)
@pytest.mark.parametrize("step", [0.05, 1e-3, 1.7e-4])
def test_first_impact(spin, mu, step):
    # To the digits of the reference, for any step: free flight of a die is exact.
    a = carom.simulate(die(spin, mu), 0.197, step=step)
    assert len(a.impacts) == 1
    hit = a.impacts[0]
    agree(hit.time, T1[spin], atol=1e-13)
    agree(hit.point, np.add(CENTRE[spin], ARM[spin]), atol=1e-14)
    x, _, v, w = a.evaluate(hit.time)
    agree(x[0], CENTRE[spin], atol=1e-13)
    agree(v[0], AFTER[spin, mu][0], atol=1e-8)
    agree(w[0], AFTER[spin, mu][1], rtol=1e-8, atol=1e-8)
    _, _, v, w = a.evaluate(hit.time, side="left")
    agree(v[0], (0.5, 0, -0.5 - 9.81 * hit.time), atol=1e-13)
    agree(w[0], spin, atol=1e-12)
    # slip throughout: on the cone in the plane, inside it where slip bends
    ratio = np.hypot(*hit.impulse[1:]) / (mu * hit.impulse[0])
    assert abs(ratio - 1) < 1e-12 if spin == PLANE else 0.8 < ratio < 1


@pytest.mark.parametrize(
    ("mu", "time", "v"),
    [
        (0.05, 0.244618278685, (0.315247923596, None, 0.795336214182)),
        (0.2, 0.320919590469, (-0.118281790452, None, 0.556254864347)),
    ],
)
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_second_impact_in_the_plane(mu, time, v, method):
    # Two cubic-spline steps are exact in the plane: both methods meet the same numbers.
    a = carom.simulate(die(PLANE, mu), time + 1e-3, step=1e-3, method=method)
    hit = a.impacts[1]
    assert hit.time == pytest.approx(time, abs=1e-11)
    _, _, after, _ = a.evaluate(hit.time)
    np.testing.assert_allclose(after[0, ::2], v[::2], rtol=0, atol=1e-10)


@pytest.mark.parametrize("mu", [0.05, 0.2])
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_motion_stays_in_the_plane(mu, method):
    # The lower edge strikes at its centre: nothing leaves the plane y = 0, three impacts and more.
    a = carom.simulate(die(PLANE, mu), 0.55, step=1e-3, method=method, throw=False)
    assert len(a.impacts) >= 3
    assert np.max(np.abs(a.position[:, 0, 1])) <= 1e-12 * 0.02
    assert np.max(np.abs(a.velocity[:, 0, 1])) <= 1e-12
    assert np.max(np.abs(a.angular_velocity[:, 0, ::2])) <= 1e-12 * 200
    assert np.max(np.abs(a.orientation[:, 0, 1::2])) <= 1e-12


def test_a_plane_that_is_not_along_the_axes():
    # The die turned about the vertical by .7 and thrown that way: in its own plane to 1e-12.
    c, s = np.cos(0.7), np.sin(0.7)
    scene = die(
        (-10 * s, 10 * c, 0), 0.2,
        orientation=(np.cos(0.35), 0, 0, np.sin(0.35)), velocity=(0.5 * c, 0.5 * s, -0.5),
    )  # fmt: skip
    a = carom.simulate(scene, 0.53, step=1e-3)
    assert len(a.impacts) >= 6
    across = np.array([-s, c, 0])
    # (the last state is that of the corner at which the run ends, within hundreds of blows)
    assert np.max(np.abs(a.position[:-1, 0] @ across)) <= 1e-12
    assert np.max(np.abs(a.velocity[:-1, 0] @ across)) <= 1e-12
    np.testing.assert_allclose(a.impacts.time[0], T1[PLANE], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("law", "rate"),
    [
        ("newton", 1.142381055285),
        ("poisson", 1.108096434391),
        ("stronge", 1.110828064109),
    ],
)
def test_laws_in_space(law, rate):
    # mu = .2: slip bends during the impact, so the three laws differ.
    a = carom.simulate(die(SPACE, 0.2, law=law), 0.197, step=1e-3)
    assert a.impacts.relative_velocity_after[0, 0] == pytest.approx(rate, abs=1e-11)


@pytest.mark.parametrize(("mu", "delay"), [(0.05, 2.50e-3), (0.2, 2.91e-3)])
def test_second_impact_in_space(mu, delay):
    # Another vertex, milliseconds later.
    a = carom.simulate(die(SPACE, mu), 0.2, step=1e-3)
    assert a.impacts.time[1] - a.impacts.time[0] == pytest.approx(delay, abs=5e-6)
    assert np.linalg.norm(a.impacts.point[1] - a.impacts.point[0]) > 0.01


@pytest.mark.parametrize("mu", [0.05, 0.2])
def test_the_paper_method_agrees_in_space(mu):
    # The splines are of order 4 where slip turns: 5e-4 at the paper's two steps, 1e-8 at 256.
    exact = np.array(AFTER[SPACE, mu][0])
    for count, tolerance in ((2, 2e-3), (256, 1e-8)):
        options = carom.Options(layer_steps=count)
        a = carom.simulate(die(SPACE, mu), 0.197, step=1e-3, method="paper", options=options)
        assert a.impacts.time[0] == pytest.approx(T1[SPACE], abs=1e-13)
        np.testing.assert_allclose(a.velocity[-1, 0, :2], exact[:2], rtol=0, atol=tolerance)


@pytest.mark.parametrize("option", [{"layer_width": 1e-3}, {"penetration": 0.8}])
def test_the_layer_does_not_change_the_motion(option):
    # Width and penetration set the time in the layer only: T_c = 2 b l / v_0.
    a = carom.simulate(die(SPACE, 0.2), 0.197, step=1e-3)
    b = carom.simulate(die(SPACE, 0.2), 0.197, step=1e-3, options=carom.Options(**option))
    np.testing.assert_array_equal(a.velocity, b.velocity)
    assert b.impacts.layer_duration[0] > a.impacts.layer_duration[0]


def test_layer_time_on_the_clock():
    # add_layer_time: the position stands still for the duration of the impact.
    options = carom.Options(layer_width=1e-4, add_layer_time=True)
    a = carom.simulate(ball(0.8), 0.9, step=1e-2, options=options)
    b = carom.simulate(ball(0.8), 0.9, step=1e-2)
    assert a.impacts.time[0] == b.impacts.time[0]
    late = a.impacts.time[1] - b.impacts.time[1]
    assert late == pytest.approx(a.impacts.layer_duration[0], rel=1e-9)


@pytest.mark.parametrize("how", [{}, {"save_at": 2.0}, {"step": 1e-3}])
def test_every_impact_has_its_restitution(how):
    # A die that rattles strikes some hundred times, often within a few saved times. What strikes alone leaves
    # with e times its speed, by Newton's law, however many times it has struck before.
    scene = planar_die.scene(spin=(10, 10, 0))
    s = carom.simulate(scene, 2.0, **how)
    single = (s.impacts.together == 1) & (s.impacts.relative_velocity_before[:, 0] < -1e-6)
    assert single.sum() > 30
    before, after = (
        s.impacts.relative_velocity_before[single, 0],
        s.impacts.relative_velocity_after[single, 0],
    )
    assert after == pytest.approx(-0.5 * before, abs=1e-9)
