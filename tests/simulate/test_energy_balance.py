"""The balance of energy is watched, and what is off is said."""

import warnings

import numpy as np
import pytest

import carom
from carom import GROUND, Status, constraints, forces, joints
from carom._compiled.decorators import entry
from carom.contact.depth import watch_depth
from carom.results.accuracy import inaccurate, sentences, watched
from carom.results.ledger import Ledger
from simulate.scenes import G

FINER = "Take a smaller step"
TOLERANCE = carom.Options().energy_tolerance
AS_THEY_ARE = carom.Options(energy_tolerance=1.0)  # steps are not cut for what they lose


def spring(stiffness, damping=0.0, height=0.0, gravity=0.0):
    """A ball of 1 kg on a spring that is stretched by 1 cm, `height` above the origin."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, height - 1.01))
    ends = (0, 0, height), (0, 0, height - 1.01)
    scene.add_force(forces.Spring(stiffness, *ends, rest_length=1.0, damping=damping), ball)
    return scene


def quiet(*given, **named):
    """Simulate without raising or warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return carom.simulate(*given, throw=False, **named)


def exchanged(solution):
    """Return the largest energy exchanged, from the ledger."""
    a = solution.ledger
    lines = (a.kinetic, a.potential - a.potential[0], a.loads, a.impacts, a.friction, a.bounces)
    return max(np.max(np.abs(line)) for line in lines)


@pytest.mark.parametrize(
    ("h_omega", "status", "warns"),
    [
        # RK4 multiplies the energy of an oscillator by 1 - (h w)^6/72 + ... a step, and beyond 2 sqrt(2) it
        # grows: steps are cut until each has less than 1e-7
        (0.1, Status.SUCCESS, False),
        (0.3, Status.SUCCESS, False),
        (1.0, Status.SUCCESS, False),
        (10.0, Status.SUCCESS, False),
        # ... but where 1/1024 of the step is not enough: 1e5 steps lose 1e-3 at h w = 100/1024, then all
        (100.0, Status.SUCCESS, True),
        (1000.0, Status.INACCURATE, True),
        (1e6, Status.UNSTABLE, False),
    ],
)
def test_an_oscillator(h_omega, status, warns):
    solution = quiet(spring((h_omega / 5e-3) ** 2), 0.5, step=5e-3)
    assert solution.status is status
    assert bool(solution.warnings) == warns
    if status is not Status.UNSTABLE:
        # the shortest step may gain a quarter of what it exchanges, and no more than that
        assert np.max(solution.total_energy) < 2.0 * solution.total_energy[0]


@pytest.mark.few(6)
@pytest.mark.parametrize("h_lambda", [0.01, 3.0, 100.0, 1e4, 1e6])
@pytest.mark.parametrize("h_omega", [0.1, 1.0, 10.0, 1e3])
def test_a_stiff_spring_and_damper_is_no_success(h_omega, h_lambda):
    # What ends in SUCCESS has the energy that it must have: c s'^2 over the path that was taken, which the
    # ledger works out by the quadrature of the method.
    solution = quiet(spring((h_omega / 5e-3) ** 2, h_lambda / 5e-3), 0.1, step=5e-3)
    if solution.success:
        off = np.max(np.abs(solution.ledger.residual))
        assert off <= 100.0 * TOLERANCE * exchanged(solution)
        assert bool(solution.warnings) == (off > TOLERANCE * exchanged(solution))
    assert solution.success == (h_omega <= 10.0 and h_lambda <= 100.0)


def test_it_is_told_once_and_says_what_to_do():
    with pytest.warns(carom.AccuracyWarning, match="Options.energy_tolerance") as found:
        solution = carom.simulate(spring(60.0**2), 0.5, step=5e-3, method="implicit")
    assert len(found) == 1
    assert solution.success
    (said,) = solution.warnings
    off = np.abs(solution.ledger.residual)
    assert f"at t = {solution.t[np.argmax(off)]:.6g} s" in said
    assert f"{solution.ledger.residual[np.argmax(off)]:.3g} J" in said
    assert "smaller step" in said
    # allowed for, nothing is said
    fine = carom.simulate(
        spring(60.0**2), 0.5, step=5e-3, method="implicit",
        options=carom.Options(energy_tolerance=0.01),
    )  # fmt: skip
    assert fine.warnings == ()


