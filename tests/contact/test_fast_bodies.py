"""Bodies that pass more than their own size in a step do not get through each other."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom.contact.continuous_detection import cubic_clears


@pytest.mark.parametrize(("mass", "count"), [(1.0, 3), (100.0, 31), (1e4, 313)])
@pytest.mark.parametrize("step", [1e-3, 1e-2])
def test_a_wall_and_two_balls_count_the_digits_of_pi(mass, count, step):
    # Galperin 2003: with e = 1 and masses 1 : 100^n there are floor(pi 10^n) impacts; the light ball becomes a
    # hundred times as fast within a step
    scene = carom.Scene(gravity=(0, 0, 0))
    wall = scene.add_half_space((0, 0, 0), (1, 0, 0))
    light = scene.add_body(carom.Sphere(0.05), mass=1.0, position=(0.5, 0, 0))
    heavy = scene.add_body(carom.Sphere(0.1), mass=mass, position=(1, 0, 0), velocity=(-1, 0, 0))
    for other in (wall, heavy):
        scene.add_contact(light, other, restitution=1.0, friction=0.0)
    run = carom.simulate(scene, 3.0, step=step)
    assert len(run.impacts) == count
    energy = 0.5 * mass
    np.testing.assert_allclose(run.kinetic_energy, energy, rtol=1e-9)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    offset=st.floats(0.0, 0.05), speed=st.floats(1.0, 400.0), late=st.floats(0.0, 1.0),
    gravity=st.sampled_from([0.0, 9.81]),
)  # fmt: skip
def test_a_fast_ball_meets_what_is_in_its_way(offset, speed, late, gravity):
    # two balls of r = .01 whose centres pass at an offset d strike if d < 2 r, at the time when the centres are
    # 2 r apart: t = (.2 + late v h - sqrt(4 r^2 - d^2)) / v; both fall alike
    if abs(offset - 0.02) < 1e-6:
        return
    step, r = 1e-3, 0.01
    start = 0.2 + late * speed * step
    scene = carom.Scene(gravity=(0, 0, -gravity))
    still = scene.add_body(carom.Sphere(r), mass=1.0, position=(0, 0, 0))
    fast = scene.add_body(
        carom.Sphere(r), mass=1.0, position=(-start, offset, 0), velocity=(speed, 0, 0)
    )
    scene.add_contact(fast, still, restitution=1.0, friction=0.0)
    run = carom.simulate(scene, np.ceil((start + 0.1) / speed / step) * step, step=step)
    assert len(run.impacts) == (1 if offset < 2 * r else 0)
    if offset < 2 * r:
        time = (start - np.sqrt(4 * r * r - offset * offset)) / speed
        slip = np.sqrt(4 * r * r - offset * offset) / r  # a graze is located less sharply
        assert run.impacts.time[0] == pytest.approx(time, abs=1e-10 / min(1.0, slip))


def test_what_comes_out_of_round_off_does_not_touch_again():
    # Two balls of a row, 5e-16 m inside each other after their impact where 4.8e-16 m is round-off, separate at
    # 5e-11 m/s: as an event this halved the steps of all others a thousand times.
    clears = getattr(cubic_clears, "py_func", cubic_clears)
    assert clears(-5.1e-16, 4.6e-11, -4.4e-16, 4.6e-11, 1.3e-6, 4.8e-16)
    rng, s = np.random.default_rng(8), np.linspace(0.0, 1.0, 101)
    clear = 0
    for z0, d0, z1, d1 in rng.normal(size=(2000, 4)):
        tiny = abs(rng.normal()) * 0.3
        # Hermite's cubic of values z and of rates d over a step of length 1
        curve = (1 + 2 * s) * (1 - s) ** 2 * z0 + s * (1 - s) ** 2 * d0
        curve += s**2 * (3 - 2 * s) * z1 - s**2 * (1 - s) * d1
        if clears(z0, d0, z1, d1, 1.0, tiny):
            clear += 1
            assert curve.min() >= min(-tiny, z0) - 1e-12
    assert clear > 300
