"""`contact_inverse_mass`: the Delassus operator of one point of a scene, with all its joints.

Constraints leave velocities, in units of 1/sqrt(mass), that are perpendicular to their rows: with the rows g
of the contact and an orthonormal basis V of those of the constraints W = f f^T, f = g - g V V^T. A rotor is a
row with the compliance 1/I (`carom.dynamics.rotors`), which is one more column of the length 1/sqrt(I).
"""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.dynamics.mobility import dense_rows, mass_matrix
from carom.dynamics.thresholds import RANK
from carom.geometry import quaternion
from carom.geometry.frames import contact_axes
from carom.geometry.thresholds import ROUND_OFF
from carom.model.relations import is_inertia
from carom.options import Options
from carom.scene.bodies import FIXED, Body
from carom.scene.scene import Scene
from carom.status import MistakeWarning


@arguments.known
def contact_inverse_mass(
    scene: Scene,
    body: Body | str,
    point: ArrayLike,
    normal: ArrayLike,
    other: Body | str | None = None,
) -> np.ndarray:
    """Return the inverse mass W of a point of a body, as `resolve_impact` takes it.

    Joints and constraints of the scene hold during an impact, so the whole mechanism is part of W; contacts and
    stops are not.

    Parameters
    ----------
    scene : Scene
        The scene, in its initial position.
    body : Body or str
        The body that is struck, or its name.
    point : (3,)
        The point where it is struck, in the world [m]. A `MistakeWarning` says if it is far outside the body.
    normal : (3,)
        Normal of the contact, towards `body`; it is normalised.
    other : Body or str, optional
        Another body at the same point, which strikes `body`; W then belongs to the relative velocity. Default:
        the partner does not move.

    Returns
    -------
    (3, 3)
        W [1/kg] in the axes normal, tangent 1, tangent 2: ``velocity_after = velocity + W impulse``. Tangent 1
        is the world axis that is least along the normal, made tangent, as for a contact with a half-space.

    Raises
    ------
    ValueError
        If the scene has no such body, or a vector is invalid.

    Examples
    --------
    A rod of 3 kg and 1 m is struck at its free end: 1/m + (l/2)^2 / (m l^2/12) = 4/m. On a hinge at the
    other end its inertia is m l^2/3, and 1/W = m/3:

    >>> scene = carom.Scene()
    >>> rod = scene.add_body(mass=3.0, inertia=(1e-9, 0.25, 0.25), position=(0.5, 0, 0), name="rod")
    >>> print(carom.contact_inverse_mass(scene, rod, point=(1, 0, 0), normal=(0, 0, 1))[0, 0].round(12))
    1.333333333333
    >>> hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, rod)
    >>> print(carom.contact_inverse_mass(scene, "rod", point=(1, 0, 0), normal=(0, 0, 1))[0, 0].round(12))
    1.0
    """
    from carom.model.compile import compile_scene

    checks.instance("scene", scene, (Scene,))
    struck = [scene._parts.member("body", body, (Body,))]
    if other is not None:
        second = scene._parts.member("other", other, (Body, *FIXED))
        if second is struck[0]:
            raise ValueError(f"other must be another part than body, got {checks.shown(other)}")
        struck += [second] if isinstance(second, Body) else []
    point = checks.finite_array("point", point, (3,), "m")
    axes = contact_axes(checks.unit_vector("normal", normal))
    shape, arm = struck[0].shape, point - struck[0].position
    if shape is not None and arm @ arm > 4.0 * shape.size**2:
        warnings.warn(
            f"point {tuple(point.tolist())} is far outside {struck[0].name!r} at "
            f"{tuple(struck[0].position.tolist())}: it is a point of the world, not of body axes",
            MistakeWarning,
            stacklevel=3,
        )

    compiled = compile_scene(scene, Options(), loops=True)
    sides = [(sign, one.index) for sign, one in zip((1.0, -1.0), struck)]
    return delassus(compiled.system, compiled.start, [(sides, point, axes)])


def delassus(system, state, points) -> np.ndarray:
    """Return W (3k, 3k) of k points of a system, compiled with its joints as loops, in a state.

    Each point is ``(sides, place, axes)``: the bodies at it with their signs, its place in the world, and its
    axes (3, 3), normal first.
    """
    from carom.model.records import new_work

    scale = 1.0 / np.sqrt(mass_matrix(system))
    g = np.zeros((3 * len(points), len(system.bodies), 6))
    for k, (sides, place, axes) in enumerate(points):
        for sign, b in sides:
            arm = np.cross(place - state.x[b], axes)
            turn = quaternion.rotate_back(np.broadcast_to(state.Q[b], (3, 4)), arm)
            g[3 * k : 3 * k + 3, b] = sign * np.hstack([axes, turn])
    g = (g * scale).reshape(len(g), -1)
    if len(system.joints):
        A, owner = dense_rows(system, state, new_work(system, 1), rotors=True)
        inertia = np.ones(len(system.joints))
        inertia[is_inertia(system.joints)] = system.relations.rotors.inertia
        soft = np.where(is_inertia(system.joints), 1.0 / np.sqrt(inertia), 0.0)[owner]
        rows = np.hstack([(A * scale).reshape(len(A), -1), np.diag(soft)])
        rows /= np.linalg.norm(rows, axis=1, keepdims=True)
        _, size, basis = np.linalg.svd(rows, full_matrices=False)
        basis = basis[size > RANK * size[0]]
        whole = np.hstack([g, np.zeros((len(g), len(A)))])
        g = whole - (whole @ basis.T) @ basis
        held = np.linalg.norm(g, axis=1) <= ROUND_OFF * np.linalg.norm(whole, axis=1)
        g[held] = 0.0
    return g @ g.T
