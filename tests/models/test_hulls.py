"""Hulls of meshes with fewer corners: what they leave out is said, and nothing else changes."""

import numpy as np
import pytest

import carom
from carom.collision.api import nearest_points
from carom.io.models.hulls import with_fewer_corners
from carom.scene.shapes.convex import hull_of

SMALL = 1e-9  # radius of the ball that measures a distance


def ellipsoid(n, seed=0):
    points = np.random.default_rng(seed).normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1)[:, None] * (0.1, 0.07, 0.05)


def model_of(points, **given):
    """Return the model of two bodies with one mesh."""
    vertices = " ".join(map(repr, points.ravel().tolist()))
    return carom.load_model(
        f"""<mujoco><asset><mesh name="stone" vertex="{vertices}"/></asset><worldbody>
        <body name="one"><freejoint/><geom type="mesh" mesh="stone"/></body>
        <body name="two" pos="0 0 1"><freejoint/><geom type="mesh" mesh="stone"/></body>
        </worldbody></mujoco>""",
        restitution=0.5,
        **given,
    )


def mesh_shape(model, name="one"):
    """Return the hull that covers a body."""
    ((shape, _, _),) = model.scene[name].shape.parts
    return shape


def distance(points, hull):
    """Return the distances of points from a hull, by the search for nearest points of two solids."""
    shape, turn = carom.Convex(hull), (1.0, 0.0, 0.0, 0.0)
    gaps = [
        nearest_points(carom.Sphere(SMALL), (p, turn), shape, (shape.centroid, turn)).gap
        for p in points
    ]
    return np.maximum(np.array(gaps) + SMALL, 0.0)


def cases():
    rng = np.random.default_rng(4)
    turn = 2.0 * np.pi * rng.uniform(size=200)
    box = rng.integers(0, 2, size=(300, 3))
    return {
        "ellipsoid": ellipsoid(300),
        "cylinder": np.stack([np.cos(turn), np.sin(turn), rng.integers(0, 2, 200)], -1),
        "thin": ellipsoid(200) * (1.0, 1.0, 1e-4),
        "rounded box": box + 0.1 * ellipsoid(300) / (0.1, 0.07, 0.05),
        "lattice": np.round(200.0 * ellipsoid(300)),
    }


@pytest.mark.parametrize("most", [4, 7, 20])
@pytest.mark.parametrize("kind", cases())
def test_the_deviation_is_the_greatest_distance(kind, most):
    """It is that of a corner, and no point of the faces is farther: both to the round-off of a distance."""
    corners, triangles = hull_of(cases()[kind])
    fewer, said = with_fewer_corners(corners, most)
    size = np.ptp(corners, axis=0).max()
    assert len(fewer) == most
    assert {tuple(p) for p in fewer} <= {tuple(p) for p in corners}
    assert said == pytest.approx(distance(corners, fewer).max(), abs=1e-14 * size)
    rng = np.random.default_rng(most)
    weight = rng.dirichlet(np.ones(3), size=50)
    chosen = corners[triangles[rng.integers(len(triangles), size=50)]]
    assert distance(np.einsum("nk,nki->ni", weight, chosen), fewer).max() <= said + 1e-14 * size


def test_more_corners_leave_out_less():
    corners, _ = hull_of(ellipsoid(500))
    out = [with_fewer_corners(corners, most)[1] for most in (8, 32, 128, 480, len(corners))]
    assert out == sorted(out, reverse=True)
    assert out[-1] == 0.0


def test_report_and_shape():
    points = ellipsoid(400)
    model, whole = model_of(points), model_of(points, max_hull_vertices=None)
    shape, full = mesh_shape(model), mesh_shape(whole)
    assert len(shape.vertices) == 64
    assert shape is mesh_shape(model, "two")
    (entry,) = model.report.of("mesh 'stone'")
    assert entry.what == "its hull has 400 corners"
    said = float(entry.instead.split()[-2])
    assert said == pytest.approx(
        distance(full.points, shape.points).max(), rel=5e-3
    )  # three digits
    assert not whole.report.of("mesh")
    given = carom.Convex(whole.mujoco.mesh_vert.astype(float))
    np.testing.assert_array_equal(full.points, given.points)


def test_nothing_else_changes():
    """Masses, inertias and places are those of the model, whatever the hull."""
    points = ellipsoid(300, seed=1)
    few, whole = model_of(points, max_hull_vertices=8), model_of(points, max_hull_vertices=None)
    for a, b in zip(few.scene.bodies, whole.scene.bodies):
        assert a.mass == b.mass
        np.testing.assert_array_equal(a.inertia, b.inertia)
        np.testing.assert_array_equal(a.position, b.position)
        np.testing.assert_array_equal(a.orientation, b.orientation)


def test_a_hull_of_few_corners_is_kept():
    points = ellipsoid(64, seed=2)
    model, whole = model_of(points), model_of(points, max_hull_vertices=None)
    assert not model.report.of("mesh")
    a, b = mesh_shape(model), mesh_shape(whole)
    np.testing.assert_array_equal(a.vertices, b.vertices)
    for (normal, ring), (other, other_ring) in zip(a.faces, b.faces, strict=True):
        np.testing.assert_array_equal(normal, other)
        assert ring == other_ring


@pytest.mark.parametrize("bad", [3, 0, -64, 8.5, "64", True, [64], np.nan])
def test_a_bad_number_is_refused(bad):
    with pytest.raises(ValueError, match="max_hull_vertices must be a whole number"):
        model_of(ellipsoid(20), max_hull_vertices=bad)
