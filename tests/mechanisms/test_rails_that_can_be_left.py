"""Rails that can be left, against closed forms and quadrature: lift-off, flights, landings, friction."""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import carom
from campaigns import loose_rails
from campaigns.case import as_row, run, wrong

G, MASS = 9.81, 0.1
#: rtol and atol, and the error [s or m] that a run may have (the table of the curve differs by 1e-12)
TOLERANCES = [(1e-6, 1e-8), (1e-10, 1e-9)]


def ring(u):
    return math.sin(u), 0.0, math.cos(u)


CIRCLE = carom.curves.Curve(ring, 0.0, 2 * math.pi, closed=True)


def on_circle(angle, speed, curve=CIRCLE, **rail):
    """A bead on the unit circle, `angle` from the top, that goes down to the right."""
    along = np.array((math.cos(angle), 0.0, -math.sin(angle)))
    scene = carom.Scene(gravity=(0, 0, -G))
    bead = scene.add_body(
        carom.Sphere(0.02), mass=MASS, position=ring(angle), velocity=speed * along, name="bead"
    )
    rail = {"side": (0, 0, 1), **rail}
    scene.add_joint(carom.joints.PointOnCurve(curve, **rail), carom.GROUND, bead, name="rail")
    return scene


def closes(s, atol):
    """Assert that the ledger has all changes of the energy."""
    left = s.total_energy - s.total_energy[0] - s.ledger.friction - s.ledger.impacts
    np.testing.assert_allclose(left, 0.0, atol=atol)


@pytest.mark.parametrize(("tolerance", "error"), TOLERANCES)
def test_bead_leaves_a_sphere_and_flies(tolerance, error):
    """It leaves where v^2 = g cos, at cos = 2/3 of that of the start, and flies on in a parabola."""
    start = 0.1
    s = carom.simulate(on_circle(start, 0.0), 1.6, rtol=tolerance, atol=tolerance)
    low = math.acos(2.0 / 3.0 * math.cos(start))
    speed = math.sqrt(G * math.cos(low))
    # time by x = start + w^2, where the integrand has no pole
    left = quad(
        lambda w: 2 * w / math.sqrt(2 * G * (math.cos(start) - math.cos(start + w * w))),
        0.0, math.sqrt(low - start), epsabs=1e-13,
    )[0]  # fmt: skip
    np.testing.assert_allclose(s.contacts.end, [left], atol=error)
    t = s.t[s.t > left]
    x = math.sin(low) + speed * math.cos(low) * (t - left)
    z = math.cos(low) - speed * math.sin(low) * (t - left) - 0.5 * G * (t - left) ** 2
    flight = s.position[s.t > left, 0]
    np.testing.assert_allclose(flight, np.column_stack([x, 0 * x, z]), atol=10 * error)
    contact = s["bead-rail"]
    np.testing.assert_allclose(contact.gap[s.t > left], np.hypot(x, z) - 1.0, atol=10 * error)
    assert np.all(contact.mode[s.t > left] == "open")
    assert len(s.impacts) == 0
    held = s.t < left
    cos = s.position[held, 0, 2]
    np.testing.assert_allclose(
        contact.force[held, 0], MASS * G * (3 * cos - 2 * math.cos(start)), atol=1e-6
    )
    closes(s, error)


