"""What a short run saves itself: arrays, types and tables that are made once, or when they are asked for."""

import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import carom
from carom._compiled.record_arrays import Columns, table
from carom._compiled.units import kind
from carom.model import records
from ensembles.ensemble_scenes import pendulum
from files.compare import differences
from simulate.scenes import ball, die


def thrown(k):
    """A die thrown with another spin each time, to rest."""
    return carom.simulate(die(spin=(k, 10, -0.5 * k), mu=0.2), 1.0, step=2e-3)


@pytest.mark.plain
def test_columns_of_records():
    rows = table([("mass", "f8"), ("x", "f8", 3)], 2)
    rows.mass, rows["x"] = np.array([1.0, 2.0]), 3.0
    rows[1].x[2] = 4.0
    assert type(rows.x) is np.ndarray
    assert isinstance(rows, np.recarray)
    np.testing.assert_array_equal(rows.mass, [1, 2])
    np.testing.assert_array_equal(rows.x, [[3, 3, 3], [3, 3, 4]])
    for other in (rows[1:], rows[[1]], rows[rows.mass > 1.0], pickle.loads(pickle.dumps(rows))[1:]):
        assert type(other) is Columns
        assert other[0].mass == other.mass[0] == 2.0
    with pytest.raises(AttributeError, match="no column 'weight'"):
        _ = rows.weight


def test_runs_at_the_same_time_are_those_in_turn():
    # No workspace is shared: bit for bit the same, whatever other threads do meanwhile.
    alone = [thrown(k) for k in range(8)]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(thrown, range(8)))
    for one, other in zip(alone, together):
        assert differences(one, other) == []


def test_a_solution_does_not_change():
    # It owns what it works out its columns from: neither another run nor more parts of the scene change them.
    scene = die(mu=0.2)
    early, late = (carom.simulate(scene, 1.0, step=2e-3) for _ in range(2))
    first = early.kinetic_energy.copy(), early.impacts.impulse.copy()
    later = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(1, 0, 1))
    hinge = scene.add_joint(carom.joints.Revolute((1, 0, 2), (0, 1, 0)), carom.GROUND, later)
    scene.add_force(carom.forces.JointSpring(hinge, stiffness=10.0))
    carom.simulate(die(mu=0.1), 1.0, step=2e-3)
    assert differences(early, late) == []
    np.testing.assert_array_equal(late.kinetic_energy, first[0])
    np.testing.assert_array_equal(late.impacts.impulse, first[1])


def test_a_solution_that_was_not_looked_at_is_pickled():
    a = carom.simulate(die(mu=0.2), 1.0, step=2e-3)
    b = pickle.loads(pickle.dumps(a))
    assert b.impacts is not a.impacts
    assert differences(a, b) == []
    middle = 0.5 * (a.t[1:] + a.t[:-1])
    for x, y in zip(a.evaluate(middle), b.evaluate(middle)):
        np.testing.assert_array_equal(x, y)


def test_columns_of_a_solution_are_plain_arrays():
    a = carom.simulate(ball(), 0.5, step=0.01)
    for name in ("t", "position", "orientation", "velocity", "total_energy", "held_residual"):
        assert type(getattr(a, name)) is np.ndarray
    assert type(a.impacts.impulse) is np.ndarray
    assert type(a.events.time) is np.ndarray
    assert type(a.ledger.loads) is np.ndarray


def test_scratch_is_of_the_same_types_in_every_run():
    # Units and entries are found by the types of system, method and settings alone (carom._compiled.units).
    makers = (ball, die, pendulum)
    runs = [carom.simulate(make(), 0.5, step=0.01)._run for make in makers]
    for name in ("active", "now", "work", "group", "multiple", "crowd", "clock", "records"):
        kinds = [in_c_order(kind(getattr(run, name))) for run in runs]
        assert kinds[1:] == kinds[:-1], name
    grown = runs[0].records
    for more in (
        lambda r: records.longer(r, runs[0].clock),
        lambda r: records.with_room(r, len(r.series)),
    ):
        assert in_c_order(kind(more(grown))) == in_c_order(kind(grown))


def in_c_order(found):
    """Kinds without Fortran's order, which arrays of one row have as well: Numba takes the other."""
    if isinstance(found, tuple) and len(found) == 3 and isinstance(found[0], np.dtype):
        assert found[2] & 0x1
        return (*found[:2], found[2] & ~0x2)
    return tuple(map(in_c_order, found)) if isinstance(found, tuple) else found
