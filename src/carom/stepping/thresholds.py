"""Thresholds of stepping: the grid, the balance of energy, islands, and the step of a crowd."""

TIGHT_RTOL = 1e-9  #: 1: at this tolerance or below, the default is the method of order 8
SMOOTH_RTOL = 1e-6  #: 1: the same where nothing strikes or sticks
MOST_STEPS = 1e12  #: steps: of a run: times are then known to a thousandth of a step
STEPS_BY_SPEED = 1e4  #: steps: greatest number by speed in a scene without gravity
LONGEST_PART = 0.1  #: duration: longest step of a run with contacts
FALL_OF_ONE = 4.0  #: time of a fall through a body's least size: longest step: one body has no neighbours
FALL_OF_MANY = 0.03  #: time of a fall through a body's least size: nearness is checked once a step
SHORTEST_STEP = 1.0 / 1024.0  #: a step of the run: trial steps are not cut below it by the balance of energy
ENERGY_ROUND_OFF = 1e-13  #: sum of the sizes of energies: error of an energy
FRICTION_GAIN = 1e-9  #: greatest energy exchanged: a given step in which friction adds more is cut
ENERGY_GAIN = 0.25  #: energy that a step exchanges: a step that gains more is cut
STEP_SHARE = 1e-3  #: `Options.energy_tolerance`: energy error that a step of an explicit method may have
ACTIVE_SHARE = 10.0  #: `STEP_SHARE`: with active points, because the order is lower
LIMIT_GROWTH = 4.0  #: limit: by which it grows if the shortest step exceeds it
PARTED_STEPS = 100  #: steps: after which clusters of mechanisms that could be divided in each are divided
START_ROOM = 1e-3  #: size of the body: room of a body that starts from rest: doubled with each repetition
BALL_SLACK = 1e-6  #: radius: growth of balls, so that balls in contact overlap
SPEED_UP = 2.0  #: greatest speed of bodies that may meet: greatest speed of one of them in the step
NEAR_REACH = 1.5  #: greatest speed of points of near bodies: their mean speed: a ball begins to roll with 1.43
MEETING_STEPS = 8.0  #: steps: contacts are made for bodies that may meet so soon, near their balls
THIN_PART = 1.0 / 32.0  #: ball of the body: displacement in a piece that is allowed, however thin the body
SEARCH_GROWTH = 4.0  #: search distance: after points were missed
SEARCH_LIMIT = 16.0  #: first search distance: greatest one
MISSED_DEPTH = 1e-5  #: size of the smaller body: depth of a missed feature, from which on the piece is cut
MISSED_PIECE = 1.0 / 16.0  #: step: down to which it is cut
RESIDUAL_LIMIT = 1e-3  #: greatest speed: a piece whose contacts have a greater residual is cut
SLOW_RESIDUAL = 1e-8  #: greatest velocity: residual that is enough if convergence is slow
POSSIBLE = 1e-9  #: greatest lack of opening: a motion that lacks less keeps the points apart
MOVES_NOTHING = 1e-11  #: of impulses on free bodies: the work of impulses that move nothing, by round-off
WRONG_RESIDUAL = 1e-2  #: greatest velocity: more is no result, whatever the cost
#: diagonal of W: weights of the proximal term in turn: impulses are often not unique (four corners of a
#: box), and with 1e-8 a step changes the undetermined part arbitrarily
PROXIMAL_TURNS = (1e-2, 1e-3, 1e-4)
RHO = 0.05  #: mean of the diagonal of W: weight of alternating directions
MIXING_GROWTH = 2.0  #: last |f|: with more the stored differences are dropped
MIXING_RIDGE = 1e-10  #: squares of the columns: added to them, as they may be dependent
LEAVING_SPEED = 1e-6  #: speed that gravity gives in the step: a slower point does not leave
CROWD_GAIN = 1e-7  #: kinetic energy plus m g times sizes: greatest gain of energy of a group in a piece
CROWD_ERROR = 1e-4  #: kinetic energy plus m g times sizes: greatest difference of the gain from the work
RETURN_GAIN = 0.01  #: depth: that a pass leaves: gaps are not linear, so less is no gain
#: mean of the diagonal of W: least W_nn of a point that returns: with the normal through the axis of a
#: hinge W_nn is round-off, and 1e-7 m would turn a gear by many teeth
IMMOBILITY = 1e-6
FLAT_PART = 0.1  #: difference of the values of an event function around its zero: change that is none
EVENT_VALUE = 1e-13  #: first value of the function of an event: that counts as its zero
LEAST_RTOL = 1e-13  #: 1: least tolerance of a run that may be asked for
