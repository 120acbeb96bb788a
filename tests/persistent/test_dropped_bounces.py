"""The friction of bounces that are not resolved: what slides on has the speed that all of them would have left.

Along an incline v(t) = v(0) + g t sin - mu P/m, with P the normal impulse of all impacts and of the hold. What
starts without normal velocity and ends without has P = m g t cos, whatever happens between, as long as it slips
one way.
"""

import numpy as np
import pytest

import carom

G = 9.81


def slide(shape, step, *, e=0.5, mu=0.1, angle=0.7, height=0.1, law="stronge", time=2.0):
    """Drop a body onto an incline; return the solution and its speed down it, less the closed form."""
    normal = np.array([np.sin(angle), 0, np.cos(angle)])
    down = np.array([np.cos(angle), 0, -np.sin(angle)])
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), normal)
    body = scene.add_body(
        shape, mass=1.3, position=(height + 0.2) * normal,
        orientation=(np.cos(angle / 2), 0, np.sin(angle / 2), 0),
    )  # fmt: skip
    scene.add_contact(body, ground, restitution=e, friction=mu, impact_law=law)
    s = carom.simulate(scene, time, step=step)
    return s, s.velocity[-1, 0] @ down - G * time * (np.sin(angle) - mu * np.cos(angle))


@pytest.mark.parametrize("step", [1e-2, 1e-3])
@pytest.mark.parametrize("law", ["newton", "poisson"])
def test_a_ball_that_bounces_down_an_incline_and_slides(step, law):
    s, error = slide(carom.Sphere(0.1), step, law=law)
    assert s.contacts.mode[-1] == "slipping"
    assert s.ledger.bounces[-1] < 0.0
    assert (
        abs(error) < 1e-11
    )  # mu times the dropped normal speed is 3e-4 m/s at 10 ms, 8e-5 at 1 ms


@pytest.mark.parametrize("step", [1e-2, 1e-3])
def test_a_box_that_tumbles_until_it_slides_on_a_face(step):
    # Friction turns it at the first blow: edges and corners strike some forty times, many at once.
    s, error = slide(carom.Box(0.2, 0.2, 0.2), step)
    assert len(s.impacts) > 20
    assert np.all(s.angular_velocity[-1] == pytest.approx(0.0, abs=1e-9))
    assert (
        abs(error) < 1e-9
    )  # of steps of order 4; 3e-3 and 4e-4 m/s if bounces took no friction along


def test_friction_takes_no_energy_back():
    # The friction that goes with the pull is less than what the hold takes until the bounces would have ended,
    # and that is within the step: no line of the ledger rises from one saved time to the next.
    for shape in (carom.Sphere(0.1), carom.Box(0.2, 0.2, 0.2)):
        s, _ = slide(shape, 1e-2)
        for line in (s.ledger.impacts, s.ledger.friction, s.ledger.bounces):
            assert np.all(np.diff(line) <= 1e-12)


# of 1000 drawn at random those whose line rose most, by 1e-2 to 1e-1 of all energy: tilt [rad], slip [m/s], mu,
# e and the height of the lower edge [m]
SLABS = [
    (8.341e-5, 0.1058, 0.9152, 0.4941, 2.019e-4),
    (3.540e-4, 0.1182, 0.7693, 0.3500, 3.159e-4),
    (9.122e-4, 0.1132, 0.8531, 0.3689, 3.961e-4),
    (3.101e-4, 0.2320, 0.8428, 0.4033, 3.438e-4),
    (6.889e-4, -0.210, 0.9598, 0.3521, 3.719e-4),
    (4.339e-4, 0.4117, 0.5108, 0.1936, 8.228e-4),
    (2.073e-5, 1.3700, 0.5824, 0.5709, 1.337e-4),
]


def drop_slab(scene, ground, place, tilt, slip, mu, e, height):
    """Add a slab that slides as it falls, nearly flat."""
    z = 0.1 * np.sin(tilt) + 0.01 * np.cos(tilt) + height
    slab = scene.add_body(
        carom.Box(0.2, 0.1, 0.02), mass=1.0, position=(0, place, z), velocity=(slip, 0, 0),
        orientation=(np.cos(tilt / 2), 0, np.sin(tilt / 2), 0),
    )  # fmt: skip
    scene.add_contact(slab, ground, restitution=e, friction=mu)
    return slab


@pytest.mark.parametrize("islands", [False, True])
def test_friction_gives_nothing_where_the_other_edge_strikes_first(islands):
    # One edge is held with the friction of bounces that the blow at the other edge ends: what that gave the
    # hold has not taken back by the end of the step. Slabs beside each other are islands.
    for k, values in enumerate(SLABS):
        scene = carom.Scene(gravity=(0, 0, -G))
        ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
        slab = drop_slab(scene, ground, 0.0, *values)
        if islands:
            other = drop_slab(scene, ground, 1.0, *SLABS[k - 1])
            scene.add_contact(slab, other, restitution=0.5, friction=0.5)
        s = carom.simulate(scene, 0.1, step=0.02)
        energy = np.max(s.kinetic_energy)
        for line in (s.ledger.impacts, s.ledger.friction, s.ledger.bounces):
            assert np.all(np.diff(line, prepend=0.0) <= 1e-12 * energy), k
        assert np.all(np.abs(s.ledger.residual) <= 1e-5 * energy), k  # 2e-8 of m g L a step


def test_a_ball_that_sticks_rolls_on_with_its_angular_momentum():
    # About the line of contact: 2/5 w r^2 + v r is kept by all impacts and by sliding on level ground.
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(
        carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.3), velocity=(2, 0, 0),
        angular_velocity=(0, -10, 0),
    )  # fmt: skip
    scene.add_contact(ball, ground, restitution=0.4, friction=0.15)
    s = carom.simulate(scene, 3.0, step=5e-3)
    assert s.velocity[-1, 0, 0] == pytest.approx(5 / 7 * (2.0 - 0.4 * 0.1 * 10), abs=1e-12)


@pytest.mark.parametrize("how", [{"rtol": 1e-6}, {"rtol": 1e-10}, {"step": 1e-2}])
def test_rolling_friction_begins_when_the_bounces_have_ended(how):
    # A ball on ice (no friction of slip) keeps its spin in impacts. Its bounces end at
    # t = t0 + 2 e u0/(g (1 - e)), u0 = g t0, t0 = sqrt(2 h/g); from then on w = w0 - d m g (t - t_end)/J.
    e, h, d, m, J, w0, end = 0.4, 0.05, 1e-3, 1.0, 4e-3, 5.0, 0.5
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(
        carom.Sphere(0.1),
        mass=m,
        inertia=[J] * 3,
        position=(0, 0, 0.1 + h),
        angular_velocity=(0, w0, 0),
    )
    scene.add_contact(ball, ground, restitution=e, friction=0.0, rolling_friction=d)
    s = carom.simulate(scene, end, **how)
    first = np.sqrt(2 * h / G)
    left = end - first * (1 + 2 * e / (1 - e))
    assert s.angular_velocity[-1, 0, 1] == pytest.approx(w0 - d * m * G * left / J, abs=1e-10)
