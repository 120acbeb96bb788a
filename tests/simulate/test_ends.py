"""A run ends at the time that was asked for: where impacts accumulate a body takes its steps whole."""

import numpy as np
import pytest

import carom
from carom.geometry import quaternion
from simulate.scenes import on_plane, turn

G = 9.81
#: as if a step with more than one impact were one that does not get on
SOON = carom.Options(max_impacts_per_step=1)


def tilted(e, mu, axis, angle, law="stronge", spin=(0, 0, 0)):
    """Return a scene of a plate that falls on a floor, nearly flat: its corners strike again and again."""
    plate = {
        "shape": carom.Box(0.1, 0.08, 0.02), "mass": 1.0, "position": (0, 0, 0.02),
        "orientation": turn(axis, angle), "velocity": (0.3, 0.1, 0.0), "angular_velocity": spin,
    }  # fmt: skip
    contact = {"restitution": e, "friction": mu, "impact_law": law}
    return on_plane(plate, gravity=(0, 0, -G), contact=contact)


def check_end(scene, s, duration, gains=False):
    """The run ends, nothing is inside, what is lost has a name, and no line of the ledger rises."""
    assert s.success
    assert s.t[-1] == duration
    lowest = np.einsum(
        "tk,vk->tv", quaternion.matrix(s.orientation[:, 0])[:, 2], scene.bodies[0].shape.vertices
    )
    assert np.min(s.position[:, 0, 2] + lowest.min(axis=1)) > -1e-9 * scene.bodies[0].shape.size
    start = np.max(s.kinetic_energy)
    lines = [s.ledger.friction, s.ledger.bounces] + ([] if gains else [s.ledger.impacts])
    for line in lines:
        assert np.all(np.diff(line) <= 1e-12 * start)


@pytest.mark.plain
def test_a_plate_that_rattles_keeps_energy_and_momentum():
    """e = 1 without friction: no horizontal force, and whole steps lose next to nothing."""
    scene = tilted(1.0, 0.0, (1, 2, 0), 0.03)
    s = carom.simulate(scene, 0.4, step=0.02, options=SOON)
    check_end(scene, s, 0.4)
    assert s.stats["whole_steps"] > 0
    np.testing.assert_allclose(s.velocity[:, 0, :2], np.tile((0.3, 0.1), (len(s.t), 1)), rtol=1e-12)
    start = s.total_energy[0] - np.min(s.potential_energy)
    assert np.all(s.total_energy > s.total_energy[0] - 0.02 * start)
    np.testing.assert_allclose(s.ledger.residual, 0.0, atol=1e-13 * start)


# whole steps with e = 0 leave 2e-4 of the energy without a name
@pytest.mark.few(4)
@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
@pytest.mark.processors
@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
@pytest.mark.parametrize(("e", "mu"), [(1.0, 0.5), (0.9, 0.0), (0.0, 0.0), (0.5, 1.2)])
def test_a_plate_that_rattles_ends(law, e, mu):
    rng, whole = np.random.default_rng(3), 0
    for _ in range(3):
        scene = tilted(e, mu, (*rng.normal(size=2), 0), 0.05, law, spin=rng.normal(size=3))
        s = carom.simulate(scene, 0.4, step=0.02, options=SOON)
        check_end(scene, s, 0.4, gains=law == "newton" and mu > 0.0)  # Newton's law may gain energy
        whole += s.stats["whole_steps"]
    assert whole > 0


CAPSULE, CYLINDER = carom.Capsule(0.005, 0.03), carom.Cylinder(0.01, 0.03)


@pytest.mark.parametrize(
    ("shape", "spin", "angle", "e", "mu"),
    [
        (CAPSULE, (0, 80.0, 799.7), 1.298, 0.0, 0.4),
        (CAPSULE, (0, 56.2, 561.9), 1.569, 0.0, 1.0),
        (CAPSULE, (678.6, 0, 0), 1.474, 0.3, 0.1),
        (CYLINDER, (0, 122.6, 408.7), 1.513, 0.0, 0.4),
        (CYLINDER, (0, 35.7, 119.0), 1.547, 0.3, 1.0),
    ],
)
def test_a_body_that_turns_far_within_a_piece_gains_nothing(shape, spin, angle, e, mu):
    """It spins nearly flat on a floor; what the return to the floor would give it has been up to 0.3 of all."""
    body = {
        "shape": shape, "mass": 0.1, "position": (0, 0, 0.022), "velocity": (0.5, 0.2, -0.3),
        "orientation": turn((0, 1, 0), angle), "angular_velocity": spin,
    }  # fmt: skip
    scene = on_plane(body, gravity=(0, 0, -G), contact={"restitution": e, "friction": mu})
    s = carom.simulate(scene, 0.2, step=5e-3, options=SOON)
    assert s.stats["whole_steps"] > 0
    start = np.max(s.kinetic_energy)
    for line in (s.ledger.friction, s.ledger.bounces, s.ledger.impacts):
        assert np.all(np.diff(line) <= 1e-12 * start)
    # what is left is of steps that are not taken whole
    np.testing.assert_allclose(s.ledger.residual, 0.0, atol=1e-6 * start)


def test_an_impact_that_cannot_be_excluded():
    """A cube spins a hair above the plane, and one halving cannot exclude a touch: it goes on as it is."""
    cube = {
        "shape": carom.Box(0.1, 0.1, 0.1), "mass": 1, "angular_velocity": (0, 40, 0),
        "position": (0, 0, 0.1 / np.sqrt(2) * (1 + 1e-6)),
    }  # fmt: skip
    scene = on_plane(cube, gravity=(0, 0, 0))
    s = carom.simulate(scene, 1.0, step=np.pi / 80, options=carom.Options(max_cuts=1))
    assert s.success
    assert s.stats["whole_steps"] > 0
    np.testing.assert_allclose(s.angular_velocity[-1, 0], (0, 40, 0), rtol=1e-12)


@pytest.mark.filterwarnings("ignore::carom.MistakeWarning")  # of the step, which is far too long
@pytest.mark.parametrize("e", [0.9, 1.0])
def test_a_pendulum_that_a_force_holds_to_a_wall(e):
    """Steps are taken whole where impacts are too many: with e < 1 it comes to rest, with e = 1 never."""
    scene = carom.Scene(gravity=(0, 0, -G))
    wall = scene.add_half_space((0, 0, 0), (1, 0, 0))
    rod = scene.add_body(carom.Box(0.02, 0.02, 0.4), mass=1.0, position=(0.011, 0, -0.2))
    scene.add_joint(carom.joints.Revolute((0.011, 0, 0), (0, 1, 0)), carom.GROUND, rod)
    scene.add_force(carom.forces.Force((-1000.0, 0, 0)), rod)
    scene.add_contact(rod, wall, restitution=e, friction=0.3)
    s = carom.simulate(scene, 0.5, step=0.02, options=SOON, throw=False)
    assert s.status in (carom.Status.SUCCESS, carom.Status.INACCURATE)
    assert s.stats["whole_steps"] > 0
    assert np.all(np.diff(s.ledger.impacts) <= 1e-12 * np.max(s.kinetic_energy))
    at_rest = np.max(s.kinetic_energy[-5:]) < 1e-6
    assert at_rest == (e < 1.0)
