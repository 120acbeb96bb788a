"""Thresholds of stepping: the grid, the balance of energy, islands, and the step of a crowd."""

RTOL = 1e-8  #: the size and displacement of a body: default tolerance of a run
TIGHT_RTOL = 1e-9  #: 1: at this tolerance or below, the default is the method of order 8
SMOOTH_RTOL = 1e-6  #: 1: the same where nothing strikes or sticks
MOST_STEPS = 1e12  #: steps: of a run: times are then known to a thousandth of a step
STEPS_BY_SPEED = 1e4  #: steps: greatest number by speed in a scene without gravity
LONGEST_PART = 0.1  #: the duration: longest step of a run with contacts
#: the time of a fall through the least size of a body: longest step of a run with tolerances: one body has
#: no neighbours
FALL_OF_ONE = 4.0
#: the time of a fall through the least size of a body: with several bodies, because nearness is checked
#: once a step
FALL_OF_SEVERAL = 0.03
#: a step of the run: trial steps are not cut below it by the balance of energy
SHORTEST_STEP = 1.0 / 1024.0
ENERGY_ROUND_OFF = 1e-13  #: the sum of the sizes of energies: error of an energy
ENERGY_GAIN = 0.25  #: the energy that a step exchanges: a step that gains more is cut
#: `Options.energy_tolerance`: energy error that a step of an explicit method may have
STEP_SHARE = 1e-3
ACTIVE_SHARE = 10.0  #: `STEP_SHARE`: with active points, because the order is lower
LIMIT_GROWTH = 4.0  #: the limit: by which it grows if the shortest step exceeds it
#: the size of the body: room of a body that starts from rest and has left its ball: doubled with each
#: repetition
START_ROOM = 1e-3
BALL_SLACK = 1e-6  #: the radius: growth of balls, so that balls in contact overlap
#: steps: contacts are made for bodies that may meet so soon, within a distance of their balls
MEETING_STEPS = 8.0
#: the ball of the body: displacement in a piece of a step that is always allowed, however thin the body is
THIN_PART = 1.0 / 32.0
SHORTEST_PIECE = 1e-4  #: the step: shortest piece
SEARCH_GROWTH = 4.0  #: the search distance: after points were missed
SEARCH_LIMIT = 16.0  #: the first search distance: greatest one
#: the size of the smaller body: depth of a feature that was no candidate, from which on the piece is cut
MISSED_DEPTH = 1e-5
MISSED_PIECE = 1.0 / 16.0  #: the step: down to which it is cut
RESIDUAL_LIMIT = 1e-3  #: the greatest speed: a piece whose contacts have a greater residual is cut
SLOW_RESIDUAL = 1e-8  #: the greatest velocity: residual that is enough if convergence is slow
SLOW_TURN = 0.1  #: the residual before: convergence is slow if a turn leaves more
WRONG_RESIDUAL = 1e-2  #: the greatest velocity: more is no result, whatever the cost
REST_RESIDUAL = 1e3  #: the tolerance: enough for bodies to come to rest; more is no rest
SOLVER_SHARE = 0.1  #: the speed below which bodies rest: tolerance of the solver
#: the diagonal of W: weights of the proximal term in turn: impulses are often not unique (four corners of
#: a box), and with 1e-8 a step changes the undetermined part arbitrarily
PROXIMAL_TURNS = (1e-2, 1e-3, 1e-4)
RHO = 0.05  #: the mean of the diagonal of W: weight of alternating directions
MIXING_GROWTH = 2.0  #: the last |f|: with more the stored differences are dropped
MIXING_RIDGE = 1e-10  #: the squares of the columns: added to them, as they may be dependent
SAME_NORMAL = 1e-3  #: 1: normals of two points of a pair that differ by less are made equal
LEAVING_SPEED = 1e-6  #: the speed that gravity gives in the step: a slower point does not leave
#: the kinetic energy plus m g times the size of the bodies: greatest gain of energy of a group in a piece
GROUP_GAIN = 1e-7
#: the kinetic energy plus m g times the size of the bodies: greatest difference of the gain from the work
#: of the impulses
GROUP_ERROR = 1e-4
RETURN_DEPTH = 1e-11  #: the size of the smaller body: depth allowed after the return to the surface
RETURN_GAIN = 0.01  #: the depth: that a pass leaves: gaps are not linear, so less is no gain
#: the mean of the diagonal of W: least W_nn of a point that returns: with the normal through the axis of a
#: hinge W_nn is round-off, and 1e-7 m would turn a gear by many teeth
IMMOBILITY = 1e-6
