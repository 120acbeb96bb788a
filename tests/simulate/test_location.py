"""The three ways to place an impact in time: `impact_location`."""

import numpy as np
import pytest

import carom
from simulate.scenes import G, ball, bounce_times, die, matrix, on_plane, product, total, turn
from verified import agree, verifies

MODES = ("locate", "project", "work")
#: the return of "project" puts in energy, and "work" takes it out to first order: known here, and no warning
KNOWN = carom.Options(energy_tolerance=10.0)


def slopes(errors):
    return np.log2(np.array(errors[:-1]) / errors[1:])


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_no_saved_state_is_inside(mode, method):
    # rho >= 0 at every saved time: an impact leaves the body on the surface, in all modes.
    a = carom.simulate(
        ball(0.8), 2.0, step=0.013, impact_location=mode, method=method, options=KNOWN
    )
    assert np.min(a.position[:, 0, 2]) >= 0.1 - 1e-14
    assert len(a.impacts) >= 6


@verifies('impact_location="project"', r"each return adds $m g\,\delta$", "closed form")
def test_project_puts_in_the_work_of_the_return():
    # e = 1: each return by pen at constant velocity adds m g pen; pen is what the impact height
    # lacks: the time of an impact is the end of its step.
    a = carom.simulate(ball(1.0), 5.0, step=1e-2, impact_location="project", options=KNOWN)
    energy = a.total_energy - a.total_energy[0]
    jumps = np.diff(energy)
    assert np.all(jumps > -1e-13)
    hits = np.searchsorted(a.t, a.impacts.time - 1e-9)
    agree(a.impacts.time, a.t[hits], atol=1e-12)
    # the free parabola of the step gives the penetration
    x, v = a.position[hits - 1, 0, 2] - 0.1, a.velocity[hits - 1, 0, 2]
    depth = -(x + v * 0.01 - 0.5 * G * 0.01**2)
    assert np.all(depth > -1e-15)  # what has arrived at the end of a step strikes there
    agree(jumps[hits - 1], G * depth, atol=1e-12)
    assert energy[-1] > 0.01 * a.total_energy[0]


@verifies('impact_location="{mode}"', "$e = 1$ keeps the energy", "invariant")
@pytest.mark.parametrize("mode", ["locate", "work"])
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_work_and_locate_keep_the_energy(mode, method):
    # u_n is changed by the work of gravity along the return: e = 1 keeps the energy to round-off.
    a = carom.simulate(ball(1.0), 20.0, step=1e-2, impact_location=mode, method=method)
    assert len(a.impacts) >= 30
    agree(total(a), 1.0, atol=1e-12)


def test_locate_is_exact_and_the_others_of_order_one():
    # Times of the third impact of a ball, e = .8.
    exact = bounce_times(3, 0.8)[2]
    error = {}
    for mode in MODES:
        error[mode] = []
        for k in range(8):
            h = 0.0137 / 2**k
            a = carom.simulate(ball(0.8), 1.3, step=h, impact_location=mode, options=KNOWN)
            error[mode].append(abs(a.impacts.time[2] - exact))
    assert max(error["locate"]) < 1e-13
    for mode in (
        "project",
        "work",
    ):  # where in its step an impact falls is chance: fit over 8 steps
        order = -np.polyfit(np.arange(8), np.log2(error[mode]), 1)[0]
        assert 0.5 < order < 1.5
        assert error[mode][-1] < 2 * 3 * 0.0137 / 2**7


def test_convergence_on_a_die_with_several_impacts():
    # The planar die, mu = .2, to t = .4 (two impacts). Free flight of a cube and impacts in the plane
    # are exact: "locate" does not depend on the step. The others err by up to a step at each impact,
    # by chance: the mean over neighbouring steps is of order 1.
    t = 0.4
    exact = carom.simulate(die(mu=0.2), t, step=t / 16)
    assert len(exact.impacts) == 2
    for mode in MODES:
        mean = []
        for n in (16, 160, 1600) if mode == "locate" else (16000, 64000, 256000):
            errors = []
            for k in range(10):
                h = t / (n + 0.0371 * k * n)
                a = carom.simulate(
                    die(mu=0.2), t, step=h, impact_location=mode, save_every=10**6, options=KNOWN
                )
                assert len(a.impacts) == 2
                errors.append(np.max(np.abs(a.velocity[-1] - exact.velocity[-1])))
            mean.append(np.mean(errors))
        if mode == "locate":
            assert max(mean) < 1e-10
        else:
            np.testing.assert_allclose(slopes(mean) / 2, 1, rtol=0, atol=0.2)
            assert mean[-1] < 2e-3  # at a step of 1.5e-6 s: the motion is sensitive


def test_a_general_body_with_impacts():
    # A brick, general moments, two impacts. Free flight is exact, and so is "locate"; it keeps the order of
    # the paper's method.
    brick = {
        "shape": carom.Box(0.1, 0.06, 0.03), "mass": 1, "position": (0, 0, 0.3),
        "orientation": turn((1, 2, 0.5), 0.7), "velocity": (0.4, 0, 0),
        "angular_velocity": (4, 6, 3),
    }  # fmt: skip
    scene = on_plane(brick, contact={"restitution": 0.7, "friction": 0.2})
    exact = carom.simulate(scene, 0.3, step=1e-4).impacts.time
    assert len(exact) == 2
    for n in (3, 10, 128):
        times = carom.simulate(scene, 0.3, step=0.3 / n).impacts.time
        np.testing.assert_allclose(times, exact, rtol=0, atol=1e-12)
    options = carom.Options(layer_steps=2048)
    times = [
        carom.simulate(scene, 0.3, step=0.3 / n, method="paper", options=options).impacts.time
        for n in (256, 512, 1024)
    ]
    for hit in (0, 1):
        assert slopes([abs(a[hit] - exact[hit]) for a in times])[-1] == pytest.approx(2, abs=0.15)


@pytest.mark.parametrize("mode", ["project", "work"])
def test_the_return_is_normal_in_the_kinetic_metric(mode):
    # xi = kappa M^-1 G^T: of a ball it is along n; of a tilted box it turns the body too,
    # xi_theta = J^-1 (r x n) m xi_z (world axes, first order in the depth).
    box = {
        "shape": carom.Box(0.2, 0.1, 0.06), "mass": 1, "position": (0, 0, 0.5),
        "orientation": turn((1, 2, 0.5), 0.7),
    }  # fmt: skip
    scene = on_plane(box, contact={"restitution": 0.5})
    h = 1e-3
    a = carom.simulate(scene, 0.4, step=h, impact_location=mode, throw=False, options=KNOWN)
    t = a.impacts.time[0]
    k = round(t / h)
    # without spin before: the rotation of the return is all that there is
    assert np.all(a.angular_velocity[k - 1] == 0.0)
    x, q, _, _ = a.evaluate(t)
    fall = 0.5 - 0.5 * G * t**2
    lift = x[0, 2] - fall
    assert lift > 0
    np.testing.assert_allclose(x[0, :2], 0, atol=1e-15)
    inverse = q[0] * 1
    start = turn((1, 2, 0.5), 0.7) * (1, -1, -1, -1)
    small = 2 * product(inverse, start)[1:]
    R = matrix(q[0])
    J = R @ scene.bodies[0].inertia @ R.T
    arm = a.impacts.point[0] - x[0]
    expected = np.linalg.solve(J, np.cross(arm, (0, 0, 1))) * lift
    np.testing.assert_allclose(small, expected, rtol=0, atol=30 * np.linalg.norm(expected) ** 2)
