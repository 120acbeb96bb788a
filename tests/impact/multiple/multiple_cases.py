"""Several contacts: rows of balls, the die on its face, blocks; the full solve of alike contacts."""

import numpy as np
from hypothesis import strategies as st

from carom.impact.multiple.api import resolve_impacts

MASS, EDGE = 0.016, 0.02  # the die of the paper
INERTIA = MASS * EDGE**2 / 6


def rows(point, normal=(0, 0, 1), t1=(1, 0, 0), t2=(0, 1, 0)):
    """Rows (n, t1, t2) of a contact of a free body at `point` from its centre: 3 x 6."""
    return np.array([np.r_[a, np.cross(point, a)] for a in np.array([normal, t1, t2], float)])


class Body:
    """A body with contacts at fixed points: G, M^-1, W."""

    def __init__(self, points, mass=MASS, inertia=INERTIA):
        self.G = np.vstack([rows(p) for p in points])
        self.inverse = np.diag([1 / mass] * 3 + [1 / inertia] * 3)
        self.W = self.G @ self.inverse @ self.G.T

    def strike(self, velocity, *arguments, touching=(), **options):
        """Velocity after (v, w), and the impact. Contacts `touching` have u_n = 0 exactly."""
        u = (self.G @ velocity).reshape(-1, 3)
        u[list(touching), 0] = 0.0
        impact = resolve_impacts(self.W, u, *arguments, **options)
        return velocity + self.inverse @ self.G.T @ impact.impulse.ravel(), impact


CORNERS = [(x, y, -EDGE / 2) for x in (-EDGE / 2, EDGE / 2) for y in (-EDGE / 2, EDGE / 2)]
DIE = Body(CORNERS)


def row_of_balls(velocity, masses=None):
    """G and W of a row of balls that touch; contact i is between balls i and i + 1."""
    n = len(velocity)
    masses = np.ones(n) if masses is None else np.asarray(masses)
    G = np.zeros((3 * (n - 1), n))
    for i in range(n - 1):
        G[3 * i, i], G[3 * i, i + 1] = -1, 1
    return G, G @ np.diag(1 / masses) @ G.T, 1 / masses


def strike_row(velocity, restitution, law="stronge", masses=None, **options):
    """Velocities of the balls after, and the impact."""
    velocity = np.asarray(velocity, float)
    G, W, inverse = row_of_balls(velocity, masses)
    u = (G @ velocity).reshape(-1, 3)
    impact = resolve_impacts(W, u, 0.0, restitution, law, **options)
    return velocity + inverse * (G.T @ impact.impulse.ravel()), impact


def unlike(k):
    """Stiffnesses that differ by round-off only: contacts that move alike are then not solved as one."""
    return 1.0 + 1e-12 * np.arange(k)


@st.composite
def problems(draw, most=6):
    """W = G G^T of any rank and u in its range, friction, restitution, stiffness ratio up to 100."""
    k = draw(st.integers(2, most))
    n = draw(st.integers(2, 3 * k))
    seed = draw(st.integers(0, 2**32 - 1))
    random = np.random.default_rng(seed)
    G, v = random.normal(size=(3 * k, n)), random.normal(size=n)
    u = (G @ v).reshape(k, 3)
    if u[:, 0].min() > 0:
        u = -u
    touching = draw(st.booleans()) and n > 2
    if touching:  # contact 0 touches: v orthogonal to its row
        g = G[0]
        v = v - g * (g @ v) / (g @ g)
        u = (G @ v).reshape(k, 3)
        if u[1:, 0].min() > 0:
            u = -u
        u[0, 0] = 0.0
    mu = random.uniform(0, 3, k) * draw(st.sampled_from([0.0, 0.1, 1.0]))
    e = random.uniform(0.1, 1, k) if draw(st.booleans()) else np.full(k, draw(st.floats(0, 1)))
    kappa = 10 ** random.uniform(-1, 1, k)
    return G @ G.T, u, mu, e, kappa
