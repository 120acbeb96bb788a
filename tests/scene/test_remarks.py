"""What is nearly always a mistake is warned of once, by name, and listed by `scene.check()`: no more."""

import warnings

import numpy as np
import pytest

import carom


def floor_and(*bodies):
    scene = carom.Scene()
    scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    for k, name in enumerate(bodies):
        scene.add_body(carom.Sphere(0.1), mass=1, position=(k, 0, 0.5), name=name)
    return scene


def warned(scene, duration=0.02, **settings):
    """The sentences that simulate warns of."""
    settings = {"step": 0.01, **settings}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        carom.simulate(scene, duration, **settings)
    assert all(one.category is carom.MistakeWarning for one in caught)
    assert all(one.filename == __file__ for one in caught)  # it points to the call
    return [str(one.message) for one in caught]


def test_bodies_that_nothing_can_touch():
    scene = floor_and("ball", "egg", "nut")
    scene.add_contact("ball", "floor", restitution=0.5)
    (said,) = warned(scene)
    assert said.startswith("Nothing can touch 'egg', 'nut': no contacts are computed for them.")
    assert scene.check().remarks == (said,)
    assert str(scene.check()) == f"3 bodies, 0 constraint rows: 18 degrees of freedom\n{said}"
    scene.add_contact("egg", "floor", restitution=0.5)
    scene.add_contact("nut", "egg", restitution=0.5)
    assert warned(scene) == []
    assert scene.check().remarks == ()


def test_a_body_without_a_shape_among_pairs_that_touch_by_default():
    scene = floor_and("ball")
    scene.set_contact_default(restitution=0.5, friction=0.1)
    scene.add_body(mass=1, inertia=(1, 1, 1), position=(5, 0, 1), name="point")
    (said,) = warned(scene)
    assert said.startswith("Nothing can touch 'point' ('point' without a shape):")


@pytest.mark.parametrize(
    "held", ["joint", "spring", "rows", "nothing to touch", "ignored but for one"]
)
def test_bodies_that_need_no_contact(held):
    scene = floor_and("ball")
    if held == "joint":
        scene.add_joint(carom.joints.Spherical((0, 0, 1)), carom.GROUND, "ball")
    elif held == "spring":
        scene.add_force(carom.forces.Spring(10, (0, 0, 1), (0, 0, 0.5)), carom.GROUND, "ball")
    elif held == "rows":
        up = carom.constraints.Rows(
            scene["ball"], lambda t, s: np.array([[0, 0, 1, 0, 0, 0, 0.0]]), 1
        )
        scene.add_constraint(up)
    elif held == "nothing to touch":
        scene = carom.Scene()
        scene.add_body(carom.Sphere(0.1), mass=1)
    else:
        scene.set_contact_default(restitution=0.5)
        scene.add_body(carom.Sphere(0.1), mass=1, position=(5, 0, 1), name="other")
        scene.ignore_contact("ball", "floor")
    assert warned(scene) == []


def test_contacts_of_which_nothing_is_stated():
    scene = floor_and("ball", "egg")
    scene.add_contact("ball", "floor")
    scene.add_contact("egg", "floor", friction=0.1)
    said = (
        "Restitution and friction are not given for 'ball-floor': the defaults 0.5 and 0 are used. "
        "Give them, for example restitution=0.5, friction=0.3."
    )
    assert warned(scene) == [said]
    scene = floor_and("ball")
    scene.set_contact_default()
    assert warned(scene) == [said.replace("'ball-floor'", "set_contact_default")]


def test_contacts_whose_materials_or_default_say_it():
    scene = carom.Scene()
    rubber = carom.Material(restitution=0.7, friction=0.8)
    scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), material=rubber, name="floor")
    scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 0.5), material=rubber, name="ball")
    scene.set_contact_default()
    assert warned(scene) == []
    scene.add_contact("ball", "floor")
    assert warned(scene) == []
    scene = floor_and("ball")
    scene.set_contact_default(restitution=0.2, all_pairs=False)
    scene.add_contact("ball", "floor")
    assert warned(scene) == []


def test_a_step_that_is_longer_than_the_run():
    scene = floor_and("ball")
    scene.add_contact("ball", "floor", restitution=0.5)
    (said,) = warned(scene, 0.05, step=0.1)
    assert said.startswith("step=0.1 s is longer than the run of 0.05 s, so the run is one step.")
    assert warned(scene, 0.05, step=0.05) == []