@pytest.mark.few(3)
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(("tolerance", "error"), TOLERANCES)
def test_bead_falls_off_the_top_of_a_loop_and_lands(tolerance, error, restitution):
    """Inside a loop it leaves at sin = (v0^2/(g R) - 2)/3 above the centre, and lands at -sin(3 angle)."""
    speed = math.sqrt(3.6 * G)
    scene = on_circle(math.pi, -speed, restitution=restitution)
    s = carom.simulate(scene, 1.6, rtol=tolerance, atol=tolerance)
    angle = math.asin((3.6 - 2.0) / 3.0)
    slow = math.sqrt(G * math.sin(angle))
    left = quad(
        lambda u: 1 / math.sqrt(speed**2 - 2 * G * (1 - math.cos(u))),
        0.0, 0.5 * math.pi + angle, epsabs=1e-13,
    )[0]  # fmt: skip
    flight = (
        4.0 * slow * math.cos(angle) / G
    )  # the parabola has the circle's curvature at its start
    blow = s.impacts[0]
    assert blow.time == pytest.approx(left + flight, abs=error)
    landing = np.array((math.cos(3 * angle), 0.0, -math.sin(3 * angle)))
    np.testing.assert_allclose(blow.point, landing, atol=10 * error)
    assert s.contacts.end[0] == pytest.approx(left, abs=error)
    normal = landing @ (slow * math.sin(angle), 0.0, G * flight - slow * math.cos(angle))
    before, after = blow.relative_velocity_before, blow.relative_velocity_after
    assert before[0] == pytest.approx(normal, abs=10 * error)
    assert after[0] == pytest.approx(-restitution * normal, abs=10 * error)
    assert np.all(s["bead-rail"].gap > -1e-9)
    closes(s, error)
    if restitution == 0.0:  # it stays on the loop
        assert s["bead-rail"].mode[-1] == "slipping"
        assert len(s.impacts) == 1


@pytest.mark.parametrize(("tolerance", "error"), TOLERANCES)
def test_friction_of_the_rail(tolerance, error):
    """On a sphere w = v^2/g has w' = 2 sin - 2 mu (cos - w), until w = cos."""
    mu, speed = 0.3, 2.2
    s = carom.simulate(on_circle(0.0, speed, friction=mu), 0.8, rtol=tolerance, atol=tolerance)
    path = solve_ivp(
        lambda u, y: (2 * math.sin(u) - 2 * mu * (math.cos(u) - y[0]), 1 / math.sqrt(G * y[0])),
        (0.0, 1.2), (speed**2 / G, 0.0), rtol=1e-12, atol=1e-13, dense_output=True,
    )  # fmt: skip
    low = brentq(lambda u: path.sol(u)[0] - math.cos(u), 0.01, 1.2)
    assert s.contacts.end[0] == pytest.approx(path.sol(low)[1], abs=error)
    force = s["bead-rail"].force[s.t < s.contacts.end[0]]
    np.testing.assert_allclose(force[:, 1], -mu * force[:, 0], atol=1e-12)
    lost = 0.5 * MASS * G * (2 * (1 - math.cos(low)) + speed**2 / G - path.sol(low)[0])
    assert s.ledger.friction[-1] == pytest.approx(-lost, abs=error)
    closes(s, error)


def test_bead_sticks_on_a_gentle_slope():
    s = carom.simulate(on_circle(0.2, 0.0, friction=0.3), 0.3)
    assert s["bead-rail"].mode[-1] == "sticking"
    force = MASS * G * np.array((math.cos(0.2), -math.sin(0.2), 0.0))
    np.testing.assert_allclose(s["bead-rail"].force[-1], force, atol=1e-9)
    np.testing.assert_allclose(s.position[-1, 0], ring(0.2), atol=1e-12)


def wave(u):
    return 2 * math.cos(u), 2 * math.sin(u), 0.5 * math.sin(2 * u) + 0.3 * math.cos(u)


WAVE = carom.curves.Curve(wave, 0.0, 2 * math.pi, closed=True)


LOW = ring(2.5)


def on_hoop(curve=CIRCLE, start=LOW, speed=5.0, **rail):
    """A body with an arm on a hoop that moves and turns."""
    centre, spin = np.array((0.1, 0.2, -0.3)), np.array((0.5, 0.3, 0.4))
    s = curve.nearest(start)
    place, along = curve.point(s), curve.tangent(s)
    arm, turn = np.array((0.05, 0.1, -0.03)), np.array((1.0, 2.0, -1.0))
    velocity = np.cross(spin, place - centre) + speed * along + np.cross(turn, arm)
    scene = carom.Scene(gravity=(0, 0, -G))
    hoop = scene.add_body(
        mass=2.0, inertia=(0.5, 0.6, 0.7), position=centre, angular_velocity=spin, name="hoop"
    )
    bead = scene.add_body(
        mass=0.5, inertia=(0.01, 0.02, 0.025), position=place + arm, velocity=velocity,
        angular_velocity=turn, name="bead",
    )  # fmt: skip
    rail = carom.joints.PointOnCurve(curve, anchor=place, **rail)
    scene.add_joint(rail, hoop, bead, name="rail")
    return scene


