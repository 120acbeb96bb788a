"""What a short run saves itself: arrays, types and tables that are made once, or when they are asked for."""

import pickle
from concurrent.futures import ThreadPoolExecutor
from copy import deepcopy
from itertools import combinations

import numpy as np
import pytest

import carom
from carom._compiled.record_arrays import Columns, table
from carom._compiled.template import arrays_of
from carom._compiled.units import kind
from carom.impact.workspace import LEAST_POINTS
from carom.model import compile as compiling
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


def joined():
    """A rod on a spring and a hinge with a stop, and a ball that rolls off a box onto the floor."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_static(carom.Box(1, 1, 0.2), position=(0, 0, 0.1))
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0.4, 0, 0.3), velocity=(1, 0, 0))
    rod = scene.add_body(carom.Box(0.5, 0.05, 0.05), mass=0.3, position=(0.25, 0, 2))
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 2), (0, 1, 0)), carom.GROUND, rod)
    scene.add_force(carom.forces.JointSpring(hinge, stiffness=0.5, damping=0.01))
    scene.add_stop(hinge, upper=0.6, restitution=0.5)
    scene.set_contact_default(restitution=0.4, friction=0.3)
    return scene


def pile():
    """Two boxes, one on another, which have impacts of many points and a workspace that grows."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(2):
        place = (0.01 * k, 0, 0.051 + 0.102 * k)
        scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=place)
    scene.set_contact_default(restitution=0.2, friction=0.4)
    return scene


quiet = pytest.mark.filterwarnings(
    "ignore::carom.status.MistakeWarning", "ignore::carom.status.AccuracyWarning"
)
WAYS = ({}, {"step": 0.01}, {"step": 0.01, "method": "implicit"}, {"rtol": 1e-6, "save_at": 0.07})


@pytest.mark.few(5)
@quiet
@pytest.mark.parametrize("how", WAYS)
@pytest.mark.parametrize("make", [die, joined, pile, pendulum])
def test_a_scene_is_compiled_once_while_it_does_not_change(make, how, monkeypatch):
    # Bit for bit the same as of a new scene: at first, from the compiled scene, and made from a template.
    count, scene, compile_scene = [], make(), compiling.compile_scene
    monkeypatch.setattr(
        compiling, "compile_scene", lambda *given: count.append(1) or compile_scene(*given)
    )
    runs = [carom.simulate(scene, 0.3, **how) for _ in range(4)]
    assert len(count) == 1
    carom.simulate(scene, 0.2, **how)
    assert len(count) == 1
    again = [carom.simulate(scene, 0.3, **how), carom.simulate(make(), 0.3, **how)]
    assert len(count) == 2
    for other in (*runs[1:], *again):
        assert differences(runs[0], other) == []


@quiet
@pytest.mark.parametrize("make", [die, joined, pile])
def test_runs_of_a_scene_share_nothing_that_is_written(make):
    scene = make()
    runs = [carom.simulate(scene, 0.1)._run for _ in range(4)]
    bounds = [
        sorted(np.lib.array_utils.byte_bounds(a) for a in arrays_of(own(run))) for run in runs
    ]
    for one, other in combinations(bounds, 2):
        assert not any(a < d and c < b for a, b in one for c, d in other)
    assert len({id(run.scene) for run in runs}) == 1  # it cannot be changed


def own(run):
    """All that a run writes, except what stands in for a workspace that it has not made."""
    islands = run.islands
    if islands.apart:
        islands = islands._replace(single=(), others=())
    else:
        islands = islands.single
    system = run.compiled.system
    if system.joints.size == 0:
        system = system._replace(solver=())
        islands = tuple(part for part in islands if part is not run.islands.joined)
    many = run.multiple if len(run.multiple.contact) > 1 else ()
    group = run.group
    if len(group.closed) < LEAST_POINTS:  # without a graph of bodies
        group = group._replace(equations=group.equations._replace(tree=(), graph=()))
    return system, run.now, run.active, run.work, islands, group, many, run.clock, run.records


def changes():
    """Changes of a scene of a die, each of which has another motion."""
    yield lambda s: s.add_body(carom.Sphere(0.01), mass=0.1, position=(0.1, 0, 0.01))
    yield (
        lambda s: s.add_half_space((0.1, 0, 0), (-1, 0, 0)) and s.set_contact_default(friction=0.5)
    )
    yield lambda s: s.add_force(carom.forces.Force((0, 0, 0.1)), s.bodies[0])
    yield lambda s: s.ignore_contact(s.bodies[0], s.half_spaces[0])
    yield lambda s: s.add_joint(carom.joints.Prismatic((0, 0, 1)), carom.GROUND, s.bodies[0])


@quiet
@pytest.mark.parametrize("change", list(changes()))
def test_a_scene_that_has_changed_is_compiled_again(change):
    def make():
        scene = die(velocity=(0, 0, -0.5), spin=(0, 0, 0))
        scene.set_contact_default(restitution=0.5, friction=0.2)
        return scene

    kept, new = make(), make()
    for _ in range(3):
        before = carom.simulate(kept, 0.3)
    taken = before.scene
    change(kept), change(new)
    for _ in range(3):
        assert differences(carom.simulate(kept, 0.3), carom.simulate(new, 0.3)) == []
    # the scene of a solution, copies and pickles are on their own
    for other in (taken, pickle.loads(pickle.dumps(taken)), deepcopy(taken)):
        assert differences(carom.simulate(other, 0.3), before) == []
    taken = taken.copy()
    change(taken)
    assert differences(carom.simulate(taken, 0.3), carom.simulate(new, 0.3)) == []


def test_functions_of_the_user_are_asked_again():
    # A push of F on 1 kg for 1 s: 1/2 F, whatever it was at the run before.
    push, scene = [1.0], carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(carom.Sphere(0.1), mass=1.0)
    scene.add_force(
        carom.forces.UserForce([body], lambda t, x: np.array([[push[0], 0, 0, 0, 0, 0]]))
    )
    for push[0] in (1.0, 2.0, 3.0, 4.0):
        moved = carom.simulate(scene, 1.0, step=0.1).position[-1, 0, 0]
        assert abs(moved - 0.5 * push[0]) < 1e-14  # some round-off of ten steps


@quiet
def test_threads_run_the_same_scene():
    scene = pile()
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: carom.simulate(scene, 0.05), range(12)))
    assert all(differences(found[0], other) == [] for other in found)


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


def hull():
    """A tetrahedron whose corners were given in Fortran's order."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    corners = np.asfortranarray(0.1 * np.vstack([np.eye(3), np.zeros(3)]))
    scene.add_body(carom.Convex(corners), mass=1.0, position=(0, 0, 1))
    scene.add_static(carom.Convex(corners), position=(1, 0, 1))
    scene.set_contact_default(friction=0.3)
    return scene


@quiet
def test_what_compiled_code_is_given_is_of_the_same_types_in_every_run():
    # An entry is found by the classes of its arguments alone (`Run.call`).
    makers = (ball, die, pendulum, joined, pile, hull)
    runs = [carom.simulate(make(), 0.08, **how)._run for make in makers for how in WAYS]
    for name in ("model", "data", "method", "islands", "grid"):
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
