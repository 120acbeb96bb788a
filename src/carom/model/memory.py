"""What a run changes of the relations of a scene: all other tables of a model are only read (a test)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

#: an active point: a point of persistent contact, over time (see `carom.persistent`)
ACTIVE_POINT = [
    ("contact", "i8"),
    ("feature", "i8"),  # stays the same as long as the same parts touch: number of the vertex
    ("body", "i8"),  # of the contact
    ("other", "i8"),
    ("fixed", "i8"),  # 1 if it stays where it is on the body: a vertex
    ("found", "i8"),  # 1 if it is found anew in each state
    ("mode", "i8"),  # 0 open, 1 slipping, 2 sticking
    ("next", "i8"),  # mode after the trial step
    ("comes_to_rest", "i8"),  # 1 if that step puts the body to rest
    ("shares", "i8"),  # 1 if it shares its bodies with other active points
    ("rest", "i8"),  # 1 if the body does not move at all
    ("jams", "i8"),  # 1 if it slips and no finite force keeps it closed
    ("point", "f8", 3),  # point of the core that carries the contact, body axes
    ("anchor", "f8", 3),  # its position in the world since it sticks
    # of the last solve, contact axes; the normal one with its part of an adhesion, and this part
    ("force", "f8", 3),
    ("pull", "f8"),
    ("heading", "f8", 2),  # direction of slip at the start of the step, or of starting slip
    ("speed", "f8"),  # of slip at the start of the step
    # of rolling and pivoting: direction and speed at the start of the step
    ("turning", "f8", (2, 3)),
    ("stop", "f8"),  # for several points: time until slip stops under the last forces
    ("lift", "f8"),  # for several points: margin before opening at the end of a step, below 0: open
    ("grip", "f8"),  # the same before slip
    # with given steps: least part of a slip or turn left at the end, below 0 beyond its stop
    ("left", "f8"),
    ("began", "f8"),  # speed of slip at the start of the step
    # margin before the slip passes a kink of its law, at start and end of the step: below 0 if it has passed
    ("kink", "f8", 2),
    ("due", "i8"),  # 1 if the event of the search may be its own, too
    ("turn_stop", "f8", 2),  # as `stop`, of rolling and of pivoting
    # time that bounces left out would still take: rolling and pivoting friction begin at its end
    ("bounces", "f8"),
    ("torque", "f8", 3),  # of rolling and pivoting friction, contact axes
    ("W", "f8", (3, 3)),  # effective inverse mass of the last solve
    # `stop` with both `turn_stop` at the start of the step
    ("first_stop", "f8", 3),
    # normal at the start of the step and its owner; 1 if the point passes an edge in the step
    ("normal", "f8", 3),
    ("owner", "i8"),
    ("passes", "i8"),
]

#: a coordinate of a joint over time
TURN_OF_JOINT = [
    ("reference", "f8"),  # its value at the start of the trial step, with whole turns
]

#: a spring of the implicit step
STRETCH = [
    ("speed", "f8"),  # rate of its length in the last stage; after a step, for its work
    ("gain", "f8"),  # second derivative of its length in the last stage
]

#: the foot on a curve: the point nearest to that of a joint, in the last state that was asked for, world axes
FOOT = [
    ("x", "f8", 3),  # last place on the curve, in axes of its body; derivatives by the coordinate
    ("slope", "f8", 3),
    ("second", "f8", 3),
    ("s", "f8"),  # coordinate of the foot
    ("along", "f8", 3),  # direction in which it grows as the child moves relative to the parent
    ("normal", "f8", (2, 3)),
    ("gap", "f8", 2),  # position of the child beside the parent, along both normals
    ("bend", "f8", 2),  # curvature of its path, along both normals
    ("ahead", "f8"),  # 1 - curvature vector . gap: rate along the curve = speed / ahead
]


class Memory(NamedTuple):
    """What changes in a run and belongs to a row of `Relations` with the same number."""

    coordinates: np.recarray  # (C,) TURN_OF_JOINT
    frictions: (
        np.recarray
    )  # (F,) ACTIVE_POINT: mode to kink, and the friction as the force in row t1
    stiff: np.recarray  # STRETCH
    rates: np.ndarray  # of rotors: q' that each keeps, stored before the bodies move
    feet: np.recarray  # FOOT, of curves
    read: np.ndarray  # arguments of the user's functions
    write: np.ndarray  # and results
