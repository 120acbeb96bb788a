"""Every shape of the registry: volume, inertia, support and picture agree; it falls and bounces."""

import inspect

import numpy as np
import pytest

import carom
from carom.scene.moments import of_triangles
from carom.scene.shapes import SHAPES, Compound, Convex, Disc, Mesh, Profile
from carom.visual.surfaces import surface
from verified import agree, verifies

POINTS = np.array([(0, 0, 0), (0.5, 0, 0), (0, 0.4, 0), (0.1, 0.1, 0.3)])
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
MADE = {
    Convex: lambda: Convex(POINTS, radius=0.05),
    Mesh: lambda: Mesh(POINTS, FACES),
    Compound: lambda: Compound(
        [(carom.Sphere(0.1), (0, 0, 0)), (carom.Box(0.1, 0.2, 0.1), (0.4, 0, 0))]
    ),
    Profile: lambda: Profile(lambda angle: 0.3 + 0.06 * np.cos(2 * angle), thickness=0.1),
}
#: without those that touch a half-space in their plane only
IN_SPACE = [kind for kind in SHAPES if kind is not Profile]


def made(kind):
    """A shape of each kind; of lengths 0.4, 0.16, 0.064, ... where it has no points or parts."""
    if kind in MADE:
        return MADE[kind]()
    return kind(*(0.4**k for k, _ in enumerate(inspect.signature(kind).parameters, start=1)))


@verifies(
    "{kind.__name__}", "volume, inertia and support by its triangles", "own integration: triangles"
)
@pytest.mark.parametrize("kind", SHAPES, ids=lambda kind: kind.__name__)
def test_a_shape_is_its_surface(kind):
    shape, fineness = made(kind), 96
    vertices, triangles = surface(shape, fineness)
    # Surfaces lie inside by 24/fineness^2 of the volume at most: twice that in the second moments.
    rtol = 2 * 24 / fineness**2
    volume, first, second = of_triangles(vertices[triangles])
    agree(volume, shape.volume, rtol=rtol, atol=1e-12)
    if kind is not Disc:
        agree(first / volume, 0, atol=rtol * shape.size)
        inertia = np.trace(second) * np.eye(3) - second
        theirs = shape.inertia(volume)
        agree(inertia, theirs, atol=2 * rtol * np.trace(theirs))
    assert np.max(np.linalg.norm(vertices, axis=1)) <= shape.size * (1 + 1e-12)
    for direction in np.random.default_rng(4).normal(size=(20, 3)):
        unit = direction / np.linalg.norm(direction)
        farthest = shape.support(direction) @ unit
        agree(np.max(vertices @ unit), farthest, atol=rtol * shape.size)


@verifies("{kind.__name__}", "$e = 1$ without friction keeps the energy", "invariant")
@pytest.mark.parametrize("kind", IN_SPACE, ids=lambda kind: kind.__name__)
def test_a_shape_bounces(kind):
    # e = 1 without friction: the energy stays, and nothing sinks in.
    scene, shape = carom.Scene(), made(kind)
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    turn = np.array([0.9, 0.3, -0.2, 0.1]) / np.linalg.norm([0.9, 0.3, -0.2, 0.1])
    place = (0, 0, shape.size + 0.02)
    body = scene.add_body(shape, mass=1.0, position=place, velocity=(0, 0, -3.0), orientation=turn)
    scene.add_contact(body, ground, restitution=1.0, impact_law="stronge")
    s = carom.simulate(scene, 0.2, step=5e-3)
    assert len(s.impacts) > 0
    agree(s.total_energy, s.total_energy[0], rtol=1e-9)
    for x, q in zip(s.position[:, 0], s.orientation[:, 0]):
        down = carom.geometry.quaternion.rotate_back(q, np.array([0.0, 0.0, -1.0]))
        assert x[2] - shape.support(down) @ down > -1e-8 * shape.size
