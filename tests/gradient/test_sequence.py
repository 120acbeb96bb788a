"""Where there is no derivative, and how far the next change of sequence is: it is said."""

import numpy as np
import pytest

import carom

from .thrown import NAMES, throw

FLAT = ("die.position", "die.velocity", "die.angular_velocity", "restitution", "friction")


def planar(duration=0.42, mu=0.2, **more):
    """Return the throw of a die that strikes with an edge: two vertices at once."""
    scene = carom.Scene()
    table = scene.add_half_space((0, 0, 0), (0, 0, 1), name="table")
    start = {"velocity": (0.5, 0, -0.5), "angular_velocity": (0, 10, 0), **more}
    die = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3), name="die", **start
    )
    scene.add_contact(die, table, restitution=0.5, friction=mu)
    return carom.simulate(scene, duration, step=1e-3)


def test_points_that_strike_as_one_have_derivatives_in_their_plane():
    run = planar(0.26)
    with pytest.raises(
        ValueError, match=r"several points, which do not stay together.*velocity\.y"
    ):
        carom.sensitivities(run, FLAT)
    found = carom.sensitivities(run, FLAT, throw=False)
    good = [
        k for k, label in enumerate(found.labels) if not np.isnan(found.final.position[0, 0, k])
    ]
    names = {found.labels[k] for k in good}
    assert {"die.velocity.x", "die.velocity.z", "die.angular_velocity.y", "friction"} <= names
    assert not names & {"die.velocity.y", "die.angular_velocity.x", "die.angular_velocity.z"}
    assert len(found.notes) == 1

    # those in the plane are right
    k, h = found.columns["die.velocity"].start, 1e-4
    ends = [planar(0.26, velocity=(0.5 + s * h, 0, -0.5)).velocity[-1, 0] for s in (1, -1)]
    np.testing.assert_allclose(
        found.final.velocity[0, :, k], (ends[0] - ends[1]) / (2 * h), rtol=1e-6, atol=1e-6
    )


def test_a_contact_that_is_held_ends_the_derivatives_and_those_before_stay():
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.15), name="ball")
    scene.add_contact(ball, floor, restitution=0.3, friction=0.1)
    run = carom.simulate(scene, 0.5, step=1e-3)
    with pytest.raises(ValueError, match=r"'ball' begins a persistent contact at t = 0\.1"):
        carom.sensitivities(run, "ball.position")
    found = carom.sensitivities(run, ("ball.position", "restitution"), throw=False)
    assert np.all(np.isnan(found.final.position[0, :, 2:]))
    assert np.all(np.isfinite(found.impact_time[:3]))
    np.testing.assert_allclose(found.impact_time[0, 2], 1 / np.sqrt(2 * 9.81 * 0.05), rtol=1e-10)
    assert np.all(np.isfinite(found.evaluate(0.11).position))
    assert "no derivative: 'ball' begins a persistent contact" in repr(found)


def test_several_points_at_once_have_none():
    run = planar(0.3, velocity=(0.5, 0, -0.5), angular_velocity=(0, 0, 3))  # flat on its face
    assert run.impacts.together[0] == 4
    found = carom.sensitivities(run, ("die.position", "friction"), throw=False)
    assert "with several points" in found.notes[0]
    assert np.all(np.isnan(found.final.velocity))


def test_a_body_that_nothing_concerns_has_zero_not_nan():
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    a = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.1), name="a")
    b = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(1, 0, 1.0), name="b")
    scene.add_contact(a, floor, restitution=0.3)
    scene.add_contact(b, floor, restitution=0.3)
    found = carom.sensitivities(carom.simulate(scene, 0.2, step=1e-3), "b.velocity")
    assert np.all(found.final.position[0] == 0.0)
    np.testing.assert_allclose(found.final.position[1], 0.2 * np.eye(3), rtol=1e-14)


@pytest.mark.parametrize(
    "label", ["die.position.z", "die.velocity.z", "die.orientation.x", "gravity.z"]
)
def test_the_sequence_changes_where_reach_says(label):
    reference = throw()
    found = carom.sensitivities(reference, NAMES)
    k = found.labels.index(label)
    margin = min(found.margins, key=lambda m: m.reach[k])
    # towards the change, to first order: half the way nothing happens, at one and a half the way it has
    toward = -np.sign(margin.gradient[k]) * found.reach[k]
    z = np.zeros(24)
    before, after = [], []
    for part, runs in ((0.5, before), (1.5, after)):
        z[k] = part * toward
        runs.append(carom.contact_sequence(throw(z)))
    assert before[0] == carom.contact_sequence(reference)
    assert after[0] != carom.contact_sequence(reference)


