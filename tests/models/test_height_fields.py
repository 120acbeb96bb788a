"""Height fields of MuJoCo's models become surfaces: heights, place, what touches them."""

import numpy as np
import pytest

import carom

mujoco = pytest.importorskip("mujoco")

MODEL = """<mujoco><asset>
<hfield name="hills" nrow="3" ncol="4" size="1.5 1 0.5 0.1" elevation="0 1 2 3  4 5 6 7  8 9 10 20"/>
</asset><worldbody>
<geom name="hills" type="hfield" hfield="hills" pos="1 2 3" euler="0 0 90" friction="0.7"/>
{}</worldbody></mujoco>"""
BODY = '<body name="{0}" pos="{1} {2} 4"><freejoint/><geom type="{0}" size="{3}" mass="1"/></body>'


def test_heights_and_place():
    model = carom.load_model(MODEL.format(BODY.format("sphere", 1, 2, ".05")))
    hills = model.geoms["hills"]
    assert hills is model.scene.statics[0]
    assert hills.position.tolist() == [1, 2, 3]
    assert hills.shape.spacing == pytest.approx([1.0, 1.0])
    data = mujoco.MjData(model.mujoco)
    mujoco.mj_forward(model.mujoco, data)
    for x in (-1.499, -0.5, 0.5, 1.499):  # MuJoCo's own height there, looked for along a ray
        for y in (-0.999, 0.0, 0.999):
            turned = np.array([1 - y, 2 + x, 9.0])
            way = mujoco.mj_ray(
                model.mujoco,
                data,
                turned,
                np.array([0, 0, -1.0]),
                None,
                1,
                -1,
                np.zeros(1, np.int32),
            )
            assert hills.shape.height(x, y) == pytest.approx(9.0 - way - 3.0, abs=2e-3)
    assert "smooth surface through its heights" in str(model.report)
    assert model.scene.contact_law("sphere", "hills").friction == 1.0  # the greater one


def test_a_ball_comes_to_rest_on_it():
    # a basin: z = 0.25 (x^2 + y^2)
    x = np.linspace(-1, 1, 11)
    heights = 0.25 * (x[:, None] ** 2 + x**2)
    asset = (
        f'<hfield name="basin" nrow="11" ncol="11" size="1 1 .5 .1" '
        f'elevation="{" ".join(map(str, heights.ravel().tolist()))}"/>'
    )
    ball = BODY.format("sphere", 0.4, 0.3, ".05").replace(
        'mass="1"', 'mass="1" friction="1 .1 .01" condim="6"'
    )
    model = carom.load_model(
        f"<mujoco><asset>{asset}</asset><worldbody><geom name='g' type='hfield' hfield='basin'/>{ball}"
        "</worldbody></mujoco>"
    )
    solution = carom.simulate(model.scene, 12.0)
    assert np.linalg.norm(solution["sphere"].velocity[-1]) < 1e-6
    place = solution["sphere"].position[-1]
    height = model.geoms["g"].shape.height(place[0], place[1])
    assert 0.05 < place[2] - height < 0.0515
    assert (
        np.hypot(place[0], place[1]) < 0.4
    )  # rolling friction holds it where the slope is up to 0.2


def test_what_is_left_out():
    text = MODEL.format(BODY.format("cylinder", 1, 2, ".05 .1"))
    model = carom.load_model(text)
    assert "rims have no fixed points" in str(model.report)
    assert model.scene.contact_law("cylinder", "hills") is None
    moving = MODEL.format('<body pos="0 0 9"><freejoint/><geom type="hfield" hfield="hills" mass="1"/>'
                          '<geom size=".1" mass="1"/></body>')  # fmt: skip
    assert "a height field on a body that moves" in str(carom.load_model(moving).report)
