"""Nearest points of every two shapes, certified by duality; symmetry, invariance, continuity."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.geometry import quaternion
from contact.pair_cases import (
    NAMES,
    SHAPES,
    Pose,
    beyond,
    directions,
    rotations,
    separation,
    touching,
    unit,
)

PAIRS = list(itertools.combinations_with_replacement(NAMES, 2))
ROUNDING = 1e-14  # of lengths near 1 m, a few operations deep


def random_pose(rng, least, most):
    return Pose(unit(rng.normal(size=3)) * rng.uniform(least, most), unit(rng.normal(size=4)))


@pytest.mark.parametrize("poses", [8, pytest.param(25, marks=pytest.mark.slow)])
@pytest.mark.parametrize(("first", "second"), PAIRS)
def test_distance_is_certified_by_duality(first, second, poses):
    # For any unit n: separation(n) <= distance <= |a - b| for any points a of A, b of B. Equality
    # of the two ends is a proof that the gap is the distance.
    a, b = SHAPES[first], SHAPES[second]
    rng, apart = np.random.default_rng(7), 0
    for k in range(poses):
        pose_a, pose_b = random_pose(rng, 0.5, 2.0), Pose(np.zeros(3), unit(rng.normal(size=4)))
        found = touching(a, b, pose_a, pose_b)
        lower = separation(a, b, pose_a, pose_b, found.normal)
        assert np.linalg.norm(found.normal) == pytest.approx(1, abs=ROUNDING)
        difference = found.on_a - found.on_b
        np.testing.assert_allclose(difference, found.gap * found.normal, atol=ROUNDING)
        if found.gap > 0:
            apart += 1
            assert lower == pytest.approx(found.gap, abs=ROUNDING)
            if k < poses // 3:  # a linear programme each
                assert beyond(a, pose_a, found.on_a) <= ROUNDING
                assert beyond(b, pose_b, found.on_b) <= ROUNDING
    assert apart > 0.4 * poses


@pytest.mark.parametrize(("first", "second"), PAIRS)
def test_slight_overlap_is_the_least_way_out(first, second):
    # Moved in by d along the normal of contact: the gap is -d to first order, its separation along
    # the normal is itself, and no direction nearby separates more.
    a, b = SHAPES[first], SHAPES[second]
    # A vertex exactly on a sharp rim has a cone of normals, whose edge is only approached.
    slack = 5e-9 if {first, second} & {"cylinder", "disc"} else 1e-11
    rng = np.random.default_rng(11)
    for _ in range(10):
        pose_a, pose_b = random_pose(rng, 1.5, 2.0), Pose(np.zeros(3), unit(rng.normal(size=4)))
        apart = touching(a, b, pose_a, pose_b)
        for depth in (0.0, 1e-4):
            moved = Pose(pose_a.x - (apart.gap + depth) * apart.normal, pose_a.q)
            found = touching(a, b, moved, pose_b)
            assert found.gap == pytest.approx(
                separation(a, b, moved, pose_b, found.normal), abs=ROUNDING
            )
            # Corners may part sideways by less than they were moved in.
            assert found.gap <= depth / 2 + ROUNDING
            assert found.gap >= separation(a, b, moved, pose_b, apart.normal) - slack
            for turn in rng.normal(size=(10, 3)) * 0.02:
                n = unit(found.normal + turn)
                assert separation(a, b, moved, pose_b, n) <= found.gap + slack


@settings(max_examples=150, deadline=None)
@given(
    st.sampled_from(NAMES),
    st.sampled_from(NAMES),
    directions,
    st.floats(0.6, 2),
    rotations,
    rotations,
)
def test_exchange_of_the_two(first, second, u, distance, qa, qb):
    a, b = SHAPES[first], SHAPES[second]
    pose_a, pose_b = Pose(u * distance, qa), Pose(np.zeros(3), qb)
    one, two = touching(a, b, pose_a, pose_b), touching(b, a, pose_b, pose_a)
    if one.gap > 0:
        assert two.gap == pytest.approx(one.gap, abs=ROUNDING)
        np.testing.assert_allclose(two.on_a - two.on_b, -(one.on_a - one.on_b), atol=1e-7)


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(NAMES), st.sampled_from(NAMES), directions, rotations, rotations, directions)
def test_moved_and_turned_together(first, second, u, q, turn, shift):
    # What depends on relative pose only does so to the rounding of world coordinates of 1e3 m.
    a, b = SHAPES[first], SHAPES[second]
    pose_a, pose_b = Pose(u * 1.2, q), Pose(np.zeros(3), np.array([1.0, 0, 0, 0]))
    far = 1e3 * shift
    moved = [
        Pose(far + quaternion.rotate(turn, p.x), quaternion.multiply(turn, p.q))
        for p in (pose_a, pose_b)
    ]
    one, two = touching(a, b, pose_a, pose_b), touching(a, b, *moved)
    if one.gap > 0:
        assert two.gap == pytest.approx(one.gap, abs=1e-12)
        np.testing.assert_allclose(two.normal, quaternion.rotate(turn, one.normal), atol=1e-9)


@settings(max_examples=50, deadline=None)
@given(
    st.sampled_from(NAMES), st.sampled_from(NAMES), directions, rotations, directions, directions
)
def test_gap_is_continuous_through_contact(first, second, u, q, v, w):
    # A point of A moves at most |v| + |w| size: so does the gap, apart and slightly inside.
    a, b = SHAPES[first], SHAPES[second]
    start = touching(a, b, Pose(2 * u, q))
    x = 2 * u - (start.gap - 0.005) * start.normal
    h, gaps = 2e-4, []
    for k in range(-30, 31):
        turned = quaternion.multiply(quaternion.exp(0.2 * k * h * w), q)
        gaps.append(touching(a, b, Pose(x + k * h * v, turned)).gap)
    if min(gaps) > -0.01:
        assert np.max(np.abs(np.diff(gaps))) <= h * (1 + 0.2 * a.size) * 1.05 + 1e-12
