"""`carom.Run`: a loop of one's own, against `simulate` and closed forms."""

import numpy as np
import pytest

import carom
from verified import agree, verifies

G = 9.81
WAYS = pytest.mark.parametrize("how", [{}, {"step": 0.01}], ids=["tolerances", "step"])


def cart(mass=2.0):
    """Return a scene of a cart without weight that a motor pushes."""
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(carom.Box(0.4, 0.2, 0.1), mass=mass, name="cart")
    scene.add_force(carom.forces.Force((0, 0, 0)), body, name="motor")
    return scene


def dice(count):
    """Return a scene of a die that falls, or of balls; of 70 those that come near get contacts."""
    scene, shape = carom.Scene(), carom.Box(0.1, 0.1, 0.1) if count == 1 else carom.Sphere(0.1)
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    rng = np.random.default_rng(5)
    for k in range(count):
        x, y = divmod(k, 8)
        scene.add_body(
            shape, mass=1.0, position=(0.24 * x, 0.24 * y, 0.2),
            velocity=rng.normal(size=3), angular_velocity=rng.normal(size=3),
        )  # fmt: skip
    scene.set_contact_default(restitution=0.5, friction=0.4)
    return scene


def arm():
    """Return a scene of an arm on a hinge with a motor and a spring."""
    scene = carom.Scene()
    body = scene.add_body(carom.Box(1, 0.05, 0.05), mass=2.0, position=(0.5, 0, 0), name="arm")
    hinge = carom.joints.Revolute((0, 0, 0), (0, -1, 0))
    joint = scene.add_joint(hinge, carom.GROUND, body, name="hinge")
    scene.add_force(carom.forces.JointSpring(joint, 0.5, 0.1), name="spring")
    scene.add_force(carom.forces.JointForce(joint, 1.0), name="motor")
    return scene


@pytest.mark.parametrize("make", [lambda: dice(1), lambda: dice(70), arm], ids=["1", "70", "arm"])
def test_it_is_the_run_of_simulate(make):
    """The same fixed steps one by one, by tens, and all at once: the same bits."""
    whole = carom.simulate(make(), 0.6, step=0.005)
    run = carom.Run(make(), step=0.005)
    for _ in range(37):
        run.advance()
    early = run.solution
    run.advance(0.05)
    run.advance(73 * 0.005 - 0.05)
    assert run.time == 110 * 0.005
    late = run.solution
    for solution, rows in ((early, 38), (late, 111)):
        assert solution.status is carom.Status.SUCCESS
        for name in (
            "t",
            "position",
            "orientation",
            "velocity",
            "angular_velocity",
            "total_energy",
        ):
            assert np.array_equal(getattr(solution, name), getattr(whole, name)[:rows]), name
        struck = whole.impacts.time <= solution.t[-1]
        assert np.array_equal(solution.impacts.impulse, whole.impacts.impulse[struck])
        assert np.array_equal(solution.joint_reactions, whole.joint_reactions[:rows])
        middle = solution.evaluate(0.123)
        assert all(np.array_equal(a, b) for a, b in zip(middle, whole.evaluate(0.123)))
    assert np.array_equal(run.state.velocity, whole.velocity[110])
    assert np.array_equal(run.state.orientation, whole.orientation[110])


def test_more_steps_than_there_is_room_for_at_first():
    """Uniform motion: rows and steps grow, and times are whole multiples of the step."""
    scene = cart()
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 5, 0), velocity=(0.5, 0, 0))
    for how in ({"step": 0.25}, {"step": 0.25, "save_every": 7}, {}, {"save_every": 7}):
        run = carom.Run(scene, **how)
        for _ in range(300):
            run.advance(0.25)
        run.advance(4700 * 0.25)
        solution = run.solution
        wanted = np.arange(5001) * 0.25 if "step" in how else np.append(np.arange(301) * 0.25, 1250)
        every = how.get("save_every", 1)
        keep = (np.arange(len(wanted)) % every == 0) | (np.arange(len(wanted)) == len(wanted) - 1)
        assert np.array_equal(solution.t, wanted[keep])
        assert abs(solution.position[:, 1, 0] - 0.5 * solution.t).max() < 1e-10


