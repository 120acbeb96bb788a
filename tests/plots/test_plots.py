"""What the plots draw is what the solution says."""

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest

import carom
from carom.visual import plots
from carom.visual.plots import figure, style


def line(ax, label):
    """Return the data of the line that has a label."""
    (found,) = [one for one in ax.lines if one.get_label() == label]
    return np.array(found.get_data())


def words(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_trajectory_passes_the_saved_places_and_those_of_impacts(thrown):
    ax = plots.trajectory(thrown, plane="xz")
    x, z = line(ax, "body1")
    t = np.union1d(thrown.t, thrown.impacts.time)
    assert len(x) == len(t) == len(thrown.t) + len(thrown.impacts)
    saved = np.isin(t, thrown.t)
    np.testing.assert_allclose(
        np.stack([x, z], 1)[saved], thrown.position[:, 0, [0, 2]], atol=1e-15
    )
    np.testing.assert_allclose(
        z[~saved], thrown.evaluate(thrown.impacts.time)[0][:, 0, 2], atol=1e-15
    )
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$x$ [m]", "$z$ [m]")


def test_trajectory_of_chosen_bodies_up_against_gravity(swung):
    names = [body.name for body in swung.scene.bodies]
    ax = plots.trajectory(swung, names[-1])
    up = "xyz"[int(np.argmax(np.abs(swung.scene.gravity)))]
    assert ax.get_ylabel() == f"${up}$ [m]"
    assert [one.get_label() for one in ax.lines if not one.get_label().startswith("_")] == names[
        -1:
    ]


def test_plot_takes_what_is_drawn_as_its_second_argument(swung):
    name = swung.scene.bodies[-1].name
    (path,) = [one for one in swung.plot("trajectory", name).lines if one.get_label() == name]
    np.testing.assert_array_equal(path.get_data(), line(plots.trajectory(swung, name), name))
    with pytest.raises(ValueError, match="what must be left out with kind 'energy', got 'rod'"):
        swung.plot("energy", "rod")


def test_a_rolling_disc_without_a_shape_has_the_outline_of_films():
    scene = carom.Scene()
    wheel = scene.add_body(mass=1.0, inertia=(0.01, 0.02, 0.01), position=(0, 0, 0.2))
    scene.add_joint(carom.joints.RollingDisc(0.2, (0, 1, 0)), carom.GROUND, wheel)
    ax = plots.trajectory(carom.simulate(scene, 0.1, step=0.05), outlines=[0.0], plane="xz")
    (drawn,) = ax.collections
    ends = np.concatenate(drawn.get_segments()) - (0.0, 0.2)
    assert abs(np.linalg.norm(ends, axis=1) - 0.2).max() < 1e-12  # corners of a polygon


def test_outlines_are_the_silhouette(thrown):
    # The die starts with its axes along those of the world: from the side it is a square.
    ax = plots.trajectory(thrown, outlines=[0.0], plane="xz")
    (outline,) = ax.collections
    ends = np.concatenate(outline.get_segments())
    half = 0.5 * thrown.scene.bodies[0].shape.lx
    np.testing.assert_allclose(np.abs(ends - thrown.position[0, 0, [0, 2]]), half, atol=1e-12)


def test_energy_draws_the_ledger(slid):
    above, below = plots.energy(slid)
    assert np.array_equal(line(above, "kinetic"), [slid.t, slid.kinetic_energy])
    assert np.array_equal(line(above, "sum"), [slid.t, slid.total_energy])
    assert np.array_equal(line(above, "friction"), [slid.t, slid.ledger.friction])
    assert "work of forces" not in words(above)  # there are none
    residual = np.abs(slid.ledger.residual)
    shown = below.lines[0].get_ydata()
    assert np.array_equal(shown[residual > 0], residual[residual > 0])
    assert above.get_ylabel().endswith("[J]")


def test_impacts_draw_the_table(thrown):
    normal, slip, impulse, lost = plots.impacts(thrown)
    table = thrown.impacts
    before, after = (normal.lines[k].get_data() for k in (0, 1))
    assert np.array_equal(before, [table.time, table.relative_velocity_before[:, 0]])
    assert np.array_equal(after, [table.time, table.relative_velocity_after[:, 0]])
    speeds = np.hypot(*table.relative_velocity_after[:, 1:].T)
    assert np.array_equal(slip.lines[1].get_ydata(), speeds)
    assert np.array_equal(impulse.lines[1].get_ydata(), table.impulse[:, 0])
    assert np.array_equal(line(lost, figure.contact_names(thrown)[0])[1], -table.energy_change)


def test_one_impact_inside(thrown):
    gap, speed, force = plots.impact_inside(thrown, 0)
    history = thrown.impact_history(0, steps=64)
    t, x = gap.lines[0].get_data()
    scale = t[-1] / history.duration
    np.testing.assert_allclose(x[[0, -1]] / x[0], 1.0, rtol=1e-9)
    u = line(speed, "$u_{n}$")[1]
    assert u[0] == pytest.approx(thrown.impacts[0].relative_velocity_before[0], rel=1e-12)
    assert u[-1] == pytest.approx(thrown.impacts[0].relative_velocity_after[0], rel=1e-9)
    # the impulse is what lies below the line of the force, by the rule of trapezoids: 64 steps
    moments, push = line(force, "$F_{n}$")
    unit = {"N": 1.0, "kN": 1e3, "MN": 1e6}[force.get_ylabel().split("[")[1][:-1]]
    impulse = np.trapezoid(unit * push, moments / scale)
    assert impulse == pytest.approx(thrown.impacts[0].impulse[0], rel=1e-3)


def test_hodograph_shows_slip_and_the_directions_that_it_keeps(thrown):
    left, right = plots.hodograph(thrown, 0)
    record = thrown.impacts[0]
    path = line(left, "slip").T
    np.testing.assert_allclose(path[0], record.relative_velocity_before[1:], atol=1e-15)
    np.testing.assert_allclose(path[-1], record.relative_velocity_after[1:], atol=1e-15)
    np.testing.assert_allclose(path[-2], path[-1], atol=1e-9)  # the layer leads to the same end
    W, mu = record.inverse_mass, record.friction
    rays = [one.get_xydata()[1] for one in left.lines if one.get_linestyle() in ("--", ":")]
    assert len(rays) >= 2
    for ray in rays:
        e = ray / np.linalg.norm(ray)
        rate = W[1:, 0] - mu * W[1:, 1:] @ e  # du_t/dp with slip along e stays along e
        assert abs(e[0] * rate[1] - e[1] * rate[0]) < 1e-9 * np.abs(W).max()
    circle, friction = right.lines[0].get_xydata(), right.lines[1].get_xydata()
    np.testing.assert_allclose(np.hypot(*circle.T), mu, rtol=1e-12)
    np.testing.assert_allclose(np.hypot(*friction.T), mu, rtol=1e-9)  # it slips all the time


def test_contacts_are_bars_where_they_are_held(slid):
    ax = plots.contacts(slid)
    table = slid.contacts
    spans = {
        (round(box.x0, 12), round(box.x1, 12))
        for bar in ax.collections
        for box in (path.get_extents() for path in bar.get_paths())
        if box.width > 0
    }
    expected = {(round(a, 12), round(b, 12)) for a, b in zip(table.start, table.end) if b > a}
    assert expected <= spans
    assert [label.get_text() for label in ax.get_yticklabels()] == figure.contact_names(slid)[:1]
    assert set(words(ax)) >= set(table.mode)


def test_joints(swung):
    axes = plots.joints(swung, degrees=True)
    lines = [{line.get_label(): line.get_ydata() for line in ax.lines} for ax in axes]
    np.testing.assert_array_equal(
        lines[0]["hinge1"], swung["hinge1"].coordinates(degrees=True)[0][:, 0]
    )
    np.testing.assert_array_equal(lines[2]["hinge0"], np.linalg.norm(swung["hinge0"].force, axis=1))
    assert [ax.get_ylabel() for ax in axes[:2]] == ["coordinate [deg]", "rate [deg/s]"]
    assert len(plots.joints(swung, "hinge0")[0].lines) == 1
    with pytest.raises(ValueError, match=r"joints must be among .*; did you mean 'hinge0'"):
        plots.joints(swung, "hing0")


def test_forces(swung, slid):
    force = swung.scene.forces[0]
    axes = swung.plot("forces")
    lines = {line.get_label(): line.get_ydata() for ax in axes for line in ax.lines}
    np.testing.assert_array_equal(lines[force.name], swung[force].torque)
    assert {"stop"} < set(lines)
    (ax,) = plots.forces(slid, "block-ground")
    size = np.linalg.norm(slid.contact_force[:, 0], axis=1)
    np.testing.assert_allclose(ax.lines[0].get_ydata(), size, rtol=1e-12)
    with pytest.raises(ValueError, match="there must be a force that acts"):
        plots.forces(carom.simulate(carom_scene(), 0.1))


def carom_scene():
    """A ball that falls: nothing but its weight acts."""
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0)
    return scene