@pytest.mark.parametrize("where", [(CIRCLE, LOW, 5.0), (WAVE, wave(2.2), 3.0)])
def test_pressed_rail_that_moves_is_a_two_sided_one(where):
    """Contact and joint are one constraint in two forms, with different code."""
    at = np.linspace(0.0, 0.25, 6)
    two, one = (
        carom.simulate(on_hoop(*where, **rail), 0.25, rtol=1e-11, atol=1e-11, save_at=at)
        for rail in ({}, {"side": (0, 0, 1)})
    )
    assert np.all(one["bead-rail"].mode == "slipping")
    np.testing.assert_allclose(one.position, two.position, atol=1e-10)
    np.testing.assert_allclose(
        one["rail"].force + one["bead-rail"].vector, two["rail"].force, atol=1e-8
    )
    np.testing.assert_allclose(one["rail"].coordinate, two["rail"].coordinate, atol=1e-10)


def test_bounces_on_a_helix_have_closed_forms():
    """Above a helix the bead goes round its cylinder evenly, and falls."""
    r, pitch, e, speed, height = 0.5, 0.2, 0.5, 1.5, 0.3
    helix = carom.curves.Curve(lambda u: (r * math.cos(u), r * math.sin(u), -pitch * u), 0, 40)
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(
        carom.Sphere(0.02), mass=MASS, position=(r, 0, height), velocity=(0, speed, 0), name="bead"
    )
    rail = carom.joints.PointOnCurve(helix, side=(0, 0, 1), restitution=e)
    scene.add_joint(rail, carom.GROUND, "bead", name="rail")
    s = carom.simulate(scene, 0.9, rtol=1e-10, atol=1e-10)
    cos, sin = r / math.hypot(r, pitch), -pitch / math.hypot(r, pitch)
    # height + (pitch/r) v t = g t^2/2
    fall = (pitch / r * speed + math.sqrt((pitch / r * speed) ** 2 + 2 * G * height)) / G
    normal, along = -cos * G * fall - sin * speed, cos * speed - sin * G * fall
    ahead, up = along * cos + e * normal * sin, along * sin - e * normal * cos
    again = 2 * (up - sin / cos * ahead) / G
    np.testing.assert_allclose(s.impacts.time[:2], (fall, fall + again), atol=1e-9)
    np.testing.assert_allclose(
        s.impacts.relative_velocity_before[0], (normal, along, 0.0), atol=1e-8
    )
    np.testing.assert_allclose(np.hypot(*s.position[:, 0, :2].T), r, atol=1e-11)
    flies = s.t < fall
    t = s.t[flies]
    np.testing.assert_allclose(
        s["bead-rail"].gap[flies],
        cos * (height + pitch / r * speed * t - 0.5 * G * t**2),
        atol=1e-9,
    )
    np.testing.assert_allclose(s["rail"].coordinate[flies], speed * t / cos, atol=1e-9)
    np.testing.assert_allclose(s["rail"].rate[flies], speed / cos, atol=1e-9)
    closes(s, 1e-8)


def test_blow_of_a_rail_and_of_the_joint_change_the_momenta():
    scene = on_hoop(side=(0, 0, 1), restitution=0.5, friction=0.2)
    bead = scene["bead"]
    scene.replace("bead", velocity=bead.velocity - 6.0 * np.array(ring(2.5)))
    s = carom.simulate(scene, 1.0)
    assert len(s.impacts) > 0
    blow, share = s.impacts[0], s.joint_impulses[0]
    before, after = (np.array(s.evaluate(blow.time, side)[2]) for side in ("left", "right"))
    from carom.results.joint_impulses import world_impulses

    change = 0.5 * (after - before)[1]
    np.testing.assert_allclose(share.impulse + world_impulses(s)[0], change, atol=1e-8)
    total = s.ledger.residual
    np.testing.assert_allclose(total, 0.0, atol=1e-6)


