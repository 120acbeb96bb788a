"""Parts of a compound with materials of their own: a rubber foot on a steel leg."""

import numpy as np
import pytest

import carom
from carom import Box, Compound, Material, Part, Sphere

ICE, STEEL, RUBBER = (Material(restitution=0.0, friction=mu) for mu in (0.0, 0.1, 0.5))
SIDE = 0.1  # [m]


def block(rear, front, position=(0.0, 0.0, 0.05), **given):
    """Two cubes in a row, with a material each, that slide along x."""
    parts = [
        Part(Box(SIDE, SIDE, SIDE), (x, 0, 0), material=material)
        for x, material in ((-0.05, rear), (0.05, front))
    ]
    scene = carom.Scene()
    scene.set_contact_default(combine="max")
    scene.add_body(
        Compound(parts), mass=1.0, position=position, velocity=(1, 0, 0), name="block", **given
    )
    return scene


def floor(scene):
    scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), material=ICE, name="floor")


def wall_floor(scene):
    scene.add_static(Box(4, 4, 0.2), position=(0, 0, -0.1), material=ICE, name="floor")


@pytest.mark.parametrize("ground", [floor, wall_floor])
@pytest.mark.parametrize(("rear", "front"), [(STEEL, RUBBER), (RUBBER, STEEL), (ICE, RUBBER)])
def test_each_part_slides_with_its_friction(ground, rear, front):
    # Only the outer corners of a flat face carry, at a = .1 m before and behind the mass centre, which is h =
    # .05 m high: N_f + N_r = m g and a (N_f - N_r) = h (mu_r N_r + mu_f N_f) about it.
    scene = block(rear, front)
    ground(scene)
    t = 0.05
    run = carom.simulate(scene, t)
    a, h, g = 0.1, 0.05, 9.81
    n = np.linalg.solve([[1, 1], [-a - h * rear.friction, a - h * front.friction]], [g, 0.0])
    brake = n @ [rear.friction, front.friction]
    assert run.status == 0
    assert run["block"].velocity[-1, 0] == pytest.approx(1.0 - brake * t, abs=1e-9)


def test_a_floor_of_two_materials():
    # Rubber begins at x = 0; the block is over it as a whole from some time on: both ends are in closed form.
    scene = carom.Scene()
    tiles = [
        Part(Box(2, 2, 0.2), (-1, 0, 0), material=ICE),
        Part(Box(2, 2, 0.2), (1, 0, 0), material=RUBBER),
    ]
    scene.add_static(Compound(tiles), position=(0, 0, -0.1), name="floor")
    scene.add_body(
        Box(0.2, 0.1, 0.1),
        mass=1.0,
        position=(0.5, 0, 0.05),
        velocity=(1, 0, 0),
        material=ICE,
        name="on",
    )
    scene.add_body(
        Box(0.2, 0.1, 0.1),
        mass=1.0,
        position=(-0.5, 0, 0.05),
        velocity=(1, 0, 0),
        material=ICE,
        name="off",
    )
    scene.set_contact_default(combine="max")
    run = carom.simulate(scene, 0.1)
    assert run.status == 0
    assert run["on"].velocity[-1, 0] == pytest.approx(1.0 - 0.5 * 9.81 * 0.1, abs=1e-9)
    assert run["off"].velocity[-1, 0] == pytest.approx(1.0, abs=1e-12)


def test_the_part_that_strikes_decides_how_it_bounces():
    soft, hard = Material(restitution=0.0, friction=0.0), Material(restitution=0.8, friction=0.0)
    ends = Compound(
        [
            Part(Sphere(0.05), (0, 0, 0), material=soft),
            Part(Sphere(0.05), (0, 0, 0.3), material=hard),
        ]
    )
    for turn, e in (((1, 0, 0, 0), 0.0), ((0, 1, 0, 0), 0.8)):
        scene = carom.Scene()
        scene.set_contact_default(combine="max")
        scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), material=soft)
        # stands on one end: the lower ball is the first part, or with half a turn the second
        scene.add_body(ends, mass=1.0, position=(0, 0, 0.3), orientation=turn, name="dumbbell")
        run = carom.simulate(scene, 0.2)
        first = run.impacts[0]
        before, after = first.relative_velocity_before, first.relative_velocity_after
        assert after[0] == pytest.approx(-e * before[0], abs=1e-12)
        assert np.isnan(first.restitution)
        assert first.friction == 0.0
        with pytest.raises(ValueError, match="a contact with one material"):
            run.impact_history(0)


def test_parts_of_one_material_are_as_a_body_of_it():
    one, two = block(RUBBER, RUBBER), block(None, None, material=RUBBER)
    ends = []
    for scene in (one, two):
        floor(scene)
        ends.append(carom.simulate(scene, 0.1)["block"].position[-1])
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-14)
    assert one["block"].material == RUBBER


def test_values_of_a_contact_are_those_of_all_parts():
    scene = block(STEEL, RUBBER)
    floor(scene)
    contact = scene.add_contact("block", "floor", friction=0.3)
    assert contact.of_materials == (
        "stiffness", "restitution", "rolling_friction", "pivoting_friction",
        "tangential_restitution",
    )  # fmt: skip
    run = carom.simulate(scene, 0.05)
    assert run["block"].velocity[-1, 0] == pytest.approx(1.0 - 0.3 * 9.81 * 0.05, abs=1e-9)
    scene.replace(contact.name, friction_held=0.2)
    assert "friction_held" not in scene.contacts[0].of_materials


def test_file(tmp_path):
    scene = block(STEEL, RUBBER)
    floor(scene)
    run = carom.simulate(scene, 0.05)
    run.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    again = carom.simulate(loaded.scene.copy(), 0.05)
    np.testing.assert_array_equal(again["block"].velocity, run["block"].velocity)


def test_what_is_refused():
    with pytest.raises(
        ValueError, match="material must be given for a body of which some parts have none"
    ):
        block(STEEL, None)
    with pytest.raises(TypeError, match="material must be a Material"):
        Part(Sphere(1), (0, 0, 0), material="steel")
    scene = block(STEEL, RUBBER)
    scene.set_contact_default()
    floor(scene)
    with pytest.raises(ValueError, match="combine must be given"):
        carom.simulate(scene, 0.1)
