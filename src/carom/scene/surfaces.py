"""Surfaces of the ground that are not planes: `Scene.add_surface` places them.

A surface is given in its own axes by a function phi(x), which is above 0 in free space and 0 on the surface.
Everything on its other side is solid. Kernels know it by its kind and numbers (`carom.collision.implicit`).
"""

from __future__ import annotations

from carom.arguments import members_of
from carom.scene.surface_definition import SurfaceDefinition
from carom.scene.values import subclasses_in

# isort: off
# The registry: a line a surface. A new one comes last.
from carom.scene.inside import InsideSphere as InsideSphere
from carom.scene.inside import InsideCylinder as InsideCylinder
from carom.scene.inside import InsideCone as InsideCone
from carom.scene.inside import InsideTorus as InsideTorus
from carom.scene.height_field import HeightField as HeightField
from carom.scene.user_surface import Surface as Surface
# isort: on

SURFACES = subclasses_in(globals(), SurfaceDefinition)
_NAMES = sorted(one.__name__ for one in SURFACES)
__getattr__ = members_of("carom.surfaces", _NAMES)


def __dir__() -> list[str]:
    return _NAMES
