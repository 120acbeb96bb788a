"""Thresholds of dynamics: lengths of steps, dependent rows, edges that are passed."""

SAFETY = 0.9  #: length whose error would equal the tolerance: length of the next step
SHRINKAGE = 0.2  #: step before: least length of the next step
GROWTH = 10.0  #: step before: greatest length of the next step
FIRST_STEP = 1e-3  #: a step of the run: length of the first trial step
KINK = 0.1  #: estimate of order 3: an estimate of order 5 above it is that of a kink
KINK_WEIGHT = 100.0  #: error of order 5 of a body that has met a kink: as what it counts
FINISH = 0.99  #: time left: a step longer than this takes all of it
RTOL = 1e-8  #: size and displacement of a body: default of a run; above it more energy may be lost
#: error that is allowed: share of it for a step, for friction in a step, for a solver: others are added
ERROR_SHARE = 0.1
#: trial steps: a run ends if the rest takes more at the present length, a minute or more of computing
MOST_TRIALS = 3e7
SLOW_TRIALS = 300_000  #: trial steps: so many may be too short by `MOST_TRIALS`: a stiff moment may pass
LEAST_STEP = 1e-14  #: duration: least length of a step
#: time in which its load moves a body by its size: of a body in contact: it moves by the square
LOAD_STEP = 0.2
STAGE_TURN = 0.075  #: rad: rotation of a body for each stage of a part of a step (0.3 for `rk4`)
METRIC_PIVOT = 1e-15  #: diagonal of a metric: a pivot that is round-off
RANK = 1e-8  #: largest singular value of rows of length 1: smaller ones are those of dependent rows
PARTICIPATION = 1e-6  #: a vector of length 1: least component of a row that takes part in a dependence
SINGULARITY = 1e-5  #: diagonal of a row: square of its angle to the rows before it: it depends on them
SINGULAR_TURN = 1e-2  #: rad: bodies turn by this angle to leave a singular position
SINGULAR_GROWTH = 3.0  #: angle before: if rows still depend on each other
LAST_PIVOT = 1e-29  #: diagonal: smaller pivots are round-off of 31 digits
DISPLACEMENT = 1e-5  #: size of a body: for differences of the user's functions
JOINT_ERROR = 1e-14  #: size of a body: error of joints that a return to them leaves
#: size of a body: error of joints that decreases no more: round-off of coordinates far from the origin
JOINT_NOISE = 1e-11
START_ERROR = 1e-13  #: size of a body: error of joints that `Options.project_start` leaves
COORDINATE_ERROR = 2e-16  #: greatest coordinate: its round-off
SLOWEST = 1e-6  #: size of a body in a step: least speed by which the convergence of its momenta is measured
THIRD_ORDER = 0.01  #: square of the estimate of order 3: its weight beside that of order 5 (`dop853`)
#: rad^2: squared angle of a mount above which its moment has the closed form: both are right to 2e-11
SERIES_TURN = 1e-4
LEAST_NORM_WEIGHT = 1e-6  #: diagonal of a row: greatest weight of the norm that is least for reactions
REACTION_ERROR = 1e-13  #: reactions of least norm: what the last pass changes
