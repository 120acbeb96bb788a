"""How a run ends is said by what was given: a function that fails is named with what it did, and when.

The function of a random scene turns bad at a random time T: it raises an error, or returns nan or infinity.
No step before T may suffer from it, so the run ends at T less one step at the earliest, and the time that is
named is the first call of the function from T on in the step that failed: between T and T plus one step.
"""

import re
import warnings

import numpy as np
import pytest

import carom
from carom import Status, constraints, forces, joints
from carom.generalized import GeneralizedSystem

KINDS = ("motor", "torque", "wind", "pressed", "potential", "motion", "coupled", "rows", "surface")
OWN = ("force", "metric", "potential", "constraint", "gap", "potential_gradient")
WRONG = ("raise", "nan", "inf")


def turning(rng, T, wrong, good):
    """A function that returns good(*arguments) until its first argument, the time, is beyond T."""
    which = rng.uniform()

    def function(t, *arguments):
        value = np.array(good(t, *arguments), dtype=float)
        if t > T:
            if wrong == "raise":
                raise ArithmeticError("out of range")
            flat = value.reshape(-1)
            flat[int(which * flat.size)] = np.inf if wrong == "inf" else np.nan
        return value if value.ndim else float(value)

    return function


def scene_of(kind, rng, T, wrong):
    """A random scene with a bad function of this kind, and how its message begins."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    size, amount = rng.uniform(0.05, 0.2), rng.uniform(0.01, 0.5)
    turn = lambda good: turning(rng, T, wrong, good)  # noqa: E731
    if kind in ("motor", "torque", "motion", "coupled"):
        last, axis = carom.GROUND, rng.normal(size=3)
        for k in range(int(rng.integers(1, 4))):
            body = scene.add_body(carom.Box(size, size, size), mass=1.0, position=(k + 0.5, 0, 0))
            kind_of = (
                joints.Prismatic(axis) if kind == "motion" else joints.Revolute((k, 0, 0), axis)
            )
            last_joint = scene.add_joint(kind_of, last, body)
            last = body
        if kind in ("motion", "coupled"):
            motion = turn(lambda t: (amount * t**2, 2 * amount * t, 2 * amount))
            scene.add_constraint(constraints.Driver(last_joint, motion=motion), name=kind)
            return scene, f"The motion of {kind!r}"
        function = turn(lambda t, q, rate: amount * np.sin(5 * t) - 0.1 * rate)
        scene.add_force(forces.JointForce(last_joint, function), name=kind)
        return scene, f"The force {kind!r}"
    bodies = [
        scene.add_body(carom.Sphere(size), mass=1.0, position=(k, 0, size))
        for k in range(int(rng.integers(1, 4)))
    ]
    if kind in ("rows", "surface"):  # the first body moves in a plane
        row = turn(lambda t, poses: [[0, 1.0, 0, 0, 0, 0, 0]])
        position = None
        if kind == "surface":
            row, position = lambda t, poses: [[0, 1.0, 0, 0, 0, 0, 0]], turn(lambda t, p: p[0, 1:2])
        rows = constraints.Rows(bodies[0], row, 1, position)
        scene.add_constraint(rows, name=kind)
        said = f"The constraint {kind!r}"
        return scene, said if position is None else f"The position of the constraint {kind!r}"
    if kind == "pressed":  # lies, and is pressed to the floor
        floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
        scene.set_contact_default(restitution=0.5, friction=0.3)
        assert floor is not None
    push = lambda t, states: np.tile([0.0, amount, -amount, 0, 0, 0], (len(bodies), 1))  # noqa: E731
    if kind == "potential":
        energy = turn(lambda t, states: amount * np.sum(states[:, 2] - states[:, 1]))
        scene.add_force(forces.UserForce(bodies, push, energy), name=kind)
        return scene, f"The potential of the force {kind!r}"
    scene.add_force(forces.UserForce(bodies, turn(push)), name=kind)
    return scene, f"The force {kind!r}"


def ended(scene, duration, step):
    """Run to a failure; return the solution, the error, and the time that it names."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        with pytest.raises(carom.SimulationError) as caught:
            carom.simulate(scene, duration, **({} if step is None else {"step": step}))
    solution = caught.value.solution
    found = re.search(r" at t = ([-+.e\d]+) s\.", str(caught.value))
    assert found, str(caught.value)
    return solution, caught.value, float(found[1])


