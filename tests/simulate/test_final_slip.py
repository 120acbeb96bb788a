"""Runs with friction by the final slip: `impact_law="moreau"` of contacts, stops, crowds, and in files."""

import numpy as np
import pytest

import carom
from carom import GROUND, joints


def rod(law, e=0.9, friction=0.8, **options):
    """Simulate a rod at 45 degrees whose tip strikes the floor."""
    scene = carom.Scene(gravity=(0, 0, 0))
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    body = scene.add_body(
        carom.Box(1.0, 1e-3, 1e-3), mass=1.0, inertia=(1e-3, 1 / 12, 1 / 12), position=(0, 0, 0.5),
        orientation=(np.cos(np.pi / 8), 0, np.sin(np.pi / 8), 0), velocity=(-0.6, 0, -1.0),
    )  # fmt: skip
    scene.add_contact(body, floor, restitution=e, friction=friction, impact_law=law)
    return carom.simulate(scene, 0.3, step=1e-3, **options)


def test_an_impact_of_a_run_is_that_of_one_contact():
    run = rod("moreau", 0.5, 0.3)
    hit = run.impacts[0]
    alone = carom.resolve_impact(
        hit.inverse_mass, hit.relative_velocity_before, 0.3, 0.5, impact_law="moreau"
    )
    np.testing.assert_allclose(hit.relative_velocity_after, alone.velocity_after, atol=1e-13)
    np.testing.assert_allclose(hit.impulse, alone.impulse, atol=1e-13)
    assert hit.law == "moreau"
    assert hit.friction_loss == pytest.approx(alone.friction_loss, rel=1e-12)
    assert hit.layer_duration == 0.0
    assert abs(run.ledger.residual).max() < 1e-12
    with pytest.raises(ValueError, match="course over its impulse"):
        run.impact_history(0)
    with pytest.raises(ValueError, match="course over its impulse"):
        carom.plots.hodograph(run)


def test_what_it_adds_is_named():
    run = rod("moreau")
    (said,) = run.warnings
    assert said.startswith(
        'Friction by the final slip (impact_law="moreau") added energy in 1 impacts'
    )
    assert run.ledger.impacts[-1] > 0.0
    assert abs(run.ledger.residual).max() < 1e-12
    assert rod("moreau", 0.5, 0.3).warnings == ()


def dropped_box(law, e=0.4, turn=0.0, **options):
    """Drop a box on its face: four corners strike together; turned a little, edges."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    wall = scene.add_half_space(point=(0.5, 0, 0), normal=(-1, 0, 0), name="wall")
    box = scene.add_body(
        carom.Box(0.3, 0.2, 0.4), mass=2.0, position=(0.2, 0, 0.5), velocity=(0.6, 0.7, 0),
        orientation=carom.axis_angle((0, 0, 1), turn), name="box",
    )  # fmt: skip
    for ground, mu in ((floor, 0.5), (wall, 0.3)):
        scene.add_contact(box, ground, restitution=e, friction=mu, impact_law=law)
    return carom.simulate(scene, 1.5, **options)


def test_several_points_close_the_ledger():
    run = dropped_box("moreau")
    assert run.status == 0
    assert abs(run.ledger.residual).max() < 1e-8
    hits = run.impacts
    assert hits.together.max() >= 4
    together = hits.together > 1
    goal = -hits.restitution * np.minimum(hits.relative_velocity_before[:, 0], 0.0)
    slow = np.abs(hits.relative_velocity_before[:, 0]) < 1e-2  # collapses have e = 0
    miss = hits.relative_velocity_after[:, 0] - goal
    assert np.abs(miss[together & ~slow]).max() < 1e-9
    rub = np.hypot(*hits.impulse[:, 1:].T) - hits.friction * hits.impulse[:, 0]
    assert rub.max() < 1e-9
    against = (hits.impulse[:, 1:] * hits.relative_velocity_after[:, 1:]).sum(axis=1)
    assert against.max() < 1e-9
    works = hits.compression_work + hits.restitution_work - hits.friction_loss
    np.testing.assert_allclose(works, hits.energy_change, atol=1e-12)


def test_every_method_and_file_has_it(tmp_path):
    runs = [rod("moreau", 0.5, 0.3, method=name) for name in ("rk4", "paper")]
    np.testing.assert_allclose(*(run.impacts[0].impulse for run in runs), atol=1e-9)
    runs[0].save(tmp_path / "rod.nc")
    assert carom.Solution.load(tmp_path / "rod.nc").impacts[0].law == "moreau"


def test_a_stop_beside_a_contact():
    """A frictionless stop has Newton's law alone, and with a contact that strikes at once."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    arm = scene.add_body(carom.Box(1.0, 0.1, 0.1), mass=1.0, position=(0.5, 0, 0))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), axis=(0, 1, 0)), GROUND, arm)
    scene.add_stop(hinge, upper=0.3, restitution=0.6, impact_law="moreau")
    hit = carom.simulate(scene, 1.0).impacts[0]
    assert hit.relative_velocity_after[0] == pytest.approx(-0.6 * hit.relative_velocity_before[0])


def test_its_viewer_has_no_inside():
    from carom.visual.viewer.strikes import inside_of

    assert inside_of(rod("moreau", 0.5, 0.3), 0) is None
