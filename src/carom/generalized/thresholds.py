"""Thresholds of systems in coordinates: located events, contacts that stay active, the turn of slip."""

#: tangent of the angle: by which slip turns in a given step at most (15 degrees: of steps of .02 to .2 s of
#: pucks and sleds none is off by more than 1e-3 m; 3e-3 m with 30 degrees, 1e-2 m with 60)
SLIP_TURN = 0.268
REVERSAL = 0.01  #: tangent of the angle: by which slip that stops, and is located, may miss its opposite
SHORTEST_GIVEN = 2.0**-12  #: a given step: it is halved no further
LEFT_OF_STEP = 1e-13  #: a given step: a rest that is round-off of the time
AT_ONE_INSTANT = 1e-10  #: a given step: events closer in time are at one instant
RETURN_ERROR = 1e-11  #: greatest coordinate: residual of a return map, beyond the round-off of its arc
RETURN_GOAL = 1e-14  #: greatest coordinate: residual at which its iteration ends
SYSTEM_DROP = 1e-8  #: greatest singular value: below it constraints depend on others (`Options.drop_tolerance`)
GAP_ERROR = 1e-15  #: terms of the gap: its round-off
CONE_ERROR = 1e-12  #: greatest normal force: round-off of a force, which is a result of elimination
CONE_PART = 1e-10  #: bound of friction: by which a force is within it
COORDINATE_UNIT = 1e-9  #: unit of a coordinate: its least size for tolerances: in the origin there is no other
METRIC_PIVOT = 1e-15  #: diagonal of the metric: a pivot that is round-off
SYMMETRY = 1e-12  #: greatest entry of the metric: its asymmetry by round-off
TIME_ERROR = 1e-14  #: duration: so near to an event, it is not known on which side of it
STILL_COORDINATE = 1e-12  #: speeds of a contact: a relative velocity that is round-off
DRAW = 1e-12  #: acceleration by loads and curvature, times the root of W_nn: least that keeps a contact active
#: the same: by which what others keep closed, the fourth leg of a table, may leave: round-off has located it
CLOSED_DRAW = 1e-9
PRESSED = 1e-12  #: greatest acceleration: normal acceleration of an active contact without force
REVERSED_PART = 1e-3  #: a step: time in which all friction removes the slip of one that reverses
INSIDE = 1e-9  #: sizes of the terms: depth of a contact at the start that is round-off
CONSTRAINT_ERROR = 1e-9  #: terms of a row: error of constraints after the return at the end of a step
ZERO_EXPRESSION = 1e-9  #: 1: value of an expression at some points, which is then zero
