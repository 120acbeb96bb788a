"""Results of a run: the solution, its tables, its energy ledger, and its states between saved times."""

from carom.results.event_tables import ContactTable as ContactTable
from carom.results.event_tables import EventTable as EventTable
from carom.results.event_tables import ForceTable as ForceTable
from carom.results.event_tables import ImpactRecord as ImpactRecord
from carom.results.event_tables import ImpactTable as ImpactTable
from carom.results.ledger import Ledger as Ledger
from carom.results.state import BodyState as BodyState
from carom.results.state import SystemState as SystemState
