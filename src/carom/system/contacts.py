"""The contacts of a scene as arrays: own ones, and those of all pairs."""

from __future__ import annotations

from dataclasses import asdict
from itertools import chain, combinations, product

import numpy as np

from carom.contact.pairs.layout import NoHulls, solid_table
from carom.geometry import quaternion
from carom.options import Options
from carom.scene.bodies import Body, HalfSpace
from carom.scene.contacts import IMPACT_LAWS, Contact
from carom.scene.scene import Scene
from carom.scene.shapes import Shape
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
    """Return contacts, vertices, and the solids and hulls of bodies whose points the kernels of pairs find.

    A contact of the scene has a row for each pair of pieces; against a half-space one for all vertices that
    are swollen alike, and one for each curved piece.
    """
    pairs = [(c, *sides) for c in all_contacts(scene) for sides in _rows(c)]
    rows, vertices = table(CONTACT, len(pairs)), _Vertices(to_principal)
    shaped = _shaped(pairs)
    solids, tables = solid_table([b.shape for b in shaped], [to_principal[b.index] for b in shaped])
    place = {b: int(np.searchsorted(solids.body, k)) for k, b in enumerate(shaped)}
    for row, (c, mine, others) in zip(rows, pairs):
        shape = _shape(c.body)
        row.number, row.body, row.other = c.index, c.body.index, -1
        row.touches, row.part = _touches(c, mine), len(shape.pieces) > 1
        row.extent, row.radius = shape.size, shape.pieces[mine[0]].radius
        row.first, row.last = vertices.range_of(c.body, mine)
        corners = vertices.parts[-1]
        row.core = np.max(np.linalg.norm(corners, axis=1)) if len(corners) else shape.size
        row.solid = place.get(c.body, 0) + mine[0]
        if isinstance(c.other, HalfSpace):
            row.axes[:] = contact_axes(c.other.normal)
            row.offset = c.other.point @ c.other.normal
        else:
            other = _shape(c.other)
            row.other = c.other.index
            row.other_first, row.other_last = vertices.range_of(c.other, others)
            row.other_solid = place[c.other] + others[0]
            row.other_extent = other.size
            row.radius += other.pieces[others[0]].radius
            row.part = max(row.part, len(other.pieces) > 1)
        row.still = 1e-14 * np.sqrt(np.linalg.norm(scene.gravity) * row.extent)
        row.friction, row.friction_held = c.friction, c.friction_held
        row.turning[:] = c.rolling_friction, c.pivoting_friction
        row.restitution, row.stiffness = c.restitution, c.stiffness
        row.law = IMPACT_LAWS.index(c.impact_law)
        row.width = 1e-5 * row.extent if options.layer_width is None else options.layer_width
        row.penetration = options.penetration
    return rows, vertices.all(), solids, tables if shaped else NoHulls(0)


def _shape(body: Body) -> Shape:
    """Return the shape of a body that touches."""
    assert body.shape is not None
    return body.shape


def _rows(contact: Contact) -> list[tuple[list[int], list[int]]]:
    """Return the numbers of the pieces of the body, and of the other, that each row of a contact is of."""
    pieces = _shape(contact.body).pieces
    if not isinstance(contact.other, HalfSpace):
        others = range(len(_shape(contact.other).pieces))
        return [([a], [b]) for a, b in product(range(len(pieces)), others)]
    alike: dict[float, list[int]] = {}
    for k, piece in enumerate(pieces):
        if piece.corners is not None:
            alike.setdefault(piece.radius, []).append(k)
    curved = [[k] for k, piece in enumerate(pieces) if piece.corners is None]
    return [(mine, []) for mine in [*alike.values(), *curved]]


def _touches(contact: Contact, mine: list[int]) -> bool:
    """Return whether the kernels of pairs find the points of a row."""
    between = not isinstance(contact.other, HalfSpace)
    return between or _shape(contact.body).pieces[mine[0]].corners is None


def _shaped(pairs) -> list[Body]:
    """Return the bodies that need solids, each once."""
    found = [c.body for c, mine, _ in pairs if _touches(c, mine)]
    found += [c.other for c, _, others in pairs if len(others) > 0]
    return list(dict.fromkeys(found))


class _Vertices:
    """Vertices of cores in the principal axes of their bodies, a range for each contact."""

    def __init__(self, to_principal):
        self.to_principal, self.parts, self.count = to_principal, [np.zeros((0, 3))], 0

    def range_of(self, body, numbers) -> tuple[int, int]:
        """Add the vertices of some pieces, each place once; an empty range for a curved one."""
        corners = [body.shape.pieces[k].corners for k in numbers]
        points = np.concatenate([np.zeros((0, 3)) if c is None else c for c in corners])
        if len(numbers) > 1:
            places = np.round(points / (1e-12 * body.shape.size))
            points = points[np.sort(np.unique(places, axis=0, return_index=True)[1])]
        self.parts.append(quaternion.rotate_back(self.to_principal[body.index], points))
        first, self.count = self.count, self.count + len(points)
        return first, self.count

    def all(self) -> np.ndarray:
        return np.concatenate(self.parts)