def test_a_run_that_is_inaccurate_is_whole_and_raises():
    with pytest.raises(
        carom.SimulationError, match=r"inaccurate\. .*Energy error that no entry"
    ) as found:
        carom.simulate(spring(200.0**2), 0.5, step=5e-3, method="implicit")
    solution = found.value.solution
    assert solution.t[-1] == 0.5
    assert solution.status is Status.INACCURATE
    assert solution.status.ended
    assert not solution.success
    assert solution.warnings[0] in solution.message


def test_the_zero_of_the_potential_does_not_matter():
    # The same motion 1000 km higher: the same words, up to the round-off of m g z, 1e-9 of what is exchanged.
    low, high = (
        quiet(spring(60.0**2, 0, z, G), 0.5, step=5e-3, method="implicit") for z in (0.0, 1e6)
    )
    assert low.success
    assert high.success
    assert len(low.warnings) == len(high.warnings) == 1
    assert high.ledger.residual[-1] == pytest.approx(low.ledger.residual[-1], rel=1e-3)


def test_save_every_hides_nothing():
    # The step is watched, not the row: what is given back until the next row was gone before.
    every, seldom = (
        quiet(spring(60.0**2), 0.5, step=5e-3, save_every=k, method="implicit") for k in (1, 100)
    )
    assert every.warnings == seldom.warnings


@pytest.mark.parametrize("rtol", [1e-6, 1e-10])
def test_a_whole_period_that_is_saved_at_its_end(rtol):
    """From rest to rest nothing is left of the energy exchanged, k x^2/2; the run has seen it between."""
    period = 2 * np.pi / np.sqrt(50.0)
    solution = carom.simulate(spring(50.0), period, rtol=rtol, save_at=[period])
    assert solution.success
    assert not solution.warnings
    assert abs(solution.position[-1, 0, 2] + 1.01) < 10 * rtol
    # the ends of trial steps are not at the fastest place: a step is less than a radian
    most = solution._run.watch[0].exchanged / (0.5 * 50.0 * 0.01**2)
    assert np.cos(0.5) ** 2 < most < 1.0 + rtol


def test_a_whole_period_in_own_coordinates():
    """A bead of 1 kg with q'' = -50 q, from q = .3 back to it."""
    period = 2 * np.pi / np.sqrt(50.0)
    system = carom.GeneralizedSystem(
        metric=lambda q: np.eye(1),
        potential=lambda q: 25.0 * q[0] ** 2,
        position=[0.3],
        velocity=[0.0],
    )
    solution = carom.simulate(system, period, rtol=1e-10, save_at=[period])
    assert solution.success
    assert not solution.warnings
    assert solution.q[-1, 0] == pytest.approx(0.3, abs=1e-8)


def ledger(**lines):
    zero = np.zeros(5)
    given = {name: np.array(lines.get(name, zero), dtype=float) for name in (
        "kinetic", "potential", "loads", "impacts", "friction", "bounces")}  # fmt: skip
    return Ledger(**given)


@pytest.mark.parametrize("line", ["impacts", "friction", "bounces"])
def test_a_line_that_never_rises(line):
    # 1 J goes, 0.3 J comes back, all of it in the ledger: the sum is right, and the line cannot be.
    change = [0.0, -0.6, -1.0, -0.7, -0.9]
    balance = ledger(kinetic=[2.0 + c for c in change], **{line: change})
    assert np.all(np.abs(balance.residual) < 1e-15)
    watch = watched(np.arange(5.0), balance, 0.0, 2.0, 1e-4)
    assert inaccurate(watch)
    (said,) = sentences(watch, FINER)
    assert "0.3 J at t = 3 s, 0.15 of the largest energy exchanged (2 J)" in said
    if line == "impacts":  # Newton's law with friction says so
        named = watched(np.arange(5.0), balance, np.array([0, 0, 0, 0.3, 0.3]), 2.0, 1e-4)
        assert not inaccurate(named)
        assert sentences(named, FINER) == ()