@verifies(
    "Run", r"cart under control: $x \mathrel{+}= v T + F T^2/2m$, work $F\,\Delta x$", "closed form"
)
@WAYS
def test_a_controller(how):
    """A force that is constant in each period: x += v T + F T^2/(2 m), v += F T/m, to round-off.

    Its work is in the ledger.
    """
    run, m, T, x, v, work = carom.Run(cart(), **how), 2.0, 0.01, 0.0, 0.0, 0.0
    for _ in range(500):
        state = run.state["cart"]
        force = 8 * (1 - state.position[0]) - 6 * state.velocity[0]
        run.set_force("motor", (force, 0, 0))
        run.advance(T)
        force = 8 * (1 - x) - 6 * v
        way = v * T + 0.5 * force / m * T * T
        x, v, work = x + way, v + force / m * T, work + force * way
        agree(run.state["cart"].position[0], x, atol=1e-13)
        agree(run.state["cart"].velocity[0], v, atol=1e-13)
    solution = run.solution
    assert solution.status is carom.Status.SUCCESS
    assert solution.warnings == ()
    agree(solution.ledger.loads[-1], work, atol=1e-12)
    assert abs(solution.ledger.residual).max() < 1e-13
    assert solution.t.shape == (501,)


@WAYS
def test_a_push_against_friction(how):
    """A block sticks below mu m g, slides above it with a = F/m - mu g, and stops after v^2/(2 mu g)."""
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    block = scene.add_body(carom.Box(0.2, 0.2, 0.1), mass=1.0, position=(0, 0, 0.05), name="block")
    scene.add_contact(block, ground, restitution=0.0, friction=0.5)
    push = scene.add_force(carom.forces.Force((0, 0, 0), anchor=(0, 0, 0)), block, name="push")
    run, a = carom.Run(scene, **how), 8.0 - 0.5 * G
    for force, steps in ((0, 20), (4, 20), (8, 100), (0, 100)):
        run.set_force(push, (force, 0, 0))
        for _ in range(steps):
            run.advance(0.01)
        if force < 8 and steps == 20:
            assert not run.state.velocity.any()
        elif force == 8:
            assert abs(run.state["block"].velocity[0] - a) < 1e-12
    assert not run.state.velocity.any()
    assert abs(run.state["block"].position[0] - (a / 2 + a * a / G)) < 1e-11
    assert run.solution.status is carom.Status.SUCCESS


def test_a_motor_of_a_joint():
    """A torque that carries the arm holds it; reactions are those of the torque that acted at each time."""
    scene = arm()
    run = carom.Run(scene, step=0.01)
    run.set_force("motor", 2.0 * G * 0.5)
    for _ in range(50):
        run.advance()
    q, rate = run.state.joint_coordinates("hinge")
    assert abs(q[0]) < 1e-12
    assert abs(rate[0]) < 1e-12
    run.set_force("motor", 0.0)
    run.advance()
    force = run.solution.joint_reactions[:, 0, 2]
    assert abs(force[1:51] - 2.0 * G).max() < 1e-9  # held
    # let go it turns about its end: m g (1 - (L/2)^2 m/I), I = m (L^2/3 + w^2/12)
    falling = 2.0 * G * (1.0 - 0.25 / (1.0 / 3.0 + 0.05**2 / 12.0))
    assert abs(force[51] - falling) < 0.05
    # at the start the motor had the torque that the scene says, 1 N m
    down = (2.0 * G * 0.5 - 1.0) / (2.0 * (1.0 / 3.0 + 0.05**2 / 12.0))
    assert abs(force[0] - 2.0 * (G - 0.5 * down)) < 1e-9


J = carom.joints
KINDS = [
    J.Revolute((0.3, 0, 0), (1, 2, 3)), J.Prismatic((1, 2, 3)), J.Cylindrical((0.3, 0, 0), (1, 2, 3)),
    J.Universal((0.3, 0, 0), (0, 1, 0), (0, 0, 1)), J.Planar((1, 2, 3)), J.Spherical((0.3, 0, 0)),
    J.PointOnLine((0.3, 0, 0), (1, 2, 3)), J.PointOnPlane((0.3, 0, 0), (1, 2, 3)),
    J.Screw((0.3, 0, 0), (1, 2, 3), 0.1), J.Fixed(), J.Distance((0, 0, 0), (0.5, 0.1, 0)),
]  # fmt: skip


