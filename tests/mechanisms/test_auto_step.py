"""Tolerances: errors follow them, impacts are met inside steps, each island has its own steps, bad input."""

import math

import numpy as np
import pytest
import test_andrews
import test_heavy_top as heavy_top
from mechanism_scenes import pendulum
from test_rattle import on_a_wall

import carom
from carom import GROUND, Scene, forces, joints
from carom.bench.problems import chain
from verified import agree, verifies


def auto(scene, duration, rtol, method="rk5", **more):
    how = {"save_at": duration, **more}  # states that are saved bound the steps
    return carom.simulate(scene, duration, rtol=rtol, atol=0.0, method=method, **how)


def evaluations(solution):
    """Accelerations that order 5 has worked out: one more after a step that was rejected."""
    return 6 * solution.stats["trial_steps"] + solution.stats["rejected"]


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


CASES = {  # and whether the tolerance alone chooses the steps, of the two methods
    "heavy top": (heavy_top.top, 0.2, top_error, ("rk5", "rk8")),  # of size 1 m
    "Andrews": (test_andrews.andrews, 0.03, andrews_error, ()),  # angles: 200 states to count turns
    "wall": (on_a_wall, 2.5, wall_error, ()),  # .5 m, three impacts: steps stay near what is near
}


@verifies(
    "simulate(rtol=)",
    "ten times the tolerance: heavy top, Andrews' squeezer, impacts on a wall",
    "own integration: SciPy; published end of Andrews' squeezer",
)
@pytest.mark.few(3)
@pytest.mark.parametrize("method", ["rk5", "rk8"])
@pytest.mark.parametrize("case", CASES)
def test_errors_follow_the_tolerance(case, method):
    make, duration, error, free = CASES[case]
    tolerances = np.array([1e-6, 1e-8, 1e-10])
    how = {"save_at": None} if case == "Andrews" else {}
    found = np.array([error(auto(make(), duration, rtol, method, **how)) for rtol in tolerances])
    agree(found, 0.0, atol=10.0 * tolerances)
    if method in free:
        falls = found[:-1] / found[1:]
        assert np.all((falls > 10.0) & (falls < 1000.0))


def test_absolute_tolerance():
    """With rtol 0 (almost) it is atol that counts, in metres."""
    errors = []
    for atol in (1e-6, 1e-8):
        s = carom.simulate(heavy_top.top(), 0.2, step="auto", rtol=1e-13, atol=atol, save_at=0.2)
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
    assert 2 * evaluations(s) < evaluations(fixed)
    assert s.stats["rejected"] > 0


def test_default_method_and_tolerances():
    """Order 8 from 1e-6 on where nothing strikes or sticks, else from 1e-9 on; `atol` is `rtol` of a size."""
    s = carom.simulate(pendulum(), 1.0)
    assert (s.settings["method"], s.settings["step"]) == ("rk8", "auto")
    assert s.settings["rtol"] == 1e-8
    assert s.settings["atol"] == 1e-8 * s._run.bodies["extent"].min()
    for rtol, smooth, else_ in ((1e-5, "rk5", "rk5"), (1e-6, "rk8", "rk5"), (1e-9, "rk8", "rk8")):
        for scene, method in ((pendulum(), smooth), (on_a_wall(), else_)):
            assert carom.simulate(scene, 0.01, rtol=rtol).settings["method"] == method
    changes = (
        (lambda made: None, "rk8"),
        (lambda made: made.add_stop(made.joints[0], upper=1.0), "rk5"),
        (lambda made: made.set_contact_default(restitution=0.5, friction=0.2), "rk5"),
        (lambda made: made.add_force(forces.JointFriction(made.joints[0], 0.1)), "rk5"),
    )
    for change, method in changes:
        made = chain.scene()
        change(made)
        assert carom.simulate(made, 0.01).settings["method"] == method


