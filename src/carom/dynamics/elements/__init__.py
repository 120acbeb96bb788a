"""Elements with rows of their own: a file for each kind, composed by number to the operations of an element.

The file of a kind has a function of the name of each operation in `carom.dynamics.element_operations` (there
with what it does) that is not the common one of such elements (`own_rows`). A new kind is a file here, its
number in `model.arrays`, and the part of a scene that makes such elements (`model.relations`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from carom._compiled.by_number import by_number
from carom._compiled.decorators import inlined
from carom.dynamics.elements import (
    chart_constraints,
    inertia,
    on_curve,
    own_rows,
    relation,
    stiff,
    user,
)
from carom.model.arrays import (
    ABSENT,
    CHART_CONSTRAINT,
    INERTIA,
    KIND,
    ON_CURVE,
    RELATION,
    STIFF,
    USER_ROWS,
)

#: a joint without rows has coordinates that stops limit, and no errors
_FILES: dict[int, Any] = {number: own_rows for joint, number in KIND.items() if joint.rows == 0}
_FILES |= dict.fromkeys(ON_CURVE, on_curve)
_FILES |= {RELATION: relation, USER_ROWS: user, STIFF: stiff, INERTIA: inertia}
_FILES |= {CHART_CONSTRAINT: chart_constraints, ABSENT: own_rows}


def by_element(joint: Callable) -> Any:
    """Decorate the form of an operation for plain joints; the result calls the form of the kind of an element.

    Its parameters have `joint`, or `system` and the number `j` of the element.
    """
    name, own = joint.__name__, []
    kind = "joint.kind" if "joint" in joint.__code__.co_varnames[:2] else "system.joints[j].kind"
    for k in range(1 + max(_FILES)):
        common = getattr(own_rows, name, None) if k in _FILES else None
        own.append(getattr(_FILES.get(k), name, common))
    return by_number(kind, joint, own, inlined)
