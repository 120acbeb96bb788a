"""Codes of the loop: actions on a closed point, modes of a persistent contact, and events that end a motion."""

NOTHING, STRIKE, PERSIST = range(3)
PUSHED_IN = (
    2  # `near` of a contact that a return of other points to their surfaces has pushed inside
)

MODE_OPEN, MODE_SLIP, MODE_STICK = range(3)

#: a gap closes; a point opens; friction does not suffice for stick; slip jams; the rate of a gap, and the
#: direction of slip, change sign (`carom.persistent.events`, `carom.generalized.events`)
EVENT_GAP, EVENT_SEPARATE, EVENT_CONE, EVENT_JAM, EVENT_RATE, EVENT_REVERSE, NO_EVENT = range(7)
EVENT_BREAK, EVENT_STOP = 7, 8  # a joint with friction breaks away; slip stops
EVENT_KINK, EVENT_KINK_OF_JOINT = 9, 10  # slip passes a speed at which its law has no derivatives
