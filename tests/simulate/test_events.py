"""Events: zeros of functions of the state, rest, first impacts; where they end a run and where they do not."""

import math

import numpy as np
import pytest

import carom
from verified import agree, verifies

G = 9.81
WAYS = [{}, {"step": 0.01}]
BOTH = pytest.mark.parametrize("how", WAYS, ids=["tolerances", "step"])


def thrown(up=1.3, friction=0.3, spin=(3, 4, 5)):
    """Return a scene of a die that is thrown up from 0.3 m above the ground."""
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    die = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3), velocity=(0.5, 0, up),
        angular_velocity=spin, name="die",
    )  # fmt: skip
    scene.add_contact(die, ground, restitution=0.4, friction=friction)
    return scene


def block(speed=2.0, friction=0.5):
    """Return a scene of a block that slides on the ground."""
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    part = scene.add_body(
        carom.Box(0.2, 0.2, 0.02), mass=1.0, position=(0, 0, 0.01), velocity=(speed, 0, 0),
        name="block",
    )  # fmt: skip
    scene.add_contact(part, ground, restitution=0.0, friction=friction)
    return scene


def event(function, terminal=None, direction=None):
    """Return a function with the attributes of an event."""

    def value(t, state):
        return function(t, state)

    if terminal is not None:
        value.terminal = terminal
    if direction is not None:
        value.direction = direction
    return value


def apex(t, state):
    return state.velocity[0, 2]


def height(z):
    return lambda t, state: state["die"].position[2] - z


@verifies("simulate(events=)", "apex at $v_0/g$", "closed form")
@BOTH
def test_the_apex_of_a_throw(how):
    """v_z = v_0 - g t is 0 at v_0/g, and the state there is that of the motion: z_0 + v_0^2/(2 g)."""
    solution = carom.simulate(thrown(), 0.3, events=apex, **how)
    (t,), (state,) = solution.t_events[0], solution.state_events[0]
    agree(t, 1.3 / G, atol=1e-15)
    agree(state.position[0, 2] - 0.3, 1.3**2 / (2 * G), atol=1e-15)
    assert state.t == t
    assert solution.status is carom.Status.SUCCESS
    assert solution.t[-1] == 0.3


@BOTH
@pytest.mark.parametrize(("direction", "times"), [(1, 1), (-1, 1), (0, 2), (None, 2)])
def test_a_height_is_crossed_twice(how, direction, times):
    """z_0 + v t - g t^2/2 = z at both roots; a direction takes one."""
    solution = carom.simulate(
        thrown(), 0.3, events=[event(height(0.35), direction=direction)], **how
    )
    root = math.sqrt(1.3**2 - 2 * G * 0.05)
    both = np.array([1.3 - root, 1.3 + root]) / G
    wanted = {1: both[:1], -1: both[1:]}.get(direction, both)
    assert len(solution.t_events[0]) == times
    assert abs(solution.t_events[0] - wanted).max() < 5e-15


@BOTH
def test_a_terminal_event_ends_the_run(how):
    """Down through 0.35 m: the last state is the event's, bit for bit, and the run is a success."""
    falls = event(height(0.35), terminal=True, direction=-1)
    solution = carom.simulate(thrown(), 2.0, events=[apex, falls], **how)
    assert solution.status is carom.Status.STOPPED
    assert solution.success
    assert "events[1] (value) at t = 0.2" in solution.message
    (state,) = solution.state_events[1]
    assert solution.t[-1] == state.t == solution.t_events[1][0]
    assert np.array_equal(solution.position[-1], state.position)
    assert np.array_equal(solution.velocity[-1], state.velocity)
    assert np.array_equal(solution.orientation[-1], state.orientation)
    assert solution.total_energy[-1] == state.total_energy
    assert len(solution.t_events[0]) == 1


@verifies(
    "simulate(events=)",
    r"passages of a pendulum at $(\tfrac14, \tfrac34, \tfrac54)$ of $4\sqrt{L/g}\,K$",
    "closed form",
)
def test_a_number_of_times():
    """A pendulum passes its lowest point each half period; the third time ends the run."""
    scene, L, q = pendulum()
    low = event(lambda t, state: state.joint_coordinates("hinge")[0][0] - q, terminal=3)
    solution = carom.simulate(scene, 10.0, events=[low], rtol=1e-11)
    assert solution.status is carom.Status.STOPPED
    assert len(solution.t_events[0]) == 3
    assert solution.t_events[0][-1] == solution.t[-1]
    period = 4.0 * math.sqrt(L / G) * ellipk(math.sin(q / 2.0) ** 2)
    agree(solution.t_events[0], period * np.array([0.25, 0.75, 1.25]), atol=1e-9 * period)


