"""What all forces have: the table of their kind, and the rows of it that state one to kernels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

if TYPE_CHECKING:
    from carom.scene.forces import AppliedForce


class ForceTable(NamedTuple):
    """The rows of a kind of forces, as kernels read them.

    Columns of the names `BODIES` are numbers of bodies, -1 for the ground, and `coordinate` is that of one:
    islands number them anew (`carom.model.clusters`). `first` to `last` are the bodies of a function, and
    `address` is a function, which may change with time: what it acts on does not sleep.
    """

    name: str  #: of its field in `System.forces`, and of its file in `carom.dynamics.applied`
    columns: list[Any]
    #: whether its kernels are loaded by scenes that have coordinates of joints, or rows of such a table, only
    apart: bool = True
    settable: tuple[str, ...] = ()  #: columns that a run may set between two steps


BODIES = ("parent", "child", "body", "frame")
#: columns of what acts between points of two bodies
ENDS: list[Any] = [
    ("parent", "i8"), ("child", "i8"), ("parent_anchor", "f8", 3), ("child_anchor", "f8", 3),
]  # fmt: skip


@dataclass(frozen=True, eq=False)
class ForceDefinition:
    """Base class of forces: what the scene's arrays, reports and methods ask of them."""

    #: None for what acts through the rows of joints: dry friction and inertia along a coordinate
    table: ClassVar[ForceTable | None] = None
    #: whether it may have kinks or jumps, as a function of time or of the motion
    has_kinks: ClassVar[bool] = False
    #: unit of its value along a line or a coordinate; "" if it has none
    value_unit: ClassVar[str] = ""

    def _rows(self, force: AppliedForce, arrays: Any) -> list[dict[str, Any]]:
        """Return the rows of a force of the scene, by column: both bodies, and fields of the same names.

        `arrays` (`carom.model.forces.ForceRows`) has points and axes of bodies, coordinates, functions and
        curves as kernels know them.
        """
        assert self.table is not None
        ends = {"parent": force.parent.index, "child": force.child.index}
        names = [column[0] for column in self.table.columns]
        return [{name: ends[name] if name in ends else getattr(self, name) for name in names}]
