"""Moreau-Jean: what it keeps, and that it errs by O(h) once there is an impact."""

import numpy as np
import pytest
from baseline_scenes import die, sphere

import carom
from carom.baselines import moreau_jean
from verified import agree, verifies

FALL = np.sqrt(2 * 0.4 / 9.81)  # the sphere's first impact


def test_sphere_keeps_energy_exactly_at_e_one():
    """theta = 1/2: flight is exact, and an elastic impact returns the state of the step's begin."""
    run = moreau_jean(sphere(1.0), 4 * FALL, step=1.3e-3)
    assert run.impulse[:, 0].nonzero()[0].size == 2
    np.testing.assert_allclose(run.total_energy, run.total_energy[0], rtol=1e-12)
    heights = run.position[:, 0, 2] - 0.1
    apex = heights[run.t > 1.5 * FALL].max()
    assert apex == pytest.approx(0.4, abs=9.81 * 1.3e-3**2)


def test_impact_times_err_by_a_step():
    """The first impact is late by h/2 to 3h/2, and each further one adds 0 to 2h.

    The step is active with q in (-h|v|/2, h|v|/2]; it reverses v at that height in the time h, the
    exact motion would need 2 q/|v|.
    """
    for h in (4e-3, 1e-3):
        run = moreau_jean(sphere(1.0), 6 * FALL, step=h)
        times = run.t[run.impulse[:, 0] > 0.0]
        late = (times - FALL * np.array([1.0, 3.0, 5.0])) / h
        assert 0.5 < late[0] < 1.5
        assert np.all((np.diff(late) > 0.0) & (np.diff(late) < 2.0))


def test_first_order_after_an_impact():
    """Mean error of z at one time over nine drops; one alone is too erratic to show a slope."""
    drops = 0.4 + 0.01 * np.arange(9)
    steps = np.array([16e-3, 8e-3, 4e-3, 2e-3])
    mean = []
    for h in steps:
        errors = []
        for drop in drops:
            run = moreau_jean(sphere(0.8, drop=drop), 0.45, step=h)
            t1, v1 = np.sqrt(2 * drop / 9.81), np.sqrt(2 * drop * 9.81)
            later = 0.45 - t1
            exact = 0.1 + 0.8 * v1 * later - 0.5 * 9.81 * later**2
            errors.append(abs(run.position[-1, 0, 2] - exact))
        mean.append(np.mean(errors))
    slope = np.polyfit(np.log(steps), np.log(mean), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.3)


def test_second_order_in_free_motion():
    """A spinning body with three moments of inertia that touches nothing, theta = 1/2."""
    ends = []
    for h in (0.02, 0.01, 0.005):
        scene = sphere(0.5, drop=100.0, spin=(0.3, 2.0, 0.2))
        scene.bodies[0].inertia = np.diag([1.0, 2.0, 2.5])
        run = moreau_jean(scene, 1.0, step=h)
        ends.append(np.concatenate([run.orientation[-1, 0], run.angular_velocity[-1, 0]]))
        assert not run.impulse.any()
    order = np.log2(np.abs(ends[0] - ends[1]).max() / np.abs(ends[1] - ends[2]).max())
    assert order == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(
    ("mu", "velocity", "spin"),
    [
        (0.05, (0.366147612250, 0.0, 0.252217924424), -181.829966521),
        (0.20, (-0.104880400901, 0.0, 0.599572173967), -117.861175844),
    ],
)
def test_planar_die_first_impact(mu, velocity, spin):
    """Slip all through the first impact: the algebraic law agrees with the exact one to O(h)."""
    for h in (1e-3, 1e-4):
        run = moreau_jean(die(mu), 0.2, step=h)
        k = int(np.flatnonzero(run.impulse[:, 0])[0])
        assert abs(run.t[k] - 0.196210991904) <= h
        assert np.abs(run.velocity[k, 0] - velocity).max() < 20.0 * h
        assert abs(run.angular_velocity[k, 0, 1] - spin) < 4000.0 * h
        assert np.abs(run.impulse[k, 1:]).max() == pytest.approx(mu * run.impulse[k, 0], rel=1e-12)
    assert np.abs(run.position[:, 0, 1]).max() < 1e-14


def test_energy_of_a_die_never_grows():
    run = moreau_jean(die(0.2, spin=(7.0, 10.0, 0.0)), 0.6, step=1e-3)
    assert np.count_nonzero(run.impulse[:, 0]) > 3
    assert np.diff(run.total_energy).max() < 1e-3 * run.total_energy[0]
    np.testing.assert_allclose(np.linalg.norm(run.orientation, axis=2), 1.0, atol=1e-14)


@verifies("baselines.moreau_jean", r"rolls with $\tfrac57 v_0$", "closed form")
def test_sphere_slides_then_rolls():
    """v0 = 1, mu = 0.2 on the plane: rolls with 5/7 v0 from t = 2 v0 / (7 mu g) on."""
    run = moreau_jean(sphere(0.0, drop=0.0, friction=0.2, velocity=(1, 0, 0)), 0.3, step=1e-3)
    agree(run.velocity[-1, 0], [5 / 7, 0, 0], atol=1e-3)
    agree(run.angular_velocity[-1, 0], [0, 50 / 7, 0], atol=1e-2)
    agree(run.gap[-1], 0.0, atol=1e-4)


def test_shapes_are_those_of_a_solution():
    run = moreau_jean(sphere(0.5), 0.01, step=3e-3)
    np.testing.assert_allclose(run.t, [0, 0.003, 0.006, 0.009, 0.01])
    assert run.position.shape == run.velocity.shape == run.angular_velocity.shape == (5, 1, 3)
    assert run.orientation.shape == (5, 1, 4)
    assert run.impulse.shape == (5, 3)


def test_bad_input_names_the_argument():
    for name, given in (
        ("step", dict(duration=1.0, step=0.0)),
        ("duration", dict(duration=np.nan, step=0.1)),
        ("theta", dict(duration=1.0, step=0.1, theta=0.4)),
    ):
        with pytest.raises(ValueError, match=name):
            moreau_jean(sphere(0.5), **given)
    two = sphere(0.5)
    two.bodies = two.bodies * 2
    with pytest.raises(ValueError, match="exactly one body"):
        moreau_jean(two, 1.0, step=0.1)
    jointed = sphere(0.5)
    jointed.joints = (object(),)
    with pytest.raises(ValueError, match="no joints"):
        moreau_jean(jointed, 1.0, step=0.1)


def test_reads_a_scene_of_the_library():
    """The same die stated as a `carom.Scene` moves the same."""
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    body = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3),
        velocity=(0.5, 0, -0.5), angular_velocity=(0, 10, 0),
    )  # fmt: skip
    scene.add_contact(body, ground, restitution=0.5, friction=0.2)
    run, same = moreau_jean(scene, 0.25, step=1e-3), moreau_jean(die(0.2), 0.25, step=1e-3)
    np.testing.assert_allclose(run.velocity, same.velocity, rtol=1e-12, atol=1e-12)