def ellipk(m):
    """Complete elliptic integral of the first kind, by the arithmetic-geometric mean."""
    a, b = 1.0, math.sqrt(1.0 - m)
    while abs(a - b) > 1e-15:
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return math.pi / (2.0 * a)


def pendulum(length=1.0, angle=1.0):
    """Return a scene of a mass point on a rod, its reduced length, and its angle at the start."""
    scene = carom.Scene()
    x = length * np.array([math.sin(angle), 0.0, -math.cos(angle)])
    bob = scene.add_body(mass=1.0, inertia=(1e-2, 1e-2, 1e-2), position=x, name="bob")
    hinge = carom.joints.Revolute((0, 0, 0), (0, 1, 0))
    scene.add_joint(hinge, carom.GROUND, bob, name="hinge")
    return scene, length + 1e-2 / length, angle


@BOTH
def test_a_block_that_stops(how):
    """It stops after v/(mu g), held by friction all the way; then its speed is exactly 0.

    (What is slower than `Options.rest_tolerance` of what forces give in a step is at rest: 1e-10 s before.)
    """
    stops = event(lambda t, state: state.velocity[0, 0], terminal=True)
    solution = carom.simulate(block(), 1.0, events=[stops], **how)
    assert abs(solution.t[-1] - 2.0 / (0.5 * G)) < 1e-10
    assert abs(solution.position[-1, 0, 0] - 4.0 / (2 * 0.5 * G)) < 1e-13
    rests = carom.simulate(block(), 1.0, events=["at rest"], **how)
    assert abs(rests.t[-1] - 2.0 / (0.5 * G)) < 1e-10
    assert not rests.velocity[-1].any()


@BOTH
def test_while_it_slides(how):
    """x = v t - mu g t^2/2 passes 0.3 m at the smaller root."""
    solution = carom.simulate(
        block(), 1.0, events=lambda t, state: state["block"].position[0] - 0.3, **how
    )
    a = 0.5 * G
    assert abs(solution.t_events[0][0] - (2.0 - math.sqrt(4.0 - 0.6 * a)) / a) < 1e-13


@BOTH
def test_a_jump_is_at_the_impact(how):
    """v_z changes its sign by a jump when the die strikes: found to the round-off of that time."""
    rises = event(apex, direction=1)
    solution = carom.simulate(thrown(), 0.5, events=[rises], **how)
    strikes = solution.impacts.time
    for t, state in zip(solution.t_events[0], solution.state_events[0]):
        assert np.abs(strikes - t).min() < 2e-15
        assert state.velocity[0, 2] > 0.0


@BOTH
@pytest.mark.parametrize("words", ["die and ground", "ground and die"])
def test_a_first_impact(how, words):
    """A ball falls for sqrt(2 h/g); the run ends just after it has struck, on its way up."""
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    die = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5), name="die")
    scene.add_contact(die, ground, restitution=0.5)
    solution = carom.simulate(scene, 2.0, events=f"first impact of {words}", **how)
    assert abs(solution.t[-1] - math.sqrt(0.8 / G)) < 4e-16
    assert len(solution.impacts) == 1
    assert abs(solution.velocity[-1, 0, 2] - 0.5 * math.sqrt(0.8 * G)) < 1e-14


def test_the_first_impact_of_two_among_others():
    """Balls in a row pass a blow on: b strikes c after a has struck b, and later than that."""
    scene = carom.Scene(gravity=(0, 0, 0))
    for name, x, v in (("a", 0.0, 1.0), ("b and b", 0.5, 0.0), ("c", 1.0, 0.0)):
        scene.add_body(
            carom.Sphere(0.1), mass=1.0, position=(x, 0, 0), velocity=(v, 0, 0), name=name
        )
    scene.set_contact_default(restitution=1.0, friction=0.0)
    for words, t in (("a and b and b", 0.3), ("c and b and b", 0.6)):
        solution = carom.simulate(scene, 1.0, step=0.01, events=[f"first impact of {words}"])
        assert abs(solution.t[-1] - t) < 1e-14
    assert carom.simulate(scene, 1.0, events="first impact of a and c").status.name == "SUCCESS"


