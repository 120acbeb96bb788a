"""Stops in joints as rows of contacts, after those of bodies."""

from __future__ import annotations

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom.model.arrays import CONTACT
from carom.model.contact_kinds import OF_JOINT
from carom.model.laws import LawTable
from carom.model.relations import Elements
from carom.model.thresholds import DIRECTION, LAYER_WIDTH, LEAST_SPEED, STILL_SPEED
from carom.scene.coordinates import Combination, Gap
from carom.scene.materials import IMPACT_LAWS
from carom.scene.switches import is_off


def with_stops(scene, contacts: np.recarray, elements: Elements, options, laws: LawTable):
    """Return the contacts, then the stops; the numbers of stops follow those of contacts."""
    if not scene.stops:
        return contacts
    _check_twists(scene)
    stops = [stop for stop in scene.stops if not is_off(scene, stop)]
    rows, first = table(CONTACT, len(stops)), int(contacts.number.max(initial=-1)) + 1
    for row, stop in zip(rows, stops):
        number = elements.coordinates.number(stop.joint, stop.coordinate)
        if isinstance(stop.joint, Gap):  # its tangents follow
            for r in (1, 2):
                elements.coordinates.number(stop.joint, r)
        c = elements.coordinates.rows[number][0]
        row.number, row.solid, row.kind = first + stop.index, number, OF_JOINT
        row.other_solid = elements.coordinates.wrap(number)
        row.body, row.other = (c.child, c.parent) if c.child >= 0 else (c.parent, -1)
        size, arm = _sizes(stop, elements.sizes)
        row.side = stop.side * (arm if stop.turns else 1.0)
        row.offset = row.side * stop.end
        row.law[:] = laws.add(
            stop.friction, stop.restitution, impact_law=IMPACT_LAWS.index(stop.impact_law),
            tangential_restitution=stop.tangential_restitution, length=abs(row.side),
        )  # fmt: skip
        row.extent = row.other_extent = size
        row.first, row.last = 0, 1
        if stop.joint.can_be_left:
            curve = stop.joint.definition.curve  # pyright: ignore[reportAttributeAccessIssue]
            row.extent = row.other_extent = max(size, np.ptp(curve.ends[:, 0], axis=0).max())
    fall = np.sqrt(np.linalg.norm(scene.gravity) * rows.extent)
    rows.still = np.maximum(STILL_SPEED * fall, LEAST_SPEED)
    for row, stop in zip(rows, stops):
        if stop.joint.can_be_left:  # its direction is that of the table of the curve
            fall = np.linalg.norm(scene.gravity) * stop.joint.definition.curve.length
            row.still = DIRECTION * (np.sqrt(fall) + np.linalg.norm(stop.joint.child.velocity))
    rows.width = LAYER_WIDTH * rows.extent if options.layer_width is None else options.layer_width
    rows.penetration = options.penetration
    return np.concatenate([contacts, rows]).view(Columns)


def _sizes(stop, sizes: np.ndarray) -> tuple[float, float]:
    """Return the size of a stop, and the arm that converts its angle to a length.

    That of a combination is the shortest of those of its angles, each over its factor.
    """
    if isinstance(stop.joint, Gap):
        return stop.joint.size, 1.0
    if not isinstance(stop.joint, Combination):
        size = sizes[stop.joint.child.index]
        return float(size), float(size)
    own = [(sizes[one.child.index], abs(factor)) for one, _, factor in stop.joint.terms if factor]
    return max(size for size, _ in own), min(size / factor for size, factor in own)


def _check_twists(scene) -> None:
    """Refuse a limit of a twist without one of the swing: where the swing is pi, a twist has no value."""
    swings = [stop.joint for stop in scene.stops if stop.coordinate == "swing"]
    for stop in scene.stops:
        if stop.coordinate == "twist" and stop.joint not in swings:
            raise ValueError(
                f"stop {stop.name!r} of the twist of {stop.joint.name!r} must come with a stop of its "
                '"swing", got none: where the swing is pi, a twist has no value'
            )
