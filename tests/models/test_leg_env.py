"""The environment of the page on robots: checked by gymnasium, and held up by its servos."""

import importlib.util
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

HOWTO = Path(__file__).parents[2] / "docs" / "howto"


def test_the_leg_of_the_page_stands_up():
    """The reward is 1 at the height that is wanted; the same seed gives the same bits."""
    pytest.importorskip("gymnasium")
    from gymnasium.utils.env_checker import check_env

    made = importlib.util.spec_from_file_location("leg_env", HOWTO / "leg_env.py")
    assert made is not None
    assert made.loader is not None
    module = importlib.util.module_from_spec(made)
    made.loader.exec_module(module)
    xml = re.search(r'LEG = """(.*?)"""', (HOWTO / "robot.md").read_text(), re.DOTALL)
    assert xml is not None
    env = module.Leg(xml[1], duration=1.5)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of its own about spaces without bounds
        check_env(env, skip_render_check=True)
    bend = np.arccos((0.75 - 0.05) / 0.8)
    ends = []
    for _ in range(2):
        env.reset(seed=3)
        late = failed = False
        while not late:
            seen, reward, failed, late, _ = env.step(np.array([bend, -2.0 * bend]))
            assert not failed
        ends.append(seen)
    assert np.array_equal(*ends)
    assert reward > 0.95
    assert env.run.time == pytest.approx(1.5, abs=1e-12)
