"""Frames, places, bodies, planes, impacts and forces as both viewers take them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import carom
from carom.geometry import quaternion
from carom.visual import bodies
from carom.visual.films import still
from carom.visual.viewer import frames, planes, strikes
from carom.visual.viewer.pack import Packer
from carom.visual.viewer.page import header
from carom.visual.viewer.planes import grid_lines, round_length
from carom.visual.viewer.show import playing_speed, show_of
from files.scenes import pile
from simulate.scenes import G


def test_frames_hold_saved_times_and_impacts(thrown):
    shown = frames.frames_of(thrown)
    assert np.all(np.isin(thrown.t, shown.time))
    assert np.all(np.isin(thrown.impacts.time, shown.time))
    assert frames.SMOOTH <= 2 * len(shown.time) <= 2.1 * frames.SMOOTH
    assert show_of(thrown).left_out == []


def test_a_curve_is_a_closed_tube_in_its_body(tmp_path):
    scene = carom.Scene()
    pin, plate = (
        scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, z)) for z in (1.0, 3.0)
    )
    arc = carom.curves.Curve(lambda u: (np.sin(u), 0, 1 + np.cos(u)), 0.0, 6.0)
    scene.add_joint(carom.joints.PointOnCurve(arc, arc.point(0)), carom.GROUND, plate)
    scene.add_joint(carom.joints.CurveOnPoint(arc, arc.point(0)), pin, plate)
    rails = [part for part in bodies.parts_of(scene, 10.0) if len(part.vertices) > 1000]
    assert [(part.bodies, part.look) for part in rails] == [([-1], "static"), ([1], "joint")]
    for part, centre in zip(rails, (1.0, -2.0)):
        a, b, c = part.vertices[part.triangles].swapaxes(0, 1)
        area = 0.5 * 8 * np.sin(np.pi / 4) * 0.06**2  # of a ring with eight sides
        volume = np.sum(np.cross(a, b) * c) / 6
        assert volume == pytest.approx(area * arc.length, rel=1e-3)  # so they are turned outwards
        away = np.linalg.norm(part.vertices - (0, 0, centre), axis=1)
        assert np.max(np.abs(away - 1.0)) < 0.0601
    (ground,) = bodies.ground_curves(scene, 5)
    np.testing.assert_allclose(ground, arc.point(np.linspace(0, arc.length, 5)), atol=1e-15)
    shown = carom.simulate(scene, 0.01, step=1e-3)
    shown.export(tmp_path / "rails.glb")  # with the names of the parts
    carom.view(shown, export=tmp_path / "rails.html")


def test_frames_are_thinned(thrown):
    shown = frames.frames_of(thrown, 20)
    assert len(shown.time) <= 20 + len(thrown.impacts)
    assert np.all(np.isin(thrown.impacts.time, shown.time))
    assert (shown.time[0], shown.time[-1]) == (thrown.t[0], thrown.t[-1])
    assert "of 51 saved times" in show_of(thrown, most=20).left_out[0]


def test_between_frames_nobody_sees_a_difference(thrown):
    """A straight line misses a fall by at most g h^2 / 8 in a step h; the turn is steady but for gyration."""
    shown = frames.frames_of(thrown)
    h = np.max(np.diff(shown.time))
    for t in np.linspace(0.0, 0.25, 37):
        x, Q = frames.poses_at(shown, t)
        exact = thrown.evaluate(t)
        assert np.max(np.abs(x - exact[0])) <= 1.01 * G * h**2 / 8 + 1e-12
        assert 1.0 - np.abs(Q[0] @ exact[1][0]) < 1e-6


def test_a_motion_in_a_plane_is_seen_from_across_it():
    up, place = np.array([0, 0, 1.0]), np.random.default_rng(1).normal(size=(40, 1, 3))
    along = np.array([0.6, 0.8, 0.0])
    flat = place[..., :1] * along + place[..., 2:] * up
    side, lift = frames._view(flat, up)
    assert abs(side @ along) < 1e-12
    assert np.cross(up, side)[0] > 0.5  # x goes to the right
    assert abs(frames._view(place, up)[0] @ up) < 1e-12
    level = place - place[..., 2:] * up
    assert frames._view(level, up)[1] > 0.8 > lift  # as on a table, from above
    assert np.allclose(frames._up(np.zeros(3), level), (0, 1, 0))  # without gravity it stands up
    assert np.allclose(frames._up(np.array([0, -G, 0]), level), (0, 1, 0))


def test_a_body_without_a_shape_is_the_ellipsoid_of_its_inertia():
    """Points of the surface fulfil x.A x = 1 with A of semi-axes a: I_x = m (b^2 + c^2) / 5, and so on."""
    turn = quaternion.rotate([0.5, 0.5, 0.5, 0.5], np.eye(3)).T
    inertia = turn @ np.diag(0.4 * np.array([13.0, 10.0, 5.0])) @ turn.T  # m = 2; a, b, c = 1, 2, 3
    scene = carom.Scene()
    scene.add_body(mass=2.0, inertia=inertia)
    (part,) = bodies.parts_of(scene, 1.0)
    local = part.vertices @ turn / [1.0, 2.0, 3.0]
    assert np.allclose(np.linalg.norm(local, axis=1), 1.0, atol=1e-12)
    a, b, c = part.vertices[part.triangles].transpose(1, 0, 2)
    assert np.sum(a * np.cross(b, c)) > 0  # turned outwards


def test_rods_reach_from_the_mass_centre_to_the_hinges():
    scene = carom.Scene()
    rod = scene.add_body(mass=1, inertia=(1, 1, 1), position=(1, 0, 0))
    scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, rod)
    turn = (np.sqrt(0.5), 0, 0, np.sqrt(0.5))
    hinge = carom.joints.Revolute((0, 0, 0), (0, 1, 0))
    arm = scene.add_body(mass=1, inertia=(1, 1, 1), position=(1, 2, 0), orientation=turn)
    frame = ((0, 1, 0), (1, 0, 0, 0)), ((-1, 0, 0), (1, 0, 0, 0))
    scene.add_joint(hinge, rod, arm, parent_frame=frame[0], child_frame=frame[1])
    parts = bodies.parts_of(scene, 1.0)
    reach = {b: np.vstack([p.vertices for p in parts if b in p.bodies]) for b in (0, 1)}
    thick = bodies.ROD
    for b, anchor in ((0, (-1, 0, 0)), (0, (0, 1, 0)), (1, (-1, 0, 0))):
        away = np.linalg.norm(reach[b] - anchor, axis=1)
        assert np.sum(away < thick * 1.001) > 20  # the ball of the joint
    assert bodies.outline_of(scene, rod).radius == 1.0


def test_the_place_is_the_box_of_all_that_is_reached(swung):
    """A rod that falls by 1.2 rad and has its hinge and its mass centre, 0.5 m away, as outline."""
    place = show_of(swung).place
    low, high = np.array([0, 0, -0.5 * np.sin(1.2)]), np.array([0.5, 0, 0])
    assert np.allclose(place.centre, (low + high) / 2, atol=1e-6)
    assert place.radius == pytest.approx(np.linalg.norm(high - low) / 2, abs=1e-6)
    assert np.allclose(np.abs(place.side), (0, 1, 0), atol=1e-6)


def test_springs_and_rods_join_their_anchors():
    scene = carom.Scene()
    turn = np.array([0.5, 0.5, 0.5, 0.5])
    one = scene.add_body(carom.Sphere(0.1), mass=1, position=(1, 2, 3), orientation=turn)
    scene.add_force(carom.forces.Spring(5.0, (0, 0, 4), (1, 2, 3.1)), one)
    scene.add_joint(carom.joints.Distance((0, 0, 0), (1, 2.1, 3)), carom.GROUND, one)
    spring, rod = bodies.links_of(scene)
    assert (spring.kind, rod.kind) == ("spring", "rod")
    for link, end in ((spring, (1, 2, 3.1)), (rod, (1, 2.1, 3))):
        place = one.position + quaternion.rotate(turn, link.child_anchor)
        assert np.allclose(place, end, atol=1e-15)
        assert link.parent == -1
    assert np.array_equal(bodies.ground_points(scene), [(0, 0, 4), (0, 0, 0)])


def parted():
    """A stone on a string that breaks, a box on a spring that is cut at .3 s, and one that comes at .2 s."""
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.08), mass=1.0, position=(-1, 0, 0), name="stone")
    string = carom.joints.Tether(1.0, anchor_parent=(0, 0, 0))
    scene.add_joint(string, carom.GROUND, "stone", name="string", breaks_at=20.0)
    scene.add_body(carom.Box(0.2, 0.2, 0.2), mass=1.0, position=(0.8, 0, -0.5), name="box")
    for name, x in (("cut", 0.8), ("comes", 0.9)):
        spring = carom.forces.Spring(40.0, (x, 0, 0.2), (x, 0, -0.5), rest_length=0.5)
        scene.add_force(spring, "box", name=name)
    scene.switch("cut", at=0.3)
    scene.switch("comes", at=0.2, off=False)
    return carom.simulate(scene, 0.6)


def test_what_broke_or_was_switched_is_drawn_while_it_is_there():
    run = parted()
    broke = run.switches.time[-1]
    times = {"cut": (-1.0, 0.3), "comes": (0.2, 1.0), "string": (-1.0, broke)}
    links = {link.part: link for link in bodies.links_in(run)}
    assert set(links) == set(times)
    for name, (begin, end) in times.items():
        for t in (0.0, 0.1999, 0.2, 0.2999, 0.3, broke - 1e-9, broke, 0.6):
            assert links[name].is_there(t) == (begin <= t < end), (name, t)
    show = show_of(run)
    made = header(show, Packer())["links"]
    there = {link.part: one["there"] for link, one in zip(show.links, made)}
    assert there["cut"] == [[-1.0, 0.2], [0.2, 0.3]]
    assert there["comes"] == [[0.2, 0.3], [0.3, broke], [broke, 1.6]]
    # without switches nothing is said
    assert all(link.there is None for link in bodies.links_in(carom.simulate(pile(2), 0.01)))


def test_a_still_shows_the_string_until_it_breaks():
    run = parted()
    broke = run.switches.time[-1]
    middle = {}
    for t in (broke - 1e-3, broke + 1e-3):
        picture = still(run, t, size=(320, 240), view="front", clock=False).astype(int)
        middle[t] = np.count_nonzero(np.all(abs(picture - 70) < 30, axis=2))  # of cords
    first, second = middle.values()
    assert second < 0.8 * first


def test_equal_shapes_are_one_part():
    scene = pile(4)
    (part,) = bodies.parts_of(scene, 1.0)
    assert (part.bodies, part.look) == ([0, 1, 2, 3], "round")


def test_half_spaces_end_at_walls():
    """Of a corner of three half-spaces nothing is drawn behind the others."""
    scene = pile(3)
    position = np.array([body.position for body in scene.bodies])[None]
    place = frames.Place(position[0, 1], 1.0, np.array([0, 0, 1.0]), np.array([0.6, -0.8, 0]), 0.3)
    drawn = planes.planes_of(scene, place, position)
    assert len(drawn) == 3
    for plane in drawn:
        assert np.all(plane.corners >= -1e-12)
        own = next(h for h in scene.half_spaces if h.name == plane.name)
        assert np.allclose((plane.corners - own.point) @ own.normal, 0.0, atol=1e-12)
        lines = grid_lines(plane, 0.1)
        assert len(lines) > 5
        assert np.all(lines >= -1e-9)
        assert np.allclose(lines @ plane.normal, plane.corners[0] @ plane.normal)


def area(corners, normal):
    if len(corners) < 3:
        return 0.0
    return 0.5 * sum(
        np.cross(corners[k] - corners[0], corners[k + 1] - corners[0]) @ normal
        for k in range(1, len(corners) - 1)
    )


@given(st.integers(0, 10**6))
def test_a_cut_leaves_what_is_in_front(seed):
    """Both sides of a cut together have the area of the whole."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 6))
    up, corners = np.array([0, 0, 1.0]), np.stack([np.cos(angles), np.sin(angles), 0 * angles], 1)
    point, normal = rng.normal(size=3) * 0.4, rng.normal(size=3)
    front, back = (planes._cut(corners, point, s * normal) for s in (1, -1))
    assert np.all((front - point) @ normal >= -1e-9)
    assert abs(area(front, up) + area(back, up) - area(corners, up)) < 1e-9


