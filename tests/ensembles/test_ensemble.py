"""carom.ensemble: runs are those of simulate, bit for bit, whoever makes them; failures; what may be varied."""

import numba
import numpy as np
import pytest
from scipy.stats import norm, uniform

import carom
from ensembles.ensemble_scenes import die, pendulum, two_balls

THROWN = {
    "die.orientation": carom.UniformOrientation(),
    "die.velocity": [norm(0.5, 0.1), 0.0, uniform(-1.0, 0.5)],
    "die-ground.friction": uniform(0.05, 0.4),
}


def throw(**more):
    given = {"step": 2e-3, "vary": THROWN, "runs": 24, **more}
    return carom.ensemble(die(), 0.6, **given)


def same(a, b):
    return a.outcomes.tobytes() == b.outcomes.tobytes() and a.failures == b.failures


def test_the_same_for_any_executor_workers_and_parts():
    """Not close: equal. Runs share arrays with those before them, and must not notice."""
    first = throw(executor="serial", chunk=24)
    assert first.complete
    assert first.counts() == {"success": 24}
    for more in ({"workers": 1}, {"workers": 2, "chunk": 5}, {"workers": 3, "chunk": 1}):
        assert same(first, throw(**more))


def agrees(e, k):
    """Whether run k ended as `simulate` does by itself."""
    s = e.solution(k)
    ends = {"position": s.position, "orientation": s.orientation, "velocity": s.velocity}
    assert e.status[k] == int(s.status)
    assert e.impacts[k] == len(s.impacts)
    return all(np.array_equal(getattr(e, name)[k], values[-1]) for name, values in ends.items())


@pytest.mark.bits
def test_each_run_is_that_of_simulate():
    e = throw()
    assert all(agrees(e, k) for k in range(0, 24, 3))
    assert len(np.unique(e.impacts)) > 3  # they do differ


@pytest.mark.parametrize(
    "vary",
    [
        {"first.angular_velocity": [[0, 0, 0], [0, 0, 0], [0, 0, 0]]},
        {"second-wall.restitution": [0.1, 0.5, 0.9]},
        {"second.mass": [0.5, 1.0, 2.0]},
        {"gravity": [[0, 0, -1.0], [0, 0, -9.81], [1.0, 0, -5.0]]},
        {"second.inertia": [[1e-3, 0.01, 0.01], [1e-3, 0.02, 0.02], [1e-3, 0.04, 0.0395]]},
    ],
    ids=lambda vary: next(iter(vary)),
)
def test_a_mechanism_that_strikes(vary):
    e = carom.ensemble(pendulum(), 0.6, step=2e-3, vary=vary, workers=2, chunk=1)
    assert e.counts() == {"success": 3}
    assert all(agrees(e, k) for k in range(3))
    if "angular" not in next(iter(vary)):
        assert len({e.position[k].tobytes() for k in range(3)}) == 3


@pytest.mark.parametrize("balls", [3, 70], ids=["few", "pairs come as they near"])
def test_a_contact_of_its_own_where_all_pairs_touch(balls):
    scene = carom.Scene()
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    for k in range(balls):
        speed = 4.0 if k == 0 else 0.0
        scene.add_body(
            carom.Sphere(0.1),
            mass=1,
            position=(0.5 * k, 0, 0.5),
            velocity=(speed, 0, 0),
            name=f"ball{k}",
        )
    scene.set_contact_default(restitution=0.5, friction=0.1)
    scene.add_contact("ball0", floor)
    e = carom.ensemble(
        scene, 0.5, step=0.01, vary={"ball0-floor.restitution": [0.2, 0.9, 0.2]}, executor="serial"
    )
    assert all(agrees(e, k) for k in range(3))
    assert e.velocity[0].tobytes() == e.velocity[2].tobytes() != e.velocity[1].tobytes()


@pytest.mark.plain
@pytest.mark.skipif(
    not numba.config.DISABLE_JIT, reason="a minute of compiling for the same arrays"
)
def test_friction_in_a_hinge_begins_anew():
    """Whether a hinge sticks is found at each start, whatever the last run left."""
    spin = [[0, 0, 0], [0, 1.0, 0], [0, 0, 0]]
    e = carom.ensemble(
        pendulum(20.0), 0.03, step=5e-3, vary={"first.angular_velocity": spin},
        executor="serial", options=carom.Options(project_start=True),
    )  # fmt: skip
    assert np.array_equal(e.position[0], e.position[2])
    assert all(agrees(e, k) for k in range(3))  # each start is brought to the joints


@pytest.mark.plain
@pytest.mark.skipif(
    not numba.config.DISABLE_JIT, reason="a minute of compiling for the same arrays"
)
def test_a_function_that_raises_fails_its_own_run_alone():
    def push(t, q, rate):
        if t > 0.006 and rate > 5.0:
            raise ValueError("too fast")
        return 0.0

    scene = pendulum()
    scene.add_force(carom.forces.JointForce(scene.joints[0], push))
    turn, fall = np.outer([0, 9.0, 0], [0, 1, 0]), np.outer([0, -9.0, 0], [0, 0, 1])
    vary = {  # all as one about the first hinge
        "first.angular_velocity": turn, "second.angular_velocity": turn,
        "first.velocity": 0.25 * fall, "second.velocity": 0.75 * fall,
    }  # fmt: skip
    e = carom.ensemble(scene, 0.02, step=5e-3, vary=vary, executor="serial")
    assert (e.status == 0).tolist() == [True, False, True]
    assert list(e.failures) == [1]
    assert np.array_equal(e.position[0], e.position[2])


