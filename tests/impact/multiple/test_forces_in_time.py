"""Forces of several contacts in time: against springs integrated in time, one contact, momentum and cones."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom
from carom import Hertz, Stiffness

STEEL, RUBBER, NU, DENSITY = 203e9, 5e7, 0.3, 7780.0


def row_of_balls(radii):
    """Return W, velocities and radii of contacts of a row, of which the first ball comes in at 1 m/s."""
    mass = DENSITY * 4 / 3 * np.pi * radii**3
    n = len(radii)
    G = np.eye(n)[1:] - np.eye(n)[:-1]
    W = np.kron(G @ np.diag(1 / mass) @ G.T, np.diag([1.0, 0.0, 0.0]))
    u = np.zeros((n - 1, 3))
    u[0, 0] = -1.0
    return W, u, radii[:-1] * radii[1:] / (radii[:-1] + radii[1:]), mass


@pytest.mark.parametrize(
    ("radii", "young"),
    [
        (np.full(4, 0.01), STEEL), (0.01 * 0.8 ** np.arange(5), STEEL),
        # rubber between steel: steel closes and opens many times in one compression of rubber
        (np.full(3, 0.01), [RUBBER, STEEL]), (np.array([0.0028, 0.0115, 0.0103]), [RUBBER, STEEL]),
        (np.array([0.0113, 0.0103, 0.0073, 0.0132]), [RUBBER, STEEL, RUBBER]),
    ],
)  # fmt: skip
def test_a_row_of_balls_is_that_of_springs_integrated_in_time(radii, young):
    W, u, R, mass = row_of_balls(radii)
    force = carom.resolve_impacts(
        W, u, 0, 1, stiffness=[Hertz(E, NU, radius=r) for E, r in np.broadcast(young, R)]
    ).force()
    n, k = len(radii), 4 / 3 * np.array(young) / (1 - NU**2) / 2 * np.sqrt(R)

    def springs(x):
        return k * np.maximum(x[: n - 1] - x[1:n], 0.0) ** 1.5

    def rates(t, y):
        F = springs(y)
        return np.concatenate([y[n:], (np.append(0, F) - np.append(F, 0)) / mass])

    begin = np.zeros(2 * n)
    begin[n] = 1.0
    between = np.linspace(0, force.duration, 400)
    for t, found in ((between, force.evaluate(between)), (force.t, force.normal_force)):
        run = solve_ivp(
            rates, (0, force.duration), begin, method="DOP853", rtol=1e-13, atol=1e-19,
            max_step=1e-5, t_eval=t,
        )  # fmt: skip
        there = np.array([springs(x) for x in run.y.T])
        np.testing.assert_allclose(found, there, rtol=0, atol=1e-6 * there.max())
    assert force.peak_force == pytest.approx(there.max(axis=0), rel=1e-6)
    assert np.all(np.diff(force.contact_time[:, 0]) > 0.0)  # the wave


@pytest.mark.parametrize("exponent", [1.0, 1.5])
@pytest.mark.parametrize("e", [1.0, 0.5])
def test_one_contact_of_several_is_one_contact(exponent, e):
    """Numbers of a spring integrated in time, and the force of `resolve_impact`."""
    W = np.array([[2.5, -1.5, 0], [-1.5, 2.5, 0], [0, 0, 1]])
    stiffness = Stiffness(1e6, exponent)
    alone = carom.resolve_impact(W, (-1, 2, 0), 0.2, e, stiffness=stiffness)
    one = carom.resolve_impacts(W, [(-1, 2, 0)], 0.2, e, stiffness=stiffness).force()
    assert one.duration == pytest.approx(alone.duration, rel=1e-8)
    assert one.peak_force[0] == pytest.approx(alone.peak_force, rel=1e-7)
    force = alone.force()
    seen = one.evaluate(force.t)[:, 0]
    np.testing.assert_allclose(seen, force.normal_force, rtol=0, atol=1e-6 * alone.peak_force)


def box_on_floor(rng):
    """Return W and velocities of the four lower corners of a box."""
    corners = np.array([(x, y, -0.5) for x in (-0.5, 0.5) for y in (-0.5, 0.5)])
    inertia = np.array([1 / 6] * 3)
    G = []
    for r in corners:
        for a in ((0, 0, 1), (1, 0, 0), (0, 1, 0)):
            G.append(np.concatenate([a, np.cross(r, a)]))
    G = np.array(G)
    W = G @ np.diag(1 / np.concatenate([[1, 1, 1], inertia])) @ G.T
    v = np.concatenate([rng.uniform(-0.5, 0.5, 2), [-1.0], rng.uniform(-0.5, 0.5, 3)])
    return W, (G @ v).reshape(4, 3)


@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_corners_with_friction_keep_momentum_and_their_cones(law, exponent):
    rng = np.random.default_rng(5)
    for _ in range(6):
        W, u = box_on_floor(rng)
        stiffness = [Stiffness(k, exponent) for k in rng.uniform(1e6, 3e6, 4)]
        impact = carom.resolve_impacts(W, u, 0.3, 0.6, law, stiffness=stiffness)
        force = impact.force()
        scale = impact.impulse[:, 0].max()
        # four corners are redundant: the shares of friction are not determined, but what they do
        np.testing.assert_allclose(
            force.impulse[-1, :, 0], impact.impulse[:, 0], rtol=0, atol=2e-5 * scale
        )
        np.testing.assert_allclose(force.velocity[-1], impact.velocity_after, rtol=0, atol=2e-5)
        times = np.linspace(0, force.duration, 20001)
        taken = np.trapezoid(force.evaluate(times), times, axis=0)
        np.testing.assert_allclose(taken, impact.impulse[:, 0], rtol=0, atol=2e-5 * scale)
        friction = np.linalg.norm(force.friction_force, axis=2)
        assert np.all(
            friction <= 0.3 * force.normal_force * (1 + 1e-8) + 1e-9 * force.peak_force.max()
        )
        k = np.array([one.k for one in stiffness])
        closing = force.normal_force[:3] > 0.0  # on the curve of loading
        np.testing.assert_allclose(
            force.normal_force[:3][closing],
            (k * np.maximum(force.depth[:3], 0.0) ** exponent)[closing],
            rtol=1e-9,
        )


def test_stiffnesses_in_newton_are_their_ratios():
    W, u, *_ = row_of_balls(np.full(3, 0.01))
    stated = carom.resolve_impacts(W, u, 0, 1, stiffness=[Stiffness(2e6), Stiffness(1e6)])
    relative = carom.resolve_impacts(W, u, 0, 1, stiffness=[2.0, 1.0])
    np.testing.assert_allclose(stated.impulse, relative.impulse, rtol=1e-12)
    np.testing.assert_allclose(
        relative.force([Stiffness(2e6), Stiffness(1e6)]).peak_force, stated.force().peak_force
    )
    slow = relative.force([Stiffness(2e4), Stiffness(1e4)])
    assert slow.duration == pytest.approx(10 * stated.force().duration)


def test_slip_without_friction_is_kept():
    W, u = box_on_floor(np.random.default_rng(1))
    impact = carom.resolve_impacts(W, u, 0, 0.5, stiffness=Stiffness(1e6))
    np.testing.assert_allclose(impact.force().velocity[-1], impact.velocity_after, atol=1e-5)


def test_what_has_no_course_is_refused():
    W, u, *_ = row_of_balls(np.full(3, 0.01))
    both = Stiffness(1e6)
    with pytest.raises(ValueError, match="one exponent"):
        carom.resolve_impacts(W, u, 0, 1, stiffness=[Stiffness(1e6), Stiffness(1e6, 1.5)])
    with pytest.raises(ValueError, match="exponent must be that of stiffness"):
        carom.resolve_impacts(W, u, 0, 1, stiffness=both, exponent=1.5)
    with pytest.raises(ValueError, match="numbers, or one Stiffness or Hertz, or 2"):
        carom.resolve_impacts(W, u, 0, 1, stiffness=[both, 1.0])
    with pytest.raises(ValueError, match="radius"):
        carom.resolve_impacts(W, u, 0, 1, stiffness=Hertz(1e9))
    with pytest.raises(TypeError, match="stiffness must be a Stiffness"):
        carom.resolve_impacts(W, u, 0, 1).force()
    with pytest.raises(ValueError, match="ratios"):
        carom.resolve_impacts(W, u, 0, 1).force([Stiffness(1e6), Stiffness(2e6)])
    for how in (dict(multiple="sequential"), dict(multiple="newton"), dict(law="moreau")):
        with pytest.raises(ValueError, match="course in time"):
            carom.resolve_impacts(W, u, 0, 1, **how).force(both)
    with pytest.raises(ValueError, match="course in time"):
        carom.resolve_impacts(W, u, 0, 0).force(both)


def test_a_plot_has_all_forces():
    W, u, *_ = row_of_balls(np.full(3, 0.01))
    impact = carom.resolve_impacts(W, u, 0, 1, stiffness=Stiffness(1e6))
    upper, lower = carom.plots.impact_force(impact)
    assert len(upper.lines) == 3  # and the axis
    assert len(lower.lines) == 2
    assert upper.lines[0].get_xdata()[-1] > 0.0


def chain(radii, **contact):
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.set_contact_default(restitution=1, friction=0, **contact)
    x = np.concatenate([[0], np.cumsum(radii[:-1] + radii[1:])])
    x[0] -= 1e-3
    for k, radius in enumerate(radii):
        scene.add_body(
            carom.Sphere(radius),
            density=DENSITY,
            position=(x[k], 0, 0),
            velocity=(0.0 if k else 1.0, 0, 0),
        )
    return scene


def test_a_run_has_the_forces_of_impacts_at_once():
    """Of a chain by Hertz's law: those of `resolve_impacts`, with the stiffness of each contact."""
    radii = 0.01 * 0.9 ** np.arange(5)
    solution = carom.simulate(chain(radii, stiffness=Hertz(STEEL, NU)), 0.01)
    force = solution.impact_forces(0)
    W, u, R, _ = row_of_balls(radii)
    alone = carom.resolve_impacts(W, u, 0, 1, stiffness=[Hertz(STEEL, NU, radius=r) for r in R])
    np.testing.assert_allclose(force.peak_force, alone.force().peak_force, rtol=1e-6)
    assert force.duration == pytest.approx(alone.force().duration, rel=1e-5)
    assert force.impacts == (0, 1, 2, 3)
    np.testing.assert_allclose(solution.impacts.peak_force, force.peak_force, rtol=1e-5)
    upper, _ = carom.plots.impact_force(solution, 2)
    assert len(upper.lines) == 5


