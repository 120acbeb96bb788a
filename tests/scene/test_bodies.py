"""Bodies and half-spaces: what is kept, what is refused."""

import copy
import math
import pickle

import numpy as np
import pytest

from carom.scene import GROUND, Box, Cylinder, Ground, Scene, Sphere

NAN = (0.0, math.nan, 0.0)


def test_body_keeps_what_it_was_given():
    body = Scene().add_body(
        Box(1, 2, 3), mass=6, position=(1, 2, 3), orientation=(0.6, 0, 0.8, 0), velocity=[4, 5, 6],
        angular_velocity=np.array([7, 8, 9]), name="die",
    )  # fmt: skip
    assert (body.index, body.name, body.mass, body.shape) == (0, "die", 6.0, Box(1, 2, 3))
    np.testing.assert_array_equal(body.position, [1, 2, 3])
    np.testing.assert_allclose(body.orientation, [0.6, 0, 0.8, 0], rtol=1e-15)
    np.testing.assert_array_equal(body.velocity, [4, 5, 6])
    np.testing.assert_array_equal(body.angular_velocity, [7, 8, 9])
    np.testing.assert_array_equal(body.inertia, Box(1, 2, 3).inertia(6))


def test_density_times_volume():
    body = Scene().add_body(Cylinder(0.1, 2), density=1000)
    assert body.mass == pytest.approx(1000 * math.pi * 0.01 * 2, rel=1e-15)


def test_given_inertia_stands_before_that_of_the_shape():
    scene = Scene()
    principal = scene.add_body(Sphere(1), mass=1, inertia=(1, 2, 2.5)).inertia
    np.testing.assert_array_equal(principal, np.diag([1, 2, 2.5]))
    matrix = [[2, 0.1, 0], [0.1, 2, 0], [0, 0, 2]]
    np.testing.assert_array_equal(scene.add_body(mass=1, inertia=matrix).inertia, matrix)


def test_flat_plate_has_the_sum_exactly():
    # A lamina: Jz = Jx + Jy, the edge of what is possible, also where rounding puts it beyond.
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    for inertia in (np.diag([0.1, 0.2, 0.1 + 0.2]), turn @ np.diag([0.1, 0.2, 0.3]) @ turn.T):
        body = Scene().add_body(mass=1, inertia=inertia)
        np.testing.assert_allclose(body.inertia, inertia, rtol=0, atol=1e-15)


def test_nearly_unit_quaternion_is_normalised():
    body = Scene().add_body(Sphere(1), mass=1, orientation=(0.8, 0.6 + 5e-7, 0, 0))
    assert np.linalg.norm(body.orientation) == pytest.approx(1.0, abs=1e-15)


