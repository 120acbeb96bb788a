"""Grids of values: all combinations, as dimensions and heat maps."""

import numpy as np
import pytest
from scipy.stats import uniform

import carom
from ensembles.ensemble_scenes import die
from ensembles.test_ensemble import agrees
from verified import agree, verifies

MU, SPEEDS, LAWS = [0.0, 0.2, 0.5], [0.5, 1.0], ["newton", "stronge"]


@pytest.fixture(scope="module")
def made():
    vary = {
        "die-ground.friction": carom.Grid(MU),
        "die.velocity": [carom.Grid(SPEEDS), uniform(-0.1, 0.2), -0.5],
        "die-ground.impact_law": carom.Grid(LAWS),
    }
    return carom.ensemble(die(), 0.15, step=2e-3, vary=vary, executor="serial")


@verifies("Grid", "all combinations, the last value changes first", "closed form")
def test_all_combinations(made):
    assert len(made) == 12
    assert list(made.grid) == ["die-ground.friction", "die.velocity.x", "die-ground.impact_law"]
    assert all(agrees(made, k) for k in (0, 7))
    seen = zip(
        made.inputs["die-ground.friction"].tolist(), made.inputs["die.velocity"][:, 0].tolist(),
        made.inputs["die-ground.impact_law"].tolist(),
    )  # fmt: skip
    assert list(seen) == [(mu, speed, law) for mu in MU for speed in SPEEDS for law in LAWS]
    agree(made.inputs["die-ground.friction"], np.repeat(MU, 4))
    across = made.inputs["die.velocity"][:, 1]
    assert len(set(across.tolist())) == 12  # drawn for each run
    assert np.all(np.abs(across) <= 0.1)


def test_dimensions(made):
    pytest.importorskip("xarray")
    data = made.to_xarray()
    assert dict(data.impacts.sizes) == {
        "die-ground.friction": 3, "die.velocity.x": 2, "die-ground.impact_law": 2,
    }  # fmt: skip
    one = data.position.sel({"die-ground.friction": 0.2, "die-ground.impact_law": "stronge"})
    run = int(one.run.sel({"die.velocity.x": 1.0}))
    assert np.array_equal(one.sel({"die.velocity.x": 1.0, "body": "die"}), made.position[run, 0])


def test_maps_and_lines(made):
    plt = pytest.importorskip("matplotlib.pyplot")
    two = made.plot("die.x", over=("die.velocity.x", "die-ground.friction"))
    cells = made.position[:, 0, 0].reshape(3, 2, 2).mean(axis=2)
    assert np.allclose(two.collections[0].get_array().reshape(3, 2), cells, rtol=1e-15)
    assert (two.get_xlabel(), two.get_ylabel()) == ("die.velocity.x", "die-ground.friction")
    line = made.plot("impacts", over="die-ground.friction").lines[0]
    assert line.get_xdata().tolist() == MU
    assert np.array_equal(line.get_ydata(), made.impacts.reshape(3, 4).mean(axis=1))
    laws = made.inputs["die-ground.impact_law"]
    words = made.plot(laws, over=("die-ground.impact_law", "die.velocity.x"), label="law")
    assert [one.get_text() for one in words.get_xticklabels()] == LAWS
    with pytest.raises(
        ValueError, match=r"over must be one or two of die-ground.friction, die.vel"
    ):
        made.plot("impacts")
    with pytest.raises(ValueError, match=r"did you mean 'die.x'"):
        made.plot("die.xx", over="die-ground.friction")
    with pytest.raises(ValueError, match="one value for each of 12 runs"):
        made.plot([1.0, 2.0], over="die-ground.friction")
    plt.close("all")


def test_points_without_a_grid():
    plt = pytest.importorskip("matplotlib.pyplot")
    down = np.outer([0.1, 0.2, 0.3], [0, 0, -1])
    vary = {"die-ground.friction": [0.1, 0.2, 0.3], "die.velocity": down}
    made = carom.ensemble(die(), 0.05, step=5e-3, vary=vary, executor="serial")
    points = made.plot("die.z").collections[0]
    assert np.array_equal(points.get_offsets()[:, 1], [-0.1, -0.2, -0.3])
    assert np.array_equal(points.get_array(), made.position[:, 0, 2])
    plt.close("all")


def of_masses(more=None, **settings):
    vary = {"die.mass": carom.Grid([1.0, 2.0]), **(more or {})}
    return carom.ensemble(die(), 0.1, step=5e-3, vary=vary, **settings)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: carom.Grid([]), "values must be at least one"),
        (lambda: carom.Grid([[1.0]]), r"values must have shape \(n,\)"),
        (lambda: carom.Grid(["a", 1.0]), "values must be numbers"),
        (lambda: carom.Grid([1.0, 2.0, 1.0]), "values must be different"),
        (lambda: of_masses(runs=3), "runs must be left out, or 2, got 3"),
        (lambda: of_masses({"die.velocity": np.zeros((3, 3))}), "must have 2 values, one for each"),
    ],
)
def test_no_grid(call, words):
    with pytest.raises(ValueError, match=words):
        call()