@pytest.mark.parametrize("unit", [1e-20, 1e20])
def test_round_off_is_relative_to_the_energies(unit):
    # What is said does not depend on the unit: as above in a unit of energy that is tiny, or huge.
    kinetic, impacts = unit * np.array([2.0, 1.0, 1.3]), unit * np.array([0.0, -1.0, -0.7])
    zero = np.zeros(3)
    watch = watched(
        np.arange(3.0), Ledger(kinetic, zero, zero, impacts, zero, zero), 0.0, 2.0 * unit, 1e-4
    )
    assert inaccurate(watch)
    assert "0.15 of the largest energy exchanged" in sentences(watch, FINER)[0]


def test_what_newtons_law_gives_is_named():
    # V8 in a run: a rod at 45 degrees, mu = .8, e = .9, gains by the law itself.
    def run(law):
        scene = carom.Scene(gravity=(0, 0, 0))
        floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
        rod = scene.add_body(
            carom.Box(1.0, 1e-3, 1e-3), mass=1.0, inertia=(1e-3, 1 / 12, 1 / 12), position=(0, 0, 0.5),
            orientation=(np.cos(np.pi / 8), 0, np.sin(np.pi / 8), 0), velocity=(-0.6, 0, -1.0),
        )  # fmt: skip
        scene.add_contact(rod, floor, restitution=0.9, friction=0.8, impact_law=law)
        return carom.simulate(scene, 0.3, step=1e-3)

    newton = run("newton")
    assert newton.ledger.impacts[-1] > 0.05
    (said,) = newton.warnings  # the energy is 81/64 of that before
    assert said.startswith("Newton's law with friction added")
    gain, first = newton.impacts.energy_change.max(), newton.impacts[0]
    assert f"in 1 impacts, at most {gain:.3g} J at t = {first.time:.6g} s" in said
    assert "26.56% of the energy of this impact" in said
    assert "contact 'body1-half_space1'" in said
    for law in ("poisson", "stronge"):
        lossy = run(law)
        assert lossy.ledger.impacts[-1] < 0.0
        assert lossy.warnings == ()


def slide(shape, motion, height=0.0, friction=0.4):
    """A motor swings an arm about a vertical axis; the body at its end lies on the floor, free to rise."""
    scene = carom.Scene(gravity=(0, 0, -G))
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    rate = motion(0.0)[1]
    arm = scene.add_body(
        carom.Box(0.5, 0.05, 0.05), mass=1.0, position=(0.25, 0, 0.5),
        velocity=(0, 0.25 * rate, 0), angular_velocity=(0, 0, rate),
    )  # fmt: skip
    hinge = scene.add_joint(joints.Revolute((0, 0, 0.5), axis=(0, 0, 1)), GROUND, arm)
    body = scene.add_body(
        shape, mass=2.0, position=(0.5, 0, 0.1 + height), velocity=(0, 0.5 * rate, 0),
        angular_velocity=(0, 0, rate),
    )  # fmt: skip
    scene.add_joint(joints.Prismatic(axis=(0, 0, 1)), arm, body)
    scene.add_contact(body, floor, restitution=0.3, friction=friction)
    scene.add_constraint(constraints.Driver(hinge, motion=motion))
    return scene


def test_friction_in_a_joint_whose_body_rubs_on_the_floor():
    # The hinge of a free arm brakes with M, four corners of the block at its end with mu m g R: what the block
    # takes from the speed in a step is taken from the work of M too. Order 2.
    off = []
    for step in (0.01, 0.005, 0.0025):
        scene = carom.Scene(gravity=(0, 0, -G))
        floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
        arm = scene.add_body(
            carom.Box(0.5, 0.05, 0.05), mass=1.0, position=(0.25, 0, 0.5), velocity=(0, 1.25, 0),
            angular_velocity=(0, 0, 5.0),
        )  # fmt: skip
        hinge = scene.add_joint(joints.Revolute((0, 0, 0.5), axis=(0, 0, 1)), GROUND, arm)
        block = scene.add_body(
            carom.Box(0.2, 0.2, 0.2), mass=2.0, position=(0.5, 0, 0.1), velocity=(0, 2.5, 0),
            angular_velocity=(0, 0, 5.0),
        )  # fmt: skip
        scene.add_joint(joints.Prismatic(axis=(0, 0, 1)), arm, block)
        scene.add_contact(block, floor, restitution=0.3, friction=0.4)
        scene.add_force(forces.JointFriction(hinge, 2.0))
        solution = quiet(scene, 0.3, step=step, options=AS_THEY_ARE)
        off.append(np.max(np.abs(solution.ledger.residual)) / exchanged(solution))
    assert off[0] < 1e-5  # M a h^2/2 a step would be 3e-3
    assert np.all(np.log2(np.array(off[:-1]) / off[1:]) > 1.5)


