"""Stops in joints as rows of contacts, after those of bodies."""

from __future__ import annotations

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom.model.arrays import CONTACT, KIND_STOP
from carom.model.more_forces import RESTITUTION, Pieces
from carom.model.relations import Elements
from carom.model.thresholds import DIRECTION
from carom.scene.friction import bound_of
from carom.scene.materials import IMPACT_LAWS


def with_stops(scene, contacts: np.recarray, elements: Elements, options, curves: Pieces):
    """Return the contacts, then the stops; the numbers of stops follow those of contacts."""
    if not scene.stops:
        return contacts
    _check_twists(scene)
    rows, first = table(CONTACT, len(scene.stops)), int(contacts.number.max(initial=-1)) + 1
    for row, stop in zip(rows, scene.stops):
        number = elements.coordinates.number(stop.joint, stop.coordinate)
        c = elements.coordinates.rows[number][0]
        row.number, row.solid, row.kind = first + stop.index, number, KIND_STOP
        row.body, row.other = (c.child, c.parent) if c.child >= 0 else (c.parent, -1)
        size = elements.sizes[stop.joint.child.index]
        row.side = stop.side * (size if stop.turns else 1.0)
        row.offset = row.side * stop.end
        row.law = IMPACT_LAWS.index(stop.impact_law)
        for name, value in zip(
            RESTITUTION, curves.add_restitution(stop.restitution, abs(row.side))
        ):
            row[name] = value
        row.extent = row.other_extent = size
        row.first, row.last, row.stiffness = 0, 1, 1.0
        if stop.joint.can_be_left:
            _write_rail(row, stop.joint, curves)
    rows.still = 1e-14 * np.sqrt(np.linalg.norm(scene.gravity) * rows.extent)
    for row, stop in zip(rows, scene.stops):
        if stop.joint.can_be_left:  # its direction is that of the table of the curve
            fall = np.linalg.norm(scene.gravity) * stop.joint.definition.curve.length
            row.still = DIRECTION * (np.sqrt(fall) + np.linalg.norm(stop.joint.child.velocity))
    rows.width = 1e-5 * rows.extent if options.layer_width is None else options.layer_width
    rows.penetration = options.penetration
    return np.concatenate([contacts, rows]).view(Columns)


def _check_twists(scene) -> None:
    """Refuse a limit of a twist without one of the swing: where the swing is pi, a twist has no value."""
    swings = [stop.joint for stop in scene.stops if stop.coordinate == "swing"]
    for stop in scene.stops:
        if stop.coordinate == "twist" and stop.joint not in swings:
            raise ValueError(
                f"stop {stop.name!r} of the twist of {stop.joint.name!r} must come with a stop of its "
                '"swing", got none: where the swing is pi, a twist has no value'
            )


def _write_rail(row, joint, curves: Pieces) -> None:
    """Write the size and the friction of a rail that can be left, in impacts and in persistent contact."""
    d = joint.definition
    row.extent = row.other_extent = max(row.extent, np.ptp(d.curve.ends[:, 0], axis=0).max())
    row.friction = row.friction_held = bound_of(d.friction)
    names = "friction_piece", "last_friction_piece", "friction_exponent"
    for name, value in zip(names, curves.add_law(d.friction)):
        row[name][:] = value
