"""Thresholds of impacts: of one contact, of several, and of the layer in which several are integrated."""

NO_RESTITUTION = 1e-6  #: 1: below this restitution an impact ends with compression; e^n below is none
SEED = 1e-10  #: slip: approach given to a point that jams, below `REMAINDER`: it changes no result
GROUP_SEED = 1e-7  #: slip: the same among several points, above `SLIP_END`
SHORTEST_PART = 1e-9  #: length of a phase or of the layer: shortest step: if it fails, u_t reaches 0 in it
#: velocity to be removed: what may be left: of approach by Newton's law, of slip, and of others
VELOCITY_LEFT = 1e-6
#: greatest velocity, mass, pivot or force: smaller ones of several contacts are round-off
GROUP_ERROR = 1e-11
SERIES_ACCURACY = 1e-14  #: root of |u_t| |u|: last term of the series of slip
SLIP_ERROR = 1e-13  #: root of |u_t| |u|: error of a step of slip whose friction depends on it
RAY_LENGTH = 1e-8  #: speed of the impact: slip up to which its friction is that at its beginning
LONGEST_IMPULSE = 1e6  #: speed of the impact by W_nn: longest step in p: round-off of u grows with p
ENERGY_BALANCE = 1e-6  #: energy lost in compression, or sum of |p u|: accuracy of the balance of an impact
GAIN = 1e-9  #: sum of |p u|: the same for Moreau's problem, which is solved without a passage
VISIBLE_ERROR = 1e-3  #: greatest velocity: a result with more approach or round-off is wrong
WEDGED_PART = 1e4  #: P.W P: greatest sum of p_n (|u_n-| + |u_n+|): larger impulses are those of a wedge
IMPACT_ERROR = 1e-13  #: size of the terms: smaller rates, couplings, depths and speeds count as zero
LEAST_RESTITUTION = 0.01  #: 1: replaces smaller e in the layer: unloading is 1/e^2 stiffer than loading
INSTANT = 1e-10  #: time of the fastest contact: changes closer in time are simultaneous
SLIP_END = 1e-10  #: greatest velocity: slower slip, or slip below 0.1 rtol, has ended
#: greatest mu N: from which on a contact stops a motion; weaker ones hold as if they had it
LOADED_PART = 1e-3
UNLOADED_WEIGHT = 0.1  #: greatest mu N: added to all where the loaded contacts alone cannot stop all motion
LEAST_SLOPE = -0.2  #: 1: of the miss of a law by mu, that is believed: where slip runs away it is 0
PULL = 1e-10  #: acceleration by friction: of a contact that its static coefficient does not hold
LAYER_PROXIMAL = 1e-10  #: diagonal of A: weight of the proximal term where A is singular: w is wrong by less
MOMENT_AHEAD = 0.3  #: time of the fastest contact: for the force of a contact that is closing
INSTANT_STEP = 1e-7  #: step: the moment ahead for the forces of an instant
LAYER_STEP = 0.05  #: time of the fastest contact: first step through the layer
LASTING_STEP = 0.01  #: time of the fastest contact: a group at rest for two such steps is wedged
LONGEST_STEP = 4.0  #: time of the fastest contact: longest step of series
STRETCHED_STEP = 40.0  #: time of the fastest contact: the same where time is stretched
SLIP_SHARE = 1e-3  #: tolerance: for the slip in the problem of friction of a stage
SERIES_SHARE = 0.01  #: tolerance: for a series of low order: its last terms do not bound the error
STAGE_ACCURACY = 1e-10  #: 1: least useful tolerance of steps by stages (order four)
STIFFNESS = 3000.0  #: rate of the fastest contact: of a slow direction, from which on stages cost less
CHANGE_TOLERANCE = 0.02  #: tolerance: for steps in which a contact begins or ceases to stick
COARSE_TOLERANCE = 1e-4  #: 1: greatest tolerance of a passage; it decreases with the misses
LARGEST_CORRECTION = 1.5  #: |ln(target/reached)|: greatest miss and step of restitution that is believed
FIRST_DIFFERENCE = 3.0  #: step: part of a first step in which contacts differ, if some have no target
PARALLEL_STEPS = 0.01  #: squared sine of the angle: least between two steps of which both are kept
ROUND_GAIN = 0.8  #: greatest miss: a round that leaves no more is a gain
NEAREST_RESULT = 0.1  #: ln(target/reached): greatest at which the nearest result is used
EQUAL_CURVATURES = 1e-6  #: 1: of two curvatures: less changes the stiffness by less than 1e-13 of it