@pytest.mark.few(19)
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("kind", KINDS)
def test_a_function_that_fails_is_named(kind, seed):
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    T, wrong = rng.uniform(0.02, 0.4), WRONG[seed % 3]
    step = None if seed % 2 else 10.0 ** rng.uniform(-3, -1.5)
    scene, name = scene_of(kind, rng, T, wrong)
    solution, error, at = ended(scene, 0.5, step)
    assert solution.status is Status.FUNCTION_FAILED, error
    what = "raised ArithmeticError: out of range" if wrong == "raise" else f"returned {wrong}"
    assert str(error).startswith(f"{name} {what} at t = ")
    longest = 0.5 / 200 if step is None else step
    # nine digits are said; rows are differentiated over a short time
    assert T - 1e-8 <= at <= T + longest + 1e-6
    assert T - longest - 1e-6 <= solution.t[-1] <= T + longest
    assert type(error.__cause__) is (ArithmeticError if wrong == "raise" else ValueError)
    assert np.all(np.isfinite(solution.position))
    assert solution.stats["trial_steps"] < 3000  # no step is short enough: it is told at once


def test_functions_that_numba_has_compiled_are_named():
    # They note nothing themselves: the step that failed is taken once more with Python calling them.
    from numba import njit

    @njit
    def raises(t, q, rate):
        if t > 0.1037:
            raise ValueError("no value")
        return 0.1

    @njit
    def is_nan(t):
        return (t * t if t < 0.1037 else np.nan), 2.0 * t, 2.0

    @njit
    def energy(t, states):
        return np.nan if t > 0.1037 else 0.0

    @njit
    def none(t, states):
        return np.zeros((1, 6))

    for step in (None, 0.01):
        for k in range(3):
            scene = carom.Scene()
            body = scene.add_body(carom.Box(0.1, 0.1, 0.4), mass=1.0, position=(0, 0, -0.2))
            hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, body)
            if k == 0:
                scene.add_force(forces.JointForce(hinge, raises), name="a")
            elif k == 1:
                scene.add_constraint(constraints.Driver(hinge, motion=is_nan), name="a")
            else:
                scene.add_force(forces.UserForce([body], none, energy), name="a")
            solution, error, at = ended(scene, 0.5, step)
            said = ("force 'a' raised ValueError: no value", "motion of 'a' returned nan",
                    "potential of the force 'a' returned nan")[k]  # fmt: skip
            assert said in str(error)
            assert solution.status is Status.FUNCTION_FAILED
            assert 0.1037 <= at <= 0.1037 + (step or 0.5 / 200)


@pytest.mark.few(11)
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("kind", OWN)
def test_a_function_of_own_coordinates_is_named(kind, seed):
    # A point at q = (t, y), whose functions turn bad at q[0] > T; gradients are differences.
    rng = np.random.default_rng([seed, 100 + OWN.index(kind)])
    T, wrong = rng.uniform(0.02, 0.4), WRONG[seed % 3]
    bad = lambda q, good: turning(rng, T, wrong, lambda t: good)(q[0])  # noqa: E731
    given = {
        "metric": lambda q: np.eye(2),
        "force": lambda t, q, v: [0.0, 0.1],
        "potential": lambda q: 0.3 * q[1],
        "potential_gradient": lambda q: [0.0, 0.3],
        "constraint": lambda q: [q[1] - q[1] * 0.5 - 0.5],
    }
    if kind == "potential":
        del given["potential_gradient"]
    if kind in ("gap", "force"):
        del given["constraint"]
    of = {
        "metric": np.eye(2),
        "force": [0.0, 0.1],
        "potential": 0.3,
        "potential_gradient": [0.0, 0.3],
    }
    if kind == "force":
        given[kind] = lambda t, q, v: bad(q, of[kind])
    elif kind == "constraint":
        given[kind] = lambda q: bad(q, [0.5 * q[1] - 0.5])
    elif kind != "gap":
        given[kind] = lambda q: bad(q, of[kind])
    system = GeneralizedSystem(given.pop("metric"), [0.0, 1.0], [1.0, 0.0], **given)
    if kind == "gap":
        system.add_contact(lambda q: bad(q, 10.0 + q[1]), restitution=0.5)
    step = None if seed % 2 else 10.0 ** rng.uniform(-3, -1.5)
    solution, error, at = ended(system, 0.5, step)
    assert solution.status is Status.FUNCTION_FAILED
    name = "gap of contact 0" if kind == "gap" else kind
    what = "raised ArithmeticError: out of range" if wrong == "raise" else f"returned {wrong}"
    assert str(error).startswith(f"The function {name!r} {what} at t = ")
    longest = step or 0.5  # no contact limits the step by tolerances
    # differences call a function 1.5e-3 beside a state
    assert T - 0.01 <= at <= T + longest
    assert T - longest - 0.01 <= solution.t[-1] <= T + 1e-9


