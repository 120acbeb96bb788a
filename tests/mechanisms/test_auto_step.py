"""step="auto": errors follow the tolerance, impacts are met inside steps, what is saved, bad input."""

import math

import numpy as np
import pytest
import test_andrews
import test_heavy_top as heavy_top
from mechanism_scenes import pendulum
from test_rattle import on_a_wall

import carom
from carom import GROUND, Scene, forces

STAGES = {"rk4": 4, "rk5": 7, "rk8": 12}


def auto(scene, duration, rtol, method="rk5", **more):
    return carom.simulate(scene, duration, step="auto", rtol=rtol, atol=0.0, method=method, **more)


def evaluations(solution):
    """Accelerations that were worked out; `rk5` has six stages in a step of fixed length."""
    stages = STAGES[solution.settings["method"]]
    fixed = solution.settings["step"] != "auto" and stages == 7
    return solution.stats["trial_steps"] * (stages - fixed)


def top_error(s):
    _, _, x = heavy_top.reference.motion(np.array([0.0, s.t[-1]]))
    return np.max(np.abs(s.position[-1, 0] - x[-1]))


def andrews_error(s):
    return test_andrews.errors(s)[0]


def wall_error(s):
    known = carom.simulate(on_a_wall(), 2.5, step=1e-3, method="rk8")  # to 1e-12
    assert len(s.impacts) == len(known.impacts) == 3
    late = np.max(np.abs(s.impacts.time - known.impacts.time))
    return max(late, np.max(np.abs(s.position[-1] - known.position[-1])))


CASES = {
    "heavy top": (heavy_top.top, 0.2, top_error),  # of size 1 m
    "Andrews": (test_andrews.andrews, 0.03, andrews_error),  # angles
    "wall": (on_a_wall, 2.5, wall_error),  # .5 m, three impacts of a double pendulum
}


@pytest.mark.parametrize("method", ["rk5", "rk8"])
@pytest.mark.parametrize("case", CASES)
def test_errors_follow_the_tolerance(case, method):
    """Over four decades; steps are no longer than a 50th of the run, which is what bounds the large ones."""
    make, duration, error = CASES[case]
    tolerances = np.array([1e-6, 1e-8, 1e-10])
    found = np.array([error(auto(make(), duration, rtol, method)) for rtol in tolerances])
    assert np.all(found < 10.0 * tolerances)
    if not (case == "heavy top" and method == "rk8"):  # 4 mrad left to a step there: 2e-10
        falls = found[:-1] / found[1:]
        assert np.all((falls > 10.0) & (falls < 1000.0))


def test_absolute_tolerance():
    """With rtol 0 (almost) it is atol that counts, in metres."""
    errors = []
    for atol in (1e-6, 1e-8):
        s = carom.simulate(heavy_top.top(), 0.2, step="auto", rtol=1e-13, atol=atol)
        errors.append(top_error(s))
    assert errors[0] < 1e-5
    assert 10.0 < errors[0] / errors[1] < 1000.0


def uneven():
    """A pendulum whose spring passes its anchor by 5 mm, where its force turns round."""
    scene = pendulum("Revolute")
    scene.add_force(
        forces.Spring(30.0, (0.0, -0.505, 0.0), (-0.5, 0, 0), rest_length=0.5),
        GROUND,
        scene["bob"],
    )
    return scene


# 2e-4 of the energy in the whole run, at a loose tolerance
def test_fewer_evaluations_where_motion_is_uneven():
    known = carom.simulate(uneven(), 3.0, step=2e-5, method="rk8").position[-1]
    s = auto(uneven(), 3.0, 1e-6)
    error = np.max(np.abs(s.position[-1] - known))
    assert error < 1e-4
    for step in (1e-2, 5e-3, 2.5e-3, 1e-3):  # the longest fixed step that is as good
        fixed = carom.simulate(uneven(), 3.0, step=step, method="rk5")
        if np.max(np.abs(fixed.position[-1] - known)) <= error:
            break
    assert 3 * evaluations(s) < evaluations(fixed)
    lengths = np.diff(s.t)
    assert lengths.max() > 10 * lengths[10:-1].min()
    assert s.stats["rejected"] > 0


def test_default_method_and_tolerances():
    s = carom.simulate(pendulum(), 1.0, step="auto")
    assert (s.settings["method"], s.settings["step"]) == ("rk5", "auto")
    assert (s.settings["rtol"], s.settings["atol"]) == (1e-6, 1e-9)


def test_rows_are_the_steps():
    """Natural steps, the ends among them; more than the room there was at first; each third by save_every."""
    s = auto(pendulum(), 20.0, 1e-9)
    assert len(s.t) == s.stats["steps"] + 1 > 300
    assert s.t[0] == 0.0
    assert s.t[-1] == 20.0
    assert np.all(np.diff(s.t) > 0)
    third = auto(pendulum(), 20.0, 1e-9, save_every=3)
    rows = [*range(0, len(s.t), 3)]
    rows += [len(s.t) - 1] if rows[-1] != len(s.t) - 1 else []
    assert np.array_equal(third.t, s.t[rows])
    assert np.array_equal(third.position, s.position[rows])


def test_longest_step():
    free = Scene()
    free.add_body(mass=1.0, inertia=[1] * 3)
    s = carom.simulate(free, 1.0, step="auto")
    assert np.diff(s.t).max() == pytest.approx(0.02)  # flies in closed form: a 50th of the run
    s = carom.simulate(free, 1.0, step="auto", options=carom.Options(max_step=0.25))
    assert np.diff(s.t).max() == pytest.approx(0.25)
    np.testing.assert_allclose(s.position[-1, 0, 2], -0.5 * 9.81, rtol=1e-14)


