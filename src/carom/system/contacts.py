"""The contacts of a scene as arrays: own ones, and those of all pairs."""

from __future__ import annotations

from dataclasses import asdict
from itertools import chain, combinations

import numpy as np

from carom.contact.pairs.layout import NoHulls, solid_table
from carom.geometry import quaternion
from carom.options import Options
from carom.scene.bodies import Body, HalfSpace
from carom.scene.contacts import IMPACT_LAWS, Contact
from carom.scene.scene import Scene
from carom.system.arrays import CONTACT, table
from carom.system.frames import contact_axes


def all_contacts(scene: Scene) -> list[Contact]:
    """Return the contacts of a scene: those added, then those of `set_contact_default`."""
    contacts = list(scene.contacts)
    if scene.contact_default is None:
        return contacts
    planes = ((b, h) for b in scene.bodies for h in scene.half_spaces)
    for body, other in chain(planes, combinations(scene.bodies, 2)):
        law = scene.contact_law(body, other)
        if law is not None:
            name = f"{body.name}-{other.name}"
            contacts.append(
                Contact(index=len(contacts), name=name, body=body, other=other, **asdict(law))
            )
    return contacts


def compile_contacts(scene: Scene, to_principal, options: Options):
    """Return contacts, vertices, and the solids and hulls of bodies that may touch each other."""
    contacts = all_contacts(scene)
    rows, vertices = table(CONTACT, len(contacts)), _Vertices(to_principal)
    meet = any(not isinstance(c.other, HalfSpace) for c in contacts)
    shaped = [b for b in scene.bodies if b.shape is not None] if meet else []
    solids, tables = solid_table([b.shape for b in shaped], [to_principal[b.index] for b in shaped])
    number = {b: k for k, b in enumerate(shaped)}
    for row, c in zip(rows, contacts):
        row.number, row.body, row.other = c.index, c.body.index, -1
        row.first, row.last = vertices.range_of(c.body)
        row.extent, row.radius = _size(c.body)
        row.core = np.max(np.linalg.norm(c.body.shape.vertices, axis=1))
        if isinstance(c.other, HalfSpace):
            row.axes[:] = contact_axes(c.other.normal)
            row.offset = c.other.point @ c.other.normal
        else:
            row.other = c.other.index
            row.other_first, row.other_last = vertices.range_of(c.other)
            row.solid, row.other_solid = number[c.body], number[c.other]
            row.other_extent, radius = _size(c.other)
            row.radius += radius
        row.still = 1e-14 * np.sqrt(np.linalg.norm(scene.gravity) * row.extent)
        row.friction, row.friction_held = c.friction, c.friction_held
        row.turning[:] = c.rolling_friction, c.pivoting_friction
        row.restitution, row.stiffness = c.restitution, c.stiffness
        row.law = IMPACT_LAWS.index(c.impact_law)
        row.width = 1e-5 * row.extent if options.layer_width is None else options.layer_width
        row.penetration = options.penetration
    return rows, vertices.all(), solids, tables if meet else NoHulls(0)


def _size(body: Body) -> tuple[float, float]:
    """Return the size of a body, and the radius of the ball that swells it."""
    assert body.shape is not None
    return body.shape.size, body.shape.pieces[0].radius


class _Vertices:
    """Vertices of cores in the principal axes of their bodies, a range for each contact."""

    def __init__(self, to_principal):
        self.to_principal, self.parts, self.count = to_principal, [np.zeros((0, 3))], 0

    def range_of(self, body) -> tuple[int, int]:
        assert body.shape is not None
        points = quaternion.rotate_back(self.to_principal[body.index], body.shape.vertices)
        self.parts.append(points)
        first, self.count = self.count, self.count + len(points)
        return first, self.count

    def all(self) -> np.ndarray:
        return np.concatenate(self.parts)