@given(st.floats(1e-6, 1e6))
def test_round_lengths(x):
    r = round_length(x)
    assert r <= x * (1 + 1e-9) < 2.5 * r * (1 + 1e-9)
    assert f"{r:.6e}"[0] in "125"


def test_arrows_of_impacts_are_the_change_of_momentum(thrown):
    shown = strikes.strikes_of(thrown)
    for k, t in enumerate(thrown.impacts.time):
        before, after = (thrown.evaluate(t, side)[2][0] for side in ("left", "right"))
        assert np.allclose(shown.arrow[k], 0.016 * (after - before), atol=1e-15)
    assert shown.contact == ["body1-half_space1"] * len(thrown.impacts)


def test_arrow_between_two_bodies():
    """Two balls with friction, one at rest: what the first gains, the other loses, along any normal."""
    scene = carom.Scene(gravity=(0, 0, 0))
    still = scene.add_body(carom.Sphere(0.1), mass=2, name="still")
    normal = np.array([0.9, 0.3, -0.3]) / np.linalg.norm([0.9, 0.3, -0.3])
    flown = scene.add_body(
        carom.Sphere(0.1), mass=1, position=0.3 * normal, velocity=-normal + [0, 0.1, 0.2],
        angular_velocity=(1, 2, 3), name="flown",
    )  # fmt: skip
    scene.add_contact(flown, still, restitution=0.5, friction=0.2)
    solution = carom.simulate(scene, 0.2, step=5e-3)
    shown = strikes.strikes_of(solution)
    assert shown.contact == ["flown-still"]
    change = solution.velocity[-1] - solution.velocity[0]
    assert np.allclose(shown.arrow[0], change[1], atol=1e-12)
    assert np.allclose(shown.arrow[0], -2 * change[0], atol=1e-12)