def pendulum(angle):
    scene = carom.Scene()
    place = (np.sin(angle), 0, -np.cos(angle))
    scene.add_body(carom.Sphere(0.05), mass=1, position=place, name="bob")
    scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, "bob")
    return scene


def test_a_step_that_is_far_too_long_for_the_motion():
    # A pendulum of 1 m swings with 3.13 rad/s: it turns by 1.57 of its phase in half a second, by .16 in .05 s.
    (said,) = warned(pendulum(0.2), 10.0, step=0.5)
    assert said.startswith(
        "step=0.5 s is far too long for the motion of 'bob': its velocity changes too much"
    )
    assert said.endswith("Take step=0.04 or less, or leave step out.")
    assert warned(pendulum(0.2), 2.0, step=0.05) == []
    assert warned(pendulum(0.2), 2.0, step="auto") == []


def test_flight_and_impacts_are_exact_at_any_step():
    scene = floor_and("ball")
    scene.add_contact("ball", "floor", restitution=0.9)
    assert warned(scene, 2.0, step=0.5) == []
    # a pendulum that strikes a stop in the middle of a step
    scene = pendulum(1.0)
    scene.add_stop(scene.joints[0].name, upper=0.9, restitution=1.0)
    scene.add_stop(scene.joints[0].name, lower=-0.9, restitution=1.0)
    assert warned(scene, 2.0, step=0.1) == []


def test_stops_beyond_a_turn_that_may_be_meant():
    # multiples of pi, whole numbers within a turn, metres of a slide, and turns of a screw
    scene = pendulum(0.2)
    slide = (
        carom.joints.Prismatic((0, 0, 1)),
        carom.joints.Screw((0, 0, 0), (0, 0, 1), 0.1),
    )
    for k, joint in enumerate(slide):
        body = scene.add_body(carom.Sphere(0.05), mass=1, position=(5 + k, 0, 0))
        scene.add_stop(scene.add_joint(joint, carom.GROUND, body), upper=90)
    for end in (3 * np.pi, -4 * np.pi, 6, -3):
        side = "upper" if end > 0 else "lower"
        scene.add_stop(scene.joints[0], **{side: end})
    assert scene.check().remarks == ()
    scene.add_stop(scene.joints[0], lower=-45)
    assert len(scene.check().remarks) == 1


@pytest.mark.parametrize("case", ["ceiling", "ramp", "wall", "spring", "weightless"])
def test_gravity_that_may_be_meant(case):
    velocity = (0, 0, 5) if case == "ceiling" else (0, 0, 0)
    normal = {"ceiling": (0, 0, -1), "wall": (1, 0, 0), "spring": (0, 0, -1)}.get(case, (0, 0, 1))
    gravity = {"ramp": (9, 0, -3), "weightless": (0, 0, 0)}.get(case, (0, 0, -9.81))
    scene = carom.Scene(gravity=gravity)
    floor = scene.add_half_space(point=-np.array(normal), normal=normal)
    ball = scene.add_body(carom.Sphere(0.1), mass=1, velocity=velocity)
    scene.add_contact(ball, floor, restitution=0.5)
    if case == "spring":
        scene.add_force(carom.forces.Spring(10, (0, 0, 1), (0, 0, 0)), carom.GROUND, ball)
    assert scene.check().remarks == ()


def test_a_force_that_a_cell_adds_twice():
    def cell(scene, **named):
        scene.add_body(carom.Sphere(0.05), mass=1, name="a", replace=True)
        spring = carom.forces.Spring(50, (-1, 0, 0), (0, 0, 0))
        scene.add_force(spring, "a", **named)

    scene = carom.Scene()
    cell(scene)
    assert scene.check().remarks == ()
    cell(scene)
    (said,) = warned(scene)
    assert said.startswith("'force2' acts a second time, as another force that is the same")
    parallel = carom.Scene()  # two that were given names are meant
    for name in ("left", "right", "right"):
        cell(parallel, name=name, replace=True)
    parallel.add_force(carom.forces.Spring(51, (-1, 0, 0), (0, 0, 0)), "a")
    assert parallel.check().remarks == ()
