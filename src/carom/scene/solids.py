"""Solids that never move, half-spaces and static bodies; what they share with bodies, and with each other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks, fields
from carom.fields import Value, Vector, keep
from carom.geometry.attitude import attitude
from carom.scene.colors import hex_color
from carom.scene.flexible_bodies import add_supported
from carom.scene.materials import Material
from carom.scene.moving_surfaces import (
    GivenSpin,
    SurfaceSpin,
    SurfaceVelocity,
    check_in_plane,
    motion_in_words,
    spin_of_surface,
    velocity_of_surface,
)
from carom.scene.shapes import SHAPES, Shape
from carom.scene.shapes.mesh import shape_given
from carom.scene.surfaces import SURFACES, SurfaceDefinition
from carom.scene.values import MethodsOfScene, PartOfScene, in_scene

if TYPE_CHECKING:
    from carom.flexible.modes import Modes
    from carom.geometry.attitude import Orientation
    from carom.scene.bodies import Body


@dataclass(frozen=True, eq=False, repr=False)
class Solid(PartOfScene):
    """What bodies may touch, or what touches them: a body, a half-space or a static body.

    Attributes
    ----------
    material : Material or None
        Material of its surface.
    color : str or None
        Colour ``#rrggbb`` in pages, pictures and films. None: a colour of the palette for a body, else grey.
    """

    _: KW_ONLY
    material: Value[Material | None, Material | None] = Value(
        partial(checks.instance, kinds=(Material,)), None
    )
    color: Value[str | None, str | ArrayLike | None] = Value(hex_color, None)


@dataclass(frozen=True, eq=False, repr=False)
class Fixed(Solid):
    """A solid that never moves. Its surface may move in itself.

    Attributes
    ----------
    surface_velocity : (3,), callable or None
        Velocity with which its surface moves in itself [m/s]; see `Scene.add_static`.
    surface_spin : tuple or None
        Axis, rate [rad/s] and point, or None for that of the part, about which its surface turns in itself.
    """

    _: KW_ONLY
    surface_velocity: SurfaceVelocity = Value(velocity_of_surface, None)
    surface_spin: SurfaceSpin = Value(spin_of_surface, None)

    @property
    def moves(self) -> bool:
        """Whether its surface moves in itself."""
        return self.surface_velocity is not None or self.surface_spin is not None


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class HalfSpace(Fixed):
    """A fixed solid half-space behind a plane, such as a floor. `Scene.add_half_space` makes it.

    Attributes
    ----------
    point : (3,)
        A point of its surface, which is a plane [m].
    normal : (3,)
        Unit normal of the surface, out of the half-space into free space.
    """

    point: Vector = fields.vector()
    normal: Vector = fields.direction()

    def __post_init__(self):
        check_in_plane(self.surface_velocity, self.surface_spin, self.normal)

    def __repr__(self) -> str:
        at = f"point={self.point}, normal={self.normal}"
        return f"HalfSpace({self.name!r}, {at}{motion_in_words(self)})"


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class StaticBody(Fixed):
    """A solid that never moves: a wall, a peg, a ramp, a mesh, a bowl.

    `Scene.add_static` makes it, and `Scene.add_surface`.

    Attributes
    ----------
    shape : Sphere, Box, Capsule, Cylinder, Disc, Ellipsoid, Convex, Mesh, Profile, Compound or a surface
        A surface is one of `carom.surfaces`.
    position : (3,)
        Position of the origin of the shape, in the world [m].
    orientation : (4,)
        Unit quaternion (w, x, y, z), shape to world.
    """

    shape: Shape | SurfaceDefinition
    position: Vector = fields.vector()
    orientation: Value[np.ndarray, Any] = Value(attitude)

    def __post_init__(self):
        checks.instance("shape", self.shape, (*SHAPES, *SURFACES))
        _ = self.shape.pieces  # refused by a shape that has nothing to touch with
        keep(self, material=whole_material(self.shape, self.material))

    def __repr__(self) -> str:
        at = f"{self.shape!r}, position={self.position}"
        return f"StaticBody({self.name!r}, {at}{motion_in_words(self)})"


#: classes that a body may touch besides other bodies
FIXED = (HalfSpace, StaticBody)


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


class SceneSolids(MethodsOfScene):
    """The methods of `Scene` for solids that never move."""

    @arguments.known
    def add_half_space(
        self,
        point: ArrayLike,
        normal: ArrayLike,
        *,
        material: Material | None = None,
        color: str | ArrayLike | None = None,
        surface_velocity: ArrayLike | Callable | None = None,
        surface_spin: GivenSpin | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> HalfSpace:
        """Add a fixed solid half-space behind a plane, for example a floor.

        Parameters
        ----------
        point : (3,)
            A point of its surface, which is a plane [m].
        normal : (3,)
            Normal of the surface, out of the half-space into free space; it is normalised.
        material
            Material of its surface, see `set_contact_default`.
        color : str or (3,)
            Colour in pages, pictures and films, as for `add_body`. Default: grey.
        surface_velocity, surface_spin
            Motion of its surface in itself, as for `add_static`: a belt, a turntable. The velocity must be in
            the plane, the axis along the normal; the spin is about `point`, if no other point is given.
        name
            Name in the scene. Default ``"half_space1"``, ``"half_space2"``, ...
        replace : bool
            True: a half-space that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.
        """
        return self._parts.make(
            HalfSpace, "half_space", name, replace, point=point, normal=normal, material=material,
            color=color, surface_velocity=surface_velocity, surface_spin=surface_spin,
        )  # fmt: skip

    @arguments.known
    def add_static(
        self,
        shape: Shape,
        *,
        position: ArrayLike = (0.0, 0.0, 0.0),
        orientation: Orientation = (1.0, 0.0, 0.0, 0.0),
        material: Material | None = None,
        color: str | ArrayLike | None = None,
        surface_velocity: ArrayLike | Callable | None = None,
        surface_spin: GivenSpin | None = None,
        modes: Modes | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> StaticBody | Body:
        """Add a solid that never moves: a wall, a peg, a ramp, a mesh; or one that bends on its supports.

        Bodies touch it as they touch each other. It has no mass and no degrees of freedom, and it does not
        connect the bodies that touch it to one island.

        Parameters
        ----------
        shape
            As for `add_body`.
        position : (3,)
            Position of the origin of the shape (its mass centre), in the world [m].
        orientation
            As for `add_body`.
        material
            Material of its surface, see `set_contact_default`.
        color : str or (3,)
            Colour in pages, pictures and films, as for `add_body`. Default: grey.
        surface_velocity : (3,), callable or scipy.interpolate.PPoly
            Velocity [m/s] with which its surface moves in itself while the solid stays where it is, as a belt
            does. At a contact only the tangential part acts. Or a function ``t -> (velocity, acceleration)``,
            each (3,), as that of a `Driver`, or the velocity as a piecewise polynomial with values (3,)
            (`scipy.interpolate.PPoly`, `CubicSpline`, ...).
        surface_spin : (axis, rate) or (axis, rate, point)
            Its surface turns in itself about an axis (3,) with this rate [rad/s], as those of turntables and
            rollers do, in addition to `surface_velocity`. The axis goes through `position`, or through `point`
            (3,). The rate may be a function ``t -> (rate, its derivative)`` or a piecewise polynomial. The work
            of both drives is in `Ledger.loads`, the power of each in `Solution.surface_power`.
        modes : Modes, optional
            Modes of a body on supports (`carom.flexible`), such as a beam with clamped ends. Then the result is
            a `Body` that is fixed to the ground, bends under its weight at the start, and rings when it is
            struck; its surface cannot move in itself. Default: rigid.
        name
            Name in the scene. Default ``"static1"``, ``"static2"``, ...
        replace : bool
            True: a static body that has this name is replaced, and what refers to it then refers to the new
            one. Default False: a name that is taken is refused.

        Examples
        --------
        A ball falls on a step:

        >>> scene = carom.Scene()
        >>> step = scene.add_static(carom.Box(1, 1, 0.2), position=(0, 0, 0.1), name="step")
        >>> ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 0.8), name="ball")
        >>> scene.add_contact(ball, step, restitution=0.5, friction=0.3)
        Contact('ball-step', restitution=0.5, friction=0.3, impact_law='newton')
        """
        if modes is not None:
            refused = {
                "surface_velocity": surface_velocity,
                "surface_spin": surface_spin,
                "replace": replace,
            }
            for key, value in refused.items():
                if value is not None and value is not False:
                    raise ValueError(
                        f"{key} must be left out with modes, got {checks.shown(value)}"
                    )
            place = {
                "position": position,
                "orientation": orientation,
                "material": material,
                "color": color,
            }
            return add_supported(self, shape_given(shape), modes, place, name)
        return self._parts.make(
            StaticBody, "static", name, replace, shape=shape_given(shape), position=position,
            orientation=orientation, material=material, color=color,
            surface_velocity=surface_velocity, surface_spin=surface_spin,
        )  # fmt: skip

    @arguments.known
    def add_surface(
        self,
        definition: SurfaceDefinition,
        *,
        position: ArrayLike = (0.0, 0.0, 0.0),
        orientation: Orientation = (1.0, 0.0, 0.0, 0.0),
        material: Material | None = None,
        color: str | ArrayLike | None = None,
        surface_velocity: ArrayLike | Callable | None = None,
        surface_spin: GivenSpin | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> StaticBody:
        """Add ground that is not a plane: a bowl, a pipe, a funnel, a field of heights.

        Bodies touch it as they touch static bodies, among which it is listed. It reaches as far as its
        definition says, without end; one side of it is solid.

        Parameters
        ----------
        definition
            A surface of `carom.surfaces`.
        position : (3,)
            Position of its origin, in the world [m].
        orientation
            From its axes to the world, as for `add_body`.
        material
            Material of the surface, see `set_contact_default`.
        color : str or (3,)
            Colour in pages, pictures and films, as for `add_body`. Default: grey.
        surface_velocity, surface_spin
            Motion of the surface in itself, as for `add_static`: a drum that turns.
        name
            Name in the scene. Default ``"surface1"``, ``"surface2"``, ...
        replace : bool
            True: a static body that has this name is replaced, and what refers to it then refers to the new
            one. Default False: a name that is taken is refused.

        Examples
        --------
        A ball rolls in a bowl:

        >>> scene = carom.Scene()
        >>> bowl = scene.add_surface(carom.surfaces.InsideSphere(0.5), position=(0, 0, 0.5), name="bowl")
        >>> ball = scene.add_body(carom.Sphere(0.05), mass=1, position=(0, 0, 0.05), name="ball")
        >>> scene.add_contact(ball, bowl, restitution=0.5, friction=0.3)
        Contact('ball-bowl', restitution=0.5, friction=0.3, impact_law='newton')
        """
        checks.instance("definition", definition, SURFACES)
        return self._parts.make(
            StaticBody, "surface", name, replace, shape=definition, position=position,
            orientation=orientation, material=material, color=color,
            surface_velocity=surface_velocity, surface_spin=surface_spin,
        )  # fmt: skip

    @property
    def half_spaces(self) -> tuple[HalfSpace, ...]:
        """Half-spaces, in the order in which they were added."""
        return self._parts.parts(HalfSpace)

    @property
    def statics(self) -> tuple[StaticBody, ...]:
        """Static bodies, in the order in which they were added."""
        return self._parts.parts(StaticBody)

    @property
    def fixed(self) -> tuple[HalfSpace | StaticBody, ...]:
        """Half-spaces, then static bodies: the parts that never move and that bodies may touch."""
        return (*self.half_spaces, *self.statics)