def test_progress_is_in_seconds():
    calls = []
    s = carom.simulate(pendulum(), 2.0, step="auto", progress=lambda *done: calls.append(done))
    times = [t for t, _ in calls]
    assert 10 < len(calls) <= 100  # once a step, where steps are longer than a hundredth
    assert {total for _, total in calls} == {2.0}
    assert times == sorted(set(times))
    assert times[-1] == 2.0
    without = carom.simulate(pendulum(), 2.0, step="auto")
    assert np.array_equal(s.t, without.t)  # reports cut no step


def test_tumbling_in_free_flight():
    """It is exact: nothing bounds the step but what it may be at most."""
    scene = Scene()
    scene.add_body(mass=1.0, inertia=[1, 2, 3], angular_velocity=(3, 0.1, 0.1))
    known = carom.simulate(scene, 10.0, step=1e-3).orientation[-1]
    s = auto(scene, 10.0, 1e-5, options=carom.Options(max_step=1.0))
    assert np.max(np.abs(s.orientation[-1] - known)) < 1e-13
    assert s.stats["steps"] < 20


def test_ball_comes_to_rest():
    """Bounces higher than the tolerance are resolved: 0.9 m e^(2k) > 1e-6 * .1 m up to k = 11."""
    scene = Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 1))
    scene.add_contact(ball, ground, restitution=0.5)
    s = carom.simulate(scene, 2.0, step="auto", atol=0.0)
    first = math.sqrt(2.0 * 0.9 / 9.81)
    known = first * (1.0 + 2.0 * (1.0 - 0.5 ** np.arange(12)))  # t_k = t_0 (1 + 2 sum of e^j)
    np.testing.assert_allclose(s.impacts.time[:12], known, rtol=0, atol=1e-12)
    assert 12 <= len(s.impacts) <= 14
    assert s.position[-1, 0, 2] == pytest.approx(0.1, abs=1e-15)
    assert s.kinetic_energy[-1] == 0.0


def block(spin):
    scene = Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    box = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.01), velocity=(1, 0, 0),
        angular_velocity=(0, 0, spin),
    )  # fmt: skip
    scene.add_contact(box, ground, restitution=0.0, friction=0.3)
    return scene


def test_block_slides_and_stops():
    """Held at four points, order 2: the turn in a step is bounded, and the stop is met."""
    s = carom.simulate(block(0.0), 0.5, step="auto")
    assert s.position[-1, 0, 0] == pytest.approx(0.5 / (0.3 * 9.81), abs=1e-12)
    known = carom.simulate(block(30.0), 0.5, step=5e-5)
    s = carom.simulate(block(30.0), 0.5, step="auto")
    assert np.max(np.abs(s.position[-1] - known.position[-1])) < 1e-6
    assert s.events.time[-1] == pytest.approx(known.events.time[-1], abs=1e-5)
    assert s.stats["steps"] < 400


def stiff(damping):
    scene = pendulum("Revolute")
    scene.add_force(
        forces.Spring(1.0, (-1.0, 0.5, 0), (-0.5, 0, 0), damping=damping), GROUND, scene["bob"]
    )
    return scene


def test_a_step_too_small_ends_the_run():
    """A damper that stops the bob within 1e-17 s: no explicit step is short enough."""
    s = carom.simulate(stiff(1e17), 1.0, step="auto", throw=False)
    assert s.status is carom.Status.STEP_TOO_SMALL
    assert "raise them" in s.message.lower()
    assert np.all(np.isfinite(s.position))


@pytest.mark.plain
def test_a_few_steps():
    s = carom.simulate(pendulum(), 0.1, step="auto", rtol=1e-3)
    assert s.t[-1] == 0.1
    assert s.stats["steps"] > 50


@pytest.mark.plain
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"step": "fast"}, r"""step must be a number \[s\] or "auto", got 'fast'"""),
        ({"method": "rk4"}, r"""method must be 'rk5' or 'rk8' for step="auto" .* got 'rk4'"""),
        ({"method": "rattle"}, r"method must be 'rk5' or 'rk8' .* got 'rattle'"),
        ({"impact_location": "project"}, r"impact_location must be 'locate' .* got 'project'"),
        ({"rtol": 0.0}, r"rtol must be finite and at least 1e-13 and at most 0.1, got 0.0"),
        ({"rtol": 1.0}, r"rtol must be .* got 1.0"),
        ({"rtol": math.nan}, r"rtol must be .* got nan"),
        ({"atol": -1e-9}, r"atol must be finite and at least 0 \[m\], got -1e-09"),
        ({"step": 0.01, "rtol": 1e-6}, r"""rtol is for step="auto", got 1e-06 with a given step"""),
        ({"step": 0.01, "atol": 1e-9}, r"""atol is for step="auto", got 1e-09 with a given step"""),
        ({"options": carom.Options(max_step=1e-14)}, r"Options.max_step must be above duration / 1e12"),
    ],
)  # fmt: skip
def test_bad_input(arguments, message):
    with pytest.raises(ValueError, match=message):
        carom.simulate(pendulum(), 1.0, **{"step": "auto", **arguments})


@pytest.mark.plain
def test_bad_longest_step():
    with pytest.raises(ValueError, match=r"max_step must be finite and above 0 \[s\], got 0.0"):
        carom.Options(max_step=0.0)