def test_a_trial_step_may_meet_nan():
    # A root of what is negative beyond the turning point, which steps by tolerances try and do without.
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0), velocity=(0.0, 0, 0))
    slide = scene.add_joint(joints.Prismatic((1, 0, 0)), carom.GROUND, body)
    calls = []

    def push(t, q, rate):
        with np.errstate(invalid="ignore"):
            value = float(np.sqrt(0.02 - q))  # q'' = sqrt(.02 - q): reaches q = .01 at about .4 s
        calls.append(value)
        return value

    scene.add_force(forces.JointForce(slide, push))
    solution = carom.simulate(scene, 0.3)
    assert solution.success
    assert solution.message == "The run reached its end."
    assert (
        solution._run.compiled.functions.calls == len(calls) - 1
    )  # and one in the check before it


def test_a_large_number_is_none_that_is_not_finite():
    # 1e300 m/s^2 is finite: the motion has diverged, and no function is to blame.
    system = GeneralizedSystem(
        lambda q: [[1.0]], [1.0], [1.0], force=lambda t, q, v: [0.0 if t < 0.1 else 1e300]
    )
    with np.errstate(all="ignore"):
        run = carom.simulate(system, 0.5, step=0.01, throw=False)
    assert run.status is not Status.FUNCTION_FAILED


def test_what_costs_is_counted_and_shown(capsys):
    # Two balls that bounce: the one with e = .9 strikes more often in the same time.
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    for x, e, name in ((0, 0.1, "dull"), (5, 0.9, "lively")):
        body = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(x, 0, 0.2), name=name)
        scene.add_contact(body, floor, restitution=e)
    a = carom.simulate(scene, 1.0, step=0.01, progress=True)
    contact = a.events.contact
    most = np.argmax(np.bincount(contact))
    assert a.stats["busiest_contact"] == a.scene.contacts[most].name == "lively-floor"
    assert a.stats["busiest_events"] == np.sum(contact == most)
    said = capsys.readouterr().err.split("\r")[-1]
    assert f"events, {a.stats['busiest_events']} of them of 'lively-floor'" in said
    fall = carom.simulate(scene, 0.1, step=0.01)
    assert (fall.stats["busiest_contact"], fall.stats["busiest_events"]) == ("", 0)


def test_an_event_without_a_number_is_named():
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0)

    def height(t, state):
        return 1.0 if t < 0.1 else 1.0 / 0.0

    a = carom.simulate(scene, 0.3, step=0.01, events=[height], throw=False)
    assert a.message.startswith("Events[0] (height) raised ZeroDivisionError: ")
    assert 0.1 <= float(re.search(r"at t = ([.\d]+) s", a.message)[1]) <= 0.11


def test_what_is_advised_fits_what_was_given():
    # Nobody who has given no step is told to take a smaller one.
    for status in Status:
        by_step, by_rtol = (
            status.advice("Take a smaller step than 0.01 s"),
            status.advice("Lower rtol"),
        )
        assert "smaller step" not in by_rtol
        assert ("Lower rtol" in by_rtol) == ("smaller step" in by_step)
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1e-9, inertia=(1, 1, 1))
    push = lambda t, states: [[0.0 if t < 0.2 else 1e300, 0, 0, 0, 0, 0]]  # noqa: E731
    scene.add_force(forces.UserForce([body], push))
    a = carom.simulate(scene, 1.0, throw=False, rtol=1e-6)
    assert "Lower rtol (it is 1e-06)" in a.message or "Raise rtol" in a.message
    a = carom.simulate(scene, 1.0, throw=False, step=0.01)
    assert "Take a smaller step than 0.01 s" in a.message
