"""Surfaces that move in themselves, as parts of a scene: what is refused, copies, files, names of values."""

from __future__ import annotations

import numba
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import carom
from carom.visual.bodies import ARROW, parts_of


def belts():
    """Return a scene with a belt and a roller, and a block on the belt."""
    scene = carom.Scene()
    belt = scene.add_half_space((0, 0, 0), (0, 0, 1), surface_velocity=(1, 0, 0), name="belt")
    block = scene.add_body(carom.Box(0.1, 0.1, 0.02), mass=1.0, position=(0, 0, 0.01), name="block")
    scene.add_static(
        carom.Cylinder(0.1, 0.2),
        position=(2, 0, 0.1),
        surface_spin=((0, 1, 0), 3.0, (2, 0, 0)),
        name="roller",
    )
    scene.add_contact(block, belt, friction=0.5, restitution=0.0)
    return scene


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"surface_velocity": (1, 0, 0.1)}, "in the plane of the half-space"),
        ({"surface_velocity": 1.0}, r"\(3,\)"),
        ({"surface_velocity": CubicSpline([0, 1], [1, 2])}, r"must have values of shape \(3,\)"),
        ({"surface_velocity": CubicSpline([0, 1], [(0, 0, 0), (1, 0, 1)])}, "in the plane"),
        (
            {"surface_spin": ((0, 0, 1), CubicSpline([0, 1], [(0, 1), (1, 0)]))},
            r"values of shape \(\)",
        ),
        ({"surface_velocity": (1, 0, float("nan"))}, "surface_velocity"),
        ({"surface_spin": ((1, 0, 0), 2.0)}, "about the normal"),
        ({"surface_spin": 2.0}, r"\(axis, rate\)"),
        ({"surface_spin": ((0, 0, 0), 2.0)}, "axis of surface_spin"),
        ({"surface_spin": ((0, 0, 1), "fast")}, "rate of surface_spin"),
        ({"surface_spin": ((0, 0, 1), 1.0, (0, 0))}, "point of surface_spin"),
    ],
)
def test_what_no_plane_does_is_refused(given, words):
    with pytest.raises((TypeError, ValueError), match=words):
        carom.Scene().add_half_space((0, 0, 0), (0, 0, 1), **given)


def test_a_function_that_leaves_the_plane_is_refused():
    scene = belts()
    scene.replace("belt", surface_velocity=lambda t: ((0, 0, 1.0), (0, 0, 0)))
    with pytest.raises(ValueError, match="in the plane of the half-space"):
        carom.simulate(scene, 0.1, step=0.01)


def test_text_copies_and_changes():
    scene = belts()
    assert "surface_velocity=(1, 0, 0)" in repr(scene["belt"])
    assert "surface_spin" in str(scene)
    other = scene.copy()
    other.replace("belt", surface_velocity=(2, 0, 0))
    assert scene["belt"].surface_velocity[0] == 1.0
    assert other["belt"].surface_velocity[0] == 2.0
    assert not other.replace("belt", surface_velocity=None).moves


def test_files_keep_it(tmp_path):
    scene = belts()
    scene.replace("roller", surface_spin=((0, 1, 0), turning))
    s = carom.simulate(scene, 0.1, step=0.01, save=tmp_path / "run.nc")
    read = carom.Solution.load(tmp_path / "run.nc", functions={"roller.surface_spin": turning})
    assert np.array_equal(read.scene["belt"].surface_velocity, (1, 0, 0))
    assert read.scene["roller"].surface_spin[1] is turning
    assert np.array_equal(read.surface_power("belt"), s.surface_power("belt"))
    assert s.surface_power("belt").max() > 0.0 == s.surface_power("roller").max()


def turning(t):
    """Return a rate that grows."""
    return 1.0 + t, 1.0


def test_ensembles_vary_it_by_name():
    runs = carom.ensemble(
        belts(),
        0.1,
        step=0.01,
        vary={"belt.surface_velocity.x": [0.0, 1.0, -1.0]},
        executor="serial",
    )
    x = runs.position[:, 0, 0]
    way = 0.5 * 0.5 * 9.81 * 0.1**2
    assert np.allclose(x, [0.0, way, -way], atol=1e-12)


def test_ensembles_vary_the_rate_of_a_spin():
    rates = np.array([0.0, 2.0, -3.0])
    runs = carom.ensemble(
        turntable(1.0), 0.1, step=0.01, vary={"table.surface_spin.rate": rates}, executor="serial"
    )
    assert np.allclose(runs.angular_velocity[:, 0, 2], rates, atol=1e-9)
    again = runs.solution(1)
    assert np.array_equal(again.angular_velocity[-1], runs.angular_velocity[1])
    with pytest.raises(ValueError, match=r"surface_spin must be \(axis, rate\)"):
        carom.ensemble(turntable(1.0), 0.1, vary={"table.surface_spin": [1.0]})


def turntable(rate):
    """Return a ball on the middle of a turntable, with so much pivoting friction that it rides at once."""
    scene = carom.Scene()
    table = scene.add_half_space((0, 0, 0), (0, 0, 1), surface_spin=((0, 0, 1), rate), name="table")
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.1), name="ball")
    scene.add_contact(ball, table, friction=0.5, restitution=0.0, pivoting_friction=0.1)
    return scene


@pytest.mark.parametrize("compiled", [False, True])
def test_polynomials_are_functions_of_time(compiled, tmp_path):
    # v = 2 t - t^2 and rate = 3 t^2, which cubic splines through four points are
    knots = np.linspace(0.0, 0.6, 4)
    velocity = CubicSpline(knots, np.outer(2.0 * knots - knots**2, (1.0, 0.0, 0.0)))
    rate = CubicSpline(knots, 3.0 * knots**2)

    def forward(t):
        return (2.0 * t - t**2, 0, 0), (2.0 - 2.0 * t, 0.0, 0.0)

    def turns(t):
        return 3.0 * t**2, 6.0 * t

    if compiled:
        forward, turns = numba.njit(forward), numba.njit(turns)
    for curve, function in ((velocity, forward), (rate, turns)):
        scenes = [belts() if curve is velocity else turntable(0.0) for _ in range(2)]
        for scene, motion in zip(scenes, (curve, function)):
            if curve is velocity:
                scene.replace("belt", surface_velocity=motion)
            else:
                scene.replace("table", surface_spin=((0, 0, 1), motion))
        save = tmp_path / "run.nc"
        a = carom.simulate(scenes[0], 0.6, save=save)
        b = carom.simulate(scenes[1], 0.6)
        assert np.allclose(a.position, b.position, atol=1e-9)
        read = carom.Solution.load(save).scene.fixed[0]
        kept = read.surface_velocity if curve is velocity else read.surface_spin[1]
        assert np.array_equal(kept.c, curve.c)


def test_arrows_lie_on_the_surfaces():
    parts = [part for part in parts_of(belts(), 1.0) if part.colour == ARROW]
    assert len(parts) == 5  # one on the belt, four on the roller
    assert np.min(parts[0].vertices[:, 2]) == 0.0
    tip = parts[0].vertices[3] - parts[0].vertices.mean(axis=0)
    assert tip[0] > 0.0
    assert abs(tip[1]) < 1e-12


def test_sensitivities_of_moving_planes_are_differences():
    scene = belts()
    scene.remove("roller")
    s = carom.simulate(scene, 0.05, step=0.01)
    with pytest.raises(ValueError, match='by="differences"'):
        carom.sensitivities(s, with_respect_to=["block.velocity"], by="saltation")
