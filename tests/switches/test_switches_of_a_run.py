"""Switches in runs that go on, in files, in ensembles, by hand; and what is refused."""

import numpy as np
import pytest

import carom
from carom import GROUND, constraints, forces, joints
from switches.test_switches import boxes, pendulum


def welded():
    """Two boxes that are together from .5 to .8 s."""
    scene = boxes()
    scene.switch("weld", at=0.5, off=False)
    scene.switch("weld", at=0.8)
    return scene


@pytest.fixture(scope="module")
def whole():
    return carom.simulate(welded(), 1.0)


def same(one, other):
    """Assert that two solutions end alike, and had the same switches."""
    np.testing.assert_allclose(one.position[-1], other.position[-1], atol=1e-12)
    np.testing.assert_allclose(one.velocity[-1], other.velocity[-1], atol=1e-12)
    for name in ("part", "on", "switch"):
        assert np.array_equal(getattr(one.switches, name), getattr(other.switches, name))
    np.testing.assert_allclose(one.switches.time, other.switches.time, atol=1e-15)
    np.testing.assert_allclose(one.switches.energy, other.switches.energy, atol=1e-12)


def test_a_file_has_the_switches(whole, tmp_path):
    whole.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    same(loaded, whole)
    assert np.array_equal(loaded.joint_reactions, whole.joint_reactions)
    assert np.array_equal(loaded.evaluate(0.77)[0], whole.evaluate(0.77)[0])
    assert str(loaded.scene.switches) == str(whole.scene.switches)


def test_a_run_goes_on_with_what_was_switched(whole, tmp_path):
    half = carom.simulate(welded(), 0.6)
    same(half.simulate(0.4), whole)
    half.save(tmp_path / "half.nc")
    same(carom.Solution.load(tmp_path / "half.nc").simulate(0.4), whole)
    carom.simulate(welded(), 0.6, save=tmp_path / "saved.nc")
    same(carom.resume(tmp_path / "saved.nc", until=1.0), whole)
    run = carom.Run(half)
    run.advance(0.4)
    same(run.solution, whole)


def test_a_run_of_ones_own_has_the_switches_of_its_scene(whole):
    run = carom.Run(welded())
    for _ in range(2):
        for wait in (0.3, 0.3, 0.4):
            run.advance(wait)
        same(run.solution, whole)
        run.reset()
    run = carom.Run(welded(), step=0.03)
    for _ in range(40):
        run.advance()
    assert run.time == pytest.approx(1.2, rel=1e-12)
    assert {0.5, 0.8} <= set(run.solution.t.tolist())


def test_a_run_switches_by_hand():
    scene = pendulum()
    scene.switch("hinge")
    run = carom.Run(scene, step=0.01)
    run.advance(0.3)
    before = run.state["hinge"].force
    run.switch("hinge")
    assert np.linalg.norm(before) > 1.0
    assert np.all(run.state["hinge"].force == 0.0)
    x, v = run.state["bob"].position, run.state["bob"].velocity
    run.advance(0.3)
    fallen = x + 0.3 * v + 0.045 * np.array([0, 0, -9.81])
    np.testing.assert_allclose(run.state["bob"].position, fallen, atol=1e-12)
    (switched,) = run.solution.switches
    assert switched["time"] == run.time / 2
    assert switched["switch"] == ""
    run.switch("hinge", off=False)
    run.advance(0.1)
    here = run.state["bob"].position, run.solution["hinge"].rate[-1]
    assert np.linalg.norm(here[0]) == pytest.approx(np.linalg.norm(fallen), rel=1e-9)
    run.switch("hinge", off=False)  # it is there
    assert len(run.solution.switches) == 2


def test_an_ensemble_is_made_of_single_runs():
    scene, times = pendulum(), np.linspace(0.3, 0.7, 5)
    scene.switch("hinge", at=0.5, name="release")
    runs = carom.ensemble(scene, 1.0, vary={"release.time": times}, executor="serial")
    for k, t in enumerate(times):
        alone = pendulum()
        alone.switch("hinge", at=t)
        end = carom.simulate(alone, 1.0).position[-1, 0]
        assert np.array_equal(runs["bob"].position[k], end)
    bobs = carom.ensemble(
        pendulum(breaks_at=20.0), 1.0, vary={"bob.mass": [0.5, 1.0, 2.0]}, executor="serial"
    )
    flies = bobs["bob"].position
    assert np.all(np.linalg.norm(flies[1:], axis=1) > 1.1)
    assert np.linalg.norm(flies[0]) < 1.0 + 1e-9


def test_events_and_switches_are_found_together(whole):
    found = carom.simulate(welded(), 1.0, events=[lambda t, state: t - 0.55, "at rest"])
    same(found, whole)
    assert found.t_events[0] == pytest.approx([0.55])
    ended = carom.simulate(pendulum(breaks_at=20.0), 1.0, events=_level)
    assert ended.t_events[0][0] > ended.switches.time[0]


