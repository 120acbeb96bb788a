"""Thresholds of dynamics: lengths of steps, dependent rows, edges that are passed."""

SAFETY = 0.9  #: the length whose error would equal the tolerance: length of the next step
LEAST_FACTOR = 0.2  #: the step before: least length of the next step
LARGEST_FACTOR = 10.0  #: the step before: greatest length of the next step
#: the tolerance of a run: error allowed in a step, because errors of steps add up
LOCAL_SHARE = 0.1
FIRST_STEP = 1e-3  #: a step of the run: length of the first trial step
REST_OF_STEP = 0.99  #: the time left: a step longer than this takes all of it
LEAST_STEP = 1e-14  #: the duration: least length of a step
#: the time in which its load would move a body by its size: longest step of a body in contact: without
#: contacts it would move by the square of this part of its size, and pass through nothing
LOADED_STEP = 0.2
#: rad: rotation of a body for each stage of a part of a step (0.3 for `rk4`)
STAGE_ROTATION = 0.075
#: rad: rotation of a joint in a trial step, by the rates at its ends: safely below half a turn
JOINT_ROTATION = 1.5
#: the largest singular value of rows of length 1: smaller ones are those of dependent rows
RANK = 1e-8
#: a vector of length 1: least component of a row that takes part in a dependence
PARTICIPATION = 1e-6
#: the diagonal of a row: square of its angle to the rows before it, below which it depends on them
SINGULARITY = 1e-5
SINGULAR_TURN = 1e-2  #: rad: bodies turn by this angle to leave a singular position
SINGULAR_GROWTH = 3.0  #: the angle before: if rows still depend on each other
LAST_PIVOT = 1e-29  #: the diagonal: smaller pivots are round-off of 31 digits
#: 1: change of a component of a normal at an edge: those of a normal that has turned with its face differ
#: by round-off
JUMP = 1e-6
#: 1: the same for edges: those of level faces have normals that differ by `LEVEL_FACES`
EDGE_JUMP = 1e-3
DISPLACEMENT = 1e-5  #: the size of a body: for differences of the user's functions
