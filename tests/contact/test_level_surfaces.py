"""Faces of static solids in one plane are one surface: only steps and cracks are obstacles."""

from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import Delaunay

import carom
from carom.model.compile import compile_scene
from carom.options import Options

G = 9.81
FLAT = (1, 0, 0, 0)
SHAPES = {
    "box": (carom.Box(0.2, 0.2, 0.1), FLAT),
    "rounded box": (carom.Box(0.2, 0.2, 0.1, radius=0.005), FLAT),
    "standing cylinder": (carom.Cylinder(0.1, 0.1), FLAT),
    "lying cylinder": (carom.Cylinder(0.05, 0.2), carom.euler("y", 90)),
    "capsule": (carom.Capsule(0.05, 0.2), carom.euler("y", 90)),
    "sphere": (carom.Sphere(0.05), FLAT),
}


def half_space(scene):
    scene.add_half_space((0, 0, 0), (0, 0, 1))


def tiles(scene, up=0.0, apart=0.0):
    """Three boxes in a row; the second stands out by `up`, with cracks of `apart`."""
    for i in range(3):
        scene.add_static(carom.Box(1, 1, 0.1), position=((1 + apart) * i, 0, -0.05 + up * (i == 1)))


def prisms(scene):
    """Triangles between random points, of different thickness."""
    rng = np.random.default_rng(3)
    rim = [(x, y) for x in (-1, 0.5, 2, 3.5) for y in (-1, 1)]
    points = np.array([*rim, *(rng.uniform((-0.9, -0.9), (3.4, 0.9), (20, 2)))])
    for corners in points[Delaunay(points).simplices]:
        low = -rng.uniform(0.1, 0.4)
        prism = carom.Convex([(x, y, z) for x, y in corners for z in (low, 0.0)])
        scene.add_static(prism, position=prism.centroid)


def run(ground, shape, speed, friction, duration=0.45, spin=0.0, **settings):
    scene = carom.Scene(gravity=(0, 0, -G))
    ground(scene)
    body, lying = SHAPES[shape]
    scene.add_body(
        body, mass=1, position=(0.2, 0.03, 0.05), velocity=(speed, 0, 0), orientation=lying,
        angular_velocity=(0, 0, spin),
    )  # fmt: skip
    scene.set_contact_default(restitution=0.5, friction=friction)
    return carom.simulate(scene, duration, **settings)


def levels_of(*boxes):
    scene = carom.Scene()
    for position in boxes:
        scene.add_static(carom.Box(1, 1, 0.1), position=position)
    scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 2))
    scene.set_contact_default(friction=0.1)
    return compile_scene(scene, Options()).system


def test_surfaces_of_two_boxes():
    """Top, bottom and two sides; a rim of six sides each; a row for each, and two rows of the boxes."""
    system = levels_of((0, 0, -0.05), (1, 0, -0.05))
    surfaces = system.levels.surfaces
    assert len(surfaces) == 4
    assert np.all(surfaces.last - surfaces.first == 2)
    assert np.all(surfaces.last_rim - surfaces.first_rim == 6)
    assert sorted(system.contacts.surface) == [0, 0, 1, 2, 3, 4]
    assert np.all(np.diff(system.contacts.number) >= 0)


@pytest.mark.parametrize("other", [(1, 0, -0.05 + 1e-8), (1 + 1e-8, 0, -0.05), (3, 0, -0.05)])
def test_steps_and_cracks_are_no_level_surfaces(other):
    system = levels_of((0, 0, -0.05), other)
    normals = system.levels.surfaces.normal
    assert not np.any(normals[:, 2] > 0.9)


@pytest.mark.few(9)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("ground", [tiles, prisms])
@pytest.mark.parametrize(("speed", "friction"), [(1.5, 0.0), (3.3, 0.05), (2.4, 0.3)])
def test_a_body_moves_as_on_one_plane(ground, shape, speed, friction):
    on, plane = run(ground, shape, speed, friction), run(half_space, shape, speed, friction)
    assert len(on.impacts) == 0
    assert np.allclose(on.position[-1], plane.position[-1], rtol=0, atol=1e-9)
    assert np.allclose(on.orientation[-1], plane.orientation[-1], rtol=0, atol=1e-9)
    assert on.stats["trial_steps"] <= 2 * plane.stats["trial_steps"]


@pytest.mark.parametrize("shape", ["box", "sphere", "lying cylinder"])
def test_a_step_up_is_struck(shape):
    """It is struck at the edge of the second box."""
    s = run(lambda scene: tiles(scene, up=1e-3), shape, 2.0, 0.0)
    assert len(s.impacts) > 0
    first = s.impacts.time == s.impacts.time[0]
    assert np.any(np.abs(s.impacts.normal[first, 0]) > 0.1)


def test_a_wall_of_bricks_is_one_wall():
    """A box slides over tiles into a wall of two level boxes, and bounces as from one."""

    def wall(scene, count):
        tiles(scene)
        height = 0.4 / count
        for i in range(count):
            scene.add_static(carom.Box(0.1, 1, height), position=(1.05, 0, (i + 0.5) * height))

    one, two = (run(partial(wall, count=n), "box", 2.4, 0.1) for n in (1, 2))
    assert len(one.impacts) == len(two.impacts) > 0
    assert np.allclose(one.position[-1], two.position[-1], rtol=0, atol=1e-9)


