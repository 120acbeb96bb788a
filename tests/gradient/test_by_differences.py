"""Derivatives by differences of pieces: joints, loops, springs and contacts that are held."""

import numpy as np
import pytest

import carom
from gradient.thrown import SIX, throw


def pendulum(mass=0.0, e=0.0, mu=0.0, gravity=0.0, duration=0.8):
    """Two rods, the second with a ball that strikes a wall at .488 s, and a spring in the first hinge."""
    scene = carom.Scene(gravity=(0, 0, -9.81 + gravity))
    wall = scene.add_half_space((-0.1, 0, 0), (1, 0, 0), name="wall")
    moments = {"inertia": (1e-3, 0.02, 0.02)}
    first = scene.add_body(mass=1.0 + mass, position=(0.25, 0, 0), name="first", **moments)
    second = scene.add_body(
        carom.Sphere(0.05), mass=1.0, position=(0.75, 0, 0), name="second", **moments
    )
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, first)
    scene.add_joint(carom.joints.Revolute((0.5, 0, 0), (0, 1, 0)), first, second)
    scene.add_force(carom.forces.JointSpring(hinge, 0.3))
    scene.add_contact(second, wall, restitution=0.6 + e, friction=0.1 + mu)
    return carom.simulate(scene, duration, step=2e-3)


def sixth_order(make, e):
    """Return differences of order 6 of whole runs: of the last positions, and of the times of impacts."""
    runs = [(weight / e, make(m * e)) for m, weight in SIX]
    return tuple(sum(w * f(run) for w, run in runs) for f in (_last, _times))


def _last(run):
    return run.position[-1]


def _times(run):
    return run.impacts.time


@pytest.fixture(scope="module")
def swung():
    run = pendulum()
    names = (
        "first.mass",
        "second-wall.restitution",
        "second-wall.friction",
        "gravity",
        "second.velocity",
    )
    return run, carom.sensitivities(run, names)


@pytest.mark.parametrize(
    ("name", "column", "e"),
    [("mass", 0, 1e-3), ("e", 1, 1e-3), ("mu", 2, 1e-3), ("gravity", 5, 1e-2)],
)
def test_pendulum_that_strikes_against_whole_runs(swung, name, column, e):
    # one impact, so whole runs have differences as well: of order 6 to 1e-9 or better
    run, found = swung
    position, time = sixth_order(lambda z: pendulum(**{name: z}), e)
    assert len(run.impacts) == 1
    most = np.max(np.abs(position))
    np.testing.assert_allclose(
        found.final.position[..., column], position, rtol=0, atol=1e-7 * most
    )
    np.testing.assert_allclose(found.impact_time[:, column], time, rtol=1e-7, atol=1e-9)
    assert found.by == "differences"
    assert found.defect < 1e-6
    assert found.notes == ()
    assert np.all(np.isnan(found.reach))


def test_tangents_stay_on_the_joints(swung):
    # d/dp of |second's end - first's end| = 0: the point (.5, 0, 0) of the start moves with both
    run, found = swung
    for k in (100, 300, 400):
        d = found.evaluate(run.t[k])
        ends = []
        for b, arm in ((0, (0.25, 0, 0)), (1, (-0.25, 0, 0))):
            q = run.orientation[k, b]
            r = carom.geometry.quaternion.rotate(q, arm)
            ends.append(d.position[b] + np.cross(d.rotation[b], r, axisa=0, axisb=0, axisc=0))
        scale = np.max(np.abs(d.position), axis=(0, 1)) + 1e-12
        assert np.max(np.abs(ends[0] - ends[1]) / scale) < 1e-7


def test_free_bodies_have_the_same_by_both_ways():
    run = throw(duration=0.2)
    names = (
        "die.velocity",
        "die.orientation",
        "die-ground.friction",
        "die-ground.restitution",
        "die.mass",
    )
    exact = carom.sensitivities(run, names)
    pieces = carom.sensitivities(run, names, by="differences")
    assert len(run.impacts) >= 3
    for one, other in zip(exact.final, pieces.final):
        np.testing.assert_allclose(other, one, rtol=0, atol=1e-6 * np.max(np.abs(one)))
    for name in ("impact_time", "impact_point", "velocity_before", "velocity_after", "impulse"):
        one, other = getattr(exact, name), getattr(pieces, name)
        np.testing.assert_allclose(other, one, rtol=0, atol=1e-6 * np.max(np.abs(one)))


def test_a_block_that_slides_to_rest_has_the_derivative_of_the_closed_form():
    # from the speed v with friction mu: x = v^2/(2 mu g), dx/dv = v/(mu g), dx/dmu = -v^2/(2 mu^2 g)
    scene = carom.Scene(gravity=(0, 0, -9.81))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    block = scene.add_body(
        carom.Box(0.2, 0.2, 0.02), mass=1.0, position=(0, 0, 0.01), velocity=(1, 0, 0), name="block"
    )
    scene.add_contact(block, ground, restitution=0.0, friction=0.3)
    run = carom.simulate(scene, 0.5, step=5e-3)
    names = ("block.velocity", "block-ground.friction")
    with pytest.raises(ValueError, match="begins a persistent contact"):
        carom.sensitivities(run, names)
    found = carom.sensitivities(run, names, by="differences", throw=False)
    x = found.final.position[0, 0]
    assert run.velocity[-1, 0, 0] == 0.0
    # steps on several points are of order 2
    assert x[0] == pytest.approx(1 / (0.3 * 9.81), rel=1e-5)
    assert x[3] == pytest.approx(-1 / (2 * 0.3**2 * 9.81), rel=1e-5)
    assert np.isnan(x[2])  # lifted or pressed: another sequence
    assert any("block.velocity.z" in note for note in found.notes)


def test_what_has_no_neighbours_or_no_steps_is_refused():
    run = throw(duration=0.05, mu=0.0)
    with pytest.raises(ValueError, match="friction must be above 0"):
        carom.sensitivities(run, "friction", by="differences")
    with pytest.raises(ValueError, match="inertia"):
        carom.sensitivities(run, "die.inertia", by="differences")
    with pytest.raises(ValueError, match="by must be"):
        carom.sensitivities(run, "gravity", by="luck")
    found = carom.sensitivities(run, "gravity", by="differences")
    with pytest.raises(ValueError, match=r"end of a step.*nearest"):
        found.evaluate(0.5 * (run.t[3] + run.t[4]))