@pytest.mark.bits
def test_one_that_turns_round_at_the_end_of_a_step_is_not_at_rest():
    """Thrown up at 1 m/s where g is 1 m/s^2 its speed is exactly 0 after 1 s, the end of a step."""
    scene = carom.Scene(gravity=(0, 0, -1))
    scene.add_body(carom.Sphere(0.1), mass=1.0, velocity=(0, 0, 1), name="ball")
    solution = carom.simulate(scene, 2.0, step=0.25, events=["at rest", apex])
    assert solution.status is carom.Status.SUCCESS
    assert solution.t[-1] == 2.0
    assert solution.t_events[1] == [1.0]
    short = carom.simulate(scene, 1.0, step=0.25, events=["at rest"])
    assert short.status is carom.Status.SUCCESS  # at the last step too


def test_what_is_zero_at_the_start_has_not_happened():
    scene = thrown(up=0.0)
    solution = carom.simulate(scene, 0.2, events=[apex, height(0.3)])
    assert [len(t) for t in solution.t_events] == [0, 0]


@BOTH
def test_a_run_keeps_its_bits(how):
    """Saved states, impacts and counts of a run with events that do not end it are those without."""
    events = [apex, height(0.2), event(lambda t, s: s.angular_velocity[0, 0]), "at rest"]
    plain = carom.simulate(thrown(), 1.5, **how)
    watched = carom.simulate(thrown(), 1.5, events=events[:3], **how)
    assert sum(map(len, watched.t_events)) > 10
    assert_same(watched, plain)
    assert watched.stats == plain.stats
    stopped = carom.simulate(thrown(), 1.5, events=events, **how)
    assert stopped.status is carom.Status.STOPPED
    assert len(stopped.t) < len(plain.t)
    assert np.array_equal(stopped.velocity[:-1], plain.velocity[: len(stopped.t) - 1])


def assert_same(one, two):
    """Compare motions and impacts bit for bit."""
    for name in ("t", "position", "orientation", "velocity", "angular_velocity", "total_energy"):
        assert np.array_equal(getattr(one, name), getattr(two, name)), name
    assert np.array_equal(one.impacts.impulse, two.impacts.impulse)
    assert np.array_equal(one.events.time, two.events.time)


