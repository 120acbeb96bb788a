"""The laws of a scene as one table: a contact, a stop, a joint, a coordinate carries the number of its law."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Any, NamedTuple

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom.model.pieces import Pieces
from carom.scene.friction import bound_of
from carom.scene.materials import IMPACT_LAWS, MULTIPLE, ContactLaw
from carom.scene.speed_law import SpeedLaw
from carom.scene.stiffness import Hertz

#: which of the two laws of a contact is in force: its friction may differ
STRIKES, PERSISTENT = range(2)
#: the speed that a coefficient is a function of: friction of the slip, restitution of the approach
SLIP, APPROACH = range(2)

LAW = [
    ("friction", "f8"),  # mu; where it depends on the slip, what bounds stick
    ("restitution", "f8"),  # e; NaN where it depends on the approach
    # by SLIP and APPROACH: range of the pieces of a coefficient over speed^exponent, empty for a number
    ("first", "i8", 2),
    ("last", "i8", 2),
    ("exponent", "f8", 2),
    ("turning", "f8", 2),  # rolling and pivoting friction [m]
    ("tangential_restitution", "f8"),
    ("impact_law", "i8"),  # of `carom.law.impact_laws`
    ("multiple", "i8"),  # 1: its pair has impacts of its own, one after another
    ("stiffness", "f8"),  # of the boundary layer, relative to others
    ("adhesion", "f8"),  # force that holds the pair together [N]
]


class Laws(NamedTuple):
    """The laws of a scene."""

    table: np.recarray  # (L,) LAW
    pieces: np.recarray  # PIECE, of coefficients that depend on speeds


def law_of(system, contacts: np.recarray, which: int = STRIKES) -> np.recarray:
    """Return the laws (C,) of contacts, in impacts or in persistent contact."""
    return system.laws.table[contacts["law"][..., which]]


def with_slip(laws: np.recarray) -> np.ndarray:
    """Return whether the friction of laws depends on the slip."""
    return laws["last"][..., SLIP] > laws["first"][..., SLIP]


class LawTable:
    """The laws of a scene, which are added one by one."""

    def __init__(self):
        self.stiffest = 0.0  # greatest modulus, where all pairs have Hertz's law [Pa]
        self.rows: list[tuple] = []
        self.pieces = Pieces()
        self._known: dict[Hashable, int] = {}

    def add(self, friction: float | SpeedLaw, restitution: float | SpeedLaw = 0.0, **other) -> int:
        """Add a law; return its number.

        `other` are columns of `LAW` from `turning` on, and `length`: speeds of approach are this multiple of
        those that the law of restitution is stated for (1 by default).
        """
        length = other.pop("length", 1.0)
        slip, approach = self.pieces.add_law(friction), self.pieces.add_law(restitution, length)
        e = np.nan if isinstance(restitution, SpeedLaw) else restitution
        row = {
            "turning": (0.0, 0.0), "tangential_restitution": 0.0, "impact_law": 0, "multiple": 0,
            "stiffness": 1.0, "adhesion": 0.0, **other,
        }  # fmt: skip
        self.rows.append((bound_of(friction), e, *zip(slip, approach), *row.values()))
        return len(self.rows) - 1

    def add_pair(self, law: ContactLaw) -> int:
        """Add the law of a pair in impacts, then that in persistent contact; return the first number."""
        other: dict[str, Any] = {
            "turning": (law.rolling_friction, law.pivoting_friction),
            "tangential_restitution": law.tangential_restitution,
            "impact_law": IMPACT_LAWS.index(law.impact_law), "multiple": MULTIPLE.index(law.multiple),
            "stiffness": self._stiffness(law), "adhesion": law.adhesion,
        }  # fmt: skip
        first = self.add(law.friction, law.restitution, **other)
        self.add(law.friction_held, law.restitution, **other)
        return first

    def _stiffness(self, law: ContactLaw) -> float:
        """Return the stiffness relative to others: of the moduli where all pairs have Hertz's law."""
        if self.stiffest > 0.0 and isinstance(law.stiffness, Hertz):
            return law.stiffness.modulus / self.stiffest
        return law.relative_stiffness

    def add_once(self, key: Hashable, law: ContactLaw) -> int:
        """Add the law of a pair, unless there is one by this key; return its first number."""
        if key not in self._known:
            self._known[key] = self.add_pair(law)
        return self._known[key]

    def arrays(self) -> Laws:
        """Return the table, and the pieces of its coefficients."""
        return Laws(law_rows(self.rows), self.pieces.rows)

    def grown(self, laws: Laws) -> Laws:
        """Return laws with those that have been added since."""
        if len(self.rows) == len(laws.table):
            return laws
        more = law_rows(self.rows[len(laws.table) :])
        return laws._replace(table=np.concatenate([laws.table, more]).view(Columns))


def law_rows(rows: Sequence[tuple]) -> np.recarray:
    """Return records of laws, from tuples of their columns."""
    made = table(LAW, len(rows))
    for name, values in zip([column[0] for column in LAW], zip(*rows)):
        made[name] = values
    return made
