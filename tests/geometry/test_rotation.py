"""The scalar kernels of rotations agree with the functions on arrays."""

import subprocess
import sys

import numpy as np
import pytest
from geometry_strategies import ROUND, components, inertias, moderate, quaternions
from hypothesis import given
from numpy.testing import assert_allclose

from carom.geometry import quaternion, rotation


@pytest.mark.plain
@moderate
@given(quaternions(), quaternions(), components())
def test_kernels_agree_with_arrays(a, b, v):
    assert_allclose(rotation.multiply(*a, *b), quaternion.multiply(a, b), atol=ROUND)
    assert_allclose(rotation.rotate(*a, *v), quaternion.rotate(a, v), atol=ROUND)
    assert_allclose(rotation.rotate_back(*a, *v), quaternion.rotate_back(a, v), atol=ROUND)
    assert_allclose(rotation.matrix(*a), quaternion.matrix(a).ravel(), atol=ROUND)
    assert_allclose(rotation.normalize(*(3.0 * a)), a, atol=ROUND)
    assert_allclose(rotation.cross(*v, *a[1:]), np.cross(v, a[1:]), atol=ROUND)


@moderate
@given(quaternions(), inertias())
def test_spin_tensor(q, J):
    moments = np.linalg.eigvalsh(J)
    R = quaternion.matrix(q)
    full = R @ np.diag(moments) @ R.T
    got = rotation.spin_tensor(tuple(R.ravel()), tuple(moments))
    assert_allclose(got, full[np.triu_indices(3)], atol=6 * ROUND)  # moments up to 6


def test_arrays_need_no_compiler():
    # Scenes and loaded results must not wait for Numba, nor for SciPy.
    code = (
        "import sys; from carom.geometry import attitude, quaternion, spline;"
        "sys.exit('numba' in sys.modules or 'scipy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
