"""Parts that are taken out of the motion, or put into it: closed forms, ledger, files, and runs that go on."""

import numpy as np
import pytest

import carom
from carom import GROUND, constraints, forces, joints
from carom.status import SimulationError
from verified import agree, verifies

G = 9.81
HOW = {"tolerances": {}, "tight": {"rtol": 1e-10}, "step": {"step": 0.01}}


def pendulum(**breaks):
    """A ball of 1 kg on a hinge 1 m away, level at the start."""
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.05), mass=1.0, position=(-1, 0, 0), name="bob")
    hinge = joints.Revolute(anchor=(0, 0, 0), axis=(0, 1, 0))
    scene.add_joint(hinge, GROUND, "bob", name="hinge", **breaks)
    return scene


def moment(k=0):
    """Return the moment of inertia of the pendulum about its hinge."""
    return 1.0 + 0.4 * 0.05**2


@verifies("switch", r"$\omega^2 = 2 m g l/I$, then a parabola", "closed form")
@pytest.mark.parametrize("how", HOW.values(), ids=HOW)
def test_released_at_the_bottom_it_flies_a_parabola(how):
    scene = pendulum()
    scene.switch("hinge", at=lambda t, state: state["bob"].position[0])
    solution = carom.simulate(scene, 1.0, **how)
    # w^2 = 2 m g l / I at the bottom
    w = np.sqrt(2.0 * G / moment())
    (t,), tolerance = solution.switches.time, 1e-9 if "step" not in how else 1e-6
    end = np.array([w * (1 - t), 0, -1 - 0.5 * G * (1 - t) ** 2])
    agree(solution["bob"].velocity[-1], (w, 0, -G * (1 - t)), atol=tolerance)
    agree(solution["bob"].position[-1], end, atol=tolerance)
    assert np.all(solution["hinge"].force[solution.t > t] == 0.0)
    assert np.all(np.isnan(solution["hinge"].coordinate[solution.t > t]))
    assert abs(solution.ledger.residual).max() < tolerance


def test_a_release_is_the_same_as_two_runs():
    scene = pendulum()
    scene.switch("hinge", at=0.6)
    whole, first = carom.simulate(scene, 1.0), carom.simulate(pendulum(), 0.6)
    flight = carom.Scene()
    flight.add_body(
        carom.Sphere(0.05), mass=1.0, position=first["bob"].position[-1], velocity=first["bob"].velocity[-1]
    )  # fmt: skip
    second = carom.simulate(flight, 0.4)
    np.testing.assert_allclose(whole.position[-1], second.position[-1], atol=1e-13)
    # between saved times as well, on both sides
    for t in (0.3, 0.5999, 0.6001, 0.77):
        part = first.evaluate(t)[0] if t < 0.6 else second.evaluate(t - 0.6)[0]
        np.testing.assert_allclose(whole.evaluate(t)[0], part, atol=1e-9)


@verifies(
    "add_joint(breaks_at=)",
    r"breaks where $\lvert R\rvert$ of a pendulum is its limit",
    "closed form",
)
@pytest.mark.parametrize("how", HOW.values(), ids=HOW)
def test_a_pin_breaks_at_its_force(how):
    solution = carom.simulate(pendulum(breaks_at=20.0), 1.0, **how)
    (t,), (name,) = solution.switches.time, solution.switches.switch
    assert name == "hinge.breaks"
    # angle a below the level: force along the arm m (g sin a + l w^2) = 20, across it m g cos a (1 - m l^2/I)
    k, ratio = int(np.flatnonzero(solution.t == t)[0]), 1.0 / moment()
    a = -float(solution["hinge"].coordinate[k])
    along, across = G * np.sin(a) * (1.0 + 2.0 * ratio), G * np.cos(a) * (1.0 - ratio)
    agree(np.hypot(along, across), 20.0, rtol=1e-9 if "step" not in how else 1e-5)
    agree(np.linalg.norm(solution["hinge"].force[k]), 20.0, rtol=1e-12)


def test_a_load_that_peaks_within_a_step_breaks():
    most = 3.0 * G * (1.0 + 2.0 / moment()) / 3.0  # at the bottom
    for part in (0.99, 0.9999, 0.999999):
        assert len(carom.simulate(pendulum(breaks_at=part * most), 1.0).switches) == 1
    assert len(carom.simulate(pendulum(breaks_at=1.00001 * most), 1.0).switches) == 0


