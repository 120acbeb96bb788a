"""Runs that end early: status, message, solution up to there; progress and interruption."""

import numpy as np
import pytest

import carom
from carom import SimulationError, Status, joints
from simulate.scenes import ball, die, on_plane, turn, zeno_time


def check_failure(status, scene, duration, **settings):
    """The same run with throw=False and throw=True; returns the solution."""
    a = carom.simulate(scene, duration, throw=False, **settings)
    assert a.status is status
    assert not a.success
    assert a.message.startswith(status.cause)
    assert "reached t = " in a.message
    with pytest.raises(SimulationError, match="reached t = ") as error:
        carom.simulate(scene, duration, **settings)
    solution = error.value.solution
    assert solution.status is status
    np.testing.assert_array_equal(solution.t, a.t)
    assert str(error.value) == a.message
    assert 0 <= a.t[-1] < duration
    return a


@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_bounces_without_hold(method):
    # e = .5 comes to rest at .856705873756; without holding, impacts accumulate there.
    options = carom.Options(hold=False, max_impacts_per_step=30)
    a = check_failure(
        Status.TOO_MANY_IMPACTS, ball(0.5), 2.0, step=0.01, options=options, method=method
    )
    assert len(a.impacts) > 30
    # the last bounces are of the round-off of the gap, 1e-14 m, that is of 1e-7 s each
    assert a.impacts.time[-1] == pytest.approx(zeno_time(0.5), abs=2e-6)
    assert abs(a.t[-1] - zeno_time(0.5)) <= 0.01
    # before the Zeno time the run is whole
    assert carom.simulate(ball(0.5), 0.8, step=0.01, options=options, method=method).success


@pytest.mark.parametrize("shape", [carom.Sphere(0.1), carom.Box(0.2, 0.2, 0.2)])
def test_a_driver_that_moves_a_body_into_the_floor(shape):
    # At 0.2 m/s from 0.1 m above it: nothing can yield at .5 s, when the body is there.
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    body = scene.add_body(shape, mass=1.0, position=(0, 0, 0.2), velocity=(0, 0, -0.2))
    way = scene.add_joint(joints.Prismatic((0, 0, 1)), carom.GROUND, body)
    scene.add_constraint(carom.constraints.Driver(way, rate=-0.2))
    scene.add_contact(body, floor, restitution=0.5, friction=0.3)
    a = check_failure(Status.BLOCKED, scene, 1.0, step=0.01)
    assert a.t[-1] == pytest.approx(0.5, abs=1e-12)
    assert len(a.impacts) == 0
    assert np.max(np.abs(a.ledger.residual)) < 1e-12


def press(shape, count, e, mu, **limits):
    """A stack on the floor and a plate .04 m above it, which a motor moves down at .2 m/s."""
    scene, height = carom.Scene(), 0.0
    below = scene.add_half_space((0, 0, 0), (0, 0, 1))
    for _ in range(count):
        body = scene.add_body(shape, mass=1.0, position=(0, 0, height + 0.05))
        scene.add_contact(body, below, restitution=e, friction=mu)
        below, height = body, height + 0.1
    place = (0, 0, height + 0.05)
    plate = scene.add_body(
        carom.Box(0.3, 0.3, 0.02), mass=5.0, position=place, velocity=(0, 0, -0.2)
    )
    scene.add_contact(plate, below, restitution=e, friction=mu)
    way = scene.add_joint(joints.Prismatic((0, 0, 1), place), carom.GROUND, plate)
    scene.add_constraint(carom.constraints.Driver(way, rate=-0.2, **limits))
    return scene


@pytest.mark.parametrize(("e", "mu"), [(0.0, 0.3), (0.5, 0.0), (1.0, 0.3)])
@pytest.mark.parametrize(
    ("shape", "count"), [(carom.Box(0.1, 0.1, 0.1), 3), (carom.Sphere(0.05), 1)]
)
def test_a_motor_that_presses_a_stack_together(shape, count, e, mu):
    # The plate is on the stack at .2 s, and none of the bodies can yield.
    run = carom.simulate(press(shape, count, e, mu), 1.0, throw=False)
    assert run.status is Status.BLOCKED
    assert "limit=" in run.message
    assert 0.2 - 1.0 / 200 <= run.t[-1] <= 0.2 + 1e-12  # the last end of a step before
    assert len(run.warnings) == 0
    assert len(run.impacts) == 0
    assert np.max(np.abs(run.ledger.residual)) < 1e-12


