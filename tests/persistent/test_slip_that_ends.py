"""Errors of place and arc where slip ends, where its law has a kink, and where it comes before an opening."""

import numpy as np
import pytest

import carom
from campaigns import loose_rails
from slip_that_ends import TOLERANCES, errors


@pytest.mark.parametrize("seed", [17, 20, 23, 29])
def test_balls_slide_by_laws_and_roll(seed):
    """Stribeck's laws and tables, on a plane and in bowls that turn, against an integration of its own."""
    found = errors("ball", seed, 0.8)
    assert found is not None
    assert max(found) < 10.0, dict(zip(TOLERANCES, found))


def test_a_ball_rolls_on_a_height_field_as_on_its_function():
    """A bicubic spline is exact for z = 1.2 x^2 + .6 y^2, so both grounds are one to round-off."""
    ends, q = [], np.linspace(-0.8, 0.8, 33)
    for ground in (
        carom.surfaces.HeightField(1.2 * q[:, None] ** 2 + 0.6 * q**2, spacing=0.05),
        carom.surfaces.Surface(
            lambda x, y, z: z - 1.2 * x**2 - 0.6 * y**2, bounds=[(-1, -1, -0.5), (1, 1, 2)]
        ),
    ):
        scene, p = carom.Scene(), np.array([0.2, 0.1, 0.054])
        normal = np.array([-0.48, -0.12, 1.0]) / np.sqrt(1.0 + 0.48**2 + 0.12**2)
        v = 0.5 * np.cross(normal, (1, 0, 0))
        ball = scene.add_body(
            carom.Sphere(0.05), mass=0.2, position=p + 0.05 * normal, velocity=v,
            angular_velocity=np.cross(normal, v) / 0.05,
        )  # fmt: skip
        scene.add_contact(ball, scene.add_surface(ground), restitution=0.0, friction=0.9)
        run = carom.simulate(scene, 0.8, rtol=1e-12, save_at=0.8)
        assert run.stats["trial_steps"] < 200
        ends.append(run.position[-1, 0])
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)


def test_slip_comes_before_an_opening():
    """What sticks while its force falls to zero leaves its cone first: it slips, then opens."""
    case = loose_rails.case(3)
    runs = [carom.simulate(case.scene, 0.2, rtol=tol, save_at=0.2) for tol in (1e-6, 1e-8, 1e-11)]
    for run, tol in zip(runs, (1e-6, 1e-8)):
        assert list(run.events.kind[-2:]) == ["slips", "opens"]
        size = run.scene.bodies[0].shape.size
        assert run.position[-1] == pytest.approx(runs[-1].position[-1], abs=20 * tol * size)
