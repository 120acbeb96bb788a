"""Models side by side in one model of MuJoCo: what nothing connects moves by itself, as in one island."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

import carom
from carom import run
from carom.stepping.islands.layout import no_islands

DATA = Path(__file__).parents[1] / "data" / "models"


def three_of(path):
    """Return the scene of three copies of a model, 20 m apart."""
    spec = mujoco.MjSpec()
    for k in range(3):
        frame = spec.worldbody.add_frame(pos=[0, 20.0 * k, 0])
        spec.attach(mujoco.MjSpec.from_file(str(DATA / path)), prefix=f"{k}_", frame=frame)
    return carom.load_model(spec.compile()).scene


@pytest.mark.parametrize("how", [{"step": 2e-3}, {"rtol": 1e-7}])
@pytest.mark.parametrize("path", ["own/joints.xml", "own/loops.xml", "dm_control/fish.xml"])
@pytest.mark.filterwarnings("ignore")
def test_each_part_is_an_island(path, how, monkeypatch):
    """Joints of all kinds, equalities, tendons and actuators, each part with its own numbers of rows."""
    scene = three_of(path)
    apart = carom.simulate(scene, 0.15, **how)
    assert len(apart._run.islands.united) % 3 == 0
    monkeypatch.setattr(
        run, "new_islands", lambda system, active, later: no_islands(system, active)
    )
    one = carom.simulate(scene, 0.15, **how)
    assert apart.status == one.status == carom.Status.SUCCESS
    for name in ("position", "orientation", "velocity", "angular_velocity"):
        np.testing.assert_allclose(
            getattr(apart, name), getattr(one, name), atol=1e-9, err_msg=name
        )
    for joint in scene.joints:
        a, b = (np.asarray(s[joint.name].force) for s in (apart, one))
        np.testing.assert_allclose(a, b, atol=1e-6 * max(1.0, np.abs(b).max()))