def test_a_hinge_breaks_by_an_impulse_and_not_by_a_smaller_one():
    def struck(limit):
        scene = carom.Scene(gravity=(0, 0, 0))
        rod = scene.add_body(carom.Box(1, 0.05, 0.05), mass=1.0, position=(0.5, 0, 0), name="rod")
        hinge = joints.Revolute((0, 0, 0), (0, 0, 1))
        scene.add_joint(hinge, GROUND, rod, name="hinge", breaks_at={"impulse": limit})
        ball = scene.add_body(
            carom.Sphere(0.05), mass=1.0, position=(0.9, -0.5, 0), velocity=(0, 1, 0)
        )
        scene.add_contact(ball, rod, restitution=0.5)
        return carom.simulate(scene, 1.0)

    held = struck(10.0)
    impulse = float(np.linalg.norm(held.joint_impulses.impulse[0]))
    broken = struck(0.99 * impulse)
    assert len(held.switches) == 0
    assert broken.switches.time[0] == pytest.approx(0.425, abs=1e-9)
    assert np.all(broken["hinge"].force[-1] == 0.0)
    # the impact itself was that of the whole
    after = [one.evaluate(0.4251)[3] for one in (held, broken)]
    np.testing.assert_allclose(after[0], after[1], atol=1e-12)


def test_what_breaks_loads_the_others_at_once():
    # two tethers carry a weight; one is weak
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0, name="load")
    for name, limit in (("weak", 4.0), ("strong", 8.0)):
        tether = joints.Tether(1.0, anchor_parent=(0, 0, 1))
        scene.add_joint(tether, GROUND, "load", name=name, breaks_at=limit)
    solution = carom.simulate(scene, 0.5)
    assert set(solution.switches.part) == {"weak", "strong"}
    assert solution["load"].position[-1, 2] < -0.5


def test_a_tether_breaks_at_its_force():
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.05), mass=1.0, position=(-1, 0, 0), name="a")
    scene.add_joint(joints.Tether(1.0, anchor_parent=(0, 0, 0)), GROUND, "a", breaks_at=20.0)
    solution = carom.simulate(scene, 1.0)
    (t,) = solution.switches.time
    x, _, v, _ = (one[0] for one in solution.evaluate(t))
    assert v @ v - G * x[2] == pytest.approx(20.0, abs=1e-8)
    away = x + v * (1 - t) + 0.5 * np.array([0, 0, -G]) * (1 - t) ** 2
    np.testing.assert_allclose(solution["a"].position[-1], away, atol=1e-9)


def boxes():
    """Two boxes in flight, of which one turns."""
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_body(carom.Box(0.2, 0.2, 0.2), mass=2.0, velocity=(1, 0, 0), name="a")
    scene.add_body(
        carom.Box(0.1, 0.2, 0.3), mass=1.0, position=(0, 1, 0.3), velocity=(0, 0.5, 0),
        angular_velocity=(0.4, 0, 2.0), name="b",
    )  # fmt: skip
    scene.add_joint(joints.Fixed(), "a", "b", name="weld")
    return scene


def momenta(solution):
    """Return linear and angular momentum (T, 6) of a solution."""
    out = np.zeros((len(solution.t), 6))
    for body in solution.scene.bodies:
        view = solution[body.name]
        spin = [
            R @ body.inertia @ R.T @ w
            for R, w in zip(_matrices(view.orientation), view.angular_velocity)
        ]
        p = body.mass * view.velocity
        out += np.hstack([p, np.cross(view.position, p) + spin])
    return out


def _matrices(Q):
    w, x, y, z = np.moveaxis(Q, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


@pytest.mark.parametrize("how", HOW.values(), ids=HOW)
def test_a_grasp_keeps_the_momenta_and_loses_what_a_plastic_impact_loses(how):
    scene = boxes()
    scene.switch("weld", at=0.5, off=False)
    scene.switch("weld", at=0.8)
    solution = carom.simulate(scene, 1.0, **how)
    kept = momenta(solution)
    np.testing.assert_allclose(kept, np.broadcast_to(kept[0], kept.shape), atol=1e-7)
    inside = (solution.t >= 0.5) & (solution.t <= 0.8)
    turn = solution["a"].angular_velocity - solution["b"].angular_velocity
    assert abs(turn[inside]).max() < 1e-12
    assert abs(solution.ledger.residual).max() < 1e-7
    assert solution.ledger.impacts[-1] == pytest.approx(solution.switches.energy[0], rel=1e-12)
    assert solution.ledger.impacts[-1] < -0.1
    errors = solution.constraint_errors[0]
    assert np.nanmax(errors[inside][1:]) < 1e-12
    assert np.all(np.isnan(errors[solution.t > 0.8]))


def test_a_clutch_turns_half_the_reduced_inertia_into_heat():
    scene = carom.Scene(gravity=(0, 0, 0))
    drum = carom.Cylinder(0.1, 0.02)
    scene.add_body(drum, mass=2.0, angular_velocity=(0, 0, 10.0), name="driving")
    scene.add_body(drum, mass=1.0, position=(0, 0, 0.1), name="driven")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, "driving")
    between = scene.add_joint(
        joints.Revolute((0, 0, 0), (0, 0, 1)), "driving", "driven", name="slip"
    )
    scene.add_force(forces.JointFriction(between, 0.05), name="clutch")
    scene.switch("clutch", at=0.3, off=False)
    solution = carom.simulate(scene, 2.0, save_at=0.001)
    first, second = 0.01, 0.005  # m r^2 / 2
    reduced = first * second / (first + second)
    assert solution.ledger.friction[-1] == pytest.approx(-0.5 * reduced * 100.0, rel=1e-9)
    locks = 0.3 + reduced * 10.0 / 0.05
    rate = abs(solution["slip"].rate)
    assert rate[solution.t < locks - 0.0011].min() > 0.01
    assert rate[solution.t > locks + 1e-6].max() < 1e-12
    np.testing.assert_allclose(solution.angular_velocity[-1, :, 2], first * 10.0 / (first + second))
    assert solution["clutch"].torque[0] == 0.0