def test_margins_are_differentiated():
    # the margins of a neighbour are those of the run plus their derivatives
    one = carom.sensitivities(throw(), NAMES)
    kinds = set()
    for label, h in (("die.velocity.z", 1e-5), ("die-ground.restitution", 1e-6)):
        k = one.labels.index(label)
        z = np.zeros(24)
        z[k] = h
        other = carom.sensitivities(throw(z), NAMES)
        found = {(m.impact, m.what): m for m in other.margins}
        assert len(found) == len(one.margins)
        for m in one.margins:
            change = found[m.impact, m.what].value - m.value
            kinds.add(m.what.split()[0])
            scale = max(abs(m.gradient[k]), 1e-3 * m.value / m.relative)
            assert abs(change / h - m.gradient[k]) < 2e-3 * scale + 1e-2 * (m.impact < 0), m.what
    assert {"gap", "slip", "speed", "time"} <= kinds


def test_what_sticks_says_how_much_friction_is_left():
    found = carom.sensitivities(throw(mu=1.2), NAMES)
    left = [m for m in found.margins if "friction above" in m.what or "impulse after" in m.what]
    k = found.columns["die-ground.friction"]
    assert left
    for m in left:
        if "friction above" in m.what and m.impact == 0:
            assert m.gradient[k] == pytest.approx(1.0, abs=1e-9)
        assert m.value > 0.0


@pytest.mark.parametrize(
    ("names", "words"),
    [
        ("die.velocitty", "velocity"),
        ("dice.velocity", "did you mean 'die'"),
        ("ground.velocity", "fields of bodies or contacts"),
        ("mass", "gravity"),
        ((), "at least one"),
        (("gravity", "gravity"), "twice"),
        ("die-ground.mass", "restitution"),
    ],
)
def test_names_that_are_none_are_refused(names, words):
    run = throw(duration=0.01)
    with pytest.raises(ValueError, match=words):
        carom.sensitivities(run, names)


def test_scenes_and_methods_that_are_not_done_are_refused():
    scene = carom.Scene()
    rod = scene.add_body(mass=1, inertia=(1, 1, 1), position=(1, 0, 0), name="rod")
    scene.add_joint(carom.joints.Spherical((0, 0, 0)), carom.GROUND, rod)
    with pytest.raises(ValueError, match='free bodies for by="saltation"'):
        carom.sensitivities(carom.simulate(scene, 0.01, step=1e-2), "rod.mass", by="saltation")
    with pytest.raises(TypeError, match="Solution"):
        carom.sensitivities(scene, "rod.mass")
    run = throw(duration=0.01)
    with pytest.raises(ValueError, match=r"within \[0, 0.01\] s, got 2"):
        carom.sensitivities(run, "gravity").evaluate(2.0)


def test_derivatives_between_impacts():
    run = throw()
    found = carom.sensitivities(run, NAMES)
    t1, t2 = run.impacts.time[:2]
    many = found.evaluate([0.0, 0.5 * (t1 + t2), run.t[-1]])
    np.testing.assert_array_equal(many.position[2], found.final.position)
    start = np.concatenate([a[0, 0] for a in many])
    np.testing.assert_array_equal(start[:, :12], np.eye(12))
    # a run that ends there has the same
    short = carom.sensitivities(throw(duration=0.5 * (t1 + t2)), NAMES)
    np.testing.assert_allclose(many.velocity[1], short.final.velocity, rtol=1e-9, atol=1e-7)


def test_sequences_tell_slip_from_stick_and_not_from_none():
    phases = [
        carom.contact_sequence(throw(mu=mu, duration=0.0908))[0].phases for mu in (0, 0.2, 1.2)
    ]
    assert phases[:2] == [(), ()]
    assert phases[2][-1] == "stick"
    event = carom.contact_sequence(throw(duration=0.0908))[0]
    assert (event.event, event.contact, event.phases, event.together) == ("impact", 0, (), 1)
