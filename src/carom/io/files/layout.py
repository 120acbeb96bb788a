"""The layout of a file of a run: dimensions, labels, units, attributes, and the version of the layout.

Units are in UDUNITS form (``m s-1``), according to the CF conventions.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

#: version of the layout of what carom reads
FORMAT = 5
CONVENTIONS = "CF-1.11"
DOI = "10.1007/978-3-030-81166-2_44"
CITATION = (
    "S. Natsiavas, P. Passas, E. Paraskevopoulos: A Novel Time-Stepping Method for Multibody Systems with "
    f"Frictional Impacts, doi:{DOI}"
)

#: dimensions that every file has, with their labels
AXIS = ("x", "y", "z")
QUATERNION = ("w", "x", "y", "z")
CONTACT_AXIS = ("normal", "tangent1", "tangent2")
LABELS = {
    "axis": (AXIS, "axes of the world"),
    "quaternion": (QUATERNION, "components of a unit quaternion, scalar first"),
    "contact_axis": (CONTACT_AXIS, "axes of a contact"),
    "contact_axis_2": (CONTACT_AXIS, "axes of a contact, second index"),
}

#: columns of the table of impacts: dimensions beyond the first, units, meaning
IMPACT = {
    "time": ((), "s", "time of the impact"),
    "contact": ((), "1", "place of the contact among all contacts, from 0"),
    "point": (("axis",), "m", "point of contact, world axes"),
    "normal": (("axis",), "1", "unit normal from the other into the body, world axes"),
    "relative_velocity_before": (
        ("contact_axis",), "m s-1", "relative velocity before, approach negative",
    ),
    "relative_velocity_after": (("contact_axis",), "m s-1", "relative velocity after"),
    "impulse": (("contact_axis",), "N s", "impulse on the body"),
    "energy_change": ((), "J", "change of the energy of the whole system"),
    "penetration": ((), "m", "greatest penetration of the boundary layer"),
    "duration": ((), "s", "duration, NaN where no stiffness is stated"),
    "law": ((), None, "law of restitution"),
    "inverse_mass": (("contact_axis", "contact_axis_2"), "kg-1", "inverse mass W of the contact"),
    "restitution": ((), "1", "coefficient of restitution e"),
    "friction": ((), "1", "coefficient of friction mu"),
    "compression_work": ((), "J", "work of the normal force in compression"),
    "restitution_work": ((), "J", "work of the normal force in restitution"),
    "friction_loss": ((), "J", "energy lost to friction"),
    "together": ((), "1", "points that were resolved together, each with a row of its own"),
    "wedged": ((), "1", "1 if friction wedges the pair, so that its law of restitution cannot hold"),
    "located": ((), "1", "1 if the time was located, 0 if it is the end of a time-stepping step"),
    "peak_force": ((), "N", "greatest normal force, of a stop of an angle the torque [N m]; NaN if not stated"),
    "layer_duration": ((), "s", "duration in the boundary layer"),
}  # fmt: skip

EVENT = {
    "time": ((), "s", "time of the event"),
    "kind": ((), None, "impact, held, slips, sticks, opens or jams"),
    "contact": ((), "1", "place of the contact among all contacts, from 0"),
}

#: the state of all bodies at one time: for each saved time, and for each event of the user's
BODIES = {
    "position": (("body", "axis"), "m", "mass centre, world axes"),
    "orientation": (("body", "quaternion"), "1", "unit quaternion, body to world"),
    "velocity": (("body", "axis"), "m s-1", "of the mass centre, world axes"),
    "angular_velocity": (("body", "axis"), "rad s-1", "world axes"),
}
ENERGIES = {
    "kinetic_energy": ((), "J", "of all bodies"),
    "potential_energy": ((), "J", "gravity and springs"),
}
RESIDUAL = (
    "largest residual of the contact law in persistent contacts since the previous saved time"
)
MOTION = {**BODIES, **ENERGIES, "held_residual": ((), "m s-1", RESIDUAL)}

#: events that `simulate` was given: a row for each time at which one happened
USER_EVENT = {
    "index": ((), "1", "place of the event among those that simulate was given, from 0"),
    "time": ((), "s", "time of the event"),
    **ENERGIES, **BODIES,
}  # fmt: skip

#: intervals of persistent contact
INTERVAL = {
    "contact": ((), "1", "place of the contact among all contacts, from 0"),
    "feature": ((), "1", "number of the contact point; on a half-space the vertex of the shape"),
    "start": ((), "s", "start of the interval"),
    "end": ((), "s", "end of the interval"),
    "mode": ((), None, "slipping or sticking (or rolling, or at rest)"),
}

#: one row for each active point and saved time
HELD = {
    "saved": ((), "1", "place of the saved time along time, from 0"),
    "contact": ((), "1", "place of the contact among all contacts, from 0"),
    "body": ((), "1", "place of its body among all bodies, from 0"),
    "other": ((), "1", "place of the other body, -1 for a half-space"),
    "mode": ((), None, "slipping or sticking (or rolling, or at rest)"),
    "point": (("axis",), "m", "point of contact, world axes"),
    "force": (("contact_axis",), "N", "force on the body, contact axes"),
    "vector": (("axis",), "N", "force on the body, world axes"),
}

#: impulses of joints in impacts
JOINT_IMPULSE = {
    "time": ((), "s", "time of the impact"),
    "impact": ((), "1", "place of the impact in the table of impacts, from 0"),
    "joint": ((), "1", "place of the joint among all joints, from 0"),
    "impulse": (("axis",), "N s", "impulse on the child at its anchor, world axes"),
    "angular_impulse": (("axis",), "N m s", "angular impulse on the child about its anchor"),
}

LEDGER = {
    "loads": "work of loads, dampers and motors since the start",
    "impacts": "change by impacts since the start",
    "friction": "work of friction in persistent contacts since the start",
    "bounces": "energy of dropped bounces, since the start",
    "residual": "energy that no entry explains: the error of the integration",
}


class Variable(NamedTuple):
    """An array with its dimensions, unit and description."""

    name: str
    dims: tuple[str, ...]
    data: np.ndarray
    units: str | None
    long_name: str

    @property
    def attrs(self) -> dict[str, str]:
        """Attributes in the file."""
        units = {} if self.units is None else {"units": self.units}
        return {"long_name": self.long_name, **units}


def table_variables(prefix: str, dim: str, columns: dict, table) -> list[Variable]:
    """Return the columns of a table as variables named ``prefix_column``, or ``column`` without a prefix."""
    return [
        Variable(f"{prefix}_{name}".strip("_"), (dim, *dims), getattr(table, name), units, meaning)
        for name, (dims, units, meaning) in columns.items()
    ]
