"""A `carom.Run` that is reset, moved into another state, and taken on from a solution or a file."""

import numpy as np
import pytest

import carom
from simulate.test_run_public import arm, cart, dice

G = 9.81
TABLES = ("t", "position", "orientation", "velocity", "angular_velocity", "total_energy")


def steps(run, count, force=None):
    """Take a run on by steps of 5 ms, with another torque of its motor."""
    if force is not None:
        run.set_force("motor", force)
    for _ in range(count):
        run.advance(0.005)
    return run


@pytest.mark.parametrize("how", [{"step": 0.005}, {}], ids=["step", "tolerances"])
def test_a_solution_of_a_run_is_taken_on(tmp_path, how):
    """From memory and from a file, with the torque that was set: the run without a break."""
    run = steps(steps(carom.Run(arm(), **how), 30, 2.0), 30, -1.0)
    here = run.solution
    here.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    whole = steps(run, 40).solution
    for start in (here, loaded):
        later = steps(carom.Run(start), 40).solution
        for name in (*TABLES, "joint_reactions"):
            a, b = getattr(later, name), getattr(whole, name)
            # times of 5 ms each are summed from another beginning where tolerances choose the steps
            assert np.array_equal(a, b) if how else np.allclose(a, b, rtol=0, atol=1e-12), name
        assert np.array_equal(later.ledger.loads[:61], here.ledger.loads)
    loaded.save(tmp_path / "again.nc")
    again = carom.Run(carom.Solution.load(tmp_path / "again.nc"))
    assert np.array_equal(steps(again, 1).state.velocity, whole.velocity[61])
    for refuse in (loaded.simulate, lambda d: carom.resume(tmp_path / "run.nc", until=1.0 + d)):
        with pytest.raises(
            ValueError, match=r"that of a Run: take it on with carom\.Run\(solution\)"
        ):
            refuse(0.1)


@pytest.mark.parametrize("make", [lambda: dice(1), lambda: dice(70)], ids=["1", "70"])
def test_a_solution_of_simulate_is_taken_on(make):
    """With impacts and contacts found on the way, to the bits of one longer run."""
    whole = carom.simulate(make(), 0.4, step=0.005)
    run = steps(carom.Run(carom.simulate(make(), 0.3, step=0.005)), 20)
    for name in TABLES:
        assert np.array_equal(getattr(run.solution, name), getattr(whole, name)), name
    assert np.array_equal(run.solution.impacts.impulse, whole.impacts.impulse)


def test_a_run_that_an_event_stopped_is_taken_on():
    """Its further steps begin at the event: free fall to round-off, and every third state is saved."""
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0, name="ball")

    def low(t, state):
        return state["ball"].position[2] + 0.01234

    low.terminal = True
    stopped = carom.simulate(scene, 1.0, step=0.01, save_every=3, events=[low])
    run, t = carom.Run(stopped), stopped.t[-1]
    assert t % 0.01 > 1e-4
    run.advance(0.07)
    assert run.time == pytest.approx(t + 0.07, abs=1e-15)
    assert np.allclose(run.solution.t[-3:], t + np.array([0.03, 0.06, 0.07]), rtol=0, atol=1e-15)
    assert run.state["ball"].position[2] == pytest.approx(-0.5 * G * run.time**2, abs=1e-14)


def test_what_cannot_be_taken_on():
    solution = carom.simulate(cart(), 0.1, step=0.01)
    with pytest.raises(ValueError, match="step must be left out with a solution"):
        carom.Run(solution, step=0.02)
    with pytest.raises(ValueError, match="save_every must be left out"):
        carom.Run(solution, save_every=2)
    with pytest.raises(
        TypeError, match=r"scene must be a carom\.Scene, a Model or a Solution, got 3"
    ):
        carom.Run(3)


def test_it_begins_again():
    """The same bits as a new run, with the forces of the scene; and from a state of another run."""
    first = steps(carom.Run(arm(), step=0.005), 40, 3.0)
    kept = first.state
    first.reset()
    assert first.time == 0.0
    fresh = steps(carom.Run(arm(), step=0.005), 40)
    steps(first, 40)
    for name in TABLES:
        assert np.array_equal(getattr(first.solution, name), getattr(fresh.solution, name)), name
    fresh.reset(kept)
    assert fresh.time == 0.0
    assert fresh.solution.t.tolist() == [0.0]
    assert np.allclose(fresh.state.position, kept.position, rtol=0, atol=1e-16)
    assert np.array_equal(fresh.state.velocity, kept.velocity)
    assert fresh.state.total_energy == pytest.approx(kept.total_energy, abs=1e-14)
    steps(fresh, 40)
    assert fresh.solution.warnings == ()


@pytest.mark.parametrize("how", [{"step": 0.005}, {}], ids=["step", "tolerances"])
def test_its_bodies_are_moved(how):
    """A ball in flight is put back to where it was: it falls again, and the balance names the lift."""
    run = carom.Run(dice(1), **how)
    begin = run.state
    steps(run, 20)
    z, fallen = begin.position[0, 2], run.state.total_energy - begin.total_energy
    run.set_state(begin)
    assert run.time == pytest.approx(0.1, abs=1e-15)
    steps(run, 10)
    solution, v = run.solution, begin.velocity[0, 2]
    assert solution.position[20, 0, 2] == z
    assert solution.position[-1, 0, 2] == pytest.approx(z + v * 0.05 - 0.5 * G * 0.05**2, abs=1e-13)
    assert solution.status is carom.Status.SUCCESS
    assert solution.ledger.loads[-1] == pytest.approx(-fallen, abs=1e-14)
    assert abs(solution.ledger.residual).max() < 1e-13


def test_bodies_at_rest_are_moved():
    """A die that lies on the ground is lifted: its contacts are forgotten, it falls and lies again."""
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    die = scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0, 0, 0.06), name="die")
    scene.add_contact(die, ground, restitution=0.0, friction=0.5)
    run = carom.Run(scene, step=0.005)
    begin = run.state
    for _ in range(2):
        steps(run, 40)
        assert not run.state.velocity.any()
        assert run.state.position[0, 2] == pytest.approx(0.05, abs=1e-9)
        run.set_state(begin)
    solution = run.solution
    assert solution.status is carom.Status.SUCCESS
    assert solution.ledger.loads[-1] == pytest.approx(2 * 0.01 * G, abs=1e-9)
    assert solution.forces.saved.max() == 79  # none of the state that the last lift replaced


def test_states_that_do_not_fit():
    run = carom.Run(arm(), step=0.005)
    with pytest.raises(ValueError, match="state must be of the scene of this run"):
        run.reset(carom.Run(cart(), step=0.1).state)
    with pytest.raises(TypeError, match="state must be a SystemState"):
        run.set_state((0, 0, 0))
    with pytest.raises(ValueError, match=r"qpos must be left out: only a scene of load_model"):
        run.reset(qpos=[0.0])