@verifies("switch", r"a spring that is cut: $v = -A\omega \sin\omega t$ stays", "closed form")
def test_a_spring_that_is_cut_takes_its_energy_with_it():
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_body(carom.Sphere(0.1), mass=1.0, name="a")
    spring = forces.Spring(100.0, (-1, 0, 0), (0, 0, 0), rest_length=0.5)
    scene.add_force(spring, "a", name="spring")
    scene.switch("spring", at=0.1)
    solution = carom.simulate(scene, 0.5)
    # x = -.5 + .5 cos(10 t) from the rest length
    agree(solution["a"].velocity[-1, 0], -5.0 * np.sin(1.0), rtol=1e-8)
    agree(solution.ledger.loads[-1], -12.5 * np.cos(1.0) ** 2, rtol=1e-8)
    assert abs(solution.ledger.residual).max() < 1e-9


def test_a_contact_that_is_off_lets_its_bodies_pass():
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    box = scene.add_body(carom.Box(0.2, 0.2, 0.2), mass=1.0, position=(0, 0, 0.1), name="box")
    scene.switch(scene.add_contact(box, floor, friction=0.3), at=0.5)
    solution = carom.simulate(scene, 1.0)
    assert solution["box"].position[-1, 2] == pytest.approx(0.1 - G / 8, abs=1e-12)
    assert np.all(solution.contacts.end == 0.5)
    assert solution.success
    assert not solution.warnings


def test_what_is_exceeded_cannot_be_put_in():
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    box = scene.add_body(carom.Box(0.2, 0.2, 0.2), mass=1.0, position=(0, 0, 0.1), name="box")
    contact = scene.add_contact(box, floor, friction=0.3)
    scene.switch(contact, at=0.3)
    scene.switch(contact, at=0.6, off=False)
    with pytest.raises(
        SimulationError, match=r"'switch2'.*'box-floor' cannot be put into the motion"
    ):
        carom.simulate(scene, 1.0)
    solution = carom.simulate(scene, 1.0, throw=False)
    assert 0.58 < solution.t[-1] <= 0.6


@pytest.mark.parametrize("how", [{}, {"step": 0.01}], ids=("tolerances", "step"))
def test_a_motor_and_a_gear_that_come_back_take_the_coordinates_as_they_stand(how):
    scene = carom.Scene(gravity=(0, 0, 0))
    for k in range(2):
        scene.add_body(
            carom.Cylinder(0.1, 0.02), mass=1.0 + k, position=(0.3 * k, 0, 0), name=f"wheel{k}",
            angular_velocity=(0, 0, (2.0, -4.0)[k]),
        )  # fmt: skip
        hinge = joints.Revolute((0.3 * k, 0, 0), (0, 0, 1))
        scene.add_joint(hinge, GROUND, f"wheel{k}", name=f"axle{k}")
    scene.add_constraint(constraints.Gear("axle0", "axle1", -2.0), name="gear")
    scene.add_force(forces.JointForce("axle0", 0.05), name="push")
    scene.switch("axle1", at=0.3)
    scene.switch("axle1", at=0.6, off=False)
    solution = carom.simulate(scene, 1.0, **how)
    rates = [solution[f"axle{k}"].rate for k in range(2)]
    np.testing.assert_allclose(rates[1][solution.t > 0.6], -2.0 * rates[0][solution.t > 0.6])
    # alone: I w' = M; put in: the least change of (w0, w1) in the kinetic metric with w1 = -2 w0
    together, alone = 0.005 + 0.01 * 4.0, 0.005
    w = 2.0 + 0.3 * 0.05 / together, -2.0 * (2.0 + 0.3 * 0.05 / together)
    free = w[0] + 0.3 * 0.05 / alone
    after = (alone * free - 2.0 * 0.01 * w[1]) / together
    assert rates[0][solution.t == 0.6][0] == pytest.approx(after, rel=1e-9)
    assert rates[0][-1] == pytest.approx(after + 0.4 * 0.05 / together, rel=1e-9)
    assert list(solution.switches.part) == ["axle1", "axle1", "gear"]
    assert abs(solution.ledger.residual).max() < 1e-12
