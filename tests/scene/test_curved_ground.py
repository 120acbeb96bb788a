"""Surfaces as parts of a scene: what is refused, replaced, listed and copied."""

import pickle

import numpy as np
import pytest

import carom

S = carom.surfaces
BOWL = S.InsideSphere(1.0)


def bowl(shape=None, **more):
    scene = carom.Scene()
    scene.add_surface(BOWL, position=(0, 0, 1), name="bowl")
    scene.add_body(shape or carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5), name="ball", **more)
    return scene


def test_a_surface_is_a_static_body():
    scene = bowl()
    assert scene.statics == (scene["bowl"],)
    assert repr(scene["bowl"]) == (
        "StaticBody('bowl', InsideSphere(radius=1.0), position=[0. 0. 1.])"
    )
    contact = scene.add_contact("ball", "bowl", friction=0.1, restitution=0.2)
    assert pickle.loads(pickle.dumps(scene))["bowl"].shape == BOWL
    scene.replace("bowl", shape=S.InsideSphere(2.0))
    assert scene.contacts[0].other.shape.radius == 2.0
    scene.add_surface(S.InsideCone(0.5), name="bowl", replace=True)
    assert scene["ball-bowl"].other.shape == S.InsideCone(0.5)
    assert contact.name == "ball-bowl"
    scene.remove("bowl", dependents=True)
    assert not scene.statics


@pytest.mark.parametrize(
    ("shape", "why"),
    [
        (carom.Cylinder(0.1, 0.2), "rims have no fixed points"),
        (carom.Disc(0.1), "rims have no fixed points"),
        (carom.Profile([(0, 0), (0.1, 0), (0, 0.1)], 0.02, "all"), "which is curved ground"),
        (carom.Ellipsoid(0.5, 0.3, 0.1), "its greatest radius of curvature, 2.5 m"),
        (carom.Sphere(1.5), "the radius of its rounding, 1.5 m, must be less than"),
    ],
)
def test_what_touches_in_several_places_is_refused(shape, why):
    with pytest.raises(ValueError, match=why):
        bowl(shape).add_contact("ball", "bowl")
    scene = bowl(shape)
    scene.set_contact_default(friction=0.1, restitution=0.2)
    with pytest.raises(ValueError, match=why):
        scene.validate()


def test_a_body_that_starts_in_the_ground_is_refused():
    scene = bowl()
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.05), name="deep")
    scene.set_contact_default(friction=0.1, restitution=0.2)
    with pytest.raises(ValueError, match=r"'deep' 0.05 m deep into 'bowl'"):
        scene.validate()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: S.InsideTorus(1.0, 2.0), "radius must be above tube_radius, got radius=1 m"),
        (lambda: S.InsideCone(2.0), "half_angle must be finite and above 0 and below 1.57"),
        (lambda: S.InsideSphere(0.0), "radius must be finite and above 0"),
        (lambda: S.InsideCylinder(1.0, length=-1.0), "length must be finite and above 0"),
        (lambda: carom.Scene().add_surface(carom.Sphere(1.0)), "definition must be a InsideSphere"),
        (lambda: carom.Scene().add_body(BOWL, mass=1.0), "shape must be a Sphere"),
    ],
)
def test_messages(make, message):
    with pytest.raises((TypeError, ValueError), match=message):
        make()


def test_files_and_ensembles_know_surfaces(tmp_path):
    scene = bowl(velocity=(0.5, 0, 0))
    scene.add_surface(S.InsideTorus(3.0, 0.5), position=(9, 0, 0))
    scene.add_contact("ball", "bowl", friction=0.1, restitution=0.2)
    first = carom.simulate(scene, 0.6, step=0.01)
    first.save(tmp_path / "run.nc")
    again = carom.Solution.load(tmp_path / "run.nc")
    assert [part.shape for part in again.scene.statics] == [BOWL, S.InsideTorus(3.0, 0.5)]
    np.testing.assert_array_equal(
        carom.simulate(again.scene, 0.6, step=0.01).position, first.position
    )
    runs = carom.ensemble(scene, 0.6, vary={"bowl.radius": [1.0, 1.2]}, step=0.01, workers=1)
    np.testing.assert_array_equal(runs.position[0, 0], first.position[-1, 0])
    assert runs.position[1, 0, 2] < first.position[-1, 0, 2]
