"""Standard problems: their exact answers, how times are taken, and the command that measures them."""

import importlib.util
import json
import math
from pathlib import Path

import numpy as np
import pytest

import carom
from carom.bench import many, measure, standard
from carom.bench.problems import (
    ALL,
    chain,
    corner_impact,
    four_bar,
    planar_die,
    sphere,
    stack,
)
from carom.cli import EXIT_OK, USAGE, main

#: what the default method makes of each problem with its longest step: round-off where free motion is exact,
#: else the error of order 4 that chain and loops have there
BOUNDS = {
    "sphere": 1e-11, "planar_die": 2e-12, "spatial_die": 1e-12, "chain": 1e-4, "four_bar": 1e-4, "stack": 1e-10,
}  # fmt: skip


def test_spread_is_median_and_quartiles():
    """Of 1 .. 5: 3, and 2 to 4 (inclusive method)."""
    found = measure.spread([5.0, 1.0, 4.0, 2.0, 3.0])
    assert found == (3.0, 2.0, 4.0, 5)
    assert found.text(0.5) == "6 (4 to 8)"
    assert measure.spread([7.0]) == (7.0, 7.0, 7.0, 1)


def test_what_a_call_costs_besides_steps_cancels(monkeypatch):
    """A clock that goes 10 for a call and 0.5 for a step gives 0.5 a step."""
    now = [0.0]
    monkeypatch.setattr(measure, "clock", lambda: now[0])

    def run(steps):
        now[0] += 10.0 + 0.5 * steps

    assert measure.per_step(run, 4, 20, rounds=2) == [0.5, 0.5]


@pytest.mark.parametrize("noisy", [4, 1000])
def test_what_noise_hides_is_measured_longer_or_not_at_all(monkeypatch, noisy):
    """A clock that goes back in the first calls, by more than steps take: up to ten times as many rounds."""
    now, calls = [0.0], [0]
    monkeypatch.setattr(measure, "clock", lambda: now[0])

    def run(steps):
        calls[0] += 1
        now[0] += 0.5 * steps - (100.0 if calls[0] < 2 * noisy and steps == 20 else 0.0)

    found = measure.per_step(run, 4, 20, rounds=2)
    if noisy == 4:
        assert 2 < len(found) < 20
        assert measure.spread(found).low > 0.0
    else:
        assert len(found) == 20
        assert measure.spread(found).text() == "lost in noise"


def test_height_of_the_ball():
    """At 0 and after each period 2 sqrt(2h/g) it is at the top, half-way between on the floor."""
    half = math.sqrt(2 * 0.4 / 9.81)
    for k in range(4):
        assert sphere.height(2 * k * half) == pytest.approx(0.5, abs=1e-12)
        assert sphere.height((2 * k + 1) * half) == pytest.approx(0.1, abs=1e-12)
    assert sphere.height(0.1) == pytest.approx(0.5 - 0.5 * 9.81 * 0.01, abs=1e-15)


def test_first_impact_of_the_planar_die_in_closed_form():
    """Slip goes on: P_n = (1 + e) |u_n| / (W_nn - mu s W_nt), P_t = -mu s P_n (Routh)."""
    impact = carom.simulate(planar_die.scene(), planar_die.END, step=1e-3).impacts[0]
    W, u = impact.inverse_mass, impact.relative_velocity_before
    s = np.sign(u[1])
    P = 1.5 * -u[0] / (W[0, 0] - 0.2 * s * W[0, 1])
    v = 0.5 - 0.2 * s * P / 0.016, -0.5 - 9.81 * planar_die.FIRST + P / 0.016
    np.testing.assert_allclose(v, planar_die.AFTER, rtol=0, atol=1e-11)
    assert impact.time == pytest.approx(planar_die.FIRST, abs=1e-12)


def test_the_stack_stands_while_it_slides():
    """It tips where mu g, times the height of its centre, is more than g times half an edge."""
    for box in range(stack.BOXES):  # of the boxes above, as seen from the face that they stand on
        above = (stack.BOXES - box) * stack.EDGE
        assert stack.MU * above / 2 < stack.EDGE / 2


@pytest.mark.parametrize("problem", ALL, ids=lambda p: p.NAME)
def test_error_is_that_of_the_method(problem):
    assert problem.ours(problem.STEPS[0]).error() < BOUNDS[problem.NAME]