def steady(t):
    return 0.7 * t, 0.7, 0.0


def uneven(t):
    return 0.7 * t + 0.05 * (1 - np.cos(6 * t)), 0.7 + 0.3 * np.sin(6 * t), 1.8 * np.cos(6 * t)


def test_work_of_a_motor_against_friction():
    # A ball on the end of the arm rubs with mu m g at R: the motor gives mu m g R per radian.
    solution = carom.simulate(slide(carom.Sphere(0.1), steady), 0.5, step=0.01)
    work = 0.4 * 2.0 * G * 0.5 * 0.7 * solution.t
    np.testing.assert_allclose(solution.ledger.loads, work, rtol=0, atol=1e-9 * work[-1])
    np.testing.assert_allclose(solution.ledger.friction, -work, rtol=0, atol=1e-9 * work[-1])


@pytest.mark.parametrize(
    ("shape", "height", "order", "least"),
    [(carom.Sphere(0.1), 0.0, 4, 1e-9), (carom.Box(0.2, 0.2, 0.2), 0.0, 4, 1e-5)],
    ids=["one point", "four points"],
)
def test_the_ledger_closes_with_motors_and_held_contact(shape, height, order, least):
    off = []
    for step in (0.01, 0.005, 0.0025):
        solution = quiet(slide(shape, uneven, height), 0.4, step=step, options=AS_THEY_ARE)
        off.append(np.max(np.abs(solution.ledger.residual)) / exchanged(solution))
    assert off[-1] < least
    slopes = np.log2(np.array(off[:-1]) / off[1:])
    np.testing.assert_allclose(slopes, order, rtol=0, atol=0.3)


def test_the_ledger_closes_with_motors_impacts_and_the_end_of_bounces():
    # A ball falls, bounces, is held and rubs; the motor answers to each. Order 4 between exact events.
    off = []
    for step in (0.01, 0.005):
        solution = carom.simulate(slide(carom.Sphere(0.1), uneven, 0.03), 0.4, step=step)
        assert len(solution.impacts) > 2
        assert solution.contact_mode[-1, 0] == 1
        off.append(np.max(np.abs(solution.ledger.residual)) / exchanged(solution))
    assert off[0] < 1e-7
    assert off[1] < 1e-8


