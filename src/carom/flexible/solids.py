"""Modes of a solid by finite elements: tetrahedra of order 2, which scikit-fem assembles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.flexible.modes import Modes
from carom.flexible.reduction import holds, lowest, reduce, rigid_body, rigid_motions
from carom.flexible.sections import material

MOST_CELLS = 100  # along an edge of a box


@arguments.known
def solid(
    shape: Any,
    density: float,
    young: float,
    poisson: float = 0.3,
    modes: int = 8,
    fixed: Callable[[np.ndarray], ArrayLike] | None = None,
    cells: int = 8,
    damping: float = 0.0,
) -> Modes:
    """Return the modes of an elastic solid, by tetrahedra with quadratic displacements.

    Needs scikit-fem: ``pip install "carom[flexible]"``.

    Parameters
    ----------
    shape
        A `Box`; or a mesh of tetrahedra: an object of meshio, a `skfem.MeshTet`, or (points (P, 3), tetrahedra
        (T, 4)).
    density : float
        [kg/m^3]
    young : float
        Young's modulus [Pa].
    poisson : float
        Poisson's ratio, above -1 and below .5. Default .3.
    modes : int
        How many, of the lowest frequencies. Default 8.
    fixed : callable, optional
        Which places (k, 3) are held: returns (k,) bool. Default: none, a free body.
    cells : int
        Of a box: number of cells along its longest edge; along others as many as make cells about cubes, at
        least 2. Default 8.
    damping : float
        Damping ratio of all modes. Default 0.

    Returns
    -------
    Modes
        About the mass centre of the solid, in the axes of the mesh. Frequencies converge from above, at best
        with the fourth power of the size of cells; near edges that are held, with less.

    Raises
    ------
    ValueError
        If an argument is outside its range, a mesh has no tetrahedra, or `fixed` does not hold the solid.
    """
    density, young = material(density, young)
    poisson = checks.number("poisson", poisson, above=-1, below=0.5)
    count, cells = (
        checks.integer("modes", modes, least=1),
        checks.integer("cells", cells, least=1, most=MOST_CELLS),
    )
    ratio = checks.number("damping", damping, least=0)
    skfem = checks.need("skfem", "flexible.solid", "flexible", "scikit-fem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = _mesh(skfem, shape, cells)
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTetP2()))
    K = skfem.asm(linear_elasticity(*lame_parameters(young, poisson)), basis)

    @skfem.BilinearForm
    def inertia(u, v, _):
        return density * sum(u[k] * v[k] for k in range(3))

    M = skfem.asm(inertia, basis)
    places = basis.doflocs[:, ::3].T  # unknowns come as x, y, z of each node
    if fixed is None:
        made = reduce(M, K, nodes=places, modes=count)
    else:
        checks.function("fixed", fixed)
        held = np.asarray(checks.call("fixed", fixed, places), dtype=bool)
        if held.shape != (len(places),):
            raise ValueError(
                f"fixed must return (k,) bool for places (k, 3), got {held.shape} for {places.shape}"
            )
        if held.all() or not holds(places[held]):
            raise ValueError(
                "fixed must hold three places or more that are not on one line, and not all of them, "
                f"got {held.sum()} of {len(held)}"
            )
        made = _held(M, K, places, held, count)
    return Modes(
        made.frequencies, ratio, made.mass, made._at, inertia=made.inertia, supported=made.supported,
        participation=made.participation,
    )  # fmt: skip


def _held(M, K, places, held, count: int) -> Modes:
    """Return the modes with some nodes held; mass and inertia are those of the whole."""
    free = np.flatnonzero(np.repeat(~held, 3))
    mass, centre, inertia = rigid_body(M, places)
    square, vectors = lowest(M[free][:, free], K[free][:, free], count)
    moved = np.zeros((M.shape[0], len(square)))
    moved[free] = vectors
    moved /= np.sqrt(np.einsum("ik,ik->k", moved, M @ moved))
    loads = (M @ rigid_motions(places)[:, :3]).T @ moved
    return Modes(
        np.sqrt(square) / (2.0 * np.pi), 0.0, mass, (places - centre, moved.reshape(len(places), 3, -1)),
        inertia=inertia, supported=True, participation=loads,
    )  # fmt: skip


def _mesh(skfem, shape, cells: int):
    """Return a mesh of tetrahedra."""
    if all(hasattr(shape, edge) for edge in ("lx", "ly", "lz")):
        size = np.array([shape.lx, shape.ly, shape.lz])
        n = np.maximum(np.rint(cells * size / size.max()).astype(int), 2)
        lines = [np.linspace(-0.5 * a, 0.5 * a, k + 1) for a, k in zip(size, n)]
        return skfem.MeshTet.init_tensor(*lines)
    if isinstance(shape, skfem.MeshTet):
        return shape
    if hasattr(shape, "points") and hasattr(shape, "cells_dict"):
        tets = shape.cells_dict.get("tetra")
        if tets is None:
            raise ValueError("shape must be a mesh of tetrahedra, got one without any")
        shape = (shape.points, tets)
    if isinstance(shape, (tuple, list)) and len(shape) == 2:
        points = checks.real_array("shape[0]", shape[0], "(P, 3)")
        points = checks.finite_array("shape[0]", points, (len(points), 3), "m")
        return skfem.MeshTet(points.T, np.asarray(shape[1], dtype=np.int64).T)
    raise ValueError(
        "shape must be a Box, or a mesh of tetrahedra (meshio, skfem, points and cells), "
        f"got {checks.shown(shape)}"
    )
