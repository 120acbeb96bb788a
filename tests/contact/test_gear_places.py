"""Places of two profiles: what is known of a pose, and how far is searched, changes none of them."""

import math

import numpy as np
import pytest

import carom
from carom.collision.layout import Placed, new_pair_work, new_points, solid_table
from carom.collision.touch import touch


def gears(teeth=(20, 31), module=0.004):
    """Two involute wheels, and the distance of their axles."""
    shapes = [carom.Profile.involute(n, module, 0.02, backlash=0.1 * module) for n in teeth]
    return shapes, 0.5 * module * sum(teeth)


def lobes():
    """Two closed curves with hollows, and a distance at which they may touch."""
    shapes = [
        carom.Profile(lambda a, n=n: 0.05 * (1.0 + 0.2 * math.cos(n * a)), 0.02) for n in (3, 5)
    ]
    return shapes, 0.105


def toothed():
    """Two polygons."""
    shapes = []
    for count in (7, 11):
        turns = 2 * np.pi / count * np.arange(count)
        points = [
            (r * math.cos(a), r * math.sin(a))
            for t in turns
            for r, a in ((0.04, t), (0.05, t + 0.3))
        ]
        shapes.append(carom.Profile(points, 0.02, corners="all"))
    return shapes, 0.098


class Pair:
    """Two profiles, with a workspace that may be kept."""

    def __init__(self, shapes):
        self.solids, self.hulls = solid_table(shapes)
        self.work = new_pair_work()

    def found(self, x, turns, reach, fresh):
        """Return the points (k,) of a pose."""
        out, work = new_points(), new_pair_work() if fresh else self.work
        poses = [
            (np.array(place), np.array([math.cos(a / 2), 0, 0, math.sin(a / 2)]))
            for place, a in zip(((0.0, 0, 0), x), turns)
        ]
        one, two = (Placed(solid, *pose) for solid, pose in zip(self.solids, poses))
        return out[: touch(one, two, self.hulls, reach, work, out)].copy()


def poses(rng, far, count):
    """Yield random poses, of which each comes several times."""
    made = []
    for _ in range(count):
        if made and rng.random() < 0.6:
            yield made[int(rng.integers(max(0, len(made) - 12), len(made)))]
            continue
        x = (far * (1.0 + 0.02 * rng.normal()), 0.01 * far * rng.normal(), 0.0)
        made.append((x, rng.uniform(0, 2 * np.pi, 2)))
        yield made[-1]


@pytest.mark.parametrize("make", [gears, lobes, toothed])
def test_what_is_known_of_a_pose_changes_nothing(make):
    """Poses and reaches in any order: the same bits as with a workspace that knows nothing."""
    shapes, far = make()
    pair, rng = Pair(shapes), np.random.default_rng(5)
    for x, turns in poses(rng, far, 300):
        reach = float(rng.choice([0.0, 1e-3, 0.2])) * far
        known = pair.found(x, turns, reach, False)
        alone = pair.found(x, turns, reach, True)
        assert known.tobytes() == alone.tobytes()


@pytest.mark.parametrize("make", [gears, lobes, toothed])
def test_a_small_reach_finds_the_nearest_of_a_large_one(make):
    shapes, far = make()
    pair, rng = Pair(shapes), np.random.default_rng(6)
    seen = 0
    for x, turns in poses(rng, far, 150):
        everything = pair.found(x, turns, 0.2 * far, True)
        least = everything["gap"].min()
        for reach in (0.0, 1e-3 * far):
            near = pair.found(x, turns, reach, True)
            assert near["gap"].min() == pytest.approx(least, abs=1e-13)
            expected = everything[everything["gap"] <= least + reach * (1.0 - 1e-9) - 1e-15]
            features = set(near["feature"].tolist())
            assert set(expected["feature"].tolist()) <= features
            assert np.all(near["gap"] <= least + reach + 1e-13)
            seen += len(everything) > len(near)
    assert seen > 3
