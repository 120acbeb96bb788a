"""An orientation may be given in each of the forms that users have, and all of them say the same."""

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import carom
from carom.collision.api import nearest_points
from carom.geometry import quaternion
from verified import agree, verifies

TURN = Rotation.from_euler("zyx", (90, 0, 30), degrees=True)
Q = TURN.as_quat()[[3, 0, 1, 2]]


def placed(orientation):
    body = carom.Scene().add_body(carom.Box(1, 2, 3), mass=1, orientation=orientation)
    return body.orientation


@verifies("axis_angle", "rotation vectors", "other program: SciPy's Rotation")
@pytest.mark.parametrize("form", ["rotation", "matrix", "euler", "quaternion", "axis"])
def test_each_form_is_the_same_rotation(form):
    vector = TURN.as_rotvec(degrees=True)
    given = {
        "rotation": TURN, "matrix": TURN.as_matrix(), "euler": carom.euler("zyx", (90, 0, 30)),
        "quaternion": tuple(Q), "axis": carom.axis_angle(vector, np.linalg.norm(vector)),
    }  # fmt: skip
    agree(quaternion.matrix(placed(given[form])), TURN.as_matrix(), atol=4e-16)


@verifies("euler", "Euler angles", "other program: SciPy's Rotation")
@pytest.mark.parametrize("axes", ["z", "xy", "xyz", "zxz", "Z", "XY", "ZYX", "YXY"])
def test_euler_angles_are_those_of_scipy(axes):
    angles = np.random.default_rng(1).uniform(-400, 400, (5, len(axes)))
    found = quaternion.matrix(carom.euler(axes, angles))
    agree(found, Rotation.from_euler(axes, angles, degrees=True).as_matrix(), atol=3e-15)


def test_a_quarter_turn_about_z_takes_x_to_y():
    for turn in (carom.euler("z", 90), carom.axis_angle((0, 0, 5), 90)):
        np.testing.assert_allclose(quaternion.rotate(turn, (1, 0, 0)), (0, 1, 0), atol=3e-16)


def test_rounded_numbers_are_normalised():
    root = np.sqrt(0.5)
    np.testing.assert_allclose(placed((0.7071, 0, 0, 0.7071)), (root, 0, 0, root), rtol=1e-15)
    rounded = [[0.7071, -0.7071, 0], [0.7071, 0.7071, 0], [0, 0, 1]]
    np.testing.assert_allclose(placed(rounded), carom.euler("z", 45), atol=1e-15)


def test_frames_of_joints_parts_of_compounds_and_poses_of_solids():
    scene = carom.Scene()
    rod = scene.add_body(carom.Box(1, 0.1, 0.1), mass=1, orientation=TURN)
    joint = scene.add_joint(
        carom.joints.Fixed((0, 0, 0)), carom.GROUND, rod,
        parent_frame=((0, 0, 0), TURN), child_frame=((0, 0, 0), np.eye(3)),
    )  # fmt: skip
    assert joint.frames is not None
    np.testing.assert_allclose(joint.frames[0][1], Q, atol=1e-16)
    one, other = (
        carom.Compound([(carom.Box(1, 2, 3), (0, 0, 0), turn)]).support((1, 1, 1))
        for turn in (TURN, Q)
    )
    np.testing.assert_allclose(one, other, atol=1e-15)
    solid, far = carom.Box(1, 2, 3), (carom.Sphere(1), ((9, 0, 0), np.eye(3)))
    gaps = [nearest_points(solid, ((0, 0, 0), turn), *far).gap for turn in (TURN, Q)]
    assert gaps[0] == pytest.approx(gaps[1], abs=1e-14)


def test_recordings_and_ensembles_take_stacks():
    t, x = np.linspace(0, 1, 4), np.zeros((4, 3))
    turns = Rotation.from_euler("z", [[0], [10], [20], [30]], degrees=True)
    expected = carom.euler("z", [[0], [10], [20], [30]])
    for given in (turns, turns.as_matrix()):
        made = carom.identify.Recording(t, x, given)  # pyright: ignore[reportArgumentType]
        np.testing.assert_allclose(made.orientation[:, 0], expected, atol=1e-15)
    scene = carom.Scene()
    scene.add_body(carom.Box(1, 2, 3), mass=1, name="die")
    runs = [
        carom.ensemble(scene, 0.02, step=0.01, vary={"die.orientation": given}, executor="serial")
        for given in (turns, turns.as_matrix(), expected)
    ]
    for one in runs[:2]:
        np.testing.assert_allclose(one.orientation, runs[2].orientation, atol=1e-15)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            (0, 0, 0.7, 0.8),
            r"orientation must be a unit quaternion (w, x, y, z), got (0, 0, 0.7, 0.8) of length 1.06301458; "
            r"the scalar w comes first, SciPy's as_quat() has it last: give the SciPy Rotation itself",
        ),
        (
            (0, 0, 90),
            "orientation must be a unit quaternion (w, x, y, z), a (3, 3) rotation matrix or a SciPy Rotation, "
            'got shape (3,); Euler angles in degrees are carom.euler("xyz", (30, 0, 90))',
        ),
        (np.diag([1, 1, -1]), "orientation must be a rotation matrix, of determinant 1, got a reflection"),
        (2 * np.eye(3), "orientation must be a rotation matrix, whose columns are unit vectors at"),
        (Rotation.from_euler("z", [[1], [2]]), "orientation must have shape (4,), got shape (2, 4)"),
    ],
)  # fmt: skip
def test_what_is_no_orientation(given, message):
    with pytest.raises(ValueError, match="^" + re.escape(message)):
        placed(given)


@pytest.mark.parametrize(
    ("axes", "angles", "message"),
    [
        ("xyw", (1, 2, 3), "axes must be one to three of x, y, z"),
        ("Xyz", (1, 2, 3), "axes must be one to three of x, y, z"),
        ("xyz", (1, 2), r"angles must have shape \(..., 3\), got shape \(2,\)"),
        ("z", "90", "angles must be numbers"),
    ],
)
def test_what_are_no_euler_angles(axes, angles, message):
    with pytest.raises(ValueError, match=message):
        carom.euler(axes, angles)


@pytest.mark.parametrize(
    "turn", [lambda: carom.euler("x", np.pi / 2), lambda: carom.axis_angle((0, 0, 1), np.pi / 2)]
)
def test_a_warning_of_radians_points_to_the_call(turn):
    with pytest.warns(carom.MistakeWarning) as caught:
        turn()
    assert [one.filename for one in caught] == [__file__]
