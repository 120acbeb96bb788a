"""Thresholds of the contact problem: accuracy, proximal terms, effort."""

#: greatest entry, or eigenvalue, of a given W: asymmetry, or less than semidefinite, that six digits of a file
#: leave (up to 5e-6 of each entry)
FILE_DIGITS = 1e-5
EIGENVALUE_ERROR = 1e-9  #: greatest eigenvalue of a given W: round-off of its least one, if it is computed
RESIDUAL = 1e-10  #: greatest velocity: residual of a solved contact problem
ENOUGH_RESIDUAL = 100.0  #: tolerance: from which on few more starting points are tried
PROXIMAL = 1e-8  #: diagonal of W: weight of the proximal term, which makes redundant impulses unique
#: diagonal of W: its weight where W has an eigenvalue below `PROXIMAL` in a direction of the solution:
#: each round removes the part lambda/(lambda + eps) of the bias in that direction
LEAST_PROXIMAL = 1e-14
RELEASE_START = 0.1  #: diagonal of W: first weight of the proximal term in a release
RELEASE_FACTOR = 0.3  #: weight before: by which it decreases after a round that converges
NEWTON_FLOOR = 1e-13  #: 1 + |p|: a smaller |f| is enough, unless a step still halves it
SHORTEST_SEARCH = 1e-3  #: step of Newton's method: shortest step of the line search
UNDAMPED_MISMATCH = 1e-6  #: 1 + |p|: below it Newton's method is near a solution, and may take undamped steps
CHORD_GAIN = 0.1  #: |f| before: a step that leaves more converges slowly; otherwise factors are used again
LEAST_PIVOT = 1e-14  #: scaled diagonal of W: smaller pivots are replaced by it
RELAXATION = 1.6  #: step of the iteration: over-relaxation (1.5 to 1.8: Boyd et al. 2011)
SEARCH_BUDGET = 1e6  #: iterations times the square of the number of contacts: effort of a search
HEADING_ERROR = 1e-6  #: 1: error of the length of a given direction
NORMAL_PART = 1e-13  #: W_nn: least part that stick leaves of it, of a point whose normal force is found
TANGENTIAL_ERROR = 1e-13  #: size of the terms: tangential velocity that is zero where W_tt is singular
LEAST_TERM = 1e-30  #: size of the terms: least slip by force of which there is a direction
GOAL_RESIDUAL = 1e-14  #: greatest velocity: residual at which the iterations end
RELEASED_RESIDUAL = 1e-8  #: 1 + |p|: residual of a round of a release that has converged
LEAST_INSIDE = 1e-300  #: square of a scaled speed or impulse: least x_0^2 - |x_t|^2 inside a cone
PATH_PROXIMAL = 1e-9  #: diagonal of W: weight of the proximal term on the central path: bounds round-off
LEAST_DAMPING = 1e-3  #: diagonal of W: its weight after a step that is too short, and up to
PATH_DAMPING = 0.1  #: diagonal of W: its greatest weight, where friction makes the matrix almost singular
EDGE = 0.99  #: way to the edge of a cone: part that a step goes (.9 to .995: Nocedal and Wright 2006)
SHORT_STEP = 0.1  #: step to the edge of a cone: a shorter one is damped
PATH_END = 1e-17  #: greatest velocity times impulse, scaled: mean product that is round-off
