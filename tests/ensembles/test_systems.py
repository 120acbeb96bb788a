"""Ensembles of systems in coordinates: each run is that of `simulate`, values have names, files keep all."""

import numpy as np
import pytest
import sympy as sp
from scipy.stats import norm, uniform

import carom
from generalized.coordinate_systems import double_pendulum, symbols

START = [-1.3, 0.5]
VARY = {
    "position": [norm(-1.3, 0.1), 0.5], "velocity.b": uniform(0.0, 0.1),
    "wall.friction": uniform(0.0, 0.3),
}  # fmt: skip


def pendulum():
    system, x, _, _ = double_pendulum(START, [0.0, 0.0])
    system.add_contact(-0.2 - x, restitution=0.5, name="wall")
    return system


def rubbed():
    system, x, z, rate = double_pendulum(START, [0.0, 0.0])
    system.add_contact(-0.2 - x, tangent=rate(z), restitution=0.5, friction=0.2, name="wall")
    return system


def metric(q):
    c = np.cos(q[0] - q[1])
    return np.array([[2.0, c], [c, 1.0]])


def potential(q):
    return -9.81 * (2.0 * np.cos(q[0]) + np.cos(q[1]))


def gap(q):
    return -0.2 - np.sin(q[0]) - np.sin(q[1])


def of_functions(friction=0.2, angle=-1.3):
    system = carom.GeneralizedSystem(metric, [angle, 0.5], [0.0, 0.0], potential=potential)
    system.add_contact(gap, tangent=np.sin, restitution=0.5, friction=friction, name="wall")
    return system


def hits(solution):
    return {"hits": len(solution.impacts), "path": solution.q[[0, -1]]}


@pytest.fixture(scope="module")
def thrown():
    return carom.ensemble(rubbed(), 1.0, runs=12, vary=VARY, observe=hits, executor="serial")


def test_each_run_is_that_of_simulate(thrown):
    assert thrown.counts() == {"success": 12}
    assert not thrown.bodies
    for run in (0, 11):
        system, x, z, rate = double_pendulum(
            thrown.inputs["position"][run], [0.0, thrown.inputs["velocity.b"][run]]
        )
        friction = thrown.inputs["wall.friction"][run]
        system.add_contact(
            -0.2 - x, tangent=rate(z), restitution=0.5, friction=friction, name="wall"
        )
        alone = carom.simulate(system, 1.0)
        assert np.array_equal(alone.q[-1], thrown.q[run])
        assert np.array_equal(alone.v[-1], thrown.v[run])
        assert thrown.impacts[run] == len(alone.impacts) == thrown.observed["hits"][run] > 0
        assert thrown.first_impact[run] == alone.impacts.time[0]
        assert thrown.impact_loss[run] == -alone.ledger.impacts[-1]
        again = thrown.solution(run)
        assert np.array_equal(again.t, alone.t)
        assert np.array_equal(again.q, alone.q)
        state = thrown.state(run)
        assert np.array_equal(state.q, alone.q[-1])
        assert state.kinetic_energy == alone.kinetic_energy[-1]


def test_workers_and_their_order_change_no_bit(thrown):
    threads = carom.ensemble(rubbed(), 1.0, runs=12, vary=VARY, workers=3, chunk=2)
    assert np.array_equal(threads.q, thrown.q)
    assert np.array_equal(threads.v, thrown.v)


@pytest.mark.bits
def test_processes_get_functions_and_expressions(thrown):
    sent = {"runs": 12, "vary": VARY, "executor": "processes", "workers": 1}
    assert np.array_equal(carom.ensemble(rubbed(), 1.0, **sent).q, thrown.q)
    given = {"vary": {"position.0": [-1.2, -1.25], "friction": [0.0, 0.1]}}
    here = carom.ensemble(of_functions(), 0.7, **given, executor="serial")
    there = carom.ensemble(of_functions(), 0.7, **given, executor="processes", workers=1)
    assert np.array_equal(here.q, there.q)
    assert here.counts() == {"success": 2}
    assert not np.array_equal(here.v[0], here.v[1])


def test_a_function_may_make_systems():
    vary = {"friction": [0.0, 0.1], "angle": [-1.2, -1.25]}
    made = carom.ensemble(of_functions, 0.7, vary=vary)
    alone = carom.simulate(of_functions(0.1, -1.25), 0.7)
    assert np.array_equal(made.q[1], alone.q[-1])
    assert np.array_equal(made.solution(1).q, alone.q)

    def either(k):
        return of_functions() if k == 0 else carom.Scene()

    with_scene = carom.ensemble(either, 0.7, vary={"k": [0, 1]})
    assert "must have 2 coordinates, as in run 0, got 0 bodies" in with_scene.failures[1]


def test_names_of_coordinates(thrown):
    assert thrown.coordinates == ["a", "b"] == list(rubbed().coordinate_names)
    assert of_functions().coordinate_names == ("0", "1")
    assert np.array_equal(thrown["b"].coordinate, thrown.q[:, 1])
    assert np.array_equal(thrown["a"].rate, thrown.v[:, 0])
    theta = sp.Function("theta")(sp.Symbol("t"))
    of_time = carom.GeneralizedSystem.from_sympy(
        [theta], kinetic_energy=theta.diff() ** 2, position=[0], velocity=[1]
    )
    assert of_time.coordinate_names == ("theta",)