def test_several_bodies_that_strike_each_other():
    """Islands, contacts of two bodies, persistent contacts: nothing of one run is left in the next."""
    gaps = np.array([0.0, 0.01, 0.02, 0.013])
    at = np.stack([0.01 * np.ones(4), np.zeros(4), 0.16 + gaps], axis=1)
    e = carom.ensemble(two_balls(), 0.5, step=2e-3, vary={"high.position": at}, executor="serial")
    assert e.counts() == {"success": 4}
    assert all(agrees(e, k) for k in range(4))
    back = carom.ensemble(
        two_balls(), 0.5, step=2e-3, vary={"high.position": at[::-1]}, executor="serial"
    )
    assert e.outcomes.tobytes() == back.outcomes[::-1].tobytes()


@pytest.mark.plain
def test_drops_of_a_ball():
    """First impact at sqrt(2 (z - r)/g); also without the compiler, where the arrays are the same ones."""
    z = np.array([0.11, 0.12, 0.115])
    at = np.stack([np.zeros(3), np.zeros(3), z], axis=1)
    scene = carom.Scene(gravity=(0, 0, -9.81))
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.2), name="ball")
    scene.add_contact(ball, floor, restitution=0.5, friction=0.0)
    e = carom.ensemble(
        scene, 0.08, step=5e-3, vary={"ball.position": at}, executor="serial", chunk=2
    )
    np.testing.assert_allclose(e.first_impact, np.sqrt(2 * (z - 0.1) / 9.81), rtol=1e-12)
    assert all(agrees(e, k) for k in range(3))


def test_whole_scenes():
    e = carom.ensemble(
        two_balls, 0.4, step=2e-3, vary={"gap": uniform(0.0, 0.03), "friction": uniform(0.1, 0.4)}, runs=4
    )  # fmt: skip
    assert e.counts() == {"success": 4}
    assert all(agrees(e, k) for k in range(4))
    assert len(np.unique(e.position[:, 1, 0])) == 4


def test_a_run_that_cannot_begin_stops_nothing():
    at = np.array([[0, 0, 0.1], [0, 0, 0.005], [0, 0, 0.2]])
    e = carom.ensemble(die(), 0.3, step=2e-3, vary={"die.position": at})
    assert e.counts() == {"refused": 1, "success": 2}
    assert list(e.failures) == [1]
    assert "deep into 'ground'" in e.failures[1]
    assert np.isnan(e.t[1])
    assert np.array_equal(e.inputs["die.position"], at)
    assert agrees(e, 2)


def test_a_run_that_fails_is_kept_with_its_status():
    options = carom.Options(max_impacts_per_step=1, hold=False)
    e = carom.ensemble(
        die(), 1.0, step=0.05, options=options, vary={"die-ground.restitution": [0.1, 0.2]}
    )
    assert e.counts() == {"too_many_impacts": 2}
    assert "max_impacts_per_step" in e.failures[0]
    assert np.all(e.t < 1.0)
    assert agrees(e, 1)


def test_when_a_die_comes_to_rest():
    e = throw(runs=12)
    late = carom.ensemble(
        die(), 1.5, step=2e-3, vary={name: e.inputs[name] for name in THROWN}, workers=2
    )
    assert np.all(np.isfinite(late.rest_time))
    k = int(np.argmin(late.rest_time))
    s = late.solution(k)
    moves = np.any(s.velocity != 0, axis=(1, 2)) | np.any(s.angular_velocity != 0, axis=(1, 2))
    assert late.rest_time[k] == s.t[np.flatnonzero(moves)[-1] + 1]
    assert np.all(late.kinetic_energy == 0.0)
    # all that there was is gone to impacts, friction and bounces that were not resolved
    start = 0.5 * 0.016 * np.sum(e.inputs["die.velocity"] ** 2, axis=1)
    start += 0.5 * (0.016 * 0.02**2 / 6) * 10.0**2 + 0.016 * 9.81 * (0.1 - 0.01)
    lost = late.impact_loss + late.friction_loss + late.bounce_loss
    assert np.max(np.abs(lost / start - 1.0)) < 2e-6  # as in a die at rest, step 2 ms


def observed(solution):
    return {"bounces": len(solution.impacts), "top": solution.position[:, 0, 2].max()}


def test_what_is_observed():
    e = throw(runs=6, observe=observed)
    assert np.array_equal(e.observed["bounces"], e.impacts)
    assert e.observed["top"][2] == e.solution(2).position[:, 0, 2].max()
    assert same(e, throw(runs=6))