def test_constraint_errors(swung):
    ax = plots.constraint_errors(swung)
    unit = swung.constraint_rows.unit
    assert set(unit) == {"m", "rad"}
    for of, errors, per in zip(("position", "velocity"), swung.constraint_errors, ("", "/s")):
        for one in ("m", "rad"):
            greatest = errors[:, unit == one].max(axis=1)
            shown = line(ax, f"{of} [{one}{per}]")[1]
            assert np.array_equal(shown[greatest > 0], greatest[greatest > 0])


def test_phase_of_a_body_steps_at_impacts(thrown):
    ax = plots.phase(thrown, "body1", axis="z")
    z, v = ax.lines[0].get_data()
    assert len(z) == len(thrown.t) + 2 * len(thrown.impacts)
    k = int(np.argmax(np.diff(v)))  # the first impact
    assert z[k] == z[k + 1]
    at = thrown.impacts.time[0]
    assert v[k] == thrown.evaluate(at, "left")[2][0, 2]
    assert v[k + 1] == thrown.evaluate(at, "right")[2][0, 2]


def test_phase_of_a_joint(swung):
    joint = swung.scene.joints[0].name
    ax = plots.phase(swung)
    q, rate = swung.joint_coordinates(joint)
    assert np.array_equal(ax.lines[0].get_data(), [q[:, 0], rate[:, 0]])
    assert ax.get_xlabel() == f"coordinate of {joint} [rad]"