@pytest.mark.parametrize("shape", ["sphere", "box"])
def test_a_body_leaves_the_rim_as_that_of_one_box(shape):
    """The rim is real: a body falls off a table of two boxes as off one."""

    def table(scene, count):
        for i in range(count):
            scene.add_static(
                carom.Box(0.5, 1 / count, 0.1),
                position=(0.25, (i + 0.5) / count - 0.47, -0.05),
            )

    one, two = (run(partial(table, count=n), shape, 2.0, 0.05, duration=0.3) for n in (1, 2))
    assert two.position[-1, 0, 2] < 0.0
    assert np.allclose(one.position[-1], two.position[-1], rtol=0, atol=1e-6)


def test_friction_of_the_box_beneath():
    """A box slides from a smooth box onto a rough one: it slows down only there, without an impact."""
    scene = carom.Scene(gravity=(0, 0, -G))
    boxes = [scene.add_static(carom.Box(1, 1, 0.1), position=(i, 0, -0.05)) for i in range(2)]
    body = scene.add_body(
        carom.Box(0.2, 0.2, 0.1), mass=1, position=(0, 0, 0.05), velocity=(2, 0, 0)
    )
    for box, friction in zip(boxes, (0.0, 0.2)):
        scene.add_contact(body, box, restitution=0.5, friction=friction)
    s = carom.simulate(scene, 0.5, save_at=np.linspace(0, 0.5, 51))
    assert len(s.impacts) == 0
    before, after = s.position[:, 0, 0] < 0.39, s.position[:, 0, 0] > 0.61
    assert np.allclose(s.velocity[before, 0, 0], 2.0, rtol=0, atol=1e-9)
    speeds = s.velocity[after, 0, 0]
    assert np.allclose(np.diff(speeds), -0.2 * G * 0.01, rtol=0, atol=1e-7)


@pytest.mark.parametrize("height", [0.2, 0.1])
def test_a_thin_floor_is_not_passed(height):
    """A fast ball does not pass through level plates within a step."""
    scene = carom.Scene(gravity=(0, 0, 0))
    for i in range(2):
        scene.add_static(carom.Box(1, 1, 0.001), position=(i, 0, -0.0005))
    scene.add_body(carom.Sphere(0.01), mass=1, position=(0.5, 0, height), velocity=(0.3, 0, -50.0))
    scene.set_contact_default(restitution=0.5, friction=0.0)
    s = carom.simulate(scene, 0.1, step=0.02)
    assert len(s.impacts) == 1
    assert s.velocity[-1, 0] == pytest.approx([0.3, 0, 25.0], abs=1e-9)


def driven_cart(parts, shape, speed, slip, friction, cart_first):
    """A body that slides on a cart of flush parts, which a motor drives."""
    ends = np.linspace(-1.0, 1.0, parts + 1) + 0.05 * np.sin(np.arange(parts + 1) * np.pi / parts)
    boxes = [(carom.Box(b - a, 1, 0.1), (0.5 * (a + b), 0, 0)) for a, b in pairwise(ends)]
    scene = carom.Scene(gravity=(0, 0, -G))

    def add_rider():
        body, lying = SHAPES[shape]
        scene.add_body(
            body, mass=0.5, position=(-0.4, 0.1, 0.05), velocity=(speed + slip, 0, 0), orientation=lying,
            name="rider",
        )  # fmt: skip

    if not cart_first:
        add_rider()
    scene.add_body(
        carom.Compound(boxes), mass=100, position=(0, 0, -0.05), velocity=(speed, 0, 0), name="cart"
    )
    if cart_first:
        add_rider()
    scene.add_joint(carom.joints.Prismatic((1, 0, 0)), carom.GROUND, "cart", name="rail")
    scene.add_constraint(carom.constraints.Driver("rail", rate=speed))
    scene.add_contact("rider", "cart", friction=friction, restitution=0)
    return scene


@pytest.mark.parametrize(("parts", "shape", "cart_first"), [
    (2, "box", True), (3, "standing cylinder", False), (5, "box", False),
])  # fmt: skip
def test_a_seam_of_a_moving_compound_is_no_edge(parts, shape, cart_first):
    # as on one part: x = x_0 + (V + u) t - mu g t^2/2
    speed, slip, friction, duration = 0.7, 1.2, 0.1, 0.5
    scene = driven_cart(parts, shape, speed, slip, friction, cart_first)
    solution = carom.simulate(scene, duration, save_at=duration)
    x = -0.4 + (speed + slip) * duration - 0.5 * friction * G * duration**2
    assert solution.position[-1, 1 if cart_first else 0] == pytest.approx([x, 0.1, 0.05], abs=1e-10)
    assert solution.stats["whole_steps"] == 0


def test_level_faces_of_a_body_that_moves():
    """Two flush boxes have four surfaces; rows of their pieces know them on either side."""
    pair = carom.Compound([(carom.Box(1, 1, 1), (0, 0, 0)), (carom.Box(1, 1, 1), (1, 0, 0))])
    scene = carom.Scene()
    scene.add_body(pair, mass=1)
    scene.add_body(carom.Sphere(0.5), mass=1, position=(0, 0, 2))
    scene.add_body(pair, mass=1, position=(0, 0, 4))
    scene.set_contact_default(friction=0, restitution=0)
    system = compile_scene(scene, Options()).system
    assert len(system.levels.surfaces) == 8
    rows = system.contacts
    mine, others = rows.last_mine - rows.first_mine, rows.last_level - rows.first_level
    assert sorted(zip(mine.tolist(), others.tolist())) == [(0, 4)] * 2 + [(4, 0)] * 2 + [(4, 4)] * 4