@pytest.mark.parametrize("count", [6, 70])
def test_islands_and_contacts_that_come(count):
    """Several bodies, some asleep; with 70 contacts are made as bodies come near each other."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    rng = np.random.default_rng(3)
    for k in range(count):
        x, y = divmod(k, 8)
        z = 0.1 if k % 2 else 0.3 + 0.2 * rng.random()
        scene.add_body(
            carom.Sphere(0.1), mass=1.0, position=(0.24 * x, 0.24 * y, z), name=f"ball{k}",
            velocity=(0, 0, 0) if k % 2 else rng.normal(size=3),
        )  # fmt: skip
    scene.set_contact_default(restitution=0.5, friction=0.4, rolling_friction=0.02)
    events = [lambda t, s, k=k: s.velocity[k, 2] for k in (0, 2)]
    plain = carom.simulate(scene, 0.4, step=0.005)
    watched = carom.simulate(scene, 0.4, step=0.005, events=events)
    assert sum(map(len, watched.t_events)) >= 4
    assert_same(watched, plain)


def test_joined_bodies_keep_their_bits():
    scene, _, q = pendulum()
    ground = scene.add_half_space((0, 0, -1.05), (0, 0, 1), name="ground")
    ball = scene.add_body(carom.Sphere(0.05), mass=0.5, position=(0, 0, -0.8), name="ball")
    scene.add_contact(ball, ground, restitution=0.6, friction=0.3)
    spring = carom.forces.Spring(5.0, scene["bob"].position, ball.position, damping=0.1)
    scene.add_force(spring, "bob", ball)
    events = [
        lambda t, s: s.joint_coordinates("hinge")[0][0] - q,
        lambda t, s: s["ball"].velocity[2],
    ]
    for how in WAYS:
        plain = carom.simulate(scene, 1.0, **how)
        watched = carom.simulate(scene, 1.0, events=events, **how)
        assert min(map(len, watched.t_events)) >= 1
        assert_same(watched, plain)


@BOTH
def test_going_on_from_an_event(how):
    """Fallen to 0.2 m, and on to the ground: free flight is exact, wherever it was stopped."""
    falls = event(height(0.2), terminal=True)
    scene = thrown(spin=(0, 0, 0))
    stopped = carom.simulate(scene, 2.0, events=[falls], **how)
    on = stopped.simulate(0.2)
    assert on.t[-1] == stopped.t[-1] + 0.2
    assert np.array_equal(on.position[: len(stopped.t)], stopped.position)
    assert abs(on.impacts.time[0] - (1.3 + math.sqrt(1.3**2 + 2 * G * 0.29)) / G) < 1e-15
    again = stopped.simulate(0.1).simulate(0.1)
    assert abs(again.position[-1] - on.position[-1]).max() < 1e-13


def test_a_stopped_run_in_a_file(tmp_path):
    pytest.importorskip("h5netcdf")
    stopped = carom.simulate(thrown(), 2.0, events=["first impact of die and ground"], step=0.01)
    stopped.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    assert loaded.status is carom.Status.STOPPED
    assert loaded.message == stopped.message
    assert_same(loaded.simulate(0.3), stopped.simulate(0.3))


@pytest.mark.parametrize("turned", [False, True], ids=["principal axes", "other axes"])
def test_events_in_a_file_are_those_of_the_run(turned, tmp_path):
    pytest.importorskip("h5netcdf")
    scene = carom.Scene()
    inertia = np.array([[0.01, 0.004, 0], [0.004, 0.02, 0], [0, 0, 0.025]])
    link = scene.add_body(
        mass=1.0,
        inertia=inertia if turned else (0.01, 0.02, 0.025),
        position=(0.5, 0, 0),
        name="link",
    )
    scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, link, name="hinge")
    level = event(lambda t, state: state["link"].position[2] + 0.3)
    solution = carom.simulate(scene, 1.5, events=[level, "at rest"])
    assert len(solution.t_events[0]) > 1
    assert len(solution.t_events[1]) == 0
    solution.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    assert loaded.message == solution.message
    for mine, own in zip(loaded.t_events, solution.t_events, strict=True):
        np.testing.assert_array_equal(mine, own)
    for mine, own in zip(loaded.state_events[0], solution.state_events[0], strict=True):
        assert (mine.t, mine.kinetic_energy, mine.total_energy) == (
            own.t, own.kinetic_energy, own.total_energy,
        )  # fmt: skip
        for name, values in own["link"]._asdict().items():
            np.testing.assert_array_equal(getattr(mine["link"], name), values)
        # a file has attitudes of the scene's axes, and kernels those of principal axes
        found, known = (one.joint_coordinates("hinge") for one in (mine, own))
        np.testing.assert_allclose(found, known, rtol=1e-14 if turned else 0.0)
    again = loaded.to_xarray()
    assert again.user_event_position.dims == ("user_event", "body", "axis")
    np.testing.assert_array_equal(again.user_event_time, solution.t_events[0])
    plain = carom.simulate(scene, 0.1)
    plain.save(tmp_path / "plain.nc")
    assert carom.Solution.load(tmp_path / "plain.nc").t_events is None
    none = carom.simulate(scene, 0.1, events=[level])
    none.save(tmp_path / "none.nc")
    assert [len(t) for t in carom.Solution.load(tmp_path / "none.nc").t_events] == [0]


def test_saved_states_need_not_be_all():
    for how in ({"save_at": 0.1}, {"save_at": [0.05, 0.2]}, {"step": 0.01, "save_every": 7}):
        plain = carom.simulate(thrown(), 0.7, **how)
        watched = carom.simulate(thrown(), 0.7, events=[apex], **how)
        assert_same(watched, plain)
        stops = event(height(0.2), terminal=True)
        stopped = carom.simulate(thrown(), 0.7, events=[stops], **how)
        root = (1.3 + math.sqrt(1.3**2 + 2 * G * 0.1)) / G
        assert abs(stopped.t[-1] - root) < 1e-15
        assert np.array_equal(stopped.t[:-1], plain.t[plain.t < root])
        on = stopped.simulate(0.3)
        assert on.t[-1] == stopped.t[-1] + 0.3


@pytest.mark.parametrize("method", ["paper", "rattle", "implicit", "rk8"])
def test_every_kind_of_method(method):
    solution = carom.simulate(thrown(), 0.3, step=0.01, method=method, events=[apex])
    assert abs(solution.t_events[0][0] - 1.3 / G) < 1e-14


def test_an_event_that_fails():
    """What it raises is the cause; the solution holds the run up to there."""

    def breaks(t, state):
        return 1.0 if t < 0.1 else 1.0 / 0.0

    with pytest.raises(carom.SimulationError) as caught:
        carom.simulate(thrown(), 0.3, step=0.01, events=[breaks])
    assert isinstance(caught.value.__cause__, ZeroDivisionError)
    assert "events[0]" in caught.value.__cause__.__notes__[0]
    assert caught.value.solution.status is carom.Status.FUNCTION_FAILED
    assert abs(caught.value.solution.t[-1] - 0.1) < 0.02
    with pytest.raises(carom.SimulationError) as caught:
        carom.simulate(thrown(), 0.3, step=0.01, events=[lambda t, s: np.nan if t > 0.1 else 1.0])
    assert "events[0] must be finite, got nan" in str(caught.value.__cause__)


def test_the_state_is_read_only_and_stays():
    kept = []
    carom.simulate(thrown(), 0.1, step=0.05, events=[lambda t, s: kept.append(s) or 1.0])
    assert [state.t for state in kept] == [0.0, 0.05, 0.1]
    assert kept[0].position[0, 2] == 0.3
    with pytest.raises(ValueError, match="read-only"):
        kept[0].position[0, 2] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        kept[0]["die"].orientation[0] = 1.0
    assert np.array_equal(kept[1]["die"].velocity, kept[1].velocity[0])
    for name, words in (("dye", "did you mean 'die'"), ("ground", "never moves")):
        with pytest.raises(KeyError, match=words):
            kept[0][name]


@pytest.mark.parametrize("throws", [25, pytest.param(60, marks=pytest.mark.slow)])
def test_random_throws(throws):
    """Heights, apices and distances of random throws, at random steps: to the round-off of their times."""
    rng = np.random.default_rng(11)
    for _ in range(throws):
        up, z, x = rng.uniform(0.5, 5.0), rng.uniform(-0.5, 0.5), rng.uniform(0.1, 1.0)
        v, step = rng.uniform(0.5, 2.0), 10.0 ** rng.uniform(-2.5, -0.5)
        scene = carom.Scene()
        scene.add_body(
            carom.Box(0.1, 0.2, 0.3), mass=1.0, velocity=(v, 0, up),
            angular_velocity=rng.normal(size=3), name="die",
        )  # fmt: skip
        events = [apex, event(height(z), direction=-1), lambda t, s, x=x: s.position[0, 0] - x]
        how = {} if rng.random() < 0.5 else {"step": step}
        solution = carom.simulate(scene, 3.0, events=events, **how)
        inside = up * up - 2.0 * G * z
        wanted = [up / G, (up + math.sqrt(inside)) / G if inside > 0.0 else 9.0, x / v]
        found = solution.t_events
        for i, t in enumerate(wanted):
            alone = [one for one in wanted if abs(one - t) < 2 * step]
            if t > 3.0 or (i == 1 and up / G < step):
                continue
            assert len(found[i]) == 1, (i, alone)
            assert abs(found[i][0] - t) < 1e-14 * max(1.0, t)


@pytest.mark.parametrize(
    ("events", "kind", "words"),
    [
        (3, TypeError, r'events must be one or a list of these: .*"at rest".*; got 3'),
        ([3], TypeError, r"events\[0\] must be a function f\(t, state\), .*; got 3"),
        ("rest", ValueError, r'events\[0\] must be .*"at rest".*; got .rest.'),
        ("first impact of die", ValueError, r"got 'die'; the scene has 'die', 'ground'"),
        ("first impact of dye and ground", ValueError, "did you mean 'die'"),
        ("first impact of ground and ground", ValueError, "no two move"),
        ([event(apex, terminal=-1)], ValueError, r"terminal of events\[0\] must be a whole number"),
        ([event(apex, terminal="yes")], ValueError, r"terminal of events\[0\] must be"),
        ([event(apex, direction="up")], ValueError, r"direction of events\[0\] must be a number"),
        (lambda t: t, TypeError, "positional argument"),
        ([lambda t, s: None], ValueError, r"events\[0\] must be a number, got None"),
        ([lambda t, s: s.position], ValueError, r"events\[0\] must be a number, got array"),
    ],
)
def test_bad_input(events, kind, words):
    with pytest.raises(kind, match=words):
        carom.simulate(thrown(), 0.3, events=events)


def test_what_events_do_not_go_with(tmp_path):
    with pytest.raises(ValueError, match="save must be left out with events"):
        carom.simulate(thrown(), 0.3, events=[apex], save=tmp_path / "run.nc")


def test_a_run_says_which_events_did_not_happen():
    waits = carom.simulate(thrown(), 0.1, events=["at rest", lambda t, state: t - 0.05, apex])
    assert waits.status is carom.Status.SUCCESS
    assert waits.message == "The run reached its end. events[0], events[2] did not happen."
    assert carom.simulate(thrown(), 0.1).message == "The run reached its end."