def test_a_motor_with_a_limit_presses_a_stack():
    # The motor yields at 100 N, and the plate comes to rest on the stack, at its height.
    scene = press(carom.Box(0.1, 0.1, 0.1), 3, 0.0, 0.3, limit=100.0)
    s = carom.simulate(scene, 0.5)
    assert s.position[-1, -1, 2] == pytest.approx(0.31, abs=1e-9)
    np.testing.assert_allclose(s.velocity[-1], 0.0, atol=1e-9)


@pytest.mark.parametrize("e", [(1.0, 0.0), (0.5, 0.0), (0.0, 0.0)])
def test_a_motor_that_closes_the_room_between_two_plays(e):
    # theta_2 >= theta_1 - p and theta_2 <= q - theta_1 leave no room from theta_1 = (p + q)/2 on.
    scene, p, q, rate = carom.Scene(gravity=(0, 0, 0)), 0.1, 0.3, 2.0
    turns = []
    for k in range(2):
        wheel = scene.add_body(
            carom.Cylinder(0.1, 0.05), mass=1.0, position=(0.5 * k, 0, 0),
            angular_velocity=(0, 0, rate * (k == 0)),
        )  # fmt: skip
        turns.append(
            scene.add_joint(joints.Revolute((0.5 * k, 0, 0), (0, 0, 1)), carom.GROUND, wheel)
        )
    first, second = turns
    scene.add_constraint(carom.constraints.Driver(first, rate=rate))
    scene.add_play({second: 1.0, first: -1.0}, -p, 1.0, restitution=e[0])
    scene.add_play({second: 1.0, first: 1.0}, -1.0, q, restitution=e[1])
    a = carom.simulate(scene, 1.0, throw=False)
    assert a.status is Status.BLOCKED
    closed = 0.5 * (p + q) / rate
    assert closed - 1.0 / 200 <= a.t[-1] <= closed + 1.0 / 200  # within the time-stepping step


def test_no_convergence():
    scene = carom.Scene()
    scene.add_body(mass=1, inertia=(1, 2, 3), angular_velocity=(1, 2, 3))
    options = carom.Options(max_iterations=1)
    a = check_failure(Status.NO_CONVERGENCE, scene, 1.0, step=0.1, method="paper", options=options)
    assert a.t[-1] == 0.0
    assert "max_iterations" in a.message


def test_step_cut_to_nothing():
    # A cube spins a hair above the plane; one halving cannot exclude a touch, and no contact may be held.
    cube = {
        "shape": carom.Box(0.1, 0.1, 0.1), "mass": 1, "angular_velocity": (0, 40, 0),
        "position": (0, 0, 0.1 / np.sqrt(2) * (1 + 1e-6)),
    }  # fmt: skip
    scene = on_plane(cube, gravity=(0, 0, 0))
    options = carom.Options(max_cuts=1, hold=False)
    check_failure(Status.STEP_CUT_TO_NOTHING, scene, 1.0, step=np.pi / 80, options=options)


def test_motion_that_diverges():
    # From t = 1 s on a force whose acceleration is beyond the largest number.
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1e-9, inertia=(1, 1, 1))

    def push(t, states):
        return [[0.0 if t < 1.0 else 1e300, 0, 0, 0, 0, 0]]

    scene.add_force(carom.forces.UserForce([body], push))
    a = check_failure(Status.NOT_FINITE, scene, 100.0, step=0.1)
    assert len(a.t) == 11  # the last step is cut to its shortest: the last stage of that is at 1 s
    assert 1.0 - 0.1 / 1024.0 <= a.t[-1] < 1.0


