"""Results of a run: the solution, its tables, its energy ledger, and its states between saved times."""

from carom.results.event_tables import (
    ContactTable,
    EventTable,
    ForceTable,
    ImpactRecord,
    ImpactTable,
)
from carom.results.ledger import Ledger
from carom.results.state import BodyState, SystemState

__all__ = [
    "BodyState",
    "ContactTable",
    "EventTable",
    "ForceTable",
    "ImpactRecord",
    "ImpactTable",
    "Ledger",
    "SystemState",
]
