"""Triangles of curved ground: on the surface, turned to free space, and with rims only where it ends."""

import numpy as np
import pytest

import carom
from carom.visual.bodies import Part
from carom.visual.curved_ground import ground
from carom.visual.films.models import model_of

S = carom.surfaces
ORIGIN = np.zeros(3)


def wave(x, y, z):
    return z - 0.1 * x * x + 0.2 * x * y


def length(x):
    return np.linalg.norm(x, axis=-1)


CASES = {
    "bowl": (S.InsideSphere(1.0), 0.5, ORIGIN, lambda p: 1.0 - length(p)),
    "large bowl": (S.InsideSphere(9.0), 0.5, (0, 0, -9.0), lambda p: 9.0 - length(p)),
    "pipe": (S.InsideCylinder(1.0), 0.5, ORIGIN, lambda p: 1.0 - length(p[..., :2])),
    "can": (
        S.InsideCylinder(1.0, 2.0), 0.5, ORIGIN,
        lambda p: np.minimum(1.0 - length(p[..., :2]), 1.0 - abs(p[..., 2])),
    ),
    "funnel": (
        S.InsideCone(0.5), 0.5, ORIGIN,
        lambda p: p[..., 2] * np.sin(0.5) - length(p[..., :2]) * np.cos(0.5),
    ),
    "tube": (
        S.InsideTorus(1.0, 0.3), 0.5, ORIGIN,
        lambda p: 0.3 - np.hypot(length(p[..., :2]) - 1.0, p[..., 2]),
    ),
    "terrain": (
        S.HeightField(np.sin(np.arange(12))[:, None] * np.cos(np.arange(9)), 0.5), 1.0, ORIGIN, None,
    ),
    "wave": (
        S.Surface(wave, [(-1, -1, -1), (1, 1, 1)]), 0.5, ORIGIN, lambda p: wave(*np.moveaxis(p, -1, 0)),
    ),
}  # fmt: skip
RIMS = {"bowl": 0, "tube": 0, "can": 0, "pipe": 128, "funnel": 64, "terrain": 256}


@pytest.mark.parametrize("name", CASES)
def test_triangles(name):
    surface, radius, centre, phi = CASES[name]
    vertices, faces = ground(surface, np.array(centre), radius, 64)
    if phi is None:

        def phi(p):
            return p[..., 2] - surface.height(p[..., 0], p[..., 1])

    assert len(faces) > 50
    assert np.max(np.abs(phi(vertices))) < 1e-5
    corners = vertices[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = length(normal)
    large = size > 1e-3 * size.max()
    step = 0.01 * radius * (normal / np.maximum(size, 1e-300)[:, None])[large]
    middle = corners.mean(axis=1)[large]
    assert np.all(phi(middle + step) > phi(middle - step))
    sides = {(a, b) for face in faces.tolist() for a, b in zip(face, face[1:] + face[:1])}
    assert len(sides) == 3 * len(faces)
    rims = [side for side in sides if side[::-1] not in sides]
    if name in RIMS:
        assert len(rims) == RIMS[name]
    model = model_of(Part(vertices, faces, [-1], "static", surface))
    drawn = int(
        model.edges.sum()
    )  # rims, and the two edges of a can, which two triangles have each
    assert drawn == len(rims) + 4 * 64 * (name == "can")


def test_the_section_in_a_plot():
    pytest.importorskip("matplotlib")
    scene = carom.Scene()
    scene.add_surface(S.InsideSphere(0.5), name="bowl")
    scene.add_body(carom.Sphere(0.05), mass=1.0, position=(0.3, 0, 0), name="ball")
    scene.add_contact("ball", "bowl", friction=0.0, restitution=0.5)
    axes = carom.simulate(scene, 0.5).plot("trajectory")
    (line,) = (c for c in axes.collections if type(c).__name__ == "LineCollection")
    ends = np.concatenate(line.get_segments())
    assert length(ends) == pytest.approx(0.5, rel=5e-3)  # of a polygon, in the plane y = 0
