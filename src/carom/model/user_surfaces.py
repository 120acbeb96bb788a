"""Surfaces of the user's functions: their addresses for kernels."""

from __future__ import annotations

from functools import lru_cache

from carom._compiled.user_functions import Functions
from carom.model.contacts import Contacts
from carom.scene.scene import Scene
from carom.scene.user_surface import RESULTS, Surface, joined, written


@lru_cache(maxsize=64)
def _code(surface: Surface):
    """Return the code of a surface, which is derived once."""
    return written(surface)


def write_addresses(scene: Scene, touching: Contacts, functions: Functions) -> None:
    """Write the addresses of functions to the surfaces that bodies may touch."""
    for solid in scene.statics:
        surface, place = solid.shape, touching.surfaces.place[len(scene.bodies) + solid.index]
        if not isinstance(surface, Surface) or place == 0:  # solids of a body that moves come first
            continue
        given = (3,), (RESULTS,), f"the function of the surface {solid.name!r}"
        if surface.gradient is None:
            address = functions.written(_code(surface), *given)
        else:
            address = functions.address(joined(surface), *given)
        touching.hulls.surfaces["address"][touching.solids["surface"][place]] = address
