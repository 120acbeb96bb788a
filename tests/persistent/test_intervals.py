"""Intervals of contact that stays, from the events of a run."""

import numpy as np
import pytest

import carom

G = 9.81


def test_a_ball_slides_rolls_and_leaves():
    # Slides for 2 v0/(7 mu g), rolls to the end of the table of a run.
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 0.1), velocity=(1, 0, 0))
    scene.add_contact(ball, ground, restitution=0.5, friction=0.2)
    c = carom.simulate(scene, 0.5, step=0.01).contacts
    assert list(c.contact) == [0, 0]
    assert list(c.feature) == [0, 0]
    assert list(c.mode) == ["slipping", "sticking"]
    roll = 2 / (7 * 0.2 * G)
    np.testing.assert_allclose(c.start, [0.0, roll], rtol=0, atol=1e-12)
    np.testing.assert_allclose(c.end, [roll, 0.5], rtol=0, atol=1e-12)


def test_a_box_slides_to_a_stop_and_another_is_in_flight():
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    high = scene.add_body(carom.Sphere(0.1), mass=1, position=(3, 0, 9))
    shape = carom.Box(0.2, 0.1, 0.06)
    box = scene.add_body(shape, mass=1, position=(0, 0, 0.03), velocity=(1, 0, 0))
    scene.add_contact(high, ground, friction=0)
    scene.add_contact(box, ground, friction=0.3)
    c = carom.simulate(scene, 0.5, step=0.01).contacts
    assert list(c.contact) == 8 * [1]
    assert sorted(c.feature[:4]) == sorted(c.feature[4:])
    low = shape.vertices[c.feature]
    np.testing.assert_array_equal(low[:, 2], -0.03)
    assert list(c.mode) == 4 * ["slipping"] + 4 * ["sticking"]
    np.testing.assert_allclose(c.end[:4], 1 / (0.3 * G), rtol=0, atol=1e-12)
    np.testing.assert_array_equal(c.start[4:], c.end[:4])
    np.testing.assert_array_equal(c.end[4:], 0.5)


def test_intervals_of_a_thrown_die_follow_each_other():
    q = np.random.default_rng(7).normal(size=4)
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    die = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3),
        orientation=q / np.linalg.norm(q), velocity=(0.5, 0, -0.5), angular_velocity=(0, 10, 0),
    )  # fmt: skip
    scene.add_contact(die, ground, restitution=0.5, friction=0.2)
    s = carom.simulate(scene, 1.5, step=1e-3)
    c = s.contacts
    assert np.all(np.diff(c.start) >= 0)
    assert np.all(c.end >= c.start)
    for vertex in np.unique(c.feature):
        own = c.feature == vertex
        assert np.all(c.start[own][1:] >= c.end[own][:-1])
    last = c.end == 1.5
    assert np.count_nonzero(last) == 4
    assert np.all(c.mode[last] == "sticking")
    # at a saved time the contact slips or sticks just if a point of it does
    for k in range(0, len(s.t), 7):
        now = (c.start < s.t[k]) & (s.t[k] < c.end)
        edge = np.any(
            np.isclose(c.start, s.t[k], atol=1e-12) | np.isclose(c.end, s.t[k], atol=1e-12)
        )
        assert edge or np.any(now) == (s.contact_mode[k, 0] > 0)


def test_tables_are_counted_by_rows():
    """`len` of a table is the number of its rows, not of its columns."""
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.1), velocity=(1, 0, 0))
    scene.add_contact(ball, floor, restitution=0.0, friction=0.1)
    slides = carom.simulate(scene, 0.1, step=0.01)
    assert (len(slides.contacts), len(slides.events), len(slides.forces)) == (1, 1, 11)
    assert slides.contacts[0]["mode"] == "slipping"
    assert [row["kind"] for row in slides.events] == ["held"]
    assert repr(slides.contacts).startswith(
        "<ContactTable: 1 rows\n  contact = 0  feature = 0  start = 0"
    )
    assert repr(slides.forces).endswith("... 3 more>")
    with pytest.raises(IndexError, match="there is no row 1: the table has 1"):
        slides.contacts[1]
