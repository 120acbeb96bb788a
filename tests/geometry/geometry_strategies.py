"""Inputs of the property tests: rotation vectors of every size, rotations, inertias."""

from fractions import Fraction

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st

moderate = settings(deadline=None, max_examples=60, derandomize=True)
few = settings(deadline=None, max_examples=25, derandomize=True)

#: Round-off of a result of size 1 after some ten operations.
ROUND = 4e-15


def _ordinary(values):
    a = np.array(values)
    return np.where(np.abs(a) < 1e-30, 0.0, a)


def components(bound=1.0):
    """Vectors (3,) with entries of 0 or at least 1e-30: their squares are ordinary numbers."""
    return st.tuples(*[st.floats(-bound, bound)] * 3).map(_ordinary)


@st.composite
def directions(draw):
    u = draw(components().filter(lambda a: np.linalg.norm(a) > 1e-3))
    return u / np.linalg.norm(u)


@st.composite
def rotation_vectors(draw, most=np.pi):
    """Angles over all scales: 0, 1e-12 ... 1, moderate, and within 1e-12 ... 1e-3 of `most`."""
    angle = draw(
        st.one_of(
            st.just(0.0),
            st.floats(-12, 0).map(lambda p: 10.0**p),
            st.floats(1e-12, most - 1e-12),  # at half a turn both signs are right
            st.floats(-12, -3).map(lambda p: most - 10.0**p),
        )
    )
    return angle * draw(directions())


@st.composite
def quaternions(draw):
    parts = st.tuples(*[st.floats(-1, 1)] * 4).map(_ordinary)
    q = draw(parts.filter(lambda a: np.linalg.norm(a) > 1e-3))
    return q / np.linalg.norm(q)


@st.composite
def inertias(draw):
    """Full tensors J of real bodies: J = tr(S) 1 - S with second moments S > 0 (so that the
    principal moments obey the triangle inequality), turned by any rotation."""
    from carom.geometry import quaternion

    moments = np.array(draw(st.tuples(*[st.floats(0.05, 3.0)] * 3)))
    R = quaternion.matrix(draw(quaternions()))
    return R @ np.diag(moments.sum() - moments) @ R.T


def exact_series(a, coefficient, terms=60):
    """Sum of coefficient(k) hat(a)^k in exact rational arithmetic, rounded once at the end.

    `coefficient` returns a Fraction. The entries of a are the given floats, exactly, so this is
    the correctly rounded matrix, with no cancellation (for |a| up to about 5 with 60 terms).
    """
    x, y, z = (Fraction(float(c)) for c in a)
    H = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], dtype=object)
    # hat^3 = -t^2 hat: the odd and the even powers are scalars times hat and hat^2.
    t2, odd, even, power = x * x + y * y + z * z, Fraction(0), Fraction(0), Fraction(1)
    for k in range(1, terms, 2):
        odd += coefficient(k) * power
        even += coefficient(k + 1) * power
        power *= -t2
    matrix = coefficient(0) * np.eye(3, dtype=int) + odd * H + even * H.dot(H)
    return matrix.astype(float)
