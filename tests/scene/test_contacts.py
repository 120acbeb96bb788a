"""Contacts: their values, and no start inside a half-space."""

import math

import numpy as np
import pytest

from carom.scene import Box, Capsule, Convex, Friction, Scene, Sphere
from carom.scene.contacts import initial_gap

HALF_TURN = (math.cos(math.pi / 8), math.sin(math.pi / 8), 0, 0)  # 45 degrees about x


def place(shape, height, orientation=(1, 0, 0, 0), **contact):
    scene = Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    inertia = (1, 1, 1) if shape is None else None
    body = scene.add_body(
        shape,
        mass=1,
        inertia=inertia,
        position=(5, -3, height),
        orientation=orientation,
        name="die",
    )
    return scene, scene.add_contact(body, ground, **contact)


def test_defaults_and_values():
    scene, contact = place(Sphere(1), 2)
    assert (contact.restitution, contact.friction, contact.impact_law) == (0.5, 0.0, "newton")
    assert (contact.name, contact.index) == ("die-ground", 0)
    assert contact.body is scene["die"]
    assert contact.half_space is scene["ground"]
    contact = place(Sphere(1), 2, restitution=1, friction=3, impact_law="stronge", name="c")[1]
    assert (contact.restitution, contact.friction, contact.impact_law) == (1.0, 3.0, "stronge")
    assert contact.name == "c"
    ice = Friction(axis=(1, 0, 0), along=0.1, across=0.3)
    assert repr(ice) in repr(place(Sphere(1), 2, friction=ice)[1])


@pytest.mark.parametrize(
    ("shape", "orientation", "lowest"),
    [
        (Sphere(0.5), HALF_TURN, 0.5),
        (Box(1, 2, 4), (1, 0, 0, 0), 2.0),
        (Box(1, 2, 4), HALF_TURN, 3 / math.sqrt(2)),
        (Capsule(0.5, 2), HALF_TURN, 1 / math.sqrt(2) + 0.5),
        (Convex(Box(1, 2, 4).vertices), HALF_TURN, 3 / math.sqrt(2)),
    ],
)
def test_gap_at_the_start(shape, orientation, lowest):
    contact = place(shape, 5.0, orientation)[1]
    assert initial_gap(contact) == pytest.approx(5.0 - lowest, abs=1e-14)
    place(shape, lowest, orientation)  # touching is fine
    with pytest.raises(ValueError, match=r"contact 'die-ground': position .* 1e-06 m deep"):
        place(shape, lowest - 1e-6, orientation)


def test_tilted_plane_far_from_the_origin():
    # Touching up to the rounding of coordinates of 1e3 m: their last place is 1e-13 m.
    normal, far = np.array([0.48, 0.6, 0.64]), np.array([1e3, -7e2, 3e2])
    along = np.cross(normal, (1, 0, 0))
    for k in range(20):
        scene = Scene()
        plane = scene.add_half_space(far, normal)
        ball = scene.add_body(Sphere(0.01), mass=1, position=far + 0.01 * normal + 0.37 * k * along)
        assert abs(initial_gap(scene.add_contact(ball, plane))) < 1e-12


def test_inside_says_how_deep_and_what_to_do():
    with pytest.raises(ValueError, match=r"must|deep") as error:
        place(Sphere(0.5), 0.3, name="landing")
    message = str(error.value)
    for part in ("'landing'", "'die'", "'ground'", "0.2 m deep", "at least 0", "move the body"):
        assert part in message


def test_validate():
    with pytest.raises(ValueError, match="at least one body"):
        Scene().validate()
    scene, contact = place(Sphere(0.5), 0.5)
    scene.validate()
    object.__setattr__(contact.body, "position", np.array([0, 0, 0.4]))
    with pytest.raises(ValueError, match=r"'die-ground'.* 0.1 m deep"):
        scene.validate()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"restitution": 1.1}, "restitution must be finite and at least 0 and at most 1, got 1.1"),
        (
            {"restitution": -0.1},
            "restitution must be finite and at least 0 and at most 1, got -0.1",
        ),
        (
            {"restitution": math.nan},
            "restitution must be finite and at least 0 and at most 1, got nan",
        ),
        ({"restitution": "half"}, "restitution must be a number, got 'half'"),
        ({"friction": -0.2}, "friction must be finite and at least 0, got -0.2"),
        ({"friction": math.nan}, "friction must be finite and at least 0, got nan"),
        ({"friction": math.inf}, "friction must be finite and at least 0, got inf"),
        (
            {"impact_law": "Newtn"},
            "impact_law must be one of 'moreau', 'newton', 'poisson', 'stronge', got 'Newtn'",
        ),
        ({"impact_law": "poison"}, "did you mean 'poisson'?"),
        (
            {"impact_law": 0},
            "impact_law must be one of 'moreau', 'newton', 'poisson', 'stronge', got 0",
        ),
        ({"shape": None}, "body must have a shape for contact, got Body('die', None"),
        ({"name": "die"}, "name must be unique in the scene, got 'die'"),
        ({"name": ""}, "name must be a non-empty string, got ''"),
    ],
)
def test_bad_contacts_are_refused(change, message):
    shape = change.pop("shape") if "shape" in change else Sphere(1)
    with pytest.raises(ValueError, match=r".") as error:
        place(shape, 2.0, **change)
    assert message in str(error.value)


def test_a_pair_once():
    scene, _ = place(Sphere(1), 2)
    with pytest.raises(ValueError, match="'die' and half_space 'ground' must be given once"):
        scene.add_contact(scene["die"], scene["ground"], name="again")


def test_wrong_handles():
    scene, contact = place(Sphere(1), 2)
    with pytest.raises(
        ValueError, match="body must be a part of the scene, which has none called 'dye';"
    ):
        scene.add_contact("dye", contact.half_space)
    with pytest.raises(TypeError, match=r"other must be a Body or HalfSpace or StaticBody, got <"):
        scene.add_contact(contact.body, scene)
    with pytest.raises(ValueError, match="body or other must be a body that moves, got"):
        scene.add_contact(contact.half_space, contact.half_space)
    other = place(Sphere(1), 2)[1]
    with pytest.raises(ValueError, match=r"body must belong to this scene, got .* of another one"):
        scene.add_contact(other.body, contact.half_space)
    with pytest.raises(ValueError, match="other must belong to this scene"):
        scene.add_contact(contact.body, other.half_space)