@pytest.mark.few(8)
@pytest.mark.parametrize("frames", [False, True])
@pytest.mark.parametrize("definition", KINDS, ids=lambda d: type(d).__name__)
def test_coordinates_of_a_joint_at_one_time(definition, frames):
    """They are those of the solution, angles but for whole turns."""
    scene = carom.Scene(gravity=(0, 0, 0))
    tilted = [carom.axis_angle(axis, 40.0) for axis in ((1, 1, 0), (0, 1, 1))]
    one, two = (
        scene.add_body(
            carom.Box(0.1, 0.2, 0.3), mass=1.0, position=(x, 0, 0.1 * x), orientation=Q,
            angular_velocity=(3, 4, 5), velocity=(0.2, x, 0.3),
        )
        for x, Q in zip((0.0, 0.5), tilted)
    )  # fmt: skip
    given = {"parent_frame": ((0.1, 0, 0), tilted[1]), "child_frame": ((0, 0.1, 0), tilted[0])}
    scene.add_joint(definition, one, two, name="joint", **(given if frames else {}))
    run = carom.Run(scene, step=0.01, options=carom.Options(project_start=True))
    states = [run.state]
    for _ in range(60):
        run.advance()
        states.append(run.state)
    found = [state.joint_coordinates("joint") for state in states]
    q, rates = run.solution.joint_coordinates("joint")
    turns = getattr(definition, "coordinates", ()) if definition.turn != "ball" else ()
    for k in range(q.shape[1]):
        off = np.array([one[0][k] for one in found]) - q[:, k]
        if turns and turns[k] == "turn":
            off -= 2.0 * np.pi * np.round(off / (2.0 * np.pi))
        assert abs(off).max() < 1e-12
        assert abs(np.array([one[1][k] for one in found]) - rates[:, k]).max() < 1e-12
    assert all(len(one[0]) == q.shape[1] for one in found)


def test_forces_of_every_kind_find_their_place():
    """Set to what another scene has from the start, in any order of forces: the same bits."""

    def made(values):
        scene = carom.Scene()
        one, two = (
            scene.add_body(carom.Box(0.1, 0.2, 0.3), mass=1.0, position=(x, 0, 0)) for x in (0, 2)
        )
        scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 3, 0))
        base = scene.add_body(
            carom.Box(0.1, 0.2, 0.3), mass=1.0, position=(4, 0, 0),
            orientation=carom.axis_angle((0, 1, 0), 30.0), name="base",
        )  # fmt: skip
        slide = scene.add_joint(carom.joints.Prismatic((2, 0, 0), (1, 0, 0)), one, two)
        f, v = carom.forces, values
        scene.add_force(f.JointSpring(slide, 3.0))
        scene.add_force(f.Torque(v[0]), one, two, name="between")
        scene.add_force(f.Force(v[1], anchor=(0.1, 0, 0)), one, name="push")
        scene.add_force(f.JointForce(slide, lambda t, q, rate: 0.1 * t))
        scene.add_force(f.Force(v[2], follow=True), base, name="thruster")
        scene.add_force(f.JointForce(slide, v[3]), name="motor")
        scene.add_force(f.Torque(v[4], follow=True), base, name="wheel")
        return scene

    values = [(0.1, 0.2, 0.3), (1, 2, 3), (0.3, 0.1, 0.4), 0.7, (0.01, 0.02, 0.03)]
    zeros = [(0, 0, 0), (0, 0, 0), (0, 0, 0), 0.0, (0, 0, 0)]
    whole = carom.simulate(made(values), 1.0, step=0.01)
    run = carom.Run(made(zeros), step=0.01)
    for name, value in zip(("between", "push", "thruster", "motor", "wheel"), values):
        run.set_force(name, value)
    for _ in range(99):
        run.advance()
    assert np.array_equal(run.solution.position, whole.position[:100])
    assert np.array_equal(run.solution.ledger.loads, whole.ledger.loads[:100])
    with pytest.raises(ValueError, match="got 'force1', a JointSpring"):
        run.set_force("force1", 1.0)
    with pytest.raises(ValueError, match="got 'force4', a JointForce"):
        run.set_force("force4", 1.0)