def test_bodies_have_steps_of_their_own():
    """A quick top does not shorten the steps of a ball that rolls."""

    def scene(both):
        made = carom.Scene()
        floor = made.add_half_space((0, 0, 0), (0, 0, 1))
        egg = made.add_body(
            carom.Ellipsoid(0.1, 0.07, 0.1), mass=1.0, position=(0, 0, 0.1), velocity=(1.2, 0, 0),
            angular_velocity=(0, 12, 0),
        )  # fmt: skip
        made.add_contact(egg, floor, restitution=0.0, friction=0.8)
        if both:
            made.add_joint(
                joints.Spherical((5, 0, 1)), GROUND,
                made.add_body(mass=1.0, inertia=(1e-3, 1e-3, 2e-3), position=(5, 0, 1.1),
                              angular_velocity=(0, 0, 2000), velocity=(0, 0, 0)),
            )  # fmt: skip
        return made

    how = {"options": carom.Options(max_step=0.01), "rtol": 1e-9, "save_at": 0.1}
    alone, both = (carom.simulate(scene(other), 0.1, **how) for other in (False, True))
    top = both.stats["trial_steps"] - alone.stats["trial_steps"]
    assert top > 10 * alone.stats["trial_steps"]  # steps of 1e-4 s and less
    np.testing.assert_allclose(both.position[:, 0], alone.position[:, 0], rtol=0, atol=1e-14)


def test_longest_step():
    """What flies in closed form goes from one saved state to the next."""
    free = Scene()
    free.add_body(mass=1.0, inertia=[1] * 3)
    s = carom.simulate(free, 1.0)
    assert s.stats["trial_steps"] == 200
    s = carom.simulate(free, 1.0, options=carom.Options(max_step=0.001))
    assert s.stats["trial_steps"] == 1000
    assert len(s.t) == 201
    np.testing.assert_allclose(s.position[-1, 0, 2], -0.5 * 9.81, rtol=1e-14)


def test_progress_is_in_steps():
    calls = []
    s = carom.simulate(pendulum(), 2.0, progress=lambda *done: calls.append(done))
    assert calls == [(k, 200) for k in range(2, 201, 2)]
    without = carom.simulate(pendulum(), 2.0)
    assert np.array_equal(s.position, without.position)


def test_tumbling_in_free_flight():
    """It is exact: nothing bounds the step but what it may be at most."""
    scene = Scene()
    scene.add_body(mass=1.0, inertia=[1, 2, 3], angular_velocity=(3, 0.1, 0.1))
    known = carom.simulate(scene, 10.0, step=1e-3).orientation[-1]
    s = auto(scene, 10.0, 1e-5, save_at=1.0)
    assert np.max(np.abs(s.orientation[-1] - known)) < 1e-13
    assert s.stats["trial_steps"] == 10


def test_ball_comes_to_rest():
    """Bounces higher than the tolerance are resolved: 0.9 m e^(2k) > 1e-6 * .1 m up to k = 11."""
    scene = Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 1))
    scene.add_contact(ball, ground, restitution=0.5)
    s = carom.simulate(scene, 2.0, rtol=1e-6, atol=0.0)
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


def test_a_run_without_an_end_is_ended():
    """2^63 N m on a hinge: it turns 1e17 times in .02 s. The step meets the tolerances, and there is no end."""
    scene = carom.Scene()
    body = scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0)
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, body)
    scene.add_force(forces.JointForce(hinge, 2.0**63))
    s = carom.simulate(scene, 0.02, throw=False)
    assert s.status is carom.Status.STEP_TOO_SMALL
    assert s.stats["trial_steps"] < 400_000
    assert 0.0 < s.t[-1] < 1e-6


def test_a_step_too_small_ends_the_run():
    """A damper that stops the bob within 1e-17 s: no explicit step is short enough."""
    s = carom.simulate(stiff(1e17), 1.0, step="auto", throw=False)
    assert s.status is carom.Status.STEP_TOO_SMALL
    assert "Raise rtol and atol" in s.message
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
        ({"method": "rk4"}, r"""step must be a number for method='rk4': only "rk5" or "rk8" estimate their"""),
        ({"method": "rattle"}, r"step must be a number for method='rattle'"),
        ({"impact_location": "project"}, r"step must be a number for impact_location='project'"),
        ({"rtol": 0.0}, r"rtol must be finite and at least 1e-13 and at most 0.1, got 0.0"),
        ({"rtol": 1.0}, r"rtol must be .* got 1.0"),
        ({"rtol": math.nan}, r"rtol must be .* got nan"),
        ({"atol": -1e-9}, r"atol must be finite and at least 0 \[m\], got -1e-09"),
        ({"step": 0.01, "rtol": 1e-6}, r"rtol must be left out with a given step, got 1e-06"),
        ({"step": 0.01, "atol": 1e-9}, r"atol must be left out with a given step, got 1e-09"),
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
