"""Bodies, half-spaces, and the ground."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from carom import checks, fields
from carom.fields import Number, Value, Vector, keep
from carom.geometry.attitude import attitude
from carom.scene.colors import hex_color
from carom.scene.look import Look, checked_look
from carom.scene.materials import Material
from carom.scene.moving_surfaces import (
    SurfaceSpin,
    SurfaceVelocity,
    check_in_plane,
    motion_in_words,
    surface_spin,
    surface_velocity,
)
from carom.scene.shapes import SHAPES, Shape
from carom.scene.surfaces import SURFACES, SurfaceDefinition
from carom.scene.values import in_scene

SLACK = 1e-12  # relative to the largest entry or moment: rounding, not physics
GREATEST = 1e300  # [kg m^2]: sums are finite

MaterialOrNone = Value[Material | None, Material | None]
Color = Value[str | None, str | ArrayLike | None]


def _material(name: str, value) -> Material:
    checks.instance(name, value, (Material,))
    return value


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class Body:
    """A rigid body with its initial state. `Scene.add_body` makes it; arrays are read-only.

    Attributes
    ----------
    index : int
        Its index in `Scene.bodies`.
    name : str
    shape : Sphere, Box, Capsule, Cylinder, Disc, Ellipsoid, Convex, Mesh, Profile, Compound or None
    mass : float
        [kg]
    inertia : (3, 3)
        Inertia about the mass centre, in body axes [kg m^2].
    position : (3,)
        Initial position of the mass centre, in the world [m].
    orientation : (4,)
        Initial orientation: unit quaternion (w, x, y, z), body to world.
    velocity, angular_velocity : (3,)
        Initial velocity of the mass centre [m/s] and angular velocity [rad/s], in world axes.
    material : Material or None
        Material of its surface.
    color : str or None
        Colour ``#rrggbb`` in pages, pictures and films; None: a colour of the palette.
    look : tuple of Look or None
        What is seen of it; None: its shape.
    """

    index: int
    name: str
    shape: Shape | None
    mass: Number = Value(checks.mass)
    inertia: Vector = Value(lambda _, value: inertia_matrix(value))
    position: Vector = fields.vector()
    orientation: Value[np.ndarray, Any] = Value(attitude)
    velocity: Vector = fields.vector()
    angular_velocity: Vector = fields.vector()
    material: MaterialOrNone = Value(_material, None)
    color: Color = Value(hex_color, None)
    look: Value[tuple[Look, ...] | None, Any] = Value(checked_look, None)

    def __post_init__(self):
        if self.shape is not None:
            checks.instance("shape", self.shape, SHAPES)
            keep(self, material=whole_material(self.shape, self.material))

    def __repr__(self) -> str:
        return f"Body({self.name!r}, {self.shape!r}, mass={self.mass:g})"


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class HalfSpace:
    """A fixed solid half-space behind a plane, such as a floor. `Scene.add_half_space` makes it.

    Attributes
    ----------
    index : int
        Its index in `Scene.half_spaces`.
    name : str
    point : (3,)
        A point of its surface, which is a plane [m].
    normal : (3,)
        Unit normal of the surface, out of the half-space into free space.
    material : Material or None
        Material of its surface.
    color : str or None
        Colour ``#rrggbb`` in pages, pictures and films; None: grey.
    surface_velocity : (3,), callable or None
        Velocity with which its surface moves in itself [m/s]; see `Scene.add_static`.
    surface_spin : tuple or None
        Axis, rate [rad/s] and point, or None for that of the part, about which its surface turns in itself.
    """

    index: int
    name: str
    point: Vector = fields.vector()
    normal: Vector = fields.direction()
    material: MaterialOrNone = Value(_material, None)
    color: Color = Value(hex_color, None)
    surface_velocity: SurfaceVelocity = surface_velocity()
    surface_spin: SurfaceSpin = surface_spin()

    def __post_init__(self):
        check_in_plane(self.surface_velocity, self.surface_spin, self.normal)

    def __repr__(self) -> str:
        at = f"point={self.point}, normal={self.normal}"
        return f"HalfSpace({self.name!r}, {at}{motion_in_words(self)})"

    @property
    def moves(self) -> bool:
        """Whether its surface moves in itself."""
        return self.surface_velocity is not None or self.surface_spin is not None


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class StaticBody:
    """A solid that never moves: a wall, a peg, a ramp, a mesh, a bowl.

    `Scene.add_static` makes it, and `Scene.add_surface`.

    Attributes
    ----------
    index : int
        Its index in `Scene.statics`.
    name : str
    shape : Sphere, Box, Capsule, Cylinder, Disc, Ellipsoid, Convex, Mesh, Profile, Compound or a surface
        A surface is one of `carom.surfaces`.
    position : (3,)
        Position of the origin of the shape, in the world [m].
    orientation : (4,)
        Unit quaternion (w, x, y, z), shape to world.
    material : Material or None
        Material of its surface.
    color : str or None
        Colour ``#rrggbb`` in pages, pictures and films; None: grey.
    surface_velocity : (3,), callable or None
        Velocity with which its surface moves in itself [m/s]; see `Scene.add_static`.
    surface_spin : tuple or None
        Axis, rate [rad/s] and point, or None for that of the part, about which its surface turns in itself.
    """

    index: int
    name: str
    shape: Shape | SurfaceDefinition
    position: Vector = fields.vector()
    orientation: Value[np.ndarray, Any] = Value(attitude)
    material: MaterialOrNone = Value(_material, None)
    color: Color = Value(hex_color, None)
    surface_velocity: SurfaceVelocity = surface_velocity()
    surface_spin: SurfaceSpin = surface_spin()

    def __post_init__(self):
        checks.instance("shape", self.shape, (*SHAPES, *SURFACES))
        _ = self.shape.pieces  # refused by a shape that has nothing to touch with
        keep(self, material=whole_material(self.shape, self.material))

    def __repr__(self) -> str:
        at = f"{self.shape!r}, position={self.position}"
        return f"StaticBody({self.name!r}, {at}{motion_in_words(self)})"

    @property
    def moves(self) -> bool:
        """Whether its surface moves in itself."""
        return self.surface_velocity is not None or self.surface_spin is not None


def whole_material(shape: Shape | SurfaceDefinition, material: Material | None) -> Material | None:
    """Return the material of a body: the given one, or that of its first part if all parts have their own."""
    if material is not None or not shape.has_materials:
        return material
    bare = [k for k, piece in enumerate(shape.pieces) if piece.material is None]
    if bare:
        raise ValueError(
            "material must be given for a body of which some parts have none of their own, got None for "
            f"{shape!r} with {len(bare)} such pieces of {len(shape.pieces)}"
        )
    return shape.pieces[0].material


#: classes that a body may touch besides other bodies
FIXED = (HalfSpace, StaticBody)


class Ground:
    """The world as the parent of joints and forces. There is one object of this class, `carom.GROUND`."""

    index: ClassVar[int] = -1  #: in the place of that of a body
    name: ClassVar[str] = "GROUND"  #: in messages

    def __new__(cls) -> Ground:
        """Return `carom.GROUND`, the only object of the class."""
        return globals().get("GROUND") or super().__new__(cls)

    def __repr__(self) -> str:
        return "carom.GROUND"

    def __reduce__(self) -> str:  # copies and pickles give the one ground again
        return "GROUND"


GROUND = Ground()


def mass_and_inertia(shape: Shape | None, mass, density, inertia) -> tuple[float, ArrayLike]:
    """Return mass [kg] and inertia [kg m^2] of a body; the arguments are those of `Scene.add_body`."""
    if shape is not None:
        checks.instance("shape", shape, SHAPES)
    mass = _mass(shape, mass, density)
    if inertia is None:
        if shape is None:
            raise ValueError("inertia must be given for a body without a shape, got None")
        inertia = shape.inertia(mass)
    return mass, inertia


def _mass(shape: Shape | None, mass, density) -> float:
    if (mass is None) == (density is None):
        raise ValueError(
            f"exactly one of mass and density must be given, got mass={checks.shown(mass)}, "
            f"density={checks.shown(density)}"
        )
    if density is None:
        if isinstance(mass, (float, np.floating)) and mass == np.inf:
            raise ValueError(
                "mass must be finite, got inf; for a body that never moves use add_static"
            )
        return checks.mass("mass", mass)
    density = checks.number("density", density, above=0, unit="kg/m^3")
    if shape is None:
        raise ValueError(
            f"density needs a shape, got density={checks.shown(density)} without one; give mass"
        )
    if not shape.volume > 0.0:
        raise ValueError(
            f"density needs a shape with a volume, got {checks.shown(shape)}; give mass"
        )
    return checks.mass("density times the volume", density * shape.volume)


def inertia_matrix(value) -> np.ndarray:
    """Return the inertia (3,3) [kg m^2] given by principal moments (3,) or a symmetric (3,3).

    Raises
    ------
    ValueError
        If the inertia is not symmetric, not positive definite, or one principal moment exceeds the sum of
        the other two: no mass distribution has such an inertia.
    """
    shape = checks.real_array("inertia", value, "(3,) or (3, 3)").shape
    if len(shape) == 2:
        matrix = checks.finite_array("inertia", value, (3, 3), unit="kg m^2")
    elif len(shape) == 1:
        matrix = np.diag(checks.finite_array("inertia", value, (3,), unit="kg m^2"))
    else:
        raise ValueError(
            f"inertia must have shape (3,) or (3, 3) [kg m^2], got {checks.shown(value)}"
        )
    if not np.max(np.abs(matrix - matrix.T)) <= SLACK * np.max(np.abs(matrix)):
        raise ValueError(f"inertia must be symmetric, got {checks.shown(value)}")
    if not np.max(np.abs(matrix)) <= GREATEST:
        raise ValueError(
            f"inertia must be at most {GREATEST:g} [kg m^2], so that sums are finite, got {checks.shown(value)}"
        )
    matrix = 0.5 * (matrix + matrix.T)
    small, middle, large = np.linalg.eigvalsh(matrix)
    positive, possible = small > SLACK * large, large <= (small + middle) * (1 + SLACK)
    if positive and possible:
        return matrix
    moments = f"got {value!r} with principal moments {small:.6g}, {middle:.6g}, {large:.6g}"
    if not positive:
        raise ValueError(
            f"inertia must have principal moments above 0 [kg m^2], {moments}; "
            "for a thin rod give a small positive moment about its axis"
        )
    raise ValueError(
        f"inertia must have no principal moment above the sum of the other two, {moments}"
    )
