"""Static bodies: bodies touch them as half-spaces and as bodies that are held; nothing else knows of them."""

import numpy as np
import pytest

import carom

TURN = carom.euler("xyz", (20, -35, 50))
DUMBBELL = carom.Compound(
    [(carom.Sphere(0.2), (-0.3, 0, 0)), (carom.Box(0.3, 0.3, 0.3), (0.3, 0, 0))]
)
LAW = {"restitution": 0.4, "friction": 0.3}


def thrown(floor, shape=None):
    """A box or another shape that is thrown on a floor: a half-space, a static slab, a slab that is held."""
    scene = carom.Scene()
    slab, place = carom.Box(4, 4, 1), {"position": (0, 0, -0.5)}
    if floor == "half-space":
        scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    else:
        scene.add_static(slab, **place, name="floor")
    scene.add_body(
        shape or carom.Box(0.2, 0.3, 0.4), mass=1, position=(0, 0, 0.6), velocity=(1, 0.3, 0),
        angular_velocity=(1, 2, 3), name="body",
    )  # fmt: skip
    scene.add_contact("body", "floor", **LAW)
    return scene


@pytest.mark.parametrize(
    "shape", [None, carom.Sphere(0.2), carom.Cylinder(0.2, 0.3), carom.Ellipsoid(0.2, 0.15, 0.1)]
)
def test_the_top_of_a_slab_is_a_half_space(shape):
    plane, slab = (carom.simulate(thrown(floor, shape), 0.6) for floor in ("half-space", "slab"))
    assert len(plane.impacts) == len(slab.impacts) > 0
    # points of rims on faces are found to 1e-7 of the angle; later impacts are apart as errors have grown
    few, exact = 8, 1e-7 if shape is None else 1e-4
    np.testing.assert_allclose(slab.impacts.time[:few], plane.impacts.time[:few], rtol=exact)
    np.testing.assert_allclose(
        slab.impacts.impulse[:2, 0], plane.impacts.impulse[:2, 0], rtol=exact
    )
    np.testing.assert_allclose(slab.position, plane.position, atol=1e-5)
    assert np.max(np.abs(slab.ledger.residual)) < 1e-6


def test_an_elastic_ball_is_reflected_by_a_ramp():
    # Without friction and gravity: v - 2 (v.n) n, n the normal of a face that is turned by 30 degrees about y.
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_static(
        carom.Box(2, 2, 0.2), position=(3, 1, -2), orientation=carom.euler("y", 30), name="ramp"
    )
    n = np.array([np.sin(np.pi / 6), 0, np.cos(np.pi / 6)])
    start = np.array([3, 1, -2]) + 0.2 * n + np.array([0, 0, 1.0])
    scene.add_body(carom.Sphere(0.1), mass=2, position=start, velocity=(0, 0, -4), name="ball")
    scene.add_contact("ramp", "ball", restitution=1, friction=0)
    run = carom.simulate(scene, 0.5)
    assert len(run.impacts) == 1
    assert run.impacts.time[0] == pytest.approx(0.25, abs=1e-14)
    np.testing.assert_allclose(run.impacts.normal[0], n, atol=1e-13)
    v = np.array([0, 0, -4.0])
    np.testing.assert_allclose(run.velocity[-1, 0], v - 2 * (v @ n) * n, atol=1e-13)


