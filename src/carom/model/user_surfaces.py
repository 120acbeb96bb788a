"""Surfaces of the user's functions: what a run keeps of them."""

from __future__ import annotations

from carom._compiled.user_functions import Functions
from carom.model.contacts import Contacts
from carom.scene.scene import Scene
from carom.scene.user_surface import RESULTS, Surface, address_of, code_of


def add_functions(scene: Scene, touching: Contacts, functions: Functions) -> None:
    """Add the functions of surfaces, which rows of surfaces have already, to those of a run.

    Plain ones get an address of their own, at which the run learns of their errors.
    """
    for solid in scene.statics:
        surface, place = solid.shape, touching.surfaces.place[len(scene.bodies) + solid.index]
        if not isinstance(surface, Surface) or place == 0:  # solids of a body that moves come first
            continue
        code, is_written = code_of(surface)
        if is_written:
            own = address_of(surface)[0]
            functions._kept += own._kept
            functions._plainly |= own._plainly
            continue
        what = f"the function of the surface {solid.name!r}"
        address = functions.address(code, (3,), (RESULTS,), what)
        touching.hulls.surfaces["address"][touching.solids["surface"][place]] = address