def test_the_scene_stays_as_it_is():
    scene = cart()
    for _ in range(2):
        run = carom.Run(scene, step=0.01)
        run.advance()
        assert not run.state.velocity.any()
        run.set_force("motor", (1, 0, 0))
        run.advance()
        assert abs(run.state["cart"].velocity[0] - 0.005) < 1e-16


def test_a_solution_stays_as_it_is(tmp_path):
    """Looked at before or after the run has gone on, and in a file."""
    run = carom.Run(arm(), step=0.01, save_every=4)
    run.advance(0.1)
    one, two = run.solution, run.solution
    at_once = one.evaluate(0.05)[0], one.joint_reactions, one.constraint_errors[0]
    run.set_force("motor", 30.0)
    run.advance(1.0)
    later = two.evaluate(0.05)[0], two.joint_reactions, two.constraint_errors[0]
    assert all(np.array_equal(a, b) for a, b in zip(at_once, later))
    assert np.allclose(two.t, [0, 0.04, 0.08, 0.1])
    assert np.allclose(run.solution.t[:4], [0, 0.04, 0.08, 0.12])
    assert run.solution.settings["duration"] == run.time
    with pytest.raises(ValueError, match=r"take it on with carom\.Run\(solution\)"):
        two.simulate(1.0)
    pytest.importorskip("h5netcdf")
    last = run.solution
    last.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    assert np.array_equal(loaded.joint_reactions, last.joint_reactions)
    assert np.array_equal(loaded.evaluate(0.5)[0], last.evaluate(0.5)[0])


def test_with_tolerances_it_is_as_exact():
    """A throw of a die, in periods of 0.01 s, is that of `simulate` with these times to save at."""
    whole = carom.simulate(dice(1), 0.5, save_at=0.01)
    run = carom.Run(dice(1))
    for _ in range(50):
        run.advance(0.01)
    assert abs(run.solution.position - whole.position).max() < 1e-9


def test_a_run_that_fails():
    """It raises each time, with the solution up to there."""
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5))
    scene.add_contact(ball, ground, restitution=0.8)
    run = carom.Run(scene, step=0.01, options=carom.Options(hold=False))
    with pytest.raises(carom.SimulationError, match="One step has more impacts") as caught:
        run.advance(3.0)
    assert 2.5 < run.time < 2.6
    assert caught.value.solution.t[-1] == run.time
    with pytest.raises(carom.SimulationError):
        run.advance()
    assert run.solution.status is carom.Status.TOO_MANY_IMPACTS


@pytest.mark.parametrize(
    ("call", "kind", "words"),
    [
        (lambda scene: carom.Run(3), TypeError, "scene must be a carom.Scene, a Model or a Solution, got 3"),
        (lambda scene: carom.Run(scene, dt=0.1), TypeError, "it is called step="),
        (lambda scene: carom.Run(scene, step=-1), ValueError, "step must be finite and above 0"),
        (lambda scene: carom.Run(carom.Scene()), ValueError, "at least one body"),
        (lambda scene: carom.Run(scene).advance(), ValueError, "duration must be given"),
        (lambda scene: carom.Run(scene).advance(0), ValueError, "duration must be finite and above"),
        (
            lambda scene: carom.Run(scene, step=0.1).advance(0.25),
            ValueError,
            "duration must be a whole multiple of the step of 0.1 s, got 0.25",
        ),
        (
            lambda scene: carom.Run(scene).set_force("motr", (0, 0, 0)),
            ValueError,
            "force must be a part of the scene, which has none called 'motr'; did you mean 'motor'",
        ),
        (
            lambda scene: carom.Run(scene).set_force("cart", (0, 0, 0)),
            TypeError,
            "force must be a AppliedForce",
        ),
        (
            lambda scene: carom.Run(scene).set_force("motor", 1.0),
            ValueError,
            r"value must have shape \(3,\) \[N\], got shape \(\)",
        ),
        (
            lambda scene: carom.Run(scene).set_force("motor", (0, np.nan, 0)),
            ValueError,
            "value must be finite",
        ),
    ],
)  # fmt: skip
def test_bad_input(call, kind, words):
    with pytest.raises(kind, match=words):
        call(cart())