def box(stiffness, turn=(0, 0, 0), **contact):
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    scene.add_body(
        carom.Box(0.2, 0.2, 0.1), mass=2.0, position=(0, 0, 0.3), name="box",
        orientation=carom.euler("xyz", turn), velocity=(0.3, 0.1, -1),
    )  # fmt: skip
    scene.add_contact("box", "floor", restitution=0.5, friction=0.3, stiffness=stiffness, **contact)
    return scene


@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
@pytest.mark.parametrize("turn", [(0, 0, 0), (0, 3, 0)])
def test_a_face_and_an_edge_of_a_box(law, turn):
    solution = carom.simulate(box(Stiffness(1e6), turn, impact_law=law), 0.4)
    hit = solution.impacts[0]
    force = solution.impact_forces(0)
    assert len(force.impacts) == hit.together == (2 if any(turn) else 4)
    np.testing.assert_allclose(
        force.peak_force, solution.impacts.peak_force[list(force.impacts)], rtol=1e-6
    )
    impulse = solution.impacts.impulse[list(force.impacts)]
    np.testing.assert_allclose(force.impulse[-1, :, 0], impulse[:, 0], rtol=1e-5)
    np.testing.assert_allclose(force.impulse[-1].sum(axis=0), impulse.sum(axis=0), rtol=1e-4)
    with pytest.raises(ValueError, match=r"Solution\.impact_forces"):
        hit.force(Stiffness(1e6))