def test_error_sees_a_wrong_answer(monkeypatch):
    """Against another place the same run is wrong by the distance."""
    monkeypatch.setattr(four_bar, "TIP", (four_bar.TIP[0] + 0.3, four_bar.TIP[1] - 0.4))
    assert four_bar.ours(2e-2).error() == pytest.approx(0.5, abs=1e-3)


def test_order_four_of_the_chain():
    """Error of the energy by halving: 2^4 each, within a half order."""
    errors = [chain.ours(h, links=1).error() for h in (8e-3, 4e-3)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.6)


def test_corner_impacts_meet_their_law():
    W, u = corner_impact.impacts(50)
    assert np.all(u[:, 0] < 0)
    np.testing.assert_allclose(W, np.swapaxes(W, 1, 2), atol=1e-12)
    assert corner_impact.error(count=50) < 1e-12


@pytest.mark.parametrize("problem", ALL, ids=lambda p: p.NAME)
def test_mujoco_does_the_same_problem(problem):
    """Its error falls below a tenth of what moves (0.4 m, 0.3 m, 1 m, m g N L/2)."""
    mujoco = pytest.importorskip("mujoco")
    more = {"duration": 1.0} if problem is sphere else {}
    task = problem.mujoco(mujoco, min(problem.PEER_STEPS[1], 1e-3), **more)
    task.run()
    assert task.error() < 0.06


def test_the_command_measures(capsys):
    assert main(["bench", "corner_impact", "planar_die", "--rounds", "2", "--json"]) == EXIT_OK
    told = json.loads(capsys.readouterr().out)
    assert told["machine"]["versions"]["carom"] == carom.__version__
    names = [row["name"] for row in told["problems"]]
    assert names == ["planar_die", "corner_impact"]
    for row in told["problems"]:
        assert 0.0 < row["carom"]["low"] <= row["carom"]["median"] <= row["carom"]["high"]
        assert row["carom"]["error"] < 1e-11
    assert main(["bench", "corner_impact", "--rounds", "1"]) == EXIT_OK
    out = capsys.readouterr().out
    assert "us an impact" in out
    assert f"carom {carom.__version__}" in out
    assert main(["bench", "nonsense"]) == USAGE
    assert "corner_impact" in capsys.readouterr().err


def test_names_of_the_set_are_its_own():
    names = [problem.name for problem in standard.problems()]
    assert len(set(names)) == len(names) == 10


@pytest.mark.parametrize("make", many.ALL)
def test_scenes_of_many_bodies_are_the_same_in_both(make):
    """Masses, and the first 20 ms, in which most bodies fall."""
    mujoco = pytest.importorskip("mujoco")
    made = make()
    scene, (model, _) = made.scene(), made.mujoco(mujoco)
    assert [body.mass for body in scene.bodies] == pytest.approx(model.body_mass[1:], rel=1e-12)
    theirs = made.run_mujoco(mujoco, 0.02)
    ours = carom.simulate(scene, 0.02, step=1e-3, throw=False)
    assert ours.success
    assert np.abs(ours.position[-1] - theirs).max() < 3e-3
    assert 0.5 * len(theirs) < np.sum(np.abs(ours.position[-1] - theirs).max(axis=1) < 3e-4)


def asv_module(name):
    """A module of benchmarks/asv; asv itself is not needed."""
    folder = Path(__file__).parents[1] / "benchmarks" / "asv"
    spec = importlib.util.spec_from_file_location(f"asv_{name}", folder / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_asv_measures_scenes_of_many_bodies(monkeypatch):
    module = asv_module("many")
    assert module.Many.params[0] == [make.__name__ for make in many.ALL]
    monkeypatch.setitem(module.SCENES, "plate", lambda: many.plate()._replace(duration=0.01))
    assert 0.0 < module.Many().track_run("plate") < 60.0


def test_what_asv_runs():
    """The classes of benchmarks/asv work."""
    module = asv_module("problems")
    problem = module.Problem()
    assert set(module.Problem.params[0]) == {p.NAME for p in ALL}
    problem.setup("sphere")
    problem.time_run("sphere")
    assert problem.track_error("sphere") < BOUNDS["sphere"]