def _level(t, state):
    return state["bob"].position[2] + 2.0


_level.terminal = True


def test_a_named_event_acts_once():
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5), name="ball")
    scene.add_contact(ball, "floor", restitution=0.9)
    scene.add_force(forces.Force((0, 0, 20.0)), ball, name="lift")
    scene.switch("lift", at="first impact of ball and floor", off=False)
    solution = carom.simulate(scene, 1.0)
    (t,) = solution.switches.time
    assert t == pytest.approx(np.sqrt(0.8 / 9.81), abs=1e-9)
    # it rises with 20 - 9.81 m/s^2 from there
    up = 0.9 * np.sqrt(0.8 * 9.81)
    z = 0.1 + up * (1 - t) + 0.5 * (20 - 9.81) * (1 - t) ** 2
    assert solution["ball"].position[-1, 2] == pytest.approx(z, abs=1e-7)


def test_a_scene_states_switches():
    scene = pendulum(breaks_at={"force": 10, "torque": 2, "impulse": 1})
    assert scene["hinge.breaks"].limits == {"force": 10.0, "torque": 2.0, "impulse": 1.0}
    assert "1 switch" in str(scene)
    scene.remove("hinge")
    assert scene.switches == ()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (dict(part="bob"), "part must be"),
        (dict(part="hing"), "did you mean 'hinge'"),
        (dict(part="hinge", at=-1.0), "at must be"),
        (dict(part="hinge", at=[1.0]), "at must be"),
        (dict(part="drive", off=False), "off must be True for 'drive'"),
    ],
)
def test_what_is_no_switch_is_refused(given, message):
    scene = pendulum()
    scene.add_constraint(constraints.Driver("hinge", motion=lambda t: (t, 1.0, 0.0)), name="drive")
    with pytest.raises((ValueError, TypeError), match=message):
        scene.switch(**given)


@pytest.mark.parametrize("limit", [0.0, {}, {"load": 1.0}, {"force": -1.0}])
def test_what_is_no_limit_is_refused(limit):
    with pytest.raises(ValueError, match="breaks_at"):
        pendulum(breaks_at=limit)


def test_a_run_switches_only_what_its_scene_says():
    run = carom.Run(pendulum(), step=0.01)
    with pytest.raises(ValueError, match="part must be that of a switch, got 'hinge'"):
        run.switch("hinge")
    solution = carom.simulate(welded(), 0.1)
    with pytest.raises(ValueError, match="without switches"):
        carom.sensitivities(solution, ["a.velocity"])


def test_the_paper_method_releases_too():
    scene = pendulum()
    scene.switch("hinge", at=0.5)
    solution = carom.simulate(scene, 1.0, step=0.005, method="paper")
    other = carom.simulate(scene, 1.0)
    np.testing.assert_allclose(solution.position[-1], other.position[-1], atol=1e-3)
    assert np.all(solution["hinge"].force[-1] == 0.0)
    assert GROUND.index < 0


def test_a_belt_comes_off():
    scene, wheels = carom.Scene(gravity=(0, 0, 0)), []
    for k in range(2):
        wheel = scene.add_body(
            carom.Cylinder(0.1, 0.02),
            mass=1.0,
            position=(0.5 * k, 0, 0),
            angular_velocity=(0, 0, 1.0),
        )
        wheels.append(wheel)
        scene.add_joint(joints.Revolute((0.5 * k, 0, 0), (0, 0, 1)), GROUND, wheel, name=f"axle{k}")
    belt = scene.add_joint(joints.Belt(0.1, 0.1), *wheels)
    scene.add_force(forces.JointForce("axle0", 0.01))
    scene.switch(belt, at=0.5)
    solution = carom.simulate(scene, 1.0)
    # together M/(2 I), then alone M/I
    np.testing.assert_allclose(solution["axle0"].rate[-1], 1.0 + 0.5 * 1.0 + 0.5 * 2.0)
    np.testing.assert_allclose(solution["axle1"].rate[-1], 1.0 + 0.5 * 1.0)
    with pytest.raises(ValueError, match="left out of a Belt"):
        scene.add_joint(joints.Belt(0.1, 0.1), *wheels, breaks_at=10.0)
    assert len(scene.constraints) == 1


def test_what_begins_off_exerts_nothing_until_it_is_put_in():
    scene = pendulum()
    scene.add_force(forces.Force((0, 0, 5.0)), "bob", name="lift")
    scene.add_force(forces.JointFriction("hinge", 0.3), name="brake")
    for name in ("lift", "brake"):
        scene.switch(name, at=2.0, off=False)
    solution, plain = carom.simulate(scene, 0.5), carom.simulate(pendulum(), 0.5)
    np.testing.assert_allclose(solution.position, plain.position, atol=1e-12)
    assert np.all(solution["lift"].force == 0.0)
    assert np.all(solution["brake"].torque == 0.0)
    np.testing.assert_allclose(solution["hinge"].force, plain["hinge"].force, atol=1e-9)
    assert len(solution.switches) == 0
