"""What a run hands back: evaluate, tables, histories of impacts, counts, representation."""

import numpy as np
import pytest

import carom
from simulate.scenes import G, ball, bounce_times, die, event_times

E = 0.8


@pytest.fixture(scope="module")
def bounce():
    return carom.simulate(ball(E, velocity=(0.3, 0, 0)), 2.0, step=0.05)


def height(t):
    """Height and speed of the dropped ball at a time, between impacts."""
    times = bounce_times(12, E)
    k = np.searchsorted(times, t, side="right")
    if k == 0:
        return 0.4 - 0.5 * G * t * t, -G * t
    speed = np.sqrt(2 * G * 0.4) * E**k
    s = t - times[k - 1]
    return speed * s - 0.5 * G * s * s, speed - G * s


def test_evaluate_between_steps(bounce):
    # A parabola between impacts: the cubic is exact, also in steps that contain an impact.
    t = np.linspace(0, 2, 1001)
    x, Q, v, w = bounce.evaluate(t)
    assert x.shape == v.shape == w.shape == (1001, 1, 3)
    assert Q.shape == (1001, 1, 4)
    exact = np.array([height(s) for s in t])
    np.testing.assert_allclose(x[:, 0, 2] - 0.1, exact[:, 0], rtol=0, atol=1e-12)
    np.testing.assert_allclose(v[:, 0, 2], exact[:, 1], rtol=0, atol=1e-11)
    np.testing.assert_allclose(x[:, 0, 0], 0.3 * t, rtol=0, atol=1e-13)


