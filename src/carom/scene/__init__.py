"""The description of a system: shapes, bodies, contacts, joints, forces. NumPy only, no motion."""

from carom.scene import constraints, forces, joints, shapes
from carom.scene.bodies import GROUND, Body, Ground, HalfSpace
from carom.scene.constraints import Constraint
from carom.scene.contacts import Contact
from carom.scene.forces import AppliedForce
from carom.scene.joints import Joint
from carom.scene.materials import ContactLaw, Material
from carom.scene.scene import Scene
from carom.scene.shapes import (
    Box,
    Capsule,
    Compound,
    Convex,
    Cylinder,
    Disc,
    Ellipsoid,
    Mesh,
    Shape,
    Sphere,
)

__all__ = [
    "GROUND",
    "AppliedForce",
    "Body",
    "Box",
    "Capsule",
    "Compound",
    "Constraint",
    "Contact",
    "ContactLaw",
    "Convex",
    "Cylinder",
    "Disc",
    "Ellipsoid",
    "Ground",
    "HalfSpace",
    "Joint",
    "Material",
    "Mesh",
    "Scene",
    "Shape",
    "Sphere",
    "constraints",
    "forces",
    "joints",
    "shapes",
]
