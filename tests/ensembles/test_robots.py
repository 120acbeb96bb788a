"""Ensembles of a robot: coordinates, velocities and controls vary by name, bit for bit as in a `Run`."""

import numpy as np
import pytest

import carom

pytest.importorskip("mujoco")
ARM = """
<mujoco><compiler angle="radian"/><worldbody>
  <body name="arm" pos="0 0 1"><joint name="shoulder" axis="0 1 0"/>
    <geom type="capsule" fromto="0 0 0 .3 0 0" size=".02" mass="1"/>
    <body name="fore" pos=".3 0 0"><joint name="elbow" axis="0 1 0" damping=".01" ref=".2"/>
      <geom type="capsule" fromto="0 0 0 .3 0 0" size=".02" mass=".5"/></body></body></worldbody>
  <actuator><motor name="m1" joint="shoulder"/><motor name="m2" joint="elbow"/></actuator>
</mujoco>"""
HOW = {"step": 2e-3, "executor": "serial"}
Q, V, U = np.random.default_rng(0).normal(size=(3, 4, 2))


@pytest.fixture(scope="module")
def arm():
    return carom.load_model(ARM, contacts=False)


@pytest.mark.parametrize(
    ("given", "start"),
    [
        ({"qpos": Q, "qvel": V}, {"qpos": Q, "qvel": V}),
        ({"qvel": V, "ctrl": U, "arm.mass": [1.0] * 4}, {"qvel": V, "ctrl": U}),
        (
            {"elbow.coordinate": Q[:, 0], "elbow.rate": V[:, 0]},
            {"qpos": np.c_[0 * Q[:, 0], Q[:, 0]], "qvel": np.c_[0 * V[:, 0], V[:, 0]]},
        ),
    ],
)
def test_the_runs_are_those_of_a_run(arm, given, start):
    runs = carom.ensemble(arm, 0.1, vary=given, **HOW)
    for k in (0, 3):
        run = carom.Run(arm, step=2e-3)
        run.reset(**{name: rows[k] for name, rows in start.items() if name != "ctrl"})
        run.ctrl[:] = start.get("ctrl", np.zeros((4, 2)))[k]
        run.advance(0.1)
        for name in ("position", "orientation", "velocity", "angular_velocity"):
            np.testing.assert_array_equal(getattr(run.state, name), getattr(runs, name)[k])
        again = runs.solution(k)
        np.testing.assert_array_equal(again.position[-1], runs.position[k])
        np.testing.assert_array_equal(arm.qpos(runs.state(k)), arm.qpos(run.state))
        assert runs["elbow"].coordinate[k] == run.state["elbow"].coordinate
        assert again.evaluate(0.0503)[0].shape == (2, 3)
    np.testing.assert_array_equal(runs["fore"].velocity, runs.velocity[:, 1])
    np.testing.assert_array_equal(runs[arm.scene["arm"]].position, runs.position[:, 0])
    np.testing.assert_array_equal(runs["status"], 0)
    assert runs[next(iter(given))] is runs.inputs[next(iter(given))]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"qpos": Q[:, :1]}, r"vary\['qpos'\] must have shape \(runs, 2\), got \(4, 1\)"),
        (
            {"qpos": Q, "elbow.coordinate": Q[:, 0]},
            "vary must have 'qpos' or 'elbow.coordinate', got both",
        ),
        ({"ctrl": U, "m1.control": U[:, 0]}, "vary must have 'ctrl' or 'm1.control', got both"),
        ({"qvel": np.full((2, 2), np.nan)}, "must be finite, got .* in run 0"),
        ({"elbw.coordinate": Q[:, 0]}, "names in vary must be"),
    ],
)
def test_nonsense_is_refused(arm, given, words):
    with pytest.raises(ValueError, match=words):
        carom.ensemble(arm, 0.1, vary=given, **HOW)


def test_only_models_have_coordinates():
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0, name="ball")
    with pytest.raises(
        ValueError, match=r"vary\['qpos'\] must be left out: only a scene of load_model"
    ):
        carom.ensemble(scene, 0.1, vary={"qpos": Q}, **HOW)
    runs = carom.ensemble(scene, 0.1, vary={"ball.mass": [1.0, 2.0]}, **HOW)
    with pytest.raises(KeyError, match="did you mean 'ball'"):
        runs["bal"]
