"""Bodies on one joint that strike with friction: wedged or not, no impulse is absurd (§1.9)."""

import numpy as np
import pytest

import carom
from campaigns import strikes
from carom import GROUND, Scene, joints

LAWS = ("newton", "poisson", "stronge")


def cube_on_a_slide(friction, restitution, law, scale=1.0):
    """A cube of 0.1 m, tilted so that an edge is below, on a slide 60 degrees from the normal of the ground."""
    scene = Scene(gravity=(0, 0, -9.81))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    cube = scene.add_body(
        carom.Sphere(0.05), mass=scale, position=(0, 0, 0.25), velocity=(0, 0, 0), name="cube"
    )
    along = (np.sin(np.pi / 3), 0.0, np.cos(np.pi / 3))
    scene.add_joint(joints.Prismatic(along), GROUND, cube)
    scene.add_contact(cube, floor, friction=friction, restitution=restitution, impact_law=law)
    return scene


@pytest.mark.few(2)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("scale", [1.0, 1e-9])
def test_body_on_a_slide_stays_where_it_struck(law, scale):
    # Along the slide it has g cos 60: it falls 0.2 m and strikes at v^2 = 2 g 0.2, along the slide (the
    # energy is that of the height). mu = 1 > cot 60: wedged, and gravity does not move it either.
    s = carom.simulate(cube_on_a_slide(1.0, 0.5, law, scale), 0.5, step=5e-3)
    assert s.status is carom.Status.SUCCESS
    blow = s.impacts[0]
    assert blow.wedged == 1
    assert blow.impulse[0] == pytest.approx(
        (1.5 if law == "poisson" else 1.0) * 0.5 * np.sqrt(2 * 9.81 * 0.2) * scale
        / (0.25 + 0.5 * np.sin(np.pi / 3)), rel=1e-9,
    )  # fmt: skip
    np.testing.assert_allclose(s.velocity[-1, 0], 0.0, atol=1e-12)
    assert s.position[-1, 0, 2] == pytest.approx(0.05, abs=1e-12)
    exchanged = scale * 9.81 * 0.2
    assert np.max(np.abs(s.ledger.residual)) < 1e-9 * exchanged
    assert s.ledger.impacts[-1] == pytest.approx(-exchanged, rel=1e-9)


def test_less_friction_than_the_slide_is_steep():
    # mu = .4 < cot 60: u_n returns at the rate W_nn - mu W_nt; Newton's law is met, energy e^2.
    s = carom.simulate(cube_on_a_slide(0.4, 0.5, "newton"), 0.45, step=5e-3)
    blow = s.impacts[0]
    assert blow.wedged == 0
    assert blow.relative_velocity_after[0] == pytest.approx(
        -0.5 * blow.relative_velocity_before[0], rel=1e-12
    )
    assert blow.energy_change == pytest.approx(-0.75 * 9.81 * 0.2, rel=1e-9)


# what they do between impacts, at this step, is not what is asked here, nor jams, nor gains by Newton's law
@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
def test_random_bodies_on_one_joint():
    # Trees alone, to keep to one solver. Each impact for itself: momentum, cone, energy, and the bound of the
    # impulse, p z.W z <= (u_n+ - u_n-) - mu (|u_t+| - |u_t-|) with z = P/p, so p z.W z = P.(u+ - u-)/p.
    count, wedged = 0, 0
    for seed in range(160):
        one = strikes.case(seed)
        if one.label["kind"] not in (
            "revolute",
            "prismatic",
            "cylindrical",
            "spherical",
            "universal",
        ):
            continue
        s = carom.simulate(one.scene, 0.3, step=5e-3, throw=False)
        assert np.isfinite(s.velocity).all()
        for row in s.impacts:
            if row.together > 1:
                continue
            before, after, P = (
                row.relative_velocity_before,
                row.relative_velocity_after,
                row.impulse,
            )
            mu, speed = row.friction, np.linalg.norm(before)
            count, wedged = count + 1, wedged + row.wedged
            terms = np.max(np.abs(row.inverse_mass) @ np.abs(P)) + speed
            assert np.max(np.abs(after - before - row.inverse_mass @ P)) <= 2e-9 * terms
            assert np.hypot(*P[1:]) <= (mu + 1e-8 * (1 + mu)) * P[0]
            slip = np.hypot(*before[1:]) - np.hypot(*after[1:])
            assert (
                P @ (after - before) / P[0]
                <= after[0] - before[0] + mu * slip + 1e-8 * (1 + mu) * terms
            )
            if row.law != "newton":
                assert row.energy_change <= 1e-9 * np.abs(P) @ np.abs(before)
            assert P[0] * row.inverse_mass[0, 0] <= 1e4 * speed
    assert count > 20
    assert wedged > 3