def test_work_precision_sorts_by_time():
    ax = plots.work_precision(
        {"rk4": ([2.0, 1.0], [1e-8, 1e-4]), "rk8": ([3.0], [0.0])}, error="error [m]"
    )
    assert np.array_equal(line(ax, "rk4"), [[1.0, 2.0], [1e-4, 1e-8]])
    assert np.isnan(line(ax, "rk8")[1][0])
    assert (ax.get_xscale(), ax.get_yscale(), ax.get_ylabel()) == ("log", "log", "error [m]")


def test_coordinates(bounced):
    axes = bounced.plot()
    assert set(axes) == {"motion", "energy", "error", "contacts"}
    t, height = line(axes["motion"], "$q_{1}$")
    assert height[np.isin(t, bounced.t)] == pytest.approx(bounced.q[:, 1], abs=1e-12)
    assert len(axes["contacts"].collections[-1].get_segments()) == len(bounced.impacts)
    assert line(bounced.plot("energy")[0], "kinetic")[1] == pytest.approx(bounced.kinetic_energy)
    normal = bounced.plot("impacts")[0]
    assert np.array_equal(
        normal.lines[0].get_ydata(), bounced.impacts.relative_velocity_before[:, 0]
    )
    left, _ = bounced.plot("hodograph")
    assert line(left, "slip")[0, -1] == pytest.approx(bounced.impacts[0].relative_velocity_after[1])
    q, v = bounced.plot("phase", number=1).lines[0].get_data()
    fall = slice(0, 20)  # before the first impact, at sqrt(2 * 0.5 / g) = 0.32 s
    np.testing.assert_allclose(v[fall] ** 2, 2 * 9.81 * (0.5 - q[fall]), rtol=0, atol=1e-9)


@pytest.mark.parametrize("run", ["thrown", "slid", "swung"])
def test_a_run_at_a_glance(run, request):
    solution = request.getfixturevalue(run)
    axes = solution.plot()
    assert {"motion", "energy", "error"} <= set(axes)
    assert ("constraints" in axes) == bool(solution.scene.joints)
    for name, ax in axes.items():
        assert bool(ax.get_ylabel()) == (name != "contacts")  # whose rows have names


