"""Bodies that slide and roll on ground that is not convex, against closed forms and equations of motion."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

import carom
from verified import agree, verifies

G, M = 9.81, 0.7
BOWL, BALL = 0.5, 0.08
L = BOWL - BALL  # from the centre of the bowl to that of the ball
S = carom.surfaces
TOLERANCES = [1e-6, 1e-10]
TURN = carom.euler("xyz", (20.0, -35.0, 50.0))


def on(ground, position, friction, *, shape=None, e=0.0, turn=None, **motion):
    """A body on a surface at the origin; all may be turned in space, together with gravity."""
    rotate = carom.geometry.quaternion.rotate
    q = np.array((1.0, 0, 0, 0) if turn is None else turn)
    scene = carom.Scene(gravity=rotate(q, np.array((0, 0, -G))))
    wall = scene.add_surface(ground, orientation=q, name="wall")
    if "orientation" in motion:
        motion["orientation"] = carom.geometry.quaternion.multiply(q, motion["orientation"])
    for name in ("velocity", "angular_velocity"):
        motion[name] = rotate(q, np.array(motion.get(name, (0.0, 0, 0)), dtype=float))
    shape = shape or carom.Sphere(BALL)
    body = scene.add_body(shape, mass=M, position=rotate(q, np.array(position)), **motion)
    scene.add_contact(body, wall, restitution=e, friction=friction)
    return scene


def run(scene, duration, tolerance, turn=None):
    """Positions and velocities at the end, in axes of the surface."""
    s = carom.simulate(scene, duration, rtol=tolerance, atol=tolerance)
    assert s.status.name == "SUCCESS"
    q = np.array((1.0, 0, 0, 0) if turn is None else turn)
    back = carom.geometry.quaternion.rotate_back
    return back(q, s.position[-1, 0]), back(q, s.velocity[-1, 0]), s


@verifies(
    "surfaces.InsideSphere",
    r"period $4\sqrt{\kappa L/g}\,K(\sin^2\tfrac\theta2)$, $\kappa = 1$ or $\tfrac75$",
    "closed form",
)
@pytest.mark.few(3)
@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize(("friction", "angle"), [(0.0, 0.01), (0.0, 1.2), (1.0, 0.01), (1.0, 0.9)])
def test_ball_swings_in_a_bowl(friction, angle, tolerance):
    # A pendulum of length R - r; of one that rolls the mass is 7/5 of that.
    inertia = 1.4 if friction else 1.0
    period = 4.0 * np.sqrt(inertia * L / G) * ellipk(np.sin(angle / 2) ** 2)
    if angle == 0.01 and friction:
        assert period == pytest.approx(2 * np.pi * np.sqrt(7 * L / (5 * G)), rel=1e-5)
    start = L * np.array([np.sin(angle), 0, -np.cos(angle)])
    scene = on(S.InsideSphere(BOWL), start, friction, turn=TURN)
    x, v, s = run(scene, 2 * period, tolerance, TURN)
    bound = 30 * tolerance
    agree(x, start, atol=bound * L)
    agree(v, 0.0, atol=bound * np.sqrt(G * L))
    agree(s.ledger.residual, 0.0, atol=bound * M * G * L)


def slide_to_roll(speed, mu, duration):
    """Place and speed along the bowl of a ball that starts to slide at its bottom, without spin."""

    def rates(rolls):
        def f(t, y):
            angle, u, w = y
            N = G * np.cos(angle) + u * u / L
            if rolls:
                a = -5 / 7 * G * np.sin(angle)
                return u / L, a, a / BALL
            slip = np.sign(u - BALL * w)
            return u / L, -G * np.sin(angle) - mu * N * slip, 2.5 * mu * N * slip / BALL

        return f

    def sticks(t, y):
        return y[1] - BALL * y[2]

    sticks.terminal = True
    how = dict(rtol=1e-13, atol=1e-14, method="DOP853")
    first = solve_ivp(rates(False), (0, duration), (0.0, speed, 0.0), events=sticks, **how)
    begin, y = first.t_events[0][0], first.y_events[0][0]
    assert begin < 0.8 * duration
    return solve_ivp(rates(True), (begin, duration), y, **how).y[:, -1]


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_ball_slides_and_then_rolls(tolerance):
    angle, u, w = slide_to_roll(1.5, 0.3, 0.9)
    x, v, s = run(on(S.InsideSphere(BOWL), (0, 0, -L), 0.3, velocity=(1.5, 0, 0)), 0.9, tolerance)
    place = L * np.array([np.sin(angle), 0, -np.cos(angle)])
    assert np.abs(x - place).max() < 100 * tolerance * L
    assert np.abs(v - u * np.array([np.cos(angle), 0, np.sin(angle)])).max() < 100 * tolerance
    assert abs(s.angular_velocity[-1, 0, 1] - w) < 100 * tolerance / BALL


@verifies(
    "surfaces.InsideCylinder", r"$\ddot z + \tfrac27 \Omega^2 z = -\tfrac57 g$", "closed form"
)
@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_ball_does_not_fall_in_a_well(tolerance):
    # z'' + 2/7 W^2 z = -5/7 g with W the rate about the axis, which stays: it comes up again.
    rate, duration = 9.0, 1.3
    scene = on(
        S.InsideCylinder(BOWL), (L, 0, 0), 3.0, velocity=(0, rate * L, 0),
        angular_velocity=(0, 0, -rate * L / BALL), turn=TURN,
    )  # fmt: skip
    x, _v, _ = run(scene, duration, tolerance, TURN)
    z = -2.5 * G / rate**2 * (1.0 - np.cos(np.sqrt(2 / 7) * rate * duration))
    place = np.array([L * np.cos(rate * duration), L * np.sin(rate * duration), z])
    agree(x, place, atol=100 * tolerance * L)


@verifies("surfaces.InsideCone", "steady circle by the balance of momentum", "closed form")
@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("friction", [0.0, 1.0])
def test_ball_goes_round_in_a_funnel(friction, tolerance):
    # A circle at the distance d of the axis, with the rate W. If it rolls, its spin about the normal is such
    # that the friction f along the cone turns its angular momentum.
    angle, d = 0.6, 0.4
    sine, cosine = np.sin(angle), np.cos(angle)
    rate = np.sqrt(G * cosine / (sine * d)) * (0.9 if friction else 1.0)
    f = G * cosine - rate**2 * d * sine  # by the mass
    along = -rate * d / BALL if friction else 0.0
    about = (along * sine + f / (0.4 * BALL * rate)) / cosine if friction else 0.0
    n, g = np.array([-cosine, 0, sine]), np.array([sine, 0, cosine])
    start = np.array([d, 0, (BALL + d * cosine) / sine])
    scene = on(
        S.InsideCone(angle), start, friction, velocity=(0, rate * d, 0),
        angular_velocity=about * n + along * g,
    )  # fmt: skip
    x, _v, _ = run(scene, 1.0, tolerance)
    place = np.array([d * np.cos(rate), d * np.sin(rate), start[2]])
    agree(x, place, atol=300 * tolerance * L)


@verifies("surfaces.InsideTorus", r"$\tan p = \Omega^2 d/g$", "closed form")
@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_ball_goes_round_in_a_bent_tube(tolerance):
    # Without friction, on the outer side of the tube at the angle p from its bottom: tan p = W^2 d/g.
    tube, ring, p = 0.2, 0.7, 0.8
    across = tube - BALL
    d = ring + across * np.sin(p)
    rate = np.sqrt(G * np.tan(p) / d)
    start = np.array([d, 0, -across * np.cos(p)])
    scene = on(S.InsideTorus(ring, tube), start, 0.0, velocity=(0, rate * d, 0), turn=TURN)
    x, _v, _ = run(scene, 1.0, tolerance, TURN)
    place = np.array([d * np.cos(rate), d * np.sin(rate), start[2]])
    agree(x, place, atol=100 * tolerance)


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_cube_on_four_corners_is_a_pendulum(tolerance):
    # Four corners in a sphere without friction leave only turns about its centre.
    a, angle = 0.2, 0.5
    depth = np.sqrt(BOWL**2 - 0.5 * a * a)  # of the lower face below the centre
    d = depth - 0.5 * a
    inertia = M * a * a / 6 + M * d * d
    period = 4.0 * np.sqrt(inertia / (M * G * d)) * ellipk(np.sin(angle / 2) ** 2)
    start = d * np.array([np.sin(angle), 0, -np.cos(angle)])
    scene = on(
        S.InsideSphere(BOWL), start, 0.0, shape=carom.Box(a, a, a),
        orientation=carom.axis_angle((0, -1, 0), np.degrees(angle)),
    )  # fmt: skip
    x, v, _ = run(scene, period, tolerance)
    assert np.abs(x - start).max() < 100 * tolerance * L
    assert np.abs(v).max() < 100 * tolerance


@verifies("Capsule", "pendulum of the mass $m + I/r^2$", "closed form")
@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("friction", [0.0, 1.0])
def test_capsule_rolls_in_a_pipe(friction, tolerance):
    # It lies along the pipe, which is level: a pendulum with the mass m + I/r^2.
    angle, shape = 0.7, carom.Capsule(BALL, 0.3)
    inertia = 1.0 + (shape.inertia(1.0)[2, 2] / BALL**2 if friction else 0.0)
    period = 4.0 * np.sqrt(inertia * L / G) * ellipk(np.sin(angle / 2) ** 2)
    scene = carom.Scene(gravity=(0, 0, -G))
    along = carom.axis_angle((1, 0, 0), 90)
    pipe = scene.add_surface(S.InsideCylinder(BOWL), orientation=along)
    start = L * np.array([np.sin(angle), 0, -np.cos(angle)])
    body = scene.add_body(shape, mass=M, position=start, orientation=along)
    scene.add_contact(body, pipe, restitution=0.0, friction=friction)
    x, _v, _ = run(scene, period, tolerance)
    agree(x, start, atol=100 * tolerance * L)


def fall_and_reflect(x, v, e, duration):
    """The path of a ball without friction in a bowl about the origin, blow by blow."""
    t, g = 0.0, np.array([0, 0, -G])
    for _ in range(100):
        # |x + v s + g s^2/2|^2 = L^2
        roots = np.roots([0.25 * g @ g, v @ g, v @ v + x @ g, 2 * x @ v, x @ x - L * L])
        real = roots.real[(abs(roots.imag) < 1e-9) & (roots.real > 1e-9)]
        s = real.min() if len(real) else np.inf
        f = np.poly1d([0.25 * g @ g, v @ g, v @ v + x @ g, 2 * x @ v, x @ x - L * L])
        for _ in range(3 if np.isfinite(s) else 0):
            s -= f(s) / f.deriv()(s)
        if t + s > duration:
            s = duration - t
            return x + v * s + 0.5 * g * s * s, v + g * s
        x, v, t = x + v * s + 0.5 * g * s * s, v + g * s, t + s
        v = v - (1 + e) * (v @ x) / (x @ x) * x
    raise AssertionError


@pytest.mark.parametrize("e", [1.0, 0.7])
def test_ball_bounces_in_a_bowl(e):
    x, v = np.array([0.2, 0.05, 0.1]), np.array([0.3, -0.4, 0.2])
    scene = on(S.InsideSphere(BOWL), x, 0.0, e=e, velocity=v)
    end, speed, s = run(scene, 0.9, 1e-10)
    place, rate = fall_and_reflect(x, v, e, 0.9)
    assert len(s.impacts) >= 3
    # errors of places grow by about ten at each blow
    assert np.abs(end - place).max() < 1e-8
    assert np.abs(speed - rate).max() < 1e-7
    if e == 1.0:
        energy = s.kinetic_energy + s.potential_energy
        np.testing.assert_allclose(energy, energy[0], rtol=1e-12)


@verifies("add_surface(surface_spin=)", "a ball in a drum that turns", "own integration: SciPy")
@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_drum_that_turns_carries_a_ball_up(tolerance):
    # Its surface passes below the ball: this slides, then rolls in its place with the speed of the surface.
    rate, mu, duration = 3.0, 0.3, 0.12

    def rates(t, y):
        angle, u, w = y
        N, slip = G * np.cos(angle) + u * u / L, np.sign(u - BALL * w + rate * BOWL)
        return u / L, -G * np.sin(angle) - mu * N * slip, 2.5 * mu * N * slip / BALL

    def drum(spin):
        scene = carom.Scene(gravity=(0, 0, -G))
        wall = scene.add_surface(
            S.InsideCylinder(BOWL), orientation=carom.axis_angle((1, 0, 0), 90),
            surface_spin=((0, 1, 0), rate),
        )  # fmt: skip
        ball = scene.add_body(
            carom.Sphere(BALL), mass=M, position=(0, 0, -L), angular_velocity=(0, spin, 0)
        )
        scene.add_contact(ball, wall, restitution=0.0, friction=mu)
        return scene

    angle, u, w = solve_ivp(rates, (0, duration), (0.0, 0, 0), rtol=1e-12, atol=1e-14).y[:, -1]
    assert u - BALL * w + rate * BOWL > 0.2  # it still slides
    x, v, s = run(drum(0.0), duration, tolerance)
    agree(x, L * np.array([np.sin(angle), 0, -np.cos(angle)]), atol=100 * tolerance)
    agree(s.angular_velocity[-1, 0, 1], w, atol=100 * tolerance / BALL)
    agree(v[0], u * np.cos(angle), atol=100 * tolerance)
    x, _, _ = run(drum(rate * BOWL / BALL), 1.0, tolerance)
    agree(x, (0, 0, -L), atol=1e-14)


def test_box_comes_to_rest_in_a_bowl():
    scene = on(
        S.InsideSphere(BOWL), (0.1, 0, -0.1), 0.4, shape=carom.Box(0.2, 0.14, 0.1), e=0.3,
        velocity=(1.0, 0.5, 0), angular_velocity=(3.0, 1.0, 2.0),
    )  # fmt: skip
    x, _v, s = run(scene, 4.0, 1e-8)
    assert np.all(s.velocity[-1] == 0.0)
    turned = carom.geometry.quaternion.rotate(s.orientation[-1, 0], scene.bodies[0].shape.vertices)
    gaps = np.sort(BOWL - np.linalg.norm(x + turned, axis=1))
    assert gaps[0] > -1e-9
    assert gaps[2] < 1e-9  # three corners at least
    assert np.abs(s.ledger.residual).max() < 1e-6 * M * G * BOWL