@pytest.mark.few(7)
@pytest.mark.parametrize(
    "solid",
    [
        carom.Sphere(0.5), carom.Capsule(0.3, 0.8), carom.Cylinder(0.5, 0.6), carom.Ellipsoid(0.5, 0.4, 0.3),
        carom.Box(0.7, 0.8, 0.6), carom.Convex(carom.Box(0.7, 0.8, 0.6).vertices), DUMBBELL,
    ],
    ids=lambda solid: type(solid).__name__,
)  # fmt: skip
@pytest.mark.parametrize(
    "falling", [carom.Sphere(0.1), carom.Box(0.2, 0.3, 0.15)], ids=["ball", "box"]
)
def test_bodies_strike_a_static_solid_as_one_that_is_held(solid, falling):
    # Held by a joint to the ground the other has a mass, which must not matter.
    runs = []
    for static in (True, False):
        scene, place = carom.Scene(), {"position": (1, 2, 3), "orientation": TURN}
        if static:
            scene.add_static(solid, **place, name="solid")
        else:
            scene.add_body(solid, mass=3, **place, name="solid")
            scene.add_joint(carom.joints.Fixed((1, 2, 3)), carom.GROUND, "solid")
        scene.add_body(
            falling, mass=1, position=(1.05, 2.1, 3.9), angular_velocity=(1, 2, 3), name="body"
        )
        scene.add_contact("body", "solid", restitution=0.5, friction=0.2)
        run = carom.simulate(scene, 0.4, step=5e-3)
        runs.append((run, [body.name for body in scene.bodies].index("body")))
    (one, i), (other, j) = runs
    assert len(one.impacts) > 0
    assert one.impacts.time[0] == pytest.approx(other.impacts.time[0], abs=1e-9)
    for name in ("impulse", "normal", "point"):
        first = [getattr(run.impacts, name)[0] for run in (one, other)]
        np.testing.assert_allclose(*first, atol=1e-6)
    before = int(np.searchsorted(one.t, one.impacts.time[0])) + 1
    np.testing.assert_allclose(one.position[:before, i], other.position[:before, j], atol=1e-7)
    np.testing.assert_allclose(one.total_energy - one.total_energy[0], one.ledger.impacts + one.ledger.friction
                               + one.ledger.bounces, atol=1e-5)  # fmt: skip


def two_on_a_slab(names):
    scene = carom.Scene()
    scene.add_static(carom.Box(20, 4, 1), position=(0, 0, -0.5), name="slab")
    for k, name in enumerate(("left", "middle", "right")):
        if name in names:
            scene.add_body(
                carom.Box(0.2, 0.3, 0.4), mass=1, position=(3 * k - 3, 0, 0.5 + 0.1 * k),
                angular_velocity=(k + 1, 2, 3), name=name,
            )  # fmt: skip
    scene.set_contact_default(**LAW)
    return carom.simulate(scene, 0.5, step=5e-3)


def test_a_static_body_joins_nothing():
    # Bodies on one slab move as each alone, bit for bit: they are islands of their own.
    together = two_on_a_slab(("left", "middle", "right"))
    assert together.position.shape[1] == 3
    for k, name in enumerate(("left", "middle", "right")):
        alone = two_on_a_slab((name,))
        assert len(alone.impacts) > 1
        mine = together.impacts.contact == k
        np.testing.assert_allclose(
            together.impacts.time[mine][:2], alone.impacts.time[:2], rtol=1e-12
        )
        np.testing.assert_allclose(together.position[:, k], alone.position[:, 0], atol=1e-9)


def test_a_body_comes_to_rest_on_a_static_one():
    run = carom.simulate(thrown("slab"), 3.0, step=5e-3)
    assert run.success
    assert not run.warnings
    np.testing.assert_array_equal(run.velocity[-1], 0.0)
    heights = run.position[-1, 0, 2]
    assert min(abs(heights - half) for half in (0.1, 0.15, 0.2)) < 1e-9


