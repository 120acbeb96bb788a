"""Shapes: volume, inertia, size, and convex pieces for contact.

A shape is given in body axes, with its mass centre at the origin. For contact it consists of `pieces`: convex
cores (a point, a segment, a box, a hull of vertices, a cylinder, an ellipsoid), each rounded by a ball: a piece
is the set of all points within the radius of the ball from its core. Only the piece of a `Profile`, a prism,
need not be convex.
"""

from __future__ import annotations

from carom.scene.pieces import Shape as Shape
from carom.scene.values import subclasses_in

# isort: off
# The registry: a line a shape. Each is `carom.NAME` for users.
from carom.scene.shapes.plain import Sphere as Sphere
from carom.scene.shapes.plain import Box as Box
from carom.scene.shapes.revolved import Capsule as Capsule
from carom.scene.shapes.revolved import Cylinder as Cylinder
from carom.scene.shapes.revolved import Disc as Disc
from carom.scene.shapes.plain import Ellipsoid as Ellipsoid
from carom.scene.shapes.convex import Convex as Convex
from carom.scene.shapes.mesh import Mesh as Mesh
from carom.scene.shapes.compound import Compound as Compound
from carom.scene.shapes.compound import Part as Part
from carom.scene.shapes.profile import Profile as Profile
# isort: on

SHAPES = subclasses_in(globals(), Shape)