def test_joints_are_part_of_the_masses():
    """Two pins of a rod that swings on a hinge strike the floor at once, with forces by their arms."""
    scene, lift = carom.Scene(gravity=(0, 0, 0)), 0.02
    pins = [carom.Part(carom.Sphere(0.02), position=(x, 0, 0)) for x in (-0.15, 0.15)]
    r = 0.3 * np.array([np.cos(lift), 0, np.sin(lift)])
    rod = scene.add_body(
        carom.Compound(pins), mass=1.5, inertia=(0.01, 0.05, 0.05), position=r + (0, 0, 0.02),
        orientation=carom.axis_angle((0, 1, 0), -np.degrees(lift)), velocity=np.cross((0, 3, 0), r),
        angular_velocity=(0, 3, 0), name="rod",
    )  # fmt: skip
    scene.add_joint(carom.joints.Revolute((0, 0, 0.02), (0, 1, 0)), carom.GROUND, rod)
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    scene.add_contact(
        "rod", "floor", restitution=0.4, friction=0, stiffness=Stiffness(1e6), impact_law="stronge"
    )
    solution = carom.simulate(scene, 0.02, options=carom.Options(corner_exponent=1))
    force = solution.impact_forces(0)
    assert len(force.impacts) == 2
    arms, J = np.array([0.15, 0.45]), 0.05 + 1.5 * 0.3**2
    order = np.argsort(force.peak_force)
    peaks = 1e6 * arms * 3 * np.sqrt(J / (1e6 * (arms**2).sum()))
    np.testing.assert_allclose(force.peak_force[order], peaks, rtol=1e-5)


