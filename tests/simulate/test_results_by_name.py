"""Results of one part by its name: against the balance of momentum, against arrays of the whole, and errors."""

import pickle

import numpy as np
import pytest

import carom
from carom import GROUND, constraints, forces, joints
from carom.geometry import quaternion

G, H = 9.81, 1e-3
ON_FREE = {
    "spring": (3.1, 0, 2.05),
    "curve": (2.9, 0, 2),
    "thrust": (3.1, 0, 2),
    "mount": (2, 0, 2),
}


def everything():
    """Return a scene with a joint, every kind of force, and a contact."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    scene.add_body(
        carom.Box(1, 0.05, 0.05), mass=2.0, position=(0.5, 0, 2), orientation=carom.euler("x", 30),
        inertia=[[0.1, 0.02, 0], [0.02, 0.2, 0], [0, 0, 0.25]], name="rod",
    )  # fmt: skip
    box = carom.Box(0.3, 0.2, 0.1)
    scene.add_body(box, mass=1.5, position=(3, 0, 2), angular_velocity=(1, 2, 3), name="free")
    die = carom.Box(0.1, 0.1, 0.1)
    scene.add_body(die, mass=1, position=(6, 0, 0.05), velocity=(1, 0, 0), name="die")
    scene.add_contact("die", "ground", friction=0.3)
    scene.add_joint(joints.Revolute((0, 0, 2), (0, -1, 0)), GROUND, "rod", name="hinge")
    motor = forces.JointForce("hinge", lambda t, q, rate: 3 * np.sin(t) - 0.2 * rate)
    scene.add_force(motor, name="motor")
    scene.add_force(forces.JointSpring("hinge", 5.0, 0.1, rest=0.2), name="clock")
    spring = forces.Spring(40.0, (3, 0, 3), (3.1, 0, 2.05), damping=0.5)
    scene.add_force(spring, "free", name="spring")
    curve = forces.CurveSpring((1, 0, 2.02), (2.9, 0, 2), ([1, 2, 3], [-1, 0.5, 9]), damping=0.2)
    scene.add_force(curve, "rod", "free", name="curve")
    thrust = forces.Force((0, 1, 2), (3.1, 0, 2), follow=True)
    scene.add_force(thrust, "free", name="thrust")
    scene.add_force(forces.Torque((0.1, 0.2, 0.3)), "rod", "free", name="torque")
    mount = forces.Bushing((30, 20), (2, 3), 0.4, 0.1, axis=(1, 1, 0), anchor=(2, 0, 2))
    scene.add_force(mount, "rod", "free", name="mount")
    drag = forces.UserForce(["free"], lambda t, x: np.hstack([-x[:, 7:10], -0.1 * x[:, 10:]]))
    scene.add_force(drag, name="drag")
    return scene


@pytest.fixture(scope="module")
def run():
    return carom.simulate(everything(), 0.4, step=H)


def rate_of(values):
    """Return central differences; their errors are H^2/6 times third derivatives, some hundreds here."""
    return (values[2:] - values[:-2]) / (2 * H)


def test_forces_change_the_momentum(run):
    """m a = sum of forces + weight, and the rate of the angular momentum is the sum of the moments."""
    free = run["free"]
    force = sum(run[name].force for name in ON_FREE) + run["drag"].force[:, 0]
    weight = np.array([0, 0, -1.5 * G])
    np.testing.assert_allclose(1.5 * rate_of(free.velocity), (force + weight)[1:-1], atol=1e-3)
    moment = run["torque"].torque + run["mount"].torque + run["drag"].torque[:, 0]
    for name, point in ON_FREE.items():
        arm = quaternion.rotate(free.orientation, np.subtract(point, (3, 0, 2)))
        moment = moment + np.cross(arm, run[name].force)
    spin = quaternion.rotate_back(free.orientation, free.angular_velocity)
    momentum = quaternion.rotate(free.orientation, spin @ run.scene["free"].inertia)
    np.testing.assert_allclose(rate_of(momentum), moment[1:-1], atol=1e-3)


def test_powers_add_up(run):
    """The power of all forces is the rate of the kinetic energy, with gravity in the energy."""
    names = [force.name for force in run.scene.forces]
    power = sum(run[name].power for name in names)
    slide = run["die-ground"]
    power = power + np.sum(slide.vector * run["die"].velocity, axis=1)
    energy = sum(run[body.name].energy for body in run.scene.bodies)
    np.testing.assert_allclose(rate_of(energy), power[1:-1], atol=3e-3)
    kinetic = sum(run[body.name].kinetic_energy for body in run.scene.bodies)
    np.testing.assert_allclose(kinetic, run.kinetic_energy, rtol=1e-13)


def test_views_read_the_arrays_of_the_whole(run):
    hinge = run["hinge"]
    q, rate = run.joint_coordinates("hinge")
    assert np.array_equal(hinge.coordinate, q[:, 0])
    assert np.array_equal(hinge.rate, rate[:, 0])
    assert np.array_equal(np.hstack([hinge.force, hinge.torque]), run.joint_reactions[:, 0])
    assert hinge.coordinates(degrees=True)[0][-1, 0] == pytest.approx(np.degrees(q[-1, 0]))
    assert np.array_equal(run["motor"].coordinate, q[:, 0])
    torque = 3 * np.sin(run.t) - 0.2 * rate[:, 0]
    np.testing.assert_allclose(run["motor"].torque, torque, rtol=1e-14)
    np.testing.assert_allclose(run["motor"].power, torque * rate[:, 0], rtol=1e-13)
    slide = run["die-ground"]
    assert np.array_equal(slide.force, run.contact_force[:, 0])
    assert np.array_equal(np.unique(slide.mode), np.array(["slipping", "sticking"]))
    assert slide.gap == pytest.approx(np.zeros(len(run.t)), abs=1e-12)
    for other in ("ground-die", run.scene.contacts[0]):
        assert np.array_equal(run[other].force, slide.force)
    assert run[run.scene["rod"]].position is not None
    spring = run["spring"]
    assert spring.length[0] == pytest.approx(np.hypot(0.1, 0.95), rel=1e-14)
    pull = 40 * (spring.length - spring.length[0]) + 0.5 * spring.length_rate
    np.testing.assert_allclose(spring.tension, pull, rtol=0, atol=1e-12)
    np.testing.assert_allclose(rate_of(spring.length), spring.length_rate[1:-1], atol=1e-4)


def test_a_state_has_the_same_at_one_time(run):
    live = carom.Run(everything(), step=H)
    live.advance(0.25)
    state = live.state
    live.advance(0.05)
    k = 250
    pairs = [
        (state[name], run[name], what)
        for name, whats in {
            "free": "position energy", "hinge": "coordinate rate force torque",
            "motor": "torque power", "mount": "force torque power", "curve": "tension length",
            "drag": "force torque", "die-ground": "force vector mode gap",
        }.items()
        for what in whats.split()
    ]  # fmt: skip
    for one, whole, what in pairs:
        assert np.array_equal(getattr(one, what), getattr(whole, what)[k]), (one, what)
    assert np.array_equal(live.state.position, run.position[300])  # reading has not changed it
    assert np.array_equal(live.state["hinge"].force, run["hinge"].force[300])
    assert len(state.forces) == 4
    with pytest.raises(AttributeError, match="impacts are those of a whole run: solution"):
        _ = state["die-ground"].impacts


def test_states_that_are_not_saved_have_contact_forces():
    live = carom.Run(everything(), step=H, save_every=40)
    live.advance(0.1)
    live.advance(0.003)
    found = live.state["die-ground"].force
    assert found == pytest.approx([G, -0.3 * G, 0], abs=1e-9)
    live.advance(0.017)
    assert len(live.solution.t) == 4  # at 0, 0.04, 0.08, 0.12


def test_a_force_that_is_set(tmp_path):
    """Its values are those of the steps, in the solution, a state that was taken before, and a file."""
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_body(mass=2.0, inertia=(1, 1, 1), name="arm")
    joint = joints.Revolute((0, 0, 0), (0, 0, 1))
    scene.add_joint(joint, GROUND, "arm", name="hinge")
    scene.add_force(forces.JointForce("hinge", 1.0), name="motor")
    scene.add_force(forces.Force((0, 0, 1), (1, 0, 0), follow=True), "arm", name="jet")
    live = carom.Run(scene, step=0.01)
    live.advance(0.02)
    first = live.state
    live.set_force("motor", -3.0)
    live.set_force("jet", (0, 2, 0))
    live.advance(0.02)
    assert (first["motor"].torque, live.state["motor"].torque) == (1.0, -3.0)
    assert first["hinge"].force[2] == pytest.approx(-1.0, abs=1e-12)
    assert live.state["hinge"].force[2] == pytest.approx(0.0, abs=1e-12)
    solution = live.solution
    assert solution["motor"].torque == pytest.approx([1, 1, 1, -3, -3])
    solution.save(tmp_path / "run.nc")
    for one in (solution, carom.Solution.load(tmp_path / "run.nc")):
        assert one["motor"].torque == pytest.approx([1, 1, 1, -3, -3])
        assert one["jet"].force[-1] @ one["jet"].force[-1] == pytest.approx(4.0)
        assert one["motor"].power[-1] == pytest.approx(-3 * one["hinge"].rate[-1])


def test_motors_gears_and_stops():
    """A motor at 2 rad/s turns a second wheel by a gear; the first one carries both inertias in its rise."""
    scene = carom.Scene(gravity=(0, 0, 0))
    for k, name in enumerate(("first", "second", "third")):
        scene.add_body(mass=1.0, inertia=(1, 1, 1), position=(k, 0, 0), name=name)
        hinge = joints.Revolute((k, 0, 0), (0, 0, 1))
        scene.add_joint(hinge, GROUND, name, name=f"shaft {name}")
    ramp = constraints.Driver("shaft first", motion=lambda t: (t**2, 2 * t, 2.0))
    scene.add_constraint(ramp, name="motor")
    scene.add_constraint(constraints.Gear("shaft first", "shaft second", -2.0), name="gear")
    scene.add_force(forces.JointForce("shaft third", 1.0), name="push")
    scene.add_stop("shaft third", upper=0.02, restitution=0.5, name="stop")
    run = carom.simulate(scene, 0.4, step=0.01)
    motor = run["motor"]
    # the second wheel accelerates by 4 rad/s^2: 2 + 2 * 4 N m on the first
    np.testing.assert_allclose(motor.torque, 10.0, rtol=1e-9)
    np.testing.assert_allclose(motor.power, 10.0 * 2 * run.t, atol=1e-8)
    assert np.array_equal(run["gear"].multipliers, run.constraint_forces[:, 1])
    stop = run["stop"]
    assert stop.gap == pytest.approx(0.02 - run["shaft third"].coordinate, abs=1e-14)
    assert len(stop.impacts) == len(run.impacts) >= 1
    assert stop.impacts.unit[0] == "rad/s"


@pytest.mark.parametrize(
    ("ask", "error", "message"),
    [
        (lambda s: s["hing"], KeyError, "solution: the scene has no part called 'hing'; did you"),
        (lambda s: s["ground"], KeyError, "'ground' never moves .* have: 'die-ground'"),
        (lambda s: s["groun"], KeyError, "did you mean 'ground'"),
        (lambda s: s[3], KeyError, "no part called 3; it has 'rod', 'free'"),
        (lambda s: s[everything().joints[0]], ValueError, r"give its name: solution\['hinge'\]"),
        (
            lambda s: s["motor"].force,
            AttributeError,
            "coordinate in rad: it has a torque, no force",
        ),
        (lambda s: s["spring"].coordinate, AttributeError, "'spring' acts along no coordinate"),
        (lambda s: s["mount"].length, AttributeError, "'mount' has no length"),
        (lambda s: s["hinge"].angle, AttributeError, "did you mean 'coordinate'"),
        (lambda s: s.to_csv, AttributeError, "written by save"),
        (lambda s: s["hinge"].coordinates(degrees=1), ValueError, "degrees must be True or False"),
        (lambda s: s.impacts["dye-ground"], KeyError, "no contact called .* mean 'die-ground'"),
    ],
)
def test_errors_say_what_is_there(run, ask, error, message):
    with pytest.raises(error, match=message):
        ask(run)


def test_texts_say_what_there_is(run):
    body, joint = run.scene.bodies[0], run.scene.joints[0]
    assert repr(run[body]).startswith(f"<BodyState of {body.name!r}: position (")
    assert len(repr(run[body])) < 200
    assert "coordinate, coordinates, force" in repr(run[joint])


def test_names_are_completed(run):
    names = run._ipython_key_completions_()
    assert names[:4] == ["rod", "free", "die", "die-ground"]
    assert {"hinge", "motor", "spring"} < set(names)
    assert "ground" not in names
    assert run.impacts._ipython_key_completions_() == ["die-ground"]
    assert "hinge" in run.scene._ipython_key_completions_()


def bouncing():
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    for k in range(2):
        ball = carom.Sphere(0.1)
        scene.add_body(ball, mass=1, position=(k, 0, 0.3 + 0.1 * k), name=f"ball {k}")
    scene.set_contact_default(restitution=0.8, friction=0.1)
    return carom.simulate(scene, 0.7, step=0.01)


def test_rows_of_tables_by_mask_and_by_name():
    run = bouncing()
    table = run.impacts
    own = table.body == "ball 1"
    assert 0 < np.sum(own) < len(table)
    for part in (
        table[own],
        table["ball 1-floor"],
        table["floor-ball 1"],
        table[np.flatnonzero(own)],
    ):
        assert np.array_equal(part.time, table.time[own])
        assert type(part) is type(table)
    assert np.array_equal(run["floor-ball 1"].impacts.time, table.time[own])
    assert len(table["ball 0-ball 1"]) == 0
    assert len(run.events["ball 1-floor"]) == np.sum(run.events.contact == table[own].contact[0])
    with pytest.raises(IndexError, match=r"boolean array of shape \(\d+,\), one value for each"):
        table[own[:-1]]
    with pytest.raises(IndexError, match="there is no impact 100: the table has"):
        table[np.array([100])]


def test_an_event_reads_forces():
    """A rod from the horizontal pulls with 3 m g cos(theta): half of its greatest force is at cos = 1/2."""
    scene = carom.Scene()
    scene.add_body(mass=2.0, inertia=(1e-3, 1e-3, 1e-3), position=(1, 0, 0), name="bob")
    scene.add_joint(joints.Distance((0, 0, 0), (1, 0, 0)), GROUND, "bob", name="rod")

    def half(t, state):
        return np.linalg.norm(state["rod"].force) - 1.5 * 2.0 * G

    solution = carom.simulate(scene, 1.0, events=[half], rtol=1e-10)
    first = solution.state_events[0][0]
    assert first["bob"].position[2] == pytest.approx(-0.5, abs=1e-8)
    assert np.linalg.norm(first["rod"].force) == pytest.approx(3.0 * G, rel=1e-9)
    assert np.array_equal(first["rod"].force, first.joint_reactions[0, :3])


def test_copies_and_the_state_of_a_file(tmp_path):
    """A view of a copy reads the copy; a state of a file has the motion, and says that it has no forces."""
    scene = everything()
    solution = carom.simulate(
        scene, 0.02, step=H, events=[lambda t, s: s["hinge"].coordinate + 1e-3]
    )
    part = pickle.loads(pickle.dumps(solution["free"].energy))
    assert np.array_equal(part, solution["free"].energy)
    solution.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    assert np.array_equal(loaded["motor"].torque, solution["motor"].torque)  # without its function
    assert np.array_equal(loaded["drag"].force, solution["drag"].force)
    assert np.array_equal(loaded["die-ground"].gap, solution["die-ground"].gap)
    (state,) = loaded.state_events[0]
    assert state["hinge"].coordinate == pytest.approx(-1e-3, abs=1e-12)
    with pytest.raises(ValueError, match="forces of a state of a file are not known"):
        _ = state["hinge"].force


def test_impacts_of_a_system_in_coordinates_are_found_by_name():
    system = carom.GeneralizedSystem(lambda q: [[1.0]], [0.5], [0.0], potential=lambda q: G * q[0])
    system.add_contact(lambda q: q[0], restitution=0.5, name="floor")
    run = carom.simulate(system, 0.6, step=1e-2)
    assert len(run.impacts["floor"]) == len(run.impacts) > 0
    with pytest.raises(KeyError, match="did you mean 'floor'"):
        run.events["flor"]


def test_a_table_keeps_its_names_in_a_copy(run):
    again = pickle.loads(pickle.dumps(run.events))
    assert np.array_equal(again["ground-die"].time, run.events.time)


@pytest.mark.parametrize("turned", [0, 1])
def test_a_state_counts_whole_turns_where_a_spring_does(turned):
    """A cross turns by 9 rad/s about one of its axes, for 2 s: a weak spring has -k q in state and solution."""
    spin, k = 9.0 * np.eye(3)[turned], 1e-3
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_body(mass=1.0, inertia=(1, 1, 1), angular_velocity=spin, name="body")
    cross = joints.Universal((0, 0, 0), axis_parent=(1, 0, 0), axis_child=(0, 1, 0))
    scene.add_joint(cross, GROUND, "body", name="cross")
    scene.add_force(forces.JointSpring("cross", k, coordinate=turned), name="spring")
    live = carom.Run(scene, step=0.01)
    live.advance(2.0)
    q = 9.0 * np.sin(np.sqrt(k) * 2.0) / np.sqrt(k)
    # the tolerance of a step of 0.01 s; a lost turn would be 0.35
    for one, last in ((live.state, ...), (live.solution, -1)):
        assert one["spring"].coordinate[last] == pytest.approx(q, rel=1e-6)
        assert one["spring"].torque[last] == pytest.approx(-k * q, rel=1e-6)