def test_arrays_are_copies_and_read_only():
    position = np.array([1.0, 2.0, 3.0])
    body = Scene().add_body(Sphere(1), mass=1, position=position)
    position[0] = 9.0
    assert body.position[0] == 1.0
    for name in ("inertia", "position", "orientation", "velocity", "angular_velocity"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(body, name)[0] = 9.0
    with pytest.raises(AttributeError):
        body.mass = 2.0  # type: ignore[misc]


def test_half_space_normal_is_made_unit():
    plane = Scene().add_half_space(point=(1, 2, 3), normal=(3e200, 0, 4e200))
    np.testing.assert_allclose(plane.normal, [0.6, 0, 0.8], rtol=1e-15)
    np.testing.assert_array_equal(plane.point, [1, 2, 3])


def test_there_is_one_ground():
    assert repr(GROUND) == "carom.GROUND"
    assert Ground() is GROUND
    assert pickle.loads(pickle.dumps(GROUND)) is GROUND
    assert copy.deepcopy(GROUND) is GROUND


BAD_BODIES = [
    ({"mass": 0}, "mass must be finite and above 0 [kg], got 0"),
    ({"mass": -2.5}, "mass must be finite and above 0 [kg], got -2.5"),
    ({"mass": math.nan}, "mass must be finite and above 0 [kg], got nan"),
    ({"mass": "heavy"}, "mass must be a number [kg], got 'heavy'"),
    (
        {"mass": None},
        "exactly one of mass and density must be given, got mass=None, density=None; or modes, with a mass",
    ),
    ({"density": 2}, "exactly one of mass and density must be given, got mass=1, density=2"),
    ({"mass": None, "density": -3}, "density must be finite and above 0 [kg/m^3], got -3"),
    ({"mass": None, "density": 3, "shape": None}, "density needs a shape, got density=3"),
    ({"shape": None}, "inertia must be given for a body without a shape, got None"),
    (
        {"inertia": (1, -2, 3)},
        "inertia must have principal moments above 0 [kg m^2], got (1, -2, 3)",
    ),
    ({"inertia": (0, 1, 1)}, "give a small positive moment"),
    ({"inertia": (0, 0, 0)}, "above 0 [kg m^2], got (0, 0, 0)"),
    ({"inertia": (1, 1, 2.1)}, "above the sum of the other two, got (1, 1, 2.1)"),
    ({"inertia": (1, 1, math.nan)}, "inertia must be finite, got (1, 1, nan)"),
    (
        {"inertia": [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]},
        "inertia must be symmetric, got [[1, 0.5, 0]",
    ),
    ({"inertia": (1, 1)}, "inertia must have shape (3,) [kg m^2], got shape (2,)"),
    ({"inertia": np.eye(2)}, "inertia must have shape (3, 3) [kg m^2], got shape (2, 2)"),
    ({"inertia": 5.0}, "inertia must have shape (3,) or (3, 3) [kg m^2], got 5.0"),
    (
        {"inertia": [[1, 2], [3]]},
        "inertia must be numbers of shape (3,) or (3, 3), got [[1, 2], [3]]",
    ),
    (
        {"orientation": (0, 0, 0, 0)},
        "orientation must be a unit quaternion (w, x, y, z), got (0, 0,",
    ),
    ({"orientation": (1, 1, 0, 0)}, "got (1, 1, 0, 0) of length 1.41421356"),
    ({"orientation": (1, 0, 0, math.nan)}, "orientation must be finite, got (1, 0, 0, nan)"),
    ({"orientation": (1, 0, 0)}, "or a SciPy Rotation, got shape (3,)"),
    *[
        ({name: bad}, f"{name} must {message}")
        for name in ("position", "velocity", "angular_velocity")
        for bad, message in (
            (NAN, "be finite, got (0.0, nan, 0.0)"),
            ((0, math.inf, 0), "be finite, got (0, inf, 0)"),
            ((1, 2), "have shape (3,), got shape (2,)"),
            (np.array([1j, 0, 0]), "be numbers of shape (3,), got array([0.+1.j"),
            ("up", "be numbers of shape (3,), got 'up'"),
        )
    ],
    ({"name": ""}, "name must be a non-empty string, got ''"),
    ({"name": 7}, "name must be a non-empty string, got 7"),
]


@pytest.mark.parametrize(("change", "message"), BAD_BODIES)
def test_bad_bodies_are_refused_and_leave_no_trace(change, message):
    scene = Scene()
    with pytest.raises(ValueError, match=r"must|exactly|needs") as error:
        scene.add_body(**{"shape": Sphere(0.5), "mass": 1, **change})
    assert message in str(error.value)
    assert scene.bodies == ()
    assert scene.add_body(Sphere(1), mass=1).name == "body1"


@pytest.mark.parametrize("shape", ["Sphere", Sphere, (1, 2, 3)])
def test_wrong_shape_object(shape):
    with pytest.raises(
        TypeError, match=r"shape must be a Sphere or Box or .*Convex or .*, got"
    ) as error:
        Scene().add_body(shape, mass=1)
    assert repr(shape) in str(error.value)


@pytest.mark.parametrize(
    ("point", "normal", "message"),
    [
        ((0, 0, 0), (0, 0, 0), "normal must not be the zero vector, got (0, 0, 0)"),
        ((0, 0, 0), NAN, "normal must be finite, got (0.0, nan, 0.0)"),
        ((0, 0, 0), (0, 1), "normal must have shape (3,), got shape (2,)"),
        (NAN, (0, 0, 1), "point must be finite, got (0.0, nan, 0.0)"),
    ],
)
def test_bad_half_spaces_are_refused(point, normal, message):
    with pytest.raises(ValueError, match="must") as error:
        Scene().add_half_space(point, normal)
    assert message in str(error.value)