def one_number(solution):
    return solution.t[-1]


def undefined(solution):
    return {"top": solution.height}


@pytest.mark.parametrize(
    ("observe", "kind", "words"),
    [
        (
            one_number,
            TypeError,
            "observe must return a dict of numbers or arrays by name.*got .*0.1",
        ),
        (undefined, AttributeError, "height"),
        (lambda solution: {"top": solution}, TypeError, "observe must return numbers or arrays"),
        (lambda solution: {1: 2.0}, TypeError, "observe must return a dict"),
        (lambda solution: {}["top"], KeyError, "top"),
    ],
)
def test_the_first_run_decides_whether_observe_works(observe, kind, words):
    with pytest.raises(kind, match=words) as error:
        carom.ensemble(die(), 0.1, step=2e-3, vary=THROWN, runs=6, chunk=3, observe=observe)
    names = [entry.name for entry in error.traceback]
    raised = kind is not TypeError  # by the function: the traceback has the user's own line
    assert (observe.__name__ in names) == raised
    notes = getattr(error.value, "__notes__", [""])
    assert ("observe, a function" in notes[0]) == raised


def test_observe_that_fails_in_processes_has_the_line_of_the_user():
    with pytest.raises(AttributeError, match="height") as error:
        throw(runs=2, executor="processes", workers=1, observe=undefined)
    assert "in undefined" in str(error.value.__cause__)


def test_observe_may_fail_in_later_runs():
    """The run is kept, the value is missing, and a message says why."""

    def sometimes(solution):
        if solution.velocity[0, 0, 2] < -0.6:
            raise ValueError("too fast")
        return {"n": 1 if solution.velocity[0, 0, 2] > -0.4 else 1.5}

    vary = {"die.velocity": [[0, 0, -0.3], [0, 0, -0.7], [0, 0, -0.5], [0, 0, -0.5]]}
    for chunk in (2, 4):
        e = carom.ensemble(die(), 0.05, step=2e-3, vary=vary, observe=sometimes, chunk=chunk)
        assert e.failures == {1: "observe: ValueError: too fast"}
        assert e.counts() == {"success": 4}
        assert e.observed["n"][[0, 2, 3]].tolist() == [
            1.0,
            1.5,
            1.5,
        ]  # no number is cut to an integer


@pytest.mark.bits
def test_processes():
    assert same(throw(runs=4), throw(runs=4, executor="processes", workers=1, chunk=2))


@pytest.mark.bits
def test_by_tolerance():
    e = carom.ensemble(die(), 0.3, rtol=1e-7, vary=THROWN, runs=3)
    assert all(agrees(e, k) for k in range(3))
    assert not same(e, carom.ensemble(die(), 0.3, vary=THROWN, runs=3))  # 1e-8


@pytest.mark.bits
def test_workspace_is_no_state():
    """What impacts of several corners have left in their workspace is nothing to the next run."""
    e = carom.ensemble(die(), 0.6, step=2e-3, vary=THROWN, runs=60, executor="serial")
    assert e.impacts.max() > 30
    assert all(agrees(e, k) for k in range(0, 60, 4))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"vary": {}}, "vary must have at least one name"),
        ({"vary": {"dice.velocity": [[0, 0, 0]]}}, "did you mean 'die.velocity'"),
        ({"vary": {"die.velocity": [[0, 0]]}}, r"shape \(runs, 3\)"),
        ({"vary": {"die-ground.restitution": [0.5, 1.2]}}, "from 0 to 1, got 1.2 in run 1"),
        ({"vary": {"die.orientation": [[1, 0, 0, 1]]}}, "unit quaternions"),
        ({"vary": {"die.mass": [-1.0]}}, "above 0"),
        ({"vary": {"die.mass": uniform(1, 2)}}, "runs must be given"),
        ({"vary": {"die.mass": [1.0, 2.0]}, "runs": 3}, "3 values, one for each run, got 2"),
        ({"vary": {"die.mass": 1.0}}, "axis over the runs"),
        ({"vary": {"die.mass": "heavy"}}, "a SciPy distribution"),
        ({"sampling": "sobl"}, "did you mean 'sobol'"),
        ({"executor": "thread"}, "did you mean 'threads'"),
        ({"workers": 0}, "workers"),
        ({"chunk": 0}, "chunk"),
        ({"step": -1.0}, "step"),
    ],
)
def test_bad_input(change, words):
    given = {"step": 1e-3, "vary": {"die.mass": uniform(1, 2)}, "runs": 2, **change}
    if "vary" in change and "runs" not in change:
        given["runs"] = None
    with pytest.raises(ValueError, match=words):
        carom.ensemble(die(), 0.1, **given)


def test_bad_types():
    with pytest.raises(TypeError, match="scene must be"):
        carom.ensemble("die", 0.1, step=1e-3, vary=THROWN, runs=2)
    with pytest.raises(TypeError, match="executor must be"):
        throw(executor=3)
    with pytest.raises(TypeError, match="observe"):
        throw(observe=3)
    with pytest.raises(AttributeError, match="speed"):
        _ = throw(runs=1).speed
