"""Numbers of features: a contact keeps its number as long as the same features touch.

Bits 60-61 are the kind: 1 a vertex of A, 2 a vertex of B, 3 an edge of A and one of B, 0 smooth or undecided.
Then follow 15 bits for each of the vertices a1, a2 of A and b1, b2 of B.

How a point moves (`carom.contact.kinds.drift`) depends on the part of each core on which it lies. Bits 30-31 of
the number of a part are its kind:

    SUPPORT   the point of the core that is farthest along the normal: a vertex, a point of a curved surface
              or of a rim
    FIXED     a point fixed to the solid although its surface is curved there: one of the eight of a rim
    EDGE      a point of an edge; the ends follow, 15 bits each
    FACE      a point inside a face; its number follows
"""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel

VERTEX_A, VERTEX_B, EDGES = 1, 2, 3
SUPPORT, FIXED, EDGE, FACE = range(4)
OF_SUPPORT, OF_FIXED = SUPPORT << 30, FIXED << 30  # parts that have no numbers
NOBODY, OF_A, OF_B = range(3)  # owners of a normal


@inlined
def of_vertex_a(i):
    """Return the feature of vertex i of A on any part of B."""
    return (1 << 60) | (i << 45)


@inlined
def vertex_a(feature):
    """Return the vertex i of a feature that `of_vertex_a` made."""
    return (feature >> 45) & 0x7FFF


@inlined
def of_vertex_b(i):
    """Return the feature of vertex i of B on any part of A."""
    return (2 << 60) | (i << 15)


@inlined
def of_edges(a1, a2, b1, b2):
    """Return the feature of the edge a1 a2 of A on the edge b1 b2 of B; the order of the ends is free."""
    return (3 << 60) | (min(a1, a2) << 45) | (max(a1, a2) << 30) | (min(b1, b2) << 15) | max(b1, b2)


@inlined
def vertex_b(feature):
    """Return the vertex i of a feature that `of_vertex_b` made."""
    return (feature >> 15) & 0x7FFF


@inlined
def edge_part(i, j):
    """Return the part of an edge with the ends i and j."""
    return (EDGE << 30) | (i << 15) | j


@inlined
def face_part(i):
    """Return the part of face i."""
    return (FACE << 30) | (i << 15)


@inlined
def first_of(part):
    """Return the first end of an edge, or the number of a face."""
    return (part >> 15) & 0x7FFF


@inlined
def second_of(part):
    """Return the second end of an edge."""
    return part & 0x7FFF


@kernel
def exchanged(feature):
    """Return the feature with A and B exchanged."""
    kind = feature >> 60
    a, b = (feature >> 30) & 0x3FFFFFFF, feature & 0x3FFFFFFF
    if kind == 1 or kind == 2:
        kind = 3 - kind
    return (kind << 60) | (b << 30) | a
