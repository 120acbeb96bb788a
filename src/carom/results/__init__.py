"""Results of a run: the solution, its tables, its energy ledger, and its states between saved times."""

from carom.results.event_tables import (
    ContactTable,
    EventTable,
    ForceTable,
    ImpactRecord,
    ImpactTable,
    JointImpulse,
    JointImpulseTable,
    SwitchTable,
)
from carom.results.ledger import Ledger
from carom.results.state import SystemState
from carom.results.views.body import BodyState
from carom.results.views.contact import ContactView
from carom.results.views.force import ConstraintView, ForceView
from carom.results.views.joint import JointView

__all__ = [
    "BodyState",
    "ConstraintView",
    "ContactTable",
    "ContactView",
    "EventTable",
    "ForceTable",
    "ForceView",
    "ImpactRecord",
    "ImpactTable",
    "JointImpulse",
    "JointImpulseTable",
    "JointView",
    "Ledger",
    "SwitchTable",
    "SystemState",
]


def __dir__() -> list[str]:
    return __all__