def test_other_ratios_and_blows_in_turn_are_refused():
    radii = np.full(4, 0.01)
    solution = carom.simulate(chain(radii), 0.01)
    with pytest.raises(TypeError, match="stiffness must be stated"):
        solution.impact_forces(0)
    with pytest.raises(ValueError, match="ratios of stiffnesses"):
        solution.impact_forces(0, Stiffness(1e6))  # another exponent
    ok = solution.impact_forces(0, Stiffness(1e9, 1.5))
    assert ok.peak_force.shape == (3,)
    with pytest.raises(ValueError, match="ratios of stiffnesses"):
        solution.impact_forces(0, [Stiffness(k, 1.5) for k in (1e9, 2e9, 1e9)])
    with pytest.raises(IndexError, match="impact 7 of 3"):
        solution.impact_forces(7)
    in_turn = carom.simulate(chain(radii, multiple="sequential"), 0.01)
    with pytest.raises(ValueError, match="one after another"):
        in_turn.impact_forces(0, Stiffness(1e9, 1.5))


def test_moduli_decide_how_balls_share_an_impact():
    """A row of steel, plastic and glass, by materials: as springs of Hertz's law integrated in time."""
    young = np.array([210e9, 210e9, 3e9, 70e9, 210e9])
    radii = np.array([0.01, 0.01, 0.012, 0.01, 0.008])
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.set_contact_default()
    x = np.concatenate([[0], np.cumsum(radii[:-1] + radii[1:])])
    x[0] -= 1e-3
    mass = np.array([0.03, 0.03, 0.01, 0.02, 0.015])
    for k, E in enumerate(young):
        scene.add_body(
            carom.Sphere(radii[k]), mass=mass[k], position=(x[k], 0, 0),
            velocity=(0.0 if k else 1.0, 0, 0), material=carom.Material(1.0, 0.0, young=E),
        )  # fmt: skip
    solution = carom.simulate(scene, 0.01)
    modulus = 1 / ((1 - 0.3**2) * (1 / young[1:] + 1 / young[:-1]))
    k = 4 / 3 * modulus * np.sqrt(radii[1:] * radii[:-1] / (radii[1:] + radii[:-1]))

    def springs(y):
        return k * np.maximum(y[:4] - y[1:5], 0.0) ** 1.5

    def rates(t, y):
        F = springs(y)
        return np.concatenate([y[5:], (np.append(0, F) - np.append(F, 0)) / mass])

    begin = np.zeros(10)
    begin[5] = 1.0
    run = solve_ivp(
        rates, (0, 8e-3), begin, method="DOP853", rtol=1e-11, atol=1e-18, max_step=1e-6, dense_output=True
    )  # fmt: skip
    np.testing.assert_allclose(solution.velocity[-1, :, 0], run.y[5:, -1], rtol=0, atol=2e-6)
    force = solution.impact_forces(0)
    t = np.linspace(0, force.duration, 500)
    there = np.array([springs(y) for y in run.sol(t).T])
    np.testing.assert_allclose(force.evaluate(t), there, rtol=0, atol=1e-4 * there.max())


def test_one_material_is_as_without():
    radii = 0.01 * 0.9 ** np.arange(5)
    one = carom.simulate(chain(radii), 0.01)
    two = carom.simulate(chain(radii, stiffness=Hertz(STEEL, NU)), 0.01)
    np.testing.assert_array_equal(one.velocity[-1], two.velocity[-1])