def test_an_overview_with_long_names_has_room_for_all_of_it():
    """Contacts and joints side by side: no legend is cut off, and long names do not narrow the plots."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    names = ("egg", "a ball with a very long name", "arm")
    for k, name in enumerate(names):
        scene.add_body(carom.Sphere(0.05), mass=1, position=(k, 0, 0.2 + 0.5 * (k == 2)), name=name)
    for name in names[:2]:
        scene.add_contact(name, "ground", restitution=0.5, friction=0.2)
    scene.add_joint(carom.joints.Revolute((1.8, 0, 0.7), (0, 1, 0)), carom.GROUND, "arm")
    axes = carom.simulate(scene, 0.5, step=0.005).plot()
    figure = axes["motion"].figure
    figure.canvas.draw()
    for ax in axes.values():
        legend = ax.get_legend()
        if legend is not None:
            box = legend.get_window_extent()
            assert box.x0 >= 0
            assert box.x1 <= figure.bbox.width
        assert ax.get_window_extent().width > 0.3 * figure.bbox.width
    labels = [label.get_text() for label in axes["contacts"].get_yticklabels()]
    assert labels == ["egg-ground", "a ball wit\u2026me-ground"]


def test_a_run_from_a_file_looks_the_same(thrown, tmp_path):
    thrown.save(tmp_path / "run.nc")
    again = carom.Solution.load(tmp_path / "run.nc")
    assert np.array_equal(
        line(plots.trajectory(again), "body1"), line(plots.trajectory(thrown), "body1")
    )
    for kind in ("impact_inside", "hodograph"):
        one, two = (
            solution.plot(kind, k=1)[0].lines[0].get_xydata() for solution in (again, thrown)
        )
        assert np.array_equal(one, two)
    again.plot()


def test_settings_of_the_user_stay(thrown):
    before = dict(mpl.rcParams)
    plots.energy(thrown)
    assert dict(mpl.rcParams) == before


def test_axes_that_are_given_are_drawn_into(thrown):
    drawn, axes = style.new(rows=2)
    given = plots.energy(thrown, ax=axes)
    assert list(given) == list(axes)
    assert axes[0].lines
    single = plots.trajectory(thrown, ax=drawn.add_axes((0, 0, 1, 1)))
    assert single.figure is drawn


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (
            lambda s: plots.trajectory(s, "body2"),
            "bodies must be among 'body1', got 'body2'; did you mean 'body1'",
        ),
        (lambda s: plots.trajectory(s, plane="xx"), "plane"),
        (lambda s: plots.trajectory(s, []), "bodies must be at least one"),
        (lambda s: plots.trajectory(s, 0), "bodies must be among 'body1', got 0"),
        (lambda s: plots.trajectory(s, outlines=[9.0]), "outlines must be times within"),
        (lambda s: plots.impact_inside(s, 99), "k, number of the impact, must be .* at most"),
        (lambda s: plots.hodograph(s, 0.5), "k, number of the impact"),
        (lambda s: plots.impacts(s, contacts="wall"), "contacts must be among"),
        (lambda s: plots.constraint_errors(s), "joint"),
        (lambda s: plots.energy(s, ax=[]), "ax must be 2"),
        (lambda s: plots.phase(s, "body2"), "of must be among"),
        (lambda s: plots.phase(s, "body1", axis="w"), "axis"),
        (lambda s: s.plot("energies"), "kind must be one of .* did you mean 'energy'"),
    ],
)
def test_bad_input_is_named(thrown, draw, message):
    with pytest.raises(ValueError, match=message):
        draw(thrown)
    assert not plt.get_fignums()  # no empty figure is left


def test_nothing_to_draw_is_said(flown, bounced):
    for draw in (plots.impacts, plots.impact_inside, plots.hodograph):
        with pytest.raises(ValueError, match="there must be an impact to draw"):
            draw(flown)
    with pytest.raises(ValueError, match="there must be a contact that touches"):
        plots.contacts(flown)
    assert set(flown.plot()) == {"motion", "energy", "error"}
    for draw in (plots.trajectory, plots.impact_inside):
        with pytest.raises(ValueError, match="scene of bodies"):
            draw(bounced)
    with pytest.raises(TypeError, match=r"Solution\.load"):
        plots.energy("run.nc")
    with pytest.raises(ValueError, match="series"):
        plots.work_precision({"rk4": ([1.0], [1.0, 2.0])})
