"""Bodies that move, and the ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks, fields
from carom.fields import Number, Value, Vector, keep
from carom.flexible.modes import Modes
from carom.geometry.attitude import attitude
from carom.scene.flexible_bodies import add_modes, of_modes
from carom.scene.look import Look, checked_look
from carom.scene.materials import Material
from carom.scene.shapes import SHAPES, Shape
from carom.scene.shapes.mesh import shape_given
from carom.scene.solids import FIXED as FIXED
from carom.scene.solids import HalfSpace as HalfSpace
from carom.scene.solids import Solid, whole_material
from carom.scene.solids import StaticBody as StaticBody
from carom.scene.values import MethodsOfScene, in_scene

if TYPE_CHECKING:
    from carom.geometry.attitude import Orientation
    from carom.scene.scene import Scene

SLACK = 1e-12  # relative to the largest entry or moment: rounding, not physics
GREATEST = 1e300  # [kg m^2]: sums are finite


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class Body(Solid):
    """A rigid body with its initial state. `Scene.add_body` makes it; arrays are read-only.

    Attributes
    ----------
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
    look : tuple of Look or None
        What is seen of it; None: its shape.
    modes : Modes or None
        Its modes; None: it is rigid.
    """

    shape: Shape | None
    mass: Number = Value(checks.mass)
    inertia: Vector = Value(lambda _, value: inertia_matrix(value))
    position: Vector = fields.vector()
    orientation: Value[np.ndarray, Any] = Value(attitude)
    velocity: Vector = fields.vector()
    angular_velocity: Vector = fields.vector()
    _: KW_ONLY
    look: Value[tuple[Look, ...] | None, Any] = Value(checked_look, None)
    modes: Value[Modes | None, Any] = Value(
        lambda name, value: checks.instance(name, value, (Modes,)), None
    )

    def __post_init__(self):
        if self.shape is not None:
            checks.instance("shape", self.shape, SHAPES)
            keep(self, material=whole_material(self.shape, self.material))

    def __repr__(self) -> str:
        return f"Body({self.name!r}, {self.shape!r}, mass={self.mass:g})"


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
            f"density={checks.shown(density)}{'; or modes, with a mass' if mass is None else ''}"
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


class SceneBodies(MethodsOfScene):
    """The methods of `Scene` for bodies."""

    @arguments.known
    def add_body(
        self,
        shape: Shape | None = None,
        *,
        mass: float | None = None,
        density: float | None = None,
        inertia: ArrayLike | None = None,
        position: ArrayLike = (0.0, 0.0, 0.0),
        orientation: Orientation = (1.0, 0.0, 0.0, 0.0),
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
        material: Material | None = None,
        color: str | ArrayLike | None = None,
        look: Shape | Look | Sequence[Shape | Look] | None = None,
        modes: Modes | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Body:
        """Add a rigid body, or one that bends by its `modes`.

        Parameters
        ----------
        shape
            `Sphere`, `Box`, `Capsule`, `Cylinder`, `Disc`, `Ellipsoid`, `Convex`, `Mesh`,
            `Profile` or `Compound`; or an object of trimesh, as a `Mesh`. A body without a shape cannot touch
            anything.
        mass, density
            Exactly one of the two, above 0: the mass [kg], or the density of the shape [kg/m^3].
        inertia : (3,) or (3, 3)
            Inertia about the mass centre [kg m^2]: principal moments along the body axes, or the symmetric
            matrix in body axes. Default: the inertia of the solid shape. A body without a shape needs it.
        position : (3,)
            Initial position of the mass centre, in the world [m].
        orientation : (4,), (3, 3) or scipy.spatial.transform.Rotation
            Initial orientation, body to world: a unit quaternion (w, x, y, z) with the scalar first, a rotation
            matrix, or a SciPy Rotation. `carom.euler` and `carom.axis_angle` compute quaternions from angles in
            degrees. A small error of normalisation (below 1e-3), as in (0.7071, 0, 0, 0.7071), is corrected.
        velocity : (3,)
            Initial velocity of the mass centre, in world axes [m/s].
        angular_velocity : (3,)
            Initial angular velocity, in world axes [rad/s].
        material
            Material of its surface, see `set_contact_default`.
        color : str or (3,)
            Colour in pages, pictures and films: a colour name of matplotlib (``"tab:red"``, ``"gold"``),
            ``"#rrggbb"``, or red, green and blue from 0 to 1. Default: a colour of the palette.
        look : Look, shape, or sequence of them
            What pages, pictures, films and exports show in place of the shape. It touches nothing. Default: the
            shape. An empty sequence: nothing is seen.
        modes : Modes, optional
            Modes of a free flexible body (`carom.flexible`), with its mass and inertia: then mass, density and
            inertia must be left out. The body flies, rings, strikes and rests; it touches at the corners, or
            the curved parts, of its shape, and no joint or force acts on it. Bodies after it in
            `bodies`, named ``"NAME modes 1-3"`` and so on, stand for its modes, three each. Default: rigid.
        name
            Name in the scene. A cube with "die" in its name is drawn with pips. Default ``"body1"``,
            ``"body2"``, ...
        replace : bool
            True: a body that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.

        Raises
        ------
        ValueError
            If an argument is outside its range, no rigid body can have the inertia, or another part has the
            name.

        Examples
        --------
        >>> scene = carom.Scene()
        >>> die = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3), name="die")
        >>> print(die.inertia[0].round(12))  # m a^2 / 6
        [1.066667e-06 0.000000e+00 0.000000e+00]
        >>> scene.add_body(carom.Sphere(0.1), mass=-1.0)
        Traceback (most recent call last):
            ...
        ValueError: mass must be finite and above 0 [kg], got -1.0
        """
        shape = shape_given(shape)
        if modes is not None:
            given = {"mass": mass, "density": density, "inertia": inertia}
            mass, inertia = of_modes(modes, shape, given, replace)
        mass, inertia = mass_and_inertia(shape, mass, density, inertia)
        body = self._parts.make(
            Body, "body", name, replace, shape=shape, mass=mass, inertia=inertia, position=position,
            orientation=orientation, velocity=velocity, angular_velocity=angular_velocity,
            material=material, color=color, look=look, modes=modes,
        )  # fmt: skip
        if modes is not None:
            add_modes(self._parts, body, modes, cast("Scene", self).gravity)
        return body

    @property
    def bodies(self) -> tuple[Body, ...]:
        """Bodies, in the order in which they were added."""
        return self._parts.parts(Body)
