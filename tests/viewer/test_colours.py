"""Colours of half-spaces and static bodies: in pages, pictures, plots and files, and from model files."""

import json

import numpy as np
import pytest

import carom
from carom.io.files.scene_parts import scene_from_text, scene_to_text
from carom.visual.viewer.pack import Packer
from carom.visual.viewer.page import header
from carom.visual.viewer.show import show_of

FLOOR, WALL = "#ff8080", "#008000"


def coloured(floor=FLOOR, wall=WALL):
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), color=floor, name="floor")
    scene.add_static(carom.Box(0.2, 2, 1), position=(-0.5, 0, 0.5), color=wall, name="wall")
    scene.add_body(carom.Sphere(0.2), mass=1, position=(0.3, 0, 0.5), name="ball")
    scene.set_contact_default(restitution=0.5)
    return scene


@pytest.fixture(scope="module")
def run():
    return carom.simulate(coloured(), 0.2, step=0.01)


def test_fixed_parts_have_colours_by_name_and_in_the_page(run):
    assert coloured("red", (0, 0.5, 0)).statics[0].color == "#008000"
    assert coloured("red").half_spaces[0].color == "#ff0000"
    head = header(show_of(run), Packer())
    assert [plane["colour"] for plane in head["planes"]] == [FLOOR]
    assert {part["look"]: part["colour"] for part in head["parts"]}["static"] == WALL
    with pytest.raises(ValueError, match="color must be a name that matplotlib has"):
        coloured("reddish")


def test_a_picture_has_the_colours(run):
    pytest.importorskip("PIL")
    picture = carom.films.still(run, 0.0, size=(160, 96)).astype(int)
    red, green, blue = np.moveaxis(picture, -1, 0)
    assert np.mean((green > red + 30) & (green > blue + 30)) > 0.02  # the wall
    assert np.mean((red > green + 60) & (abs(green - blue) < 12)) > 0.2  # the floor
    grey = carom.simulate(coloured(None, None), 0.2, step=0.01)
    red, green, blue = np.moveaxis(carom.films.still(grey, 0.0, size=(160, 96)).astype(int), -1, 0)
    assert not np.any((red > green + 60) & (red > blue + 60))


def test_a_plot_has_the_colours(run):
    plt = pytest.importorskip("matplotlib.pyplot")
    from matplotlib.colors import to_hex

    plt.close("all")  # those of other tests
    axes = run.plot("trajectory")
    found = {to_hex(c) for one in (*axes.artists, *axes.patches) for c in [one.get_facecolor()]}
    found |= {to_hex(c) for one in axes.collections for c in one.get_facecolor()[:1]}
    assert {FLOOR, WALL} <= found


def test_files_keep_colours_and_those_without_are_read():
    text = scene_to_text(coloured())
    again, _ = scene_from_text(text)
    assert [part.color for part in again.fixed] == [FLOOR, WALL]
    plain = json.loads(scene_to_text(coloured(None, None)))
    assert ["color" in part for part in plain["parts"]] == [False, False, True]
    again, _ = scene_from_text(json.dumps(plain))
    assert [part.color for part in again.fixed] == [None, None]


def test_model_files_have_colours():
    pytest.importorskip("mujoco")
    model = carom.load_model(
        """<mujoco><asset><material name="wood" rgba="1 .5 0 1"/></asset><worldbody>
        <geom name="floor" type="plane" size="1 1 .1" rgba="1 .5 .5 1"/>
        <body name="a" pos="0 0 1"><freejoint/><geom type="sphere" size=".1" material="wood"/></body>
        <body name="b" pos="1 0 1"><freejoint/><geom type="sphere" size=".1"/></body>
        </worldbody></mujoco>"""
    )
    parts = {part.name: part.color for part in (*model.scene.bodies, *model.scene.fixed)}
    assert parts == {"a": "#ff8000", "b": None, "floor": FLOOR}
    box = "<geometry><box size='1 1 1'/></geometry>"
    inertia = "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
    link = f"<inertial><mass value='1'/>{inertia}</inertial><collision>{box}</collision>"
    own = "<color rgba='0 .5 0 1'/>"
    looks = {
        "shared": f"<visual>{box}<material name='green'/></visual>",
        "own": f"<visual>{box}<material name='x'>{own}</material></visual>",
        "none": f"<visual>{box}</visual>",
    }
    links = "".join(f"<link name='{name}'>{link}{look}</link>" for name, look in looks.items())
    rest = (
        "type='revolute'><axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/>"
    )
    joints = "".join(
        f"<joint name='j{name}' {rest}<parent link='base'/><child link='{name}'/></joint>"
        for name in looks
    )
    model = carom.load_model(
        f"<robot name='r'><material name='green'>{own}</material><link name='base'/>{links}{joints}</robot>"
    )
    colours = {body.name: body.color for body in model.scene.bodies}
    assert colours == {"shared": WALL, "own": WALL, "none": None}