@pytest.mark.parametrize(
    "attitude", [turn((0, 1, 0), 0.6), turn((1, 2, 0.5), 0.7)], ids=["edge", "vertex"]
)
def test_a_box_that_needs_several_points(attitude):
    # A box that falls on an edge or a vertex, then on others, comes to rest on a face.
    box = {
        "shape": carom.Box(0.1, 0.1, 0.1), "mass": 1, "position": (0, 0, 0.2),
        "orientation": attitude,
    }  # fmt: skip
    scene = on_plane(box, contact={"restitution": 0.2, "friction": 0.5})
    a = carom.simulate(scene, 5.0, step=1e-3)
    assert len(a.impacts) > 3
    assert np.all(a.velocity[-1] == 0.0)
    assert np.all(a.position[-1] == a.position[-1000])
    assert a.position[-1, 0, 2] == pytest.approx(0.05, abs=1e-12)
    assert np.max(a.ledger.residual) < 1e-6 * a.total_energy[0]


@pytest.mark.few(4)
@pytest.mark.parametrize("seed", range(12))
def test_every_thrown_die_ends(seed):
    # Whatever the throw: the run ends, by itself or with a status, its states finite and above the plane.
    rng = np.random.default_rng(seed)
    q = rng.normal(size=4)
    scene = die(rng.normal(size=3) * 20, 0.2, law="stronge", orientation=q / np.linalg.norm(q))
    a = carom.simulate(scene, 1.0, step=1e-3, throw=False)
    assert a.success
    assert np.all(np.isfinite(a.position))
    assert np.min(a.position[:, 0, 2]) > 0.01 * (1 - 1e-6)
    assert np.all(np.diff(a.ledger.impacts) <= 1e-15)
    # held motion is of order 2 in the step; events are exact
    assert np.max(np.abs(a.ledger.residual)) < 1e-6 * a.total_energy[0]
    assert np.all(np.diff(a.t) > 0)


@pytest.mark.plain
def test_progress_is_called():
    calls = []
    carom.simulate(
        ball(1.0), 0.2, step=0.02, progress=lambda done, total: calls.append((done, total))
    )
    assert calls[-1] == (10, 10)
    done = [d for d, _ in calls]
    assert done == sorted(done)
    assert {total for _, total in calls} == {10}


def test_progress_does_not_change_the_run():
    a = carom.simulate(ball(0.8), 2.0, step=0.001, progress=lambda done, total: None)
    b = carom.simulate(ball(0.8), 2.0, step=0.001)
    np.testing.assert_array_equal(a.position, b.position)
    np.testing.assert_array_equal(a.impacts.time, b.impacts.time)


def test_a_bar_appears_by_itself_on_a_terminal(capsys, monkeypatch):
    from carom.io import progress

    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    assert carom.simulate(ball(0.8), 0.2, step=0.1).success
    assert capsys.readouterr().err == ""  # no terminal
    monkeypatch.setattr(progress, "is_watched", lambda: True)
    assert carom.simulate(ball(0.8), 0.2, step=0.1, progress=False).success
    assert capsys.readouterr().err == ""
    assert carom.simulate(ball(0.8), 0.2, step=0.1).success
    assert "2/2" in capsys.readouterr().err


def test_progress_bar(capsys):
    assert carom.simulate(ball(0.8), 0.2, step=0.001, progress=True).success
    assert "200/200" in capsys.readouterr().err


def test_interruption_hands_back_what_there_is():
    def stop(done, total):
        if done >= 500:
            raise KeyboardInterrupt

    a = carom.simulate(ball(0.8), 2.0, step=0.001, progress=stop, throw=False)
    assert a.status is Status.INTERRUPTED
    assert a.t[-1] == pytest.approx(0.5, abs=0.05)
    whole = carom.simulate(ball(0.8), 2.0, step=0.001)
    np.testing.assert_array_equal(a.position, whole.position[: len(a.t)])
    with pytest.raises(KeyboardInterrupt, match="The run was interrupted") as error:
        carom.simulate(ball(0.8), 2.0, step=0.001, progress=stop)
    assert error.value.solution.status is Status.INTERRUPTED


def test_an_error_in_the_progress_function_comes_out():
    def broken(done, total):
        raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        carom.simulate(ball(0.8), 1.0, step=0.01, progress=broken)


def test_every_status_has_a_sentence():
    for status in Status:
        assert status.message[0].isupper()
        assert status.message.endswith(".")