def test_stops_are_listed_without_an_arrow(swung):
    shown = strikes.strikes_of(swung)
    assert set(shown.contact) == {"stop"}
    assert np.all(shown.turning)
    assert not np.any(shown.arrow)


def test_persistent_forces_carry_the_weight_and_brake(slid):
    shown = show_of(slid)
    forces = shown.persistent
    last = slice(forces.first[-2], forces.first[-1])
    assert forces.time[-1] == slid.t[-1]
    along = slid.velocity[-1, 0] / np.linalg.norm(slid.velocity[-1, 0])
    expected = 0.5 * G * (np.array([0, 0, 1.0]) - 0.3 * along)  # it slides with mu = 0.3
    assert np.allclose(np.sum(forces.force[last], axis=0), expected, atol=1e-6)
    fewer = strikes.persistent_forces(slid, shown.frames.time, rows=20)
    assert 0 < len(fewer.point) <= 20 + 4
    assert fewer.first[-1] == len(fewer.point)


def test_inside_begins_and_ends_as_the_impact(thrown):
    inside = strikes.inside_of(thrown, 0)
    assert np.allclose(inside.velocity[0], thrown.impacts.relative_velocity_before[0])
    assert np.allclose(inside.velocity[-1], thrown.impacts.relative_velocity_after[0], atol=1e-6)
    assert inside.phases


def test_only_the_strongest_impacts_are_kept(thrown):
    shown = strikes.strikes_of(thrown, listed=1)
    strongest = np.argmax(np.linalg.norm(thrown.impacts.impulse, axis=1))
    assert list(shown.number) == [strongest]
    assert list(strikes.insides_of(thrown, shown, opened=1)) == [strongest]


@pytest.mark.parametrize(
    ("duration", "speed"), [(100.0, 1.0), (5.0, 1.0), (0.42, 0.05), (2.0, 0.2)]
)
def test_short_runs_are_played_slowly(duration, speed):
    assert playing_speed(duration) == pytest.approx(speed)
