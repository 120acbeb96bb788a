"""Thresholds of the contact problem: accuracy, proximal terms, effort."""

RESIDUAL_TOLERANCE = 1e-10  #: the greatest velocity: residual of a solved contact problem
ENOUGH_RESIDUAL = 100.0  #: the tolerance: from which on few more starting points are tried
#: the diagonal of W: weight of the proximal term, which makes redundant impulses unique
PROXIMAL = 1e-8
#: the diagonal of W: its weight where W has an eigenvalue below `PROXIMAL` in a direction of the solution:
#: each round removes the part lambda/(lambda + eps) of the bias in that direction
LEAST_PROXIMAL = 1e-14
RELEASE_START = 0.1  #: the diagonal of W: first weight of the proximal term in a release
RELEASE_FACTOR = 0.3  #: the weight before: by which it decreases after a round that converges
NEWTON_FLOOR = 1e-13  #: 1 + |p|: a smaller |f| is enough, unless a step still halves it
SHORTEST_SEARCH = 1e-3  #: the step of Newton's method: shortest step of the line search
#: |f| before: factors are used again if the last step reduced |f| to this part or less
CHORD_GAIN = 0.1
LEAST_PIVOT = 1e-14  #: the scaled diagonal of W: smaller pivots are replaced by it
#: the step of the iteration: over-relaxation of alternating directions (1.5 to 1.8: Boyd et al. 2011)
RELAXATION = 1.6
SEARCH_BUDGET = 1e6  #: iterations times the square of the number of contacts: effort of a search
