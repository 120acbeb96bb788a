"""`ModalSpring`: what holds back the modes of a flexible body: springs, dampers, and no weight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from carom import arguments, checks, fields
from carom.fields import Value, Vector
from carom.scene.force_definition import ForceDefinition, ForceTable

MODAL = ForceTable(
    "modal",
    [
        ("parent", "i8"),  # the body whose modes they are
        ("child", "i8"),  # the body that stands for three of them
        ("stiffness", "f8", 3),
        ("damping", "f8", 3),
        ("weight", "f8", (3, 3)),
    ],
    apart=False,
)


@arguments.known
@dataclass(frozen=True, eq=False)
class ModalSpring(ForceDefinition):
    """The stiffness and damping of three modes of a flexible body; `Scene.add_body` makes it with ``modes=``.

    The child stands for the modes: its position (3,) are their coordinates, and gravity does not act on it.
    With its mass M each coordinate has M q'' + c q' + k q = f.

    Parameters
    ----------
    stiffness, damping : (3,)
        k [N/m] and c [N s/m] of each mode.
    weight : (3, 3)
        f = weight g, with gravity in axes of the flexible body [kg]; 0 for a free one. Default 0.
    """

    table = MODAL

    stiffness: Vector = fields.vector(unit="N/m")
    damping: Vector = fields.vector(unit="N s/m")
    weight: Value[np.ndarray, Any] = Value(
        lambda name, value: checks.finite_array(name, value, (3, 3), unit="kg"),
        ((0.0, 0.0, 0.0),) * 3,
    )