def test_evaluate_at_saved_times(bounce):
    # Bitwise what is saved (no impact falls on a saved time here).
    x, Q, v, w = bounce.evaluate(bounce.t)
    np.testing.assert_array_equal(x, bounce.position)
    np.testing.assert_array_equal(v, bounce.velocity)
    np.testing.assert_allclose(Q, bounce.orientation, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(w, bounce.angular_velocity)


def test_the_motion_of_one_body_by_its_name():
    scene = carom.Scene()
    for k in range(2):
        scene.add_body(carom.Sphere(0.1), mass=1, position=(k, 0, 0), name=f"ball {k}")
    run = carom.simulate(scene, 0.1, step=0.05)
    one = run["ball 1"]
    for name, columns in one._asdict().items():
        np.testing.assert_array_equal(columns, getattr(run, name)[:, 1])
    with pytest.raises(KeyError, match="no part called 'ball'; did you mean"):
        run["ball"]


def test_evaluate_at_impacts(bounce):
    # Left: before the impact, right (the default): after it; the position is the same.
    hits = bounce.impacts
    for k in range(len(hits)):
        x0, _, v0, _ = bounce.evaluate(hits.time[k], side="left")
        x1, _, v1, _ = bounce.evaluate(hits.time[k])
        np.testing.assert_allclose(x0, x1, rtol=0, atol=1e-14)
        assert v0[0, 2] == pytest.approx(hits.relative_velocity_before[k, 0], abs=1e-13)
        assert v1[0, 2] == pytest.approx(hits.relative_velocity_after[k, 0], abs=1e-13)


def test_evaluate_a_tumbling_body():
    # Where gravity alone acts it is in closed form, with two saved times in all; with a torque that hardly acts
    # the steps of the run are taken again, those of 10 ms.
    def tumbling(damping):
        scene = carom.Scene()
        body = scene.add_body(mass=1, inertia=(1, 2, 3), angular_velocity=(0.3, 2, 0.2))
        if damping:
            scene.add_force(carom.forces.Torque((1e-14, 0, 0)), body)
        return scene

    fine = carom.simulate(tumbling(False), 2.0, step=1e-2)
    x, Q, v, w = carom.simulate(tumbling(False), 2.0, step=2.0).evaluate(fine.t)
    np.testing.assert_allclose(x, fine.position, rtol=0, atol=1e-13)
    np.testing.assert_allclose(v, fine.velocity, rtol=0, atol=1e-13)
    np.testing.assert_allclose(Q, fine.orientation, rtol=0, atol=1e-14)
    np.testing.assert_allclose(w, fine.angular_velocity, rtol=0, atol=1e-13)
    a = carom.simulate(tumbling(True), 2.0, step=1e-2, save_every=10)
    _, Q, _, w = a.evaluate(fine.t)
    assert np.max(np.abs(w - fine.angular_velocity)) < 1e-8  # order 4
    assert np.max(np.abs(np.abs(np.sum(Q * fine.orientation, -1)) - 1)) < 1e-8
    steps = carom.simulate(tumbling(True), 2.0, step=1e-2)
    np.testing.assert_allclose(w, steps.angular_velocity, rtol=0, atol=1e-14)


def test_evaluate_between_impacts():
    # A plate falls on the ground; with five saved times in all, flights between impacts are as of a fine run.
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    plate = scene.add_body(
        carom.Box(0.2, 0.1, 0.01), mass=1, position=(0, 0, 0.3), angular_velocity=(3, 20, 2)
    )
    scene.add_contact(plate, floor, restitution=0.5, friction=0.3)
    fine = carom.simulate(scene, 0.5, step=1e-2)
    assert len(fine.impacts) > 3
    x, Q, _, w = carom.simulate(scene, 0.5, step=1e-2, save_every=10).evaluate(fine.t)
    np.testing.assert_allclose(x, fine.position, rtol=0, atol=1e-13)
    np.testing.assert_allclose(Q, fine.orientation, rtol=0, atol=1e-12)
    np.testing.assert_allclose(w, fine.angular_velocity, rtol=0, atol=1e-11)


def test_evaluate_one_time_and_bad_input(bounce):
    x, Q, v, w = bounce.evaluate(0.123)
    assert x.shape == v.shape == w.shape == (1, 3)
    assert Q.shape == (1, 4)
    for t in (-0.1, 2.1, np.nan, [0.1, 3.0]):
        with pytest.raises(ValueError, match=r"t must be within \[0, 2\]"):
            bounce.evaluate(t)
    with pytest.raises(ValueError, match=r"side must be one of 'left', 'right', got 'both'"):
        bounce.evaluate(0.1, side="both")


@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_history_of_an_impact(method):
    # The layer passed in time: same velocities, duration and depth as the record.
    options = carom.Options(layer_width=1e-4, penetration=0.3, layer_steps=4)
    a = carom.simulate(die(mu=0.2), 0.4, step=1e-3, method=method, options=options)
    for k in range(len(a.impacts)):
        hit, history = a.impacts[k], a.impact_history(k)
        np.testing.assert_allclose(
            history.velocity_after, hit.relative_velocity_after, rtol=0, atol=1e-11
        )
        np.testing.assert_allclose(history.velocity[0], hit.relative_velocity_before)
        np.testing.assert_allclose(history.impulse, hit.impulse, rtol=0, atol=1e-12)
        assert history.duration == pytest.approx(hit.layer_duration, rel=1e-10)
        assert history.energy_change == pytest.approx(hit.energy_change, rel=1e-9)
        assert history.x_min == pytest.approx(0.7e-4, rel=1e-12)
        assert hit.penetration == pytest.approx(0.3e-4, rel=1e-12)
        assert history.x[0] == history.x[-1] == pytest.approx(1e-4, rel=1e-12)
    assert len(a.impact_history(0, steps=20).t) >= 20
    with pytest.raises(IndexError, match="impact 5 of 2"):
        a.impact_history(5)


def test_duration_of_an_impact(bounce):
    # T_c (1 + 1/e), T_c = 2 b l/v_0, l = -ln(1 - delta); b = 1e-5 of the size, delta = .2.
    hits = bounce.impacts
    v = -hits.relative_velocity_before[:, 0]
    expected = 2 * 1e-5 * 0.1 * -np.log(0.8) / v * (1 + 1 / E)
    np.testing.assert_allclose(hits.layer_duration, expected, rtol=1e-12)


def test_table_of_impacts(bounce):
    hits = bounce.impacts
    n = len(hits)
    shapes = {
        "point": (n, 3), "normal": (n, 3), "impulse": (n, 3), "inverse_mass": (n, 3, 3),
        "relative_velocity_before": (n, 3), "relative_velocity_after": (n, 3),
    }  # fmt: skip
    for name in hits[0]._fields:
        assert getattr(hits, name).shape == shapes.get(name, (n,)), name
    np.testing.assert_array_equal(hits.normal, [[0, 0, 1]] * n)
    np.testing.assert_allclose(hits.point[:, 2], 0, rtol=0, atol=1e-14)
    np.testing.assert_allclose(hits.point[:, 0], 0.3 * hits.time, rtol=0, atol=1e-13)
    np.testing.assert_allclose(hits.inverse_mass, [np.diag([1, 3.5, 3.5])] * n, rtol=1e-14)
    assert np.all(np.diff(hits.time) > 0)
    assert set(hits.restitution) == {E}
    records = list(hits)
    assert len(records) == n
    assert records[1].time == hits.time[1] == hits[1].time
    assert isinstance(records[0].time, float)
    assert records[0].law == "newton"
    assert hits[-1].time == hits.time[-1]
    with pytest.raises(IndexError, match=f"impact {n}: the table has {n}"):
        hits[n]
    assert f"{n} impacts" in repr(hits)


def test_solution_of_a_run(bounce):
    assert bounce.success
    assert bounce.status is carom.Status.SUCCESS
    assert bounce.t.shape == (41,)
    np.testing.assert_allclose(bounce.t, np.linspace(0, 2, 41), rtol=0, atol=1e-14)
    assert bounce.position.shape == bounce.velocity.shape == (41, 1, 3)
    assert bounce.orientation.shape == (41, 1, 4)
    assert bounce.contact_mode.shape == (41, 1)
    assert bounce.contact_force.shape == (41, 1, 3)
    assert bounce.stats["steps"] == 40
    assert bounce.stats["impacts"] == len(bounce.impacts) == bounce.stats["located"]
    assert bounce.settings["method"] == "rk4"
    np.testing.assert_allclose(
        bounce.total_energy, bounce.kinetic_energy + bounce.potential_energy, rtol=0
    )
    np.testing.assert_array_equal(event_times(bounce, "impact"), bounce.impacts.time)
    assert "1 bodies, t = 0 .. 2 s in 41 saved steps" in repr(bounce)


@pytest.mark.parametrize(
    ("duration", "step", "every", "times"),
    [
        (1.0, 0.3, 1, [0, 0.3, 0.6, 0.9, 1.0]),
        (1.0, 0.25, 2, [0, 0.5, 1.0]),
        (1.0, 0.2, 3, [0, 0.6, 1.0]),
        (0.1, 1.0, 1, [0, 0.1]),
        (0.3, 0.1, 1, [0, 0.1, 0.2, 0.3]),  # 0.3/0.1 is a hair below 3 in floating point
        (1.0, 0.1, 1000, [0, 1.0]),
    ],
)
def test_saved_times(duration, step, every, times):
    # Each `save_every`-th step, the first and the last; the last step may be shorter.
    a = carom.simulate(ball(1.0), duration, step=min(step, duration), save_every=every)
    np.testing.assert_allclose(a.t, times, rtol=0, atol=1e-14)


def test_scene_is_not_changed_and_can_run_again():
    scene = ball(E)
    before = scene.bodies[0].position.copy()
    a, b = carom.simulate(scene, 1.0, step=0.01), carom.simulate(scene, 1.0, step=0.01)
    np.testing.assert_array_equal(scene.bodies[0].position, before)
    np.testing.assert_array_equal(a.position, b.position)
    assert a.scene.bodies == scene.bodies


EDITS = [
    lambda scene: scene.add_body(carom.Box(0.1, 0.2, 0.3), mass=2.0, position=(5, 0, 5)),
    lambda scene: scene.add_half_space((-1, 0, 0), (1, 0, 0), name="wall"),
    lambda scene: scene.add_contact("body1", scene.add_half_space((0, -9, 0), (0, 1, 0))),
    lambda scene: scene.add_joint(carom.joints.Distance((0, 0, 3), (0, 0, 1)), carom.GROUND, "body1"),
    lambda scene: scene.add_force(carom.forces.Force((1, 0, 0)), "body1"),
    lambda scene: scene.set_contact_default(restitution=1.0, friction=0.1),
]  # fmt: skip


def test_a_solution_keeps_its_scene_as_it_was(tmp_path):
    """Whatever is added to the scene after the run, the solution is evaluated, drawn, and saved as before."""
    scene, plain = ball(E), carom.simulate(ball(E), 1.0, step=0.01)
    a, ended = carom.simulate(scene, 1.0, step=0.01), carom.Run(scene, step=0.01)
    parts = len(scene.bodies), len(scene.fixed), len(scene.contacts)
    for edit in EDITS:
        edit(scene)
    assert (len(a.scene.bodies), len(a.scene.fixed), len(a.scene.contacts)) == parts
    assert len(a.scene.joints) == len(a.scene.forces) == len(a.scene.pairs_by_default()) == 0
    assert len(scene.joints) == len(scene.forces) == 1
    for one, other in zip(a.evaluate(0.333), plain.evaluate(0.333)):
        np.testing.assert_array_equal(one, other)
    assert str(a.impacts) == str(plain.impacts)
    ended.advance(0.5)
    np.testing.assert_array_equal(ended.solution.position[-1], a.position[50])
    pytest.importorskip("matplotlib")
    a.plot()
    pytest.importorskip("h5netcdf")
    a.save(tmp_path / "a.nc")
    np.testing.assert_array_equal(carom.Solution.load(tmp_path / "a.nc").position, a.position)


@pytest.mark.bits
def test_an_ensemble_keeps_its_scene_as_it_was():
    scene = ball(E)
    e = carom.ensemble(scene, 0.2, step=0.01, vary={"body1.velocity": [[0, 0, 0], [1, 0, 0]]})
    for edit in EDITS:
        edit(scene)
    np.testing.assert_array_equal(e.solution(1).position[-1], e.position[1])


def test_contact_force_and_cone(bounce):
    # Open contacts carry nothing.
    assert np.all(bounce.contact_mode == 0)
    assert np.all(bounce.contact_force == 0.0)
