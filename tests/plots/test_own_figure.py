"""Plots within a figure of one's own: one panel of several, sizes, styles, single impacts."""

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest

import carom
from carom.visual import plots

PANELS = {
    "energy": ("energy", "error"),
    "impacts": ("velocity", "slip", "impulse", "energy"),
    "impact_inside": ("position", "velocity", "force"),
    "hodograph": ("slip", "friction"),
}


def curves(ax):
    return [np.array(one.get_data()) for one in ax.lines]


@pytest.mark.parametrize(("kind", "panel"), [(k, p) for k, names in PANELS.items() for p in names])
def test_a_panel_is_that_of_all(thrown, kind, panel):
    every = thrown.plot(kind)[PANELS[kind].index(panel)]
    _, ax = plt.subplots()
    assert thrown.plot(kind, panel=panel, ax=ax) is ax
    assert len(ax.lines) > 0
    for one, other in zip(curves(ax), curves(every), strict=True):
        np.testing.assert_array_equal(one, other)
    assert ax.get_ylabel() == every.get_ylabel()
    assert ax.get_xlabel()  # which only the last of several has
    alone = thrown.plot(kind, panel=panel)
    assert len(alone.figure.axes) == 1


@pytest.mark.parametrize("kind", PANELS)
def test_a_single_axes_gets_the_first_panel(thrown, kind):
    _, ax = plt.subplots()
    assert thrown.plot(kind, ax=ax) is ax
    assert ax.get_ylabel() == thrown.plot(kind)[0].get_ylabel()


def test_a_figure_has_the_size_and_the_style_that_are_asked_for(thrown):
    before = dict(mpl.rcParams)
    ours = plots.contacts(thrown)
    sizes = {}
    for name, style in (
        ("mine", None),
        ("more", {"font.size": 15.0, "axes.labelsize": 20.0}),
        ("theirs", "classic"),
    ):
        with mpl.rc_context({"axes.labelsize": 17.0}):
            ax = plots.contacts(thrown, figsize=(5, 2), style=style)
        assert tuple(ax.figure.get_size_inches()) == (5.0, 2.0)
        sizes[name] = ax.xaxis.label.get_size()
        assert (ax.spines["top"].get_visible() is False) == (name == "more")  # as carom has it
    assert (sizes["mine"], sizes["more"]) == (17.0, 20.0)
    assert ours.xaxis.label.get_size() == 8.5
    assert dict(mpl.rcParams) == before
    whole = plots.overview(thrown, figsize=(9, 5), style={"axes.labelsize": 20.0})
    assert {one.xaxis.label.get_size() for one in whole.values()} == {20.0}
    assert tuple(whole["motion"].figure.get_size_inches()) == (9.0, 5.0)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"panel": "heat"}, "panel must be one of 'energy', 'error', got 'heat'"),
        ({"figsize": (3,)}, r"figsize must have shape \(2,\)"),
        ({"figsize": (0, 3)}, r"figsize must be two numbers from 0.5 to 50.0 \[in\], got \(0, 3\)"),
        ({"style": "no such"}, "style must be .*, got 'no such'"),
        ({"style": {"font.siz": 3}}, "style must be .*'font.siz' is not a valid"),
        ({"style": 3}, "style must be .*, got 3"),
    ],
)
def test_wrong_looks_are_refused_by_name(thrown, arguments, words):
    with pytest.raises(ValueError, match=words):
        thrown.plot("energy", **arguments)
    assert not plt.get_fignums()


def test_a_size_is_for_new_figures(thrown):
    _, ax = plt.subplots()
    with pytest.raises(ValueError, match="figsize must be left out with ax"):
        thrown.plot("contacts", ax=ax, figsize=(3, 3))


def test_an_impact_draws_itself(thrown):
    record = thrown.impacts[0]
    names = ("inverse_mass", "relative_velocity_before", "friction", "restitution", "law")
    impact = carom.resolve_impact(*(getattr(record, name) for name in names))
    expected = plots.hodograph(thrown, 0, panel="slip")
    for one in (record, impact):
        drawn = one.plot(panel="slip", flow=False)
        for a, b in zip(curves(drawn), curves(expected), strict=True):
            np.testing.assert_allclose(a, b, atol=1e-12)


def test_several_impacts_have_no_hodograph():
    several = carom.resolve_impact(np.eye(3), (-1.0, 1.0, 0.0), [0.1, 0.2], 0.5)
    with pytest.raises(ValueError, match="there must be one impact in space to draw, got several"):
        several.plot()


def test_a_ball_sticks_from_the_friction_of_its_closed_form():
    """Slip 1 m/s ends at the normal impulse 1 / (3.5 mu), which is 1 + e at most."""
    ax = plots.e_mu(np.diag([1.0, 3.5, 3.5]), (-1.0, 1.0, 0.0), points=41)
    (mesh,) = [one for one in ax.collections if isinstance(one, mpl.collections.QuadMesh)]
    number = mesh.get_array().reshape(41, 41)
    words = [one[0] for one in plots.coefficients.OUTCOMES]
    mu, e = np.meshgrid(np.linspace(0, 1, 41), np.linspace(0, 1, 41))
    clear = np.abs(3.5 * mu * (1.0 + e) - 1.0) > 1e-9
    sticks = 3.5 * mu * (1.0 + e) > 1.0
    np.testing.assert_array_equal((number == words.index("stick"))[clear], sticks[clear])
    np.testing.assert_array_equal((number == words.index("slip"))[clear], ~sticks[clear])


def test_the_lines_are_the_energy_lost():
    """Without tangential motion in W the impact loses 1 - e^2 of its energy, whatever the friction."""
    _, loss = plots.coefficients._outcomes(
        np.diag([2.0, 0.0, 0.0]), np.array([-1.0, 0.0, 0.0]), 0, np.array([0.0, 0.5]), np.array([0.0, 0.5, 1.0])
    )  # fmt: skip
    np.testing.assert_allclose(loss, np.array([[1.0], [0.75], [0.0]]) * np.ones(2), atol=1e-14)


def test_the_force_of_an_impact_is_drawn_by_its_stiffness():
    struck = carom.resolve_impact(
        np.eye(3), (-1.0, 1.0, 0.0), 0.1, 0.5, stiffness=carom.Stiffness(1e6)
    )
    upper, lower = plots.impact_force(struck)
    top = max(np.max(line.get_ydata()) for line in upper.lines)
    assert top == pytest.approx(struck.peak_force / 1e3, rel=1e-3)  # in kN
    assert lower.get_ylabel().startswith("depth")
    assert plots.impact_force(struck.force(), panel="depth").get_ylabel() == lower.get_ylabel()
    _, ax = plt.subplots()
    assert plots.impact_force(struck, ax=ax) is ax
    with pytest.raises(TypeError, match="stiffness"):
        plots.impact_force(carom.resolve_impact(np.eye(3), (-1.0, 1.0, 0.0), 0.1, 0.5))
