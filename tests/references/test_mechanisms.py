"""The references of the mechanisms agree with what others have published."""

import numpy as np
import pytest

from references import andrews, andrews_minimal, chaplygin, heavy_top

Q0 = np.array(andrews.PARAMETERS["q0"])


def test_andrews_closes_at_the_start():
    assert np.abs(andrews.closures(Q0)).max() < 1e-16


def test_andrews_absolute_model_has_the_published_mass_matrix():
    """M = sum m J^T J + I J_w^T J_w with J from the mass centres, at random angles."""
    p = andrews.PARAMETERS["params"]
    m, I = ([p[f"{kind}{k}"] for k in range(1, 8)] for kind in "mi")
    for q in np.random.default_rng(2).normal(size=(5, 7)):
        both = [(andrews.centres(q + s), andrews.centres(q - s)) for s in 1e-6 * np.eye(7)]
        J = np.array([(up[0] - down[0]) / 2e-6 for up, down in both])
        Jw = np.array([(up[1] - down[1]) / 2e-6 for up, down in both])
        M = np.einsum("ibk,jbk,b->ij", J, J, m) + np.einsum("ib,jb,b->ij", Jw, Jw, I)
        np.testing.assert_allclose(M, andrews_minimal.mass(q), atol=1e-9 * np.abs(M).max())


def test_andrews_jacobian_is_that_of_the_closures():
    """By complex steps, which are exact to round-off."""
    for q in np.random.default_rng(1).normal(size=(3, 7)):
        steps = [np.imag(andrews.closures(q + 1e-30j * unit)) / 1e-30 for unit in np.eye(7)]
        np.testing.assert_allclose(andrews_minimal.jacobian(q), np.transpose(steps), atol=1e-16)


def test_andrews_published_end():
    """t = 0.03: the angles of the IVP test set to 1e-7, the rates to 1e-6 of themselves."""
    data = andrews.andrews_data()
    q, v = andrews_minimal.integrate(data["t_end"])
    np.testing.assert_allclose(q, data["reference"]["angles"], atol=1e-7)
    np.testing.assert_allclose(v, data["reference"]["rates"], rtol=1e-6)


def test_andrews_data_is_ready_for_a_scene():
    data = andrews.andrews_data()
    assert [body["name"] for body in data["bodies"]] == list(andrews.BODIES)
    assert len(data["joints"]) == 10  # 3 x 7 - 2 x 10 = 1 degree of freedom
    angles = np.array([body["angle"] for body in data["bodies"]])
    np.testing.assert_allclose(andrews.minimal_from_absolute(angles), Q0, atol=1e-15)
    length = np.subtract(data["spring"]["body_point"], data["spring"]["ground_point"])
    assert np.hypot(*length) == pytest.approx(0.0526725161, abs=1e-9)  # l0 is 0.07785


def test_heavy_top_end():
    """t = 2 s, by another code."""
    Q, W, x = heavy_top.motion([0.001, 2.0])
    np.testing.assert_allclose(
        Q[1], [0.122947135041488, -0.491079892551541, 0.350430030343313, -0.787986887549682],
        atol=1e-10,
    )  # fmt: skip
    np.testing.assert_allclose(W[1], [0.122233219473431, 150, -5.85562458920331], atol=1e-9)
    np.testing.assert_allclose(
        x[1], [-0.15041682274667, -0.724165591637348, -0.673022269559728], atol=1e-10
    )


def test_chaplygin_speeds_and_equations():
    """Samples of the closed form; du/dt = a w^2 and k dw/dt = -a u w by differences."""
    for t, u, w in (
        (0.5, 0.48015817085445484, 0.9405977171356796),
        (5.0, 1.4118133450783685, 0.05823692410587801),
    ):
        np.testing.assert_allclose(chaplygin.speeds(t), (u, w), rtol=1e-14)
        du, dw = (np.array(chaplygin.speeds(t + 1e-5)) - chaplygin.speeds(t - 1e-5)) / 2e-5
        np.testing.assert_allclose([du, 2.0 * dw], [w * w, -u * w], atol=1e-9)
        turned = (chaplygin.heading(t + 1e-5) - chaplygin.heading(t - 1e-5)) / 2e-5
        assert turned == pytest.approx(w, abs=1e-9)


def test_chaplygin_mass_centre_has_no_force_along_the_blade():
    """m (acceleration of C) . e1 = 0: the knife edge pushes along e2 only."""
    for t in (0.5, 2.0):
        C = [chaplygin.mass_centre(t + s) for s in (-1e-3, 0.0, 1e-3)]
        theta = chaplygin.heading(t)
        push = (C[0] - 2 * C[1] + C[2]) / 1e-6
        assert push @ [np.cos(theta), np.sin(theta)] == pytest.approx(0.0, abs=1e-5)
