"""The parameters of a derivative: their names, and the changes of the start that each of them makes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.scene.bodies import Body
from carom.scene.contacts import Contact
from carom.studies.gradient.body import MOMENTS, UNITS

VECTORS = ("position", "orientation", "velocity", "angular_velocity")
AXES = ("x", "y", "z")
OF_BODY = (*VECTORS, "mass", "inertia")
OF_CONTACT = ("restitution", "friction")
OF_SCENE = ("gravity", *OF_CONTACT)


@dataclass(frozen=True, eq=False)
class Parameters:
    """P parameters, and the changes of the scene by one unit of each.

    Attributes
    ----------
    labels : tuple of str
        Labels of the columns: ``"die.velocity.x"``, ``"die-ground.friction"``, ...
    columns : dict of str to slice or int
        Columns of each name: a slice for a name with components, otherwise an index.
    start : (N, 12, P)
        Changes of the initial state: position, rotation vector, velocity, angular velocity, in world axes.
    mass : (N, P)
        Changes of masses.
    inertia : (N, 3, 3, P)
        Changes of inertias, in principal axes.
    restitution, friction : (C, P)
        Changes of the values of contacts, by their numbers.
    gravity : (3, P)
        Changes of gravity.
    """

    labels: tuple[str, ...]
    columns: dict[str, slice | int]
    start: np.ndarray
    mass: np.ndarray
    inertia: np.ndarray
    restitution: np.ndarray
    friction: np.ndarray
    gravity: np.ndarray


def make_parameters(scene, names, contacts: int, to_principal: np.ndarray) -> Parameters:
    """Return the parameters of a scene with these `names`.

    `contacts` is the number of its pairs, including default pairs; `to_principal` (N, 4) turns principal axes
    to the axes of the scene's bodies.
    """
    if isinstance(names, str):
        names = (names,)
    names = tuple(checks.listed("with_respect_to", names, "names"))
    if not names:
        raise ValueError("with_respect_to must have at least one parameter, got none")
    parts = [_parts(scene, name) for name in names]
    labels, columns = [], {}
    for name, (_, _, components, _) in zip(names, parts):
        if name in columns:
            raise ValueError(
                f"with_respect_to must have each parameter once, got {checks.shown(name)} twice"
            )
        at = len(labels)
        labels += [f"{name}.{c}" for c in components] or [name]
        columns[name] = slice(at, len(labels)) if components else at
    N, P = len(scene.bodies), len(labels)
    made = Parameters(
        tuple(labels), columns, np.zeros((N, 12, P)), np.zeros((N, P)), np.zeros((N, 3, 3, P)),
        np.zeros((contacts, P)), np.zeros((contacts, P)), np.zeros((3, P)),
    )  # fmt: skip
    for name, (part, field, _, only) in zip(names, parts):
        _write(made, part, field, columns[name], to_principal, only)
    return made


def _parts(scene, name: str):
    """Return (part of the scene or None, field, components, the one of them that is meant or all) of a name."""
    checks.text("each name in with_respect_to", name)
    part, _, field = name.rpartition(".")
    if field in (*AXES, *MOMENTS) and part:
        of, own, components, _ = _parts(scene, part)
        if not components:
            raise ValueError(
                f"with_respect_to must end at {part!r}, a number, got {checks.shown(name)}"
            )
        checks.choice(f"what follows {part!r} in with_respect_to", field, components)
        return of, own, (), components.index(field)
    if not part:
        checks.choice("a name in with_respect_to", field, OF_SCENE)
        return None, field, AXES if field == "gravity" else (), slice(None)
    try:
        found = scene[part]
    except KeyError as error:
        raise ValueError(f"with_respect_to: {error.args[0]}, got {checks.shown(name)}") from None
    if isinstance(found, Body):
        checks.choice(f"what follows {part!r} in with_respect_to", field, OF_BODY)
        components = AXES if field in VECTORS else tuple(MOMENTS) if field == "inertia" else ()
        return found, field, components, slice(None)
    if isinstance(found, Contact):
        checks.choice(f"what follows {part!r} in with_respect_to", field, OF_CONTACT)
        return found, field, (), slice(None)
    raise ValueError(
        "with_respect_to must have fields of bodies or contacts, as in 'die.velocity', "
        f"'die-ground.friction', or one of {', '.join(OF_SCENE)}, got {checks.shown(name)}"
    )


def _write(made: Parameters, part, field, columns, to_principal, only) -> None:
    """Write the changes by the parameters of one name; `only` are the components that it has."""
    if field == "gravity":
        made.gravity[:, columns] = np.eye(3)[:, only]
    elif field in OF_CONTACT:
        which = slice(None) if part is None else part.index
        getattr(made, field)[which, columns] = 1.0
    elif field == "mass":
        made.mass[part.index, columns] = 1.0
    elif field == "inertia":
        R = quaternion.matrix(to_principal[part.index])
        made.inertia[part.index, :, :, columns] = np.moveaxis(R.T @ UNITS @ R, 0, -1)[..., only]
    else:
        row = 3 * VECTORS.index(field)
        made.start[part.index, row : row + 3, columns] = np.eye(3)[:, only]
