"""Thresholds of impacts: of one contact, of several, and of the layer in which several are integrated."""

#: 1: a smaller restitution ends an impact with compression (T_r = T_c/e), and a smaller e^n is none
NO_RESTITUTION = 1e-6
#: the slip: speed of approach given to a point that jams, below `REMAINDER`: it changes no result
SEED = 1e-10
GROUP_SEED = 1e-7  #: the slip: the same among several points, above `SLIP_END`
#: the speed or impulse of the impact: a smaller approach counts as zero (round-off, or `SEED`), and a
#: smaller impulse may remove what remains of slip
REMAINDER = 1e-9
#: the length of a phase, or the time of the fastest contact: shortest step: if so short a step of slip
#: fails, u_t reaches 0 in it
SHORTEST_PART = 1e-9
SERIES_ACCURACY = 1e-14  #: the root of |u_t| |u|: last term of the series of slip
#: the speed of the impact by W_nn: longest step in p: round-off of u grows with p
LONGEST_IMPULSE = 1e6
#: the energy lost in compression, or the sum of |p u|: accuracy of the energy balance of an impact
ENERGY_BALANCE = 1e-6
#: the sum of |p u|: the same for Moreau's problem, which is solved without a passage
ENERGY_GROWTH = 1e-9
#: the speed of approach before: greatest approach that Newton's law may leave in Moreau's problem
APPROACH_LEFT = 1e-6
#: the greatest velocity: greatest approach that a passage of the layer may leave
PASSAGE_APPROACH = 1e-3
#: the greatest velocity: impulses that cause more round-off of velocities are absurd
VISIBLE_ROUND_OFF = 1e-3
#: the greatest velocity, the inverse masses, or the greatest pivot: smaller differences, velocities and
#: pivots of several contacts are round-off
GROUP_ROUND_OFF = 1e-11
#: the size of the terms: smaller rates, couplings, depths and speeds of approach in an impact count as
#: zero
IMPACT_ROUND_OFF = 1e-13
#: 1: replaces smaller e in the layer, because unloading is 1/e^2 stiffer than loading
LEAST_RESTITUTION = 0.01
INSTANT = 1e-10  #: the time of the fastest contact: changes closer in time are simultaneous
SLIP_END = 1e-10  #: the greatest velocity: slower slip, or slip below 0.1 rtol, has ended
#: the greatest mu N: from which on a contact takes part in any motion that it can stop
LOADED_PART = 1e-3
#: the greatest mu N: added to all where the loaded contacts alone cannot stop all motion
UNLOADED_WEIGHT = 0.1
#: the diagonal of A: weight of the proximal term where A is singular: w is wrong by less than this part of
#: T
LAYER_PROXIMAL = 1e-10
MOMENT_AHEAD = 0.3  #: the time of the fastest contact: for the force of a contact that is closing
INSTANT_STEP = 1e-7  #: the step: the moment ahead for the forces of an instant
FIRST_LAYER_STEP = 0.05  #: the time of the fastest contact: first step through the layer
#: the time of the fastest contact: a group at rest for two such steps is wedged
LASTING_STEP = 0.01
LONGEST_STEP = 4.0  #: the time of the fastest contact: longest step of series
LONGEST_STRETCHED = 40.0  #: the time of the fastest contact: the same where time is stretched
#: the tolerance: for a series of low order: its last terms do not bound the error
SERIES_SHARE = 0.01
STAGE_ACCURACY = 1e-10  #: 1: least useful tolerance of steps by stages (order four)
#: the rate of the fastest contact: rate of a slow direction above which stages cost less than series
STIFFNESS = 3000.0
CHANGE_TOLERANCE = 0.02  #: the tolerance: for steps in which a contact begins or ceases to stick
COARSE_TOLERANCE = 1e-4  #: 1: greatest tolerance of a passage; it decreases with the misses
#: |ln(target/reached)|: greatest miss and step of restitution that is believed
LARGEST_CORRECTION = 1.5
#: the step: part of a first step in which contacts differ, if some have no target
FIRST_DIFFERENCE = 3.0
PARALLEL_STEPS = 0.01  #: squared sine of the angle: least between two steps of which both are kept
ROUND_GAIN = 0.8  #: the greatest miss: a round that leaves no more is a gain
NEAREST_RESULT = 0.1  #: ln(target/reached): greatest at which the nearest result is used