@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")  # a pile in parts of steps
def test_a_pile_in_a_box_of_static_walls():
    # Nothing gets out, or into each other: a run is warned of both.
    scene = carom.Scene()
    scene.add_static(carom.Box(1.2, 1.2, 0.1), position=(0, 0, -0.05), name="bottom")
    for k, (x, y) in enumerate([(0.55, 0), (-0.55, 0), (0, 0.55), (0, -0.55)]):
        scene.add_static(
            carom.Box(0.1 if x else 1.0, 0.1 if y else 1.0, 1.0),
            position=(x, y, 0.5),
            name=f"wall{k}",
        )
    for k in range(12):
        place = (0.3 * (k % 3) - 0.3 + 0.01 * k, 0.3 * (k // 3 % 2) - 0.15, 0.2 + 0.25 * (k // 6))
        scene.add_body(
            carom.Box(0.15, 0.2, 0.1), mass=1, position=place, angular_velocity=(k, 1, 0)
        )
    scene.set_contact_default(restitution=0.2, friction=0.4)
    run = carom.simulate(scene, 1.0, step=5e-3)
    assert run.success
    # pieces of steps may leave bodies in each other, by .0035 of a size here
    assert all("penetrates" in said or "as one contact problem" in said for said in run.warnings)
    inside = run.position[-1]
    assert np.all(np.abs(inside[:, :2]) < 0.45)
    assert np.all((inside[:, 2] > 0.049) & (inside[:, 2] < 0.6))


def test_what_a_scene_says_of_them(tmp_path):
    scene = thrown("slab")
    slab = scene["floor"]
    assert (scene.statics, scene.fixed) == ((slab,), (slab,))
    assert (
        repr(scene)
        == "<Scene: 1 body, 0 half-spaces, 1 static body, 1 contact, 0 joints, 0 forces>"
    )
    assert "  StaticBody('floor', Box(lx=4.0, ly=4.0, lz=1.0), position=[ 0.   0.  -0.5])" in str(
        scene
    )
    assert scene.check().degrees_of_freedom == 6
    with pytest.raises(ValueError, match=r"puts 'low' 0\.1 m deep into 'floor'"):
        scene.add_contact(scene.add_body(carom.Sphere(0.1), mass=1, name="low"), slab)
    with pytest.raises(ValueError, match="must be a body that moves, got 'floor' and 'floor'"):
        scene.add_contact(slab, slab)
    with pytest.raises(ValueError, match="got inf; for a body that never moves use add_static"):
        scene.add_body(carom.Sphere(0.1), mass=np.inf)
    with pytest.raises(TypeError, match="child must be a Body, got StaticBody"):
        scene.add_joint(carom.joints.Spherical((0, 0, 0)), carom.GROUND, "floor")


def test_default_pairs_and_pairs_that_are_ignored():
    scene = thrown("slab")
    peg = scene.add_static(carom.Sphere(0.1), position=(0, 0, 1), name="peg")
    scene.set_contact_default(**LAW)
    found = scene.pairs_by_default()
    assert [scene.fixed[k].name for k in found.plane] == ["peg"]
    scene.ignore_contact("body", [peg])
    assert len(scene.pairs_by_default().body) == 0


def test_saved_and_loaded(tmp_path):
    pytest.importorskip("h5netcdf")
    run = carom.simulate(thrown("slab"), 0.5, step=5e-3)
    run.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    np.testing.assert_array_equal(loaded.position, run.position)
    again = carom.simulate(loaded.scene, 0.5, step=5e-3)
    np.testing.assert_array_equal(again.position, run.position)
    assert loaded.scene.statics[0].shape == run.scene.statics[0].shape


def test_they_are_drawn(tmp_path):
    mpl = pytest.importorskip("matplotlib")
    pytest.importorskip("PIL")
    mpl.use("agg")
    import matplotlib.pyplot as plt

    from carom.visual import films
    from carom.visual.viewer.show import show_of

    run = carom.simulate(thrown("slab"), 0.3, step=5e-3)
    (part,) = [part for part in show_of(run).parts if part.look == "static"]
    corners = np.array([part.vertices.min(axis=0), part.vertices.max(axis=0)])
    np.testing.assert_allclose(corners, [(-2, -2, -1), (2, 2, 0)], atol=1e-15)
    assert carom.view(run, export=tmp_path / "run.html").size > 0
    (shadow,) = run.plot("trajectory").collections
    drawn = np.concatenate([path.vertices for path in shadow.get_paths()])
    np.testing.assert_allclose(
        [drawn.min(axis=0), drawn.max(axis=0)], [(-2, -1), (2, 0)], atol=1e-15
    )
    plt.close("all")
    grey = [int("#c3ccd4"[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    assert films.still(run, 0.1, size=(64, 64)).shape == (64, 64, 3)
    stage = films.stage.Stage(run, (64, 64))
    assert np.any(stage.all.colours[stage.owner == -1] == grey)


@pytest.mark.bits
def test_runs_of_an_ensemble_with_a_static_body():
    speeds = np.array([[1, 0, 0], [0, 1, -1.0]])
    runs = carom.ensemble(
        thrown("slab"), 0.4, step=5e-3, vary={"body.velocity": speeds}, executor="serial"
    )
    for k, velocity in enumerate(speeds):
        scene = carom.Scene()
        scene.add_static(carom.Box(4, 4, 1), position=(0, 0, -0.5), name="floor")
        scene.add_body(
            carom.Box(0.2, 0.3, 0.4), mass=1, position=(0, 0, 0.6), velocity=velocity,
            angular_velocity=(1, 2, 3), name="body",
        )  # fmt: skip
        scene.add_contact("body", "floor", **LAW)
        alone = carom.simulate(scene, 0.4, step=5e-3)
        np.testing.assert_array_equal(runs.position[k], alone.position[-1])


def test_sensitivities_refuse_them():
    run = carom.simulate(thrown("slab"), 0.1, step=5e-3)
    with pytest.raises(ValueError, match="solution must be of a scene without static bodies"):
        carom.sensitivities(run, "body.position")
