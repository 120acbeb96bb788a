"""The scalar kernels of rotations agree with the functions on arrays."""

import subprocess
import sys

import numpy as np
import pytest
from geometry_strategies import ROUND, components, inertias, moderate, quaternions
from hypothesis import given
from numpy.testing import assert_allclose

from carom._compiled.decorators import entry
from carom.geometry import quaternion, rotation


@entry
def rotations(a, b, v, long):
    """Return what the kernels make of two quaternions and a vector."""
    return (
        rotation.multiply(a, b), rotation.multiply(a, rotation.conjugate(b)), rotation.rotate(a, v),
        rotation.rotate_back(a, v), rotation.matrix(a), rotation.normalize(long),
        rotation.cross(v[0], v[1], v[2], a[1], a[2], a[3]),
    )  # fmt: skip


@entry
def spin_tensor(R, i):
    return rotation.spin_tensor(R, i)


@pytest.mark.plain
@moderate
@given(quaternions(), quaternions(), components())
def test_kernels_agree_with_arrays(a, b, v):
    found = rotations(a, b, v, 3.0 * a)
    wanted = (
        quaternion.multiply(a, b), quaternion.multiply(a, quaternion.conjugate(b)), quaternion.rotate(a, v),
        quaternion.rotate_back(a, v), quaternion.matrix(a).ravel(), a, np.cross(v, a[1:]),
    )  # fmt: skip
    for one, other in zip(found, wanted, strict=True):
        assert_allclose(one, other, atol=ROUND)


@moderate
@given(quaternions(), inertias())
def test_spin_tensor(q, J):
    moments = np.linalg.eigvalsh(J)
    R = quaternion.matrix(q)
    full = R @ np.diag(moments) @ R.T
    got = spin_tensor(tuple(R.ravel()), tuple(moments))
    assert_allclose(got, full[np.triu_indices(3)], atol=6 * ROUND)  # moments up to 6


def test_arrays_need_no_compiler():
    # Scenes and loaded results must not wait for Numba, nor for SciPy.
    code = (
        "import sys; from carom.geometry import attitude, quaternion, spline;"
        "sys.exit('numba' in sys.modules or 'scipy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
