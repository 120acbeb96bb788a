"""What the solver asks of W, for the two ways in which it is stored.

`ConeWork`: W itself (`dense`). `IslandWork`: bodies and rows, W never formed (`island`). All in scaled
variables; k contacts.
"""

from __future__ import annotations

from carom._compiled.choice import by_method
from carom.friction import dense, island
from carom.friction.arrays import IslandWork
from carom.friction.layout import ConeWork

#: multiply(work, k, x, out): out += W x
multiply = by_method({ConeWork: dense.multiply, IslandWork: island.multiply})

#: magnitude(work, k): greatest (|W| |p|)_i, in units of velocity (unscaled but for gamma)
magnitude = by_method({ConeWork: dense.magnitude, IslandWork: island.magnitude})

#: sweep(work, k, backward): each contact in turn solved exactly
sweep = by_method({ConeWork: dense.sweep, IslandWork: island.sweep})

#: factor(work, k, eps): of I - D + D (W + eps) at p, w; D the slope of the projection
factor = by_method({ConeWork: dense.factor_newton, IslandWork: island.factor_newton})

#: solve(work, k): write the step, with the factors at hand
solve = by_method({ConeWork: dense.solve_newton, IslandWork: island.solve_newton})

#: factor_shifted(work, k, sigma): of W + sigma
factor_shifted = by_method({ConeWork: dense.factor_shifted, IslandWork: island.factor_shifted})

#: solve_shifted(work, k): rhs becomes (W + sigma)^-1 rhs
solve_shifted = by_method({ConeWork: dense.solve_shifted, IslandWork: island.solve_shifted})