def test_laws_of_contacts_vary():
    grid = {
        "restitution": carom.Grid([0.0, 0.5, 1.0]),
        "wall.impact_law": carom.Grid(["newton", "stronge"]),
    }
    made = carom.ensemble(rubbed(), 1.0, vary=grid)
    assert made.counts() == {"success": 6}
    assert made.impact_loss[0] > made.impact_loss[2]
    alone = rubbed()
    alone = alone._changed({}, {"wall": {"restitution": 0.5, "impact_law": "stronge"}})
    assert np.array_equal(carom.simulate(alone, 1.0).q[-1], made.q[3])
    law = carom.Restitution.power(0.8, speed=1.0, exponent=0.5)
    with_law = rubbed()._changed({}, {"wall": {"restitution": law}})
    slow = carom.ensemble(with_law, 1.0, vary={"wall.restitution.value": [0.2, 0.8]})
    assert slow.impact_loss[0] > slow.impact_loss[1] > 0.0
    assert rubbed()["wall"].restitution == 0.5


def test_a_table_has_the_names_of_coordinates(thrown):
    pytest.importorskip("pandas")
    table = thrown.to_pandas()
    assert {"q.a", "v.b", "position.a", "position.b", "velocity.b", "hits"} <= set(table.columns)
    assert np.array_equal(table["v.b"], thrown.v[:, 1])
    pytest.importorskip("xarray")
    data = thrown.to_xarray()
    assert data.coordinate.values.tolist() == ["a", "b"]
    assert "axis" not in data.dims
    assert float(data.q.sel(run=3, coordinate="b")) == thrown.q[3, 1]


@pytest.mark.parametrize(
    ("ending", "package"), [(".nc", "h5netcdf"), (".zarr", "zarr"), (".parquet", "pyarrow")]
)
def test_files_keep_all(thrown, ending, package, tmp_path):
    pytest.importorskip(package)
    path = tmp_path / f"runs{ending}"
    thrown.save(path)
    found = carom.Ensemble.load(path)
    assert found.coordinates == ["a", "b"]
    for name in ("q", "v", "impacts", "energy_error"):
        assert np.array_equal(getattr(found, name), getattr(thrown, name))
    assert np.array_equal(found.observed["path"], thrown.observed["path"])
    with pytest.raises(ValueError, match="needs the scene"):
        found.solution(0)


def test_a_folder_goes_on_and_knows_its_system(tmp_path):
    pytest.importorskip("zarr")
    given = {
        "vary": {"position.0": [-1.2, -1.25], "wall.friction": [0.0, 0.1]},
        "save": tmp_path / "runs",
    }
    first = carom.ensemble(of_functions(), 0.3, **given)
    assert np.array_equal(carom.ensemble(of_functions(), 0.3, **given).q, first.q)
    for other in (of_functions(angle=-1.31), rubbed()._changed({"position": [-1.3, 0.5]}, {})):
        names = {
            f"position.{other.coordinate_names[0]}": [-1.2, -1.25],
            "wall.friction": [0.0, 0.1],
        }
        with pytest.raises(ValueError, match="has another ensemble"):
            carom.ensemble(other, 0.3, **{**given, "vary": names})


@pytest.mark.parametrize(
    ("vary", "message"),
    [
        ({"positon": [[1, 2]]}, "did you mean 'position'"),
        ({"position.c": [1]}, "did you mean 'position.a'|'position.b'"),
        ({"position": [[1, 2, 3]]}, r"shape \(runs, 2\), got \(1, 3\)"),
        ({"velocity": [[np.inf, 0]]}, "finite"),
        ({"position": [START], "position.a": [1.0]}, "or its components"),
        ({"wall.frictio": [0.1]}, "did you mean 'wall.friction'"),
        ({"wall.friction": [-0.1]}, "at least 0, got -0.1"),
        ({"gravity": [[0, 0, 1]]}, "must be 'position', 'velocity', or a part of the system"),
        ({"friction_held": [0.1]}, "did you mean 'wall.friction'"),
    ],
)
def test_names_and_values_that_it_does_not_take(vary, message):
    with pytest.raises(ValueError, match=message):
        carom.ensemble(rubbed(), 0.1, vary=vary)


def test_runs_that_cannot_start_do_not_stop_the_others():
    made = carom.ensemble(pendulum(), 0.1, vary={"position": [[-1.0, 1.0], [-2.0, -1.0]]})
    assert made.counts() == {"refused": 1, "success": 1}
    assert "must not be inside a contact" in made.failures[0 if made.status[0] < 0 else 1]
    without = carom.ensemble(pendulum(), 0.1, vary={"wall.friction": [0.0, 0.1]})
    assert "friction needs a tangent" in without.failures[1]
    assert without.status[0] == 0
    with pytest.raises(ValueError, match="method of a system in coordinates"):
        carom.ensemble(pendulum(), 0.1, step=1e-3, method="rattle", vary={"wall.friction": [0.0]})


def test_a_singular_metric_is_the_end_of_its_run_alone():
    # T = x v^2 / 2: x^(3/2) falls linearly from .5, to 0 at t = 1/3.
    q, v = symbols("x y")
    system = carom.GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(q[0], 1), position=[0.5, 0], velocity=[-1, 0]
    )
    vary = {"velocity.x": [-1.0, 1.0]}
    made = carom.ensemble(system, 1.0, step=0.01, vary=vary)
    assert made.counts() == {"singular_metric": 1, "success": 1}
    assert made.failures[0] == made.solution(0).message