def test_an_ensemble_has_it():
    stiff = [20.0, 60.0, 200.0]
    made = carom.ensemble(
        lambda stiffness: spring(stiffness**2), 0.5, step=5e-3, vary={"stiffness": np.array(stiff)},
        method="implicit", executor="serial",
    )  # fmt: skip
    assert [Status(s).name for s in made.status] == ["SUCCESS", "SUCCESS", "INACCURATE"]
    assert list(made.failures) == [2]
    for k, w in enumerate(stiff):
        alone = quiet(spring(w**2), 0.5, step=5e-3, method="implicit")
        off = np.max(np.abs(alone.ledger.residual)) / exchanged(alone)
        assert made.energy_error[k] == pytest.approx(off, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("value", [0.0, -1e-4, np.nan])
def test_bad_tolerance(value):
    with pytest.raises(ValueError, match="energy_tolerance"):
        carom.Options(energy_tolerance=value)


@entry
def look_at_depth(system, state, t, work, watch):
    """Look at a state as the loop does at a saved one."""
    watch_depth(system, state, t, work, watch[0])


def test_a_body_in_another_and_a_joint_beyond_its_stop_are_said():
    # No half-space in the scene. Two balls by 1e-6 m, 2e-5 of the radius; then a stop by 1e-4 rad.
    scene = carom.Scene(gravity=(0, 0, 0))
    left, right = (
        scene.add_body(carom.Sphere(0.05), mass=1.0, position=(x, 0, 0), name=name)
        for x, name in ((0.0, "left"), (0.2, "right"))
    )
    scene.add_contact(right, left, friction=0)
    run = carom.simulate(scene, 0.1, step=0.01)._run
    run.now["x"][1, 0] = 0.1 - 1e-6
    look_at_depth(run.compiled.system, run.now, 0.1, run.work, run.watch)
    (said,) = sentences(run.watch[0], FINER, scene)
    assert said.startswith("Body 'right' penetrates 'left' by 2e-05 of its size")

    scene = carom.Scene(gravity=(0, 0, 0))
    arm = scene.add_body(carom.Box(0.2, 0.02, 0.02), mass=1.0, position=(0.1, 0, 0))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, arm, name="hinge")
    scene.add_stop(hinge, lower=0.0, restitution=0.0)
    run = carom.simulate(scene, 0.1, step=0.01)._run
    run.now["Q"][0] = (np.cos(5e-5), 0, 0, -np.sin(5e-5))
    run.now["x"][0] = (0.1 * np.cos(1e-4), -0.1 * np.sin(1e-4), 0)
    look_at_depth(run.compiled.system, run.now, 0.1, run.work, run.watch)
    (said,) = sentences(run.watch[0], FINER, scene)
    assert said.startswith("Joint 'hinge' exceeds its stop by 0.0001 of the size of its body")


def test_a_body_in_what_it_touches_is_said():
    # Boxes on each other, on a floor; the state is put deeper and looked at again: exactly that depth, by the
    # distance of the corners from the centre, sqrt(3)/10.
    scene = carom.Scene(gravity=(0, 0, -G))
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    low, high = (
        scene.add_body(carom.Box(0.2, 0.2, 0.2), mass=1.0, position=(0, 0, z), name=name)
        for z, name in ((0.1, "low"), (0.3, "high"))
    )
    scene.add_contact(low, floor, friction=0)
    scene.add_contact(high, low, friction=0)
    size = 0.1 * np.sqrt(3.0)
    for body, words in ((0, "Body 'low' penetrates 'floor'"), (1, "Body 'high' penetrates 'low'")):
        run = carom.simulate(scene, 0.1, step=0.01)._run
        assert sentences(run.watch[0], FINER, scene) == ()
        for depth, status in ((1e-6, Status.SUCCESS), (3e-2, Status.INACCURATE)):
            state = run.now.copy()
            state["x"][body:, 2] -= depth
            look_at_depth(run.compiled.system, state, 0.07, run.work, run.watch)
            assert run.watch["depth"][0] == pytest.approx(depth / size, abs=1e-12)
            assert run.judged(Status.SUCCESS) is status
            (said,) = sentences(run.watch[0], FINER, scene)
            assert said.startswith(words)
            assert "t = 0.07 s" in said


def test_contacts_that_are_not_solved():
    """A sentence from a hundredth of the greatest speed on, no success from a tenth on."""
    scene = carom.Scene(gravity=(0, 0, -G))
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    scene.add_contact(
        scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.2)), floor, restitution=0.5
    )
    run = carom.simulate(scene, 0.2, step=0.01)._run
    # falls .1 m, and what gravity gives in a step of 10 ms counts
    assert run.watch["speed"][0] == pytest.approx(np.sqrt(2 * G * 0.1) + 0.01 * G, rel=0.05)
    assert run.watch["unsolved"][0] < 1e-12
    for part, status, said in ((0.009, "SUCCESS", 0), (0.05, "SUCCESS", 1), (0.2, "INACCURATE", 1)):
        run.watch["unsolved"], run.watch["unsolved_at"] = part * run.watch["speed"], 0.15
        assert run.judged(Status.SUCCESS).name == status
        assert len(sentences(run.watch[0], FINER, scene)) == said
    run.watch["unsolved"] = np.nan
    assert run.judged(Status.SUCCESS) is Status.INACCURATE
    assert "m/s at t = 0.15 s" in sentences(run.watch[0], FINER, scene)[0]
