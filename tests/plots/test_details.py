"""Colours, pips of dice, pins of joints, and what a view fits."""

import numpy as np
import pytest

import carom
from carom import GROUND, joints
from carom.geometry import quaternion
from carom.scene.colors import hex_color
from carom.studies.ensembles.dice import face_up
from carom.visual.bodies import parts_of, pins
from carom.visual.dice import is_die, pip_colour, pips
from carom.visual.films.models import model_of, models, rgb, split
from carom.visual.plots.paths import _plane
from carom.visual.viewer.page import page_text
from carom.visual.viewer.show import show_of


@pytest.mark.parametrize(
    "given",
    [
        "red",
        "tab:blue",
        "C3",
        "k",
        "lightGoldenrodYellow",
        "#abc",
        "#12EF56",
        (0.2, 0.4, 1.0),
        "g",
        "rebeccapurple",
    ],
)
def test_colours_are_those_of_matplotlib(given):
    colors = pytest.importorskip("matplotlib.colors")
    name = given.lower() if isinstance(given, str) and given != "C3" else given
    assert hex_color("color", given) == colors.to_hex(name)


def test_all_names_of_matplotlib():
    colors = pytest.importorskip("matplotlib.colors")
    for table in (colors.CSS4_COLORS, colors.TABLEAU_COLORS, colors.BASE_COLORS):
        assert all(hex_color("color", name) == colors.to_hex(name) for name in table)


@pytest.mark.parametrize("wrong", ["rde", "", "#12", (1, 2, 3), (0.1, 0.2), 5, "tab:rot", None])
def test_no_colours(wrong):
    if wrong is None:
        assert carom.Scene().add_body(carom.Sphere(1), mass=1.0, color=None).color is None
        return
    with pytest.raises(ValueError, match=r"^color must"):
        carom.Scene().add_body(carom.Sphere(1), mass=1.0, color=wrong)


def test_a_wrong_name_is_corrected():
    with pytest.raises(ValueError, match="did you mean 'crimson'"):
        hex_color("color", "crimsen")


def thrown(**more):
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="table")
    scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.1), name="die", **more
    )
    scene.set_contact_default(restitution=0.5)
    return scene


def test_colours_are_kept_in_files_and_shown(tmp_path):
    solution = carom.simulate(thrown(color="crimson"), 0.2)
    solution.save(tmp_path / "run.nc")
    assert carom.Solution.load(tmp_path / "run.nc").scene["die"].color == "#dc143c"
    assert '"bodies":["#dc143c"]' in page_text(show_of(solution)).replace(" ", "")
    model, _ = models(solution.scene, 1.0)
    assert np.array_equal(
        np.unique(model.colours, axis=0), np.unique([rgb("#dc143c"), rgb("#ffffff")], axis=0)
    )


def test_pips_are_those_of_the_face_that_is_up():
    """As `face_up` reads them: the pips at the top of each attitude are as many as the face says."""
    die = carom.Box(0.02, 0.02, 0.02)
    vertices, triangles = pips(die)
    middles = vertices[triangles[::20, 0]]  # 20 triangles a pip around its middle
    assert len(middles) == 21
    for axis, angle in (
        ((1, 0, 0), 0),
        ((1, 0, 0), 90),
        ((1, 0, 0), 180),
        ((1, 0, 0), 270),
        ((0, 1, 0), 90),
        ((0, 1, 0), 270),
    ):
        half = np.radians(angle) / 2
        Q = np.array([np.cos(half), *(np.sin(half) * np.array(axis))])
        height = quaternion.rotate(Q, middles)[:, 2]
        assert np.sum(height > 0.01) == face_up(Q)
    # they look outwards
    corners = vertices[triangles]
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.all(np.sum(outward * corners.mean(axis=1), axis=1) > 0.0)


@pytest.mark.parametrize(
    ("name", "shape", "die"),
    [
        ("die", carom.Box(1, 1, 1), True),
        ("Red Die 3", carom.Box(1, 1, 1, radius=0.1), True),
        ("dice_2", carom.Box(1, 1, 1), True),
        ("soldier", carom.Box(1, 1, 1), False),
        ("die", carom.Box(1, 1, 2), False),
        ("die", carom.Box(1, 1, 1, radius=0.4), False),
        ("die", carom.Sphere(1), False),
    ],
)
def test_what_is_a_die(name, shape, die):
    assert is_die(carom.Scene().add_body(shape, mass=1.0, name=name)) is die


def test_pips_are_seen_on_any_colour():
    assert pip_colour("#ffffff") != pip_colour("#000000")


def test_pins_of_joints_stand_out_of_a_shape():
    scene = carom.Scene()
    arm = scene.add_body(carom.Box(0.6, 0.08, 0.05), mass=1.0, position=(0.3, 0, 1))
    scene.add_joint(joints.Revolute((0, 0, 1), (0, 1, 0)), GROUND, arm)
    ((vertices, _),) = pins(scene, arm, 0.01)
    assert np.ptp(vertices[:, 1]) == pytest.approx(0.08 + 0.02)
    assert np.abs(vertices[:, 1]).max() == pytest.approx(0.05)
    np.testing.assert_allclose(vertices.mean(axis=0), [-0.3, 0, 0], atol=1e-12)
    assert "joint" in [part.look for part in show_of(carom.simulate(scene, 0.1, step=0.01)).parts]


def test_a_view_fits_what_moves():
    """A ball that falls by 0.1 m on a slab of 20 m that is fixed: the view is that of the ball."""
    scene = carom.Scene()
    slab = scene.add_body(carom.Box(20, 20, 0.1), mass=1e3)
    scene.add_joint(joints.Fixed(), GROUND, slab)
    scene.add_body(carom.Sphere(0.01), mass=1.0, position=(0, 0, 0.2))
    show = show_of(carom.simulate(scene, 0.142, step=1e-3))
    assert show.place.radius < 0.1


def test_large_triangles_are_split():
    scene = carom.Scene()
    scene.add_body(carom.Box(4, 2, 1), mass=1.0)
    whole = model_of(parts_of(scene, 1.0)[0])
    fine = split(whole, 0.7)
    area = [
        0.5 * np.linalg.norm(np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]), axis=1)
        for c in (whole.corners, fine.corners)
    ]
    assert np.sum(area[1]) == pytest.approx(2 * (4 * 2 + 4 * 1 + 2 * 1))
    sides = np.linalg.norm(
        np.roll(fine.corners, -1, axis=1) - np.roll(fine.corners, 1, axis=1), axis=2
    )
    assert sides.max() <= 0.7
    # lines are drawn along the twelve edges of the box, from both sides, and nowhere else
    assert np.sum(sides[fine.edges == 1]) == pytest.approx(2 * 4 * (4 + 2 + 1))
    assert np.array_equal(split(whole, 5.0).corners, whole.corners)


def test_a_level_table_is_seen_from_above():
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_body(carom.Sphere(0.03), mass=1.0, position=(0, 0, 0.03), velocity=(1, 0.5, 0))
    scene.set_contact_default(restitution=0.5, friction=0.1)
    solution = carom.simulate(scene, 0.5)
    assert _plane(None, solution, solution.position) == (0, 1)
    axes = solution.plot("trajectory")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("$x$ [m]", "$y$ [m]")
