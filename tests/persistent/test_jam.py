"""Painleve's rod, pushed ahead of itself on a rough plane: above a critical friction it jams."""

import re

import numpy as np
import pytest

import carom

G = 9.81
# mu_P = (1 + 3 cos^2)/(3 sin cos) at 60 degrees
CRITICAL = 1.347150628


def slide(mu, e, tips, *, held=None, method="rk4"):
    """A rod of length and mass 1 that leans 60 degrees, its lower end (one point or two) ahead, at 1 m/s."""
    angle = np.pi / 3
    ends = [(0, y, z) for y in ([0.0] if tips == 1 else [-0.1, 0.1]) for z in (-0.5, 0.5)]
    beside = [(0.01, 0, 0), (-0.01, 0, 0), (0, 0.01, 0), (0, -0.01, 0)]
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    lean = 0.5 * (angle - np.pi / 2)
    rod = scene.add_body(
        carom.Convex(ends + beside), mass=1.0, inertia=np.diag([1 / 12, 1 / 12, 0.01]),
        position=(-0.5 * np.cos(angle), 0, 0.5 * np.sin(angle)),
        orientation=(np.cos(lean), 0, np.sin(lean), 0), velocity=(1, 0, 0),
    )  # fmt: skip
    scene.add_contact(
        rod, ground, restitution=e, friction=mu, friction_held=held, impact_law="stronge"
    )
    return carom.simulate(scene, 0.05, step=1e-4, method=method)


def jammed(*arguments, **options):
    """The same, where the run has to say that it jams at once."""
    s = slide(*arguments, **options)
    (said,) = (sentence for sentence in s.warnings if "jam" in sentence)
    assert re.match("1 persistent contacts and . impacts jam", said)
    assert "the first at t = 0 s of contact 'body1-half_space1'" in said
    return s


@pytest.mark.parametrize("tips", [1, 2])
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_jams(tips, method):
    # mu = 1.6: k = 1.75 - 1.6 * 1.299038 = -.3285 < 0. Slip stops, and the end of the rod stays (e = 0) or
    # leaves (e = .5), as W = ((1.75, 1.299), (1.299, 3.25)) gives for an approach of no speed.
    s = jammed(1.6, 0.0, tips, method=method)
    assert list(s.events.kind) == tips * ["held"] + ["jams"] + tips * ["sticks"]
    assert np.all(s.events.time == 0.0)
    np.testing.assert_allclose(s.impacts.impulse, [(0.3247595264, -0.4375, 0)], rtol=0, atol=1e-8)
    np.testing.assert_allclose(s.impacts.relative_velocity_after, 0, rtol=0, atol=1e-9)
    assert s.impacts.energy_change == pytest.approx([-0.21875], abs=1e-9)
    assert np.all(s.contact_mode == 2)
    assert np.max(np.abs(s.ledger.residual)) < 1e-8
    s = jammed(1.6, 0.5, tips, method=method)
    assert list(s.events.kind[: 2 * tips + 1]) == tips * ["held"] + ["jams"] + tips * ["opens"]
    first = s.impacts[0]
    np.testing.assert_allclose(first.impulse, (0.3992873896, -0.4672890884, 0), rtol=0, atol=1e-8)
    np.testing.assert_allclose(
        first.relative_velocity_after, (0.0917266009, 0, 0), rtol=0, atol=1e-8
    )
    assert np.all(s.impacts.energy_change < 0)


@pytest.mark.few(3)
@pytest.mark.parametrize("tips", [1, 2])
@pytest.mark.parametrize("part", [0.9, 0.99, 0.999])
def test_slides_below_the_critical_friction(tips, part):
    # N = g/k, k = 1.75 - 1.299038 mu > 0: large, as friction brakes the tip and so presses it down.
    mu = part * CRITICAL
    s = slide(mu, 0.5, tips)
    # where slip stops, round-off of the nearly singular W may let two tips jump, by some 1e-8 m/s
    assert list(s.events.kind[:tips]) == tips * ["held"]
    assert s.events.kind[tips] in (("sticks", "opens") if tips == 2 else ("sticks",))
    assert np.all(np.abs(s.impacts.relative_velocity_before[:, 0]) < 1e-6)
    N = G / (1.75 - 1.299038105677 * mu)
    np.testing.assert_allclose(s.contact_force[0, 0], (N, -mu * N, 0), rtol=1e-5, atol=1e-9)
    assert np.max(s.total_energy) <= s.total_energy[0] * (1.0 + 1e-12)


def test_jams_by_the_friction_of_contact_that_stays():
    # In an impact with mu = .3 it would not: the one that jams is the one that stops it.
    s = jammed(0.3, 0.0, 1, held=1.6)
    assert list(s.events.kind) == ["held", "jams", "sticks"]
    np.testing.assert_allclose(s.impacts.impulse, [(0.3247595264, -0.4375, 0)], rtol=0, atol=1e-8)


@pytest.mark.parametrize("step", [1e-3, 2e-3])
def test_friction_takes_what_is_lost_in_a_jam_within_a_step(step):
    """An ellipsoid slides until it jams: only an impulse stops its slip, and friction has done all work.

    Steps of 1e-5 s locate the jam, and lose 1.108e-3 J by it and before; a step beyond it has order 1.
    """
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    body = scene.add_body(
        carom.Ellipsoid(0.006799792546896313, 0.0035254353668639246, 0.004343705668575818),
        mass=0.10061911810470593, position=(0, 0, 0.004662845244476286),
        orientation=(0.5329012869991496, 0.649411913842298, 0.14632817576209262, 0.5223681168031525),
        velocity=(-0.04954173793846747, -0.1919761046975443, 0.03946242557973437),
        angular_velocity=(70.90025221797113, 91.8046580420178, 77.76163665583184),
    )  # fmt: skip
    scene.add_contact(body, ground, restitution=0.0, friction=2.285)
    s = carom.simulate(scene, 0.002, step=step)
    assert s.status == carom.Status.SUCCESS
    assert np.abs(s.ledger.residual).max() < 1e-7 * s.total_energy[0]
    assert s.ledger.friction[-1] == pytest.approx(-1.108e-3, rel=0.03)
