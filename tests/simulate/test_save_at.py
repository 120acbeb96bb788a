"""`save_at`, and what is saved where nothing is said."""

import math

import numpy as np
import pytest

import carom
from simulate.scenes import die
from verified import agree, verifies


def ball(restitution=0.8):
    scene = carom.Scene(gravity=(0, 0, -9.81))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    body = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5))
    scene.add_contact(body, floor, restitution=restitution)
    return scene


def height(t, e=0.8, g=9.81, drop=0.4):
    """Height of the centre of a ball that bounces: parabolas that begin at t_k with e^k v."""
    begin, v = math.sqrt(2.0 * drop / g), math.sqrt(2.0 * g * drop)
    if t < begin:
        return 0.5 - 0.5 * g * t * t
    v *= e
    while t > begin + 2.0 * v / g:
        begin, v = begin + 2.0 * v / g, e * v
    return 0.1 + v * (t - begin) - 0.5 * g * (t - begin) ** 2


def test_two_hundred_states():
    s = carom.simulate(die(), 0.5)
    np.testing.assert_allclose(s.t, np.linspace(0.0, 0.5, 201), rtol=0, atol=1e-15)
    seldom = carom.simulate(die(), 0.5, save_every=30)
    assert np.array_equal(seldom.t, s.t[[0, 30, 60, 90, 120, 150, 180, 200]])
    assert np.array_equal(seldom.position, s.position[[0, 30, 60, 90, 120, 150, 180, 200]])


@verifies("simulate(save_at=)", "parabolas of a ball that bounces", "closed form")
@pytest.mark.parametrize("how", [{}, {"rtol": 1e-4}, {"step": 0.03}])
def test_a_spacing(how):
    """The last state is that of the end, wherever it is; all are those of the motion itself."""
    s = carom.simulate(ball(), 1.0, save_at=0.15, **how)
    agree(s.t, [*(0.15 * np.arange(7)), 1.0], atol=1e-15)
    known = [height(t) for t in s.t]
    agree(s.position[:, 0, 2], known, atol=1e-13)


@pytest.mark.parametrize("how", [{}, {"rtol": 1e-10}, {"step": 0.03}])
def test_times(how):
    """They are kept to the last digit; beginning and end are saved, too."""
    times = [0.01, 0.3, 1.0 / 3.0, 0.99]
    s = carom.simulate(ball(), 1.0, save_at=times, **how)
    assert s.t.tolist() == [0.0, *times, 1.0]
    np.testing.assert_allclose(s.position[:, 0, 2], [height(t) for t in s.t], rtol=0, atol=1e-13)
    assert s.settings["save_at"] == tuple(times)


def test_times_with_the_ends():
    s = carom.simulate(ball(), 1.0, save_at=np.linspace(0.0, 1.0, 11))
    assert np.array_equal(s.t, np.linspace(0.0, 1.0, 11))


def test_steps_between_times_are_equal():
    """No longer than the step that is given: three of 10 ms, then fourteen of 13.6 ms."""
    s = carom.simulate(ball(), 0.22, step=0.0140, save_at=[0.03])
    assert s.stats["steps"] == 3 + 14
    assert len(s.t) == 3


def test_a_system_in_coordinates():
    """An oscillator: x = cos t, at the times that were asked for."""
    system = carom.GeneralizedSystem(
        lambda q: np.eye(1), potential=lambda q: 0.5 * q[0] ** 2, position=[1.0], velocity=[0.0]
    )
    s = carom.simulate(system, 2.0, step=1e-2, save_at=[0.333, 1.0])
    assert s.t.tolist() == [0.0, 0.333, 1.0, 2.0]
    np.testing.assert_allclose(s.q[:, 0], np.cos(s.t), rtol=0, atol=1e-9)
    s = carom.simulate(system, 2.0, step=0.2, save_at=0.5)
    np.testing.assert_allclose(s.t, [0.0, 0.5, 1.0, 1.5, 2.0], rtol=0, atol=1e-15)


def test_from_a_file(tmp_path):
    """What a file says of the run makes the same run again."""
    path = tmp_path / "run.nc"
    s = carom.simulate(ball(), 1.0, save_at=[0.2, 0.7], save=path)
    again = carom.Solution.load(path)
    assert again.settings == s.settings
    same = carom.simulate(again.scene, **again.settings)
    assert np.array_equal(same.position, s.position)


@pytest.mark.plain
@pytest.mark.parametrize(
    ("save_at", "message"),
    [
        (0.0, r"save_at must be finite and above 0 and at most 1 \[s\], got 0.0"),
        (1.5, r"save_at must be finite and above 0 and at most 1 \[s\], got 1.5"),
        ([0.1, 1.5], r"save_at must be within \[0, 1\] s"),
        ([-0.1, 0.5], r"save_at must be within \[0, 1\] s"),
        ([0.5, 0.1], r"save_at must be increasing times"),
        ([0.5, 0.5], r"save_at must be increasing times"),
        ([], r"save_at must be increasing times"),
        ([[0.1, 0.2]], r"save_at must have shape \(\) or \(n,\)"),
        (math.nan, r"save_at must be finite"),
        ("often", r"save_at must"),
    ],
)
def test_bad_input(save_at, message):
    with pytest.raises((TypeError, ValueError), match=message):
        carom.simulate(ball(), 1.0, save_at=save_at)


@pytest.mark.plain
def test_two_ways_to_say_it():
    with pytest.raises(ValueError, match="save_every must be left out with save_at, got 2"):
        carom.simulate(ball(), 1.0, save_at=0.1, save_every=2)


def test_more_states_than_memory_are_refused():
    """1e12 states of three bodies take 3e14 bytes: more than a processor can address."""
    scene = carom.Scene()
    for k in range(3):
        scene.add_body(carom.Sphere(0.1), mass=1.0, position=(k, 0, 0))
    with pytest.raises(MemoryError, match=r"saved states of 3 bodies need .* GiB .* save_every="):
        carom.simulate(scene, 9e7, step=1e-4)