def test_ski_jump_lands_on_the_slope():
    """The parabola from a state in flight meets the hill, by the curve alone."""
    points = [(-9, 0, 5.0), (-6, 0, 3), (-3, 0, 1), (-1, 0, 0.05), (0, 0, 0)]
    slope = [(1 + 2 * k, 0, -0.8 - 1.4 * k) for k in range(12)]
    hill = carom.curves.Spline([*points, *slope])
    scene = carom.Scene(gravity=(0, 0, -G))
    start = hill.nearest((-6, 0, 3))
    scene.add_body(carom.Sphere(0.1), mass=70.0, position=hill.point(start), name="jumper")
    rail = carom.joints.PointOnCurve(hill, side=(0, 0, 1))
    scene.add_joint(rail, carom.GROUND, "jumper", name="hill")
    s = carom.simulate(scene, 3.2, rtol=1e-10, atol=1e-10)
    k = np.argmax(s.t > s.contacts.end[0])
    x, v, t = s.position[k, 0], s.velocity[k, 0], s.t[k]

    def above(t):
        p = x + v * t - (0, 0, 0.5 * G * t * t)
        c = hill.nearest(p)
        return np.cross(hill.tangent(c), (0, -1, 0)) @ (p - hill.point(c))

    landing = brentq(above, 0.1, 2.0, xtol=1e-13)
    assert s.impacts.time[0] == pytest.approx(t + landing, abs=1e-9)
    closes(s, 1e-5)


def test_file_goes_on_to_the_bit(tmp_path):
    scene = on_circle(math.pi, -math.sqrt(3.6 * G), restitution=0.5, friction=0.1)
    s, whole = carom.simulate(scene, 1.0, step=2e-3), carom.simulate(scene, 1.6, step=2e-3)
    s.save(tmp_path / "rail.nc")
    again = carom.Solution.load(tmp_path / "rail.nc")
    assert again.scene["rail"].definition.friction == 0.1
    assert np.array_equal(s["bead-rail"].gap, again["bead-rail"].gap)
    more = again.simulate(0.6)
    assert len(whole.impacts) > 0
    assert np.array_equal(more.position[-1], whole.position[-1])


def test_open_rail_ends_in_flight_too():
    arch = carom.curves.Curve(ring, -1.5, 1.5)
    with pytest.raises(carom.SimulationError, match="passed an end of its curve") as failed:
        carom.simulate(on_circle(0.1, 0.0, arch), 3.0)
    end = failed.value.solution
    assert end.status is carom.Status.LEFT_CURVE
    assert end["bead-rail"].mode[-1] == "open"


def test_what_is_no_rail_that_can_be_left():
    steep = carom.curves.Curve(lambda u: (math.cos(u), 0.3 * u**2, math.sin(u)), -1.0, 1.0)
    for curve, side, what in (
        (CIRCLE, (1, 0, 0), "side must not be along the curve"),
        (CIRCLE, (0, 1, 0), "side must not be perpendicular to the plane"),
        (steep, (0, 0, 1), "side must not be along a curve in space anywhere"),
    ):
        scene = carom.Scene()
        bead = scene.add_body(carom.Sphere(0.1), mass=1.0, position=curve.point(0))
        with pytest.raises(ValueError, match=what):
            scene.add_joint(carom.joints.PointOnCurve(curve, side=side), carom.GROUND, bead)
    with pytest.raises(ValueError, match="friction must be that of a rail that can be left"):
        carom.joints.PointOnCurve(CIRCLE, friction=0.1)
    scene = on_circle(0.1, 0.0)
    with pytest.raises(ValueError, match="joint must be two-sided"):
        scene.add_force(carom.forces.JointFriction("rail", 1.0))
    with pytest.raises(ValueError, match="joint must be two-sided"):
        scene.add_stop("rail", lower=-1.0)
    scene.replace("bead", position=0.9 * np.array(ring(0.1)))
    with pytest.raises(ValueError, match="must be on the free side of the rail, got a gap of -0"):
        carom.simulate(scene, 0.1)


@pytest.mark.parametrize("seed", [2, 5, 8, 11])
def test_random_rails(seed):
    """The short form of benchmarks/campaigns/loose_rails.py."""
    case = loose_rails.case(seed)
    assert wrong(as_row("loose rails", seed, case, run(case))) == []
