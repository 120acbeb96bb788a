"""Modes against closed forms and tables; flexible bodies that strike against closed forms of their modes."""

import numpy as np
import pytest
from scipy.optimize import brentq

import carom
from carom import flexible
from verified import agree, verifies

STEEL = {"density": 7800.0, "young": 210e9}


@verifies(
    "flexible.beam",
    r"$\omega = (\beta L)^2 \sqrt{E I/(\rho A L^4)}$, $\cos \beta L \cosh \beta L = \pm 1$",
    "closed form",
)
@pytest.mark.parametrize(
    ("ends", "equation"),
    [
        ("free", lambda x: np.cos(x) - 1.0 / np.cosh(x)),
        ("clamped", lambda x: np.cos(x) - 1.0 / np.cosh(x)),
        ("clamped-free", lambda x: np.cos(x) + 1.0 / np.cosh(x)),
        ("clamped-pinned", lambda x: np.sin(x) - np.cos(x) * np.tanh(x)),
        ("pinned", np.sin),
    ],
)
def test_frequencies_of_beams(ends, equation):
    length, section = 1.3, flexible.Rectangle(0.02, 0.03)
    made = flexible.beam(length, section, **STEEL, ends=ends, modes=8, kinds=("bend",))
    x = np.linspace(1.0, 30.0, 2901)
    signs = np.flatnonzero(np.diff(np.sign(equation(x))))
    roots = np.array([brentq(equation, x[k], x[k + 1], xtol=1e-14) for k in signs])
    speeds = [
        np.sqrt(STEEL["young"] * moment / (STEEL["density"] * section.area))
        for moment in section.second_moments
    ]
    exact = np.sort(np.outer(speeds, (roots / length) ** 2).ravel())[:8] / (2.0 * np.pi)
    agree(made.frequencies, exact, rtol=1e-12)


@verifies(
    "flexible.plate",
    r"$\omega a^2 \sqrt{\rho h/D}$ of a free square plate, $\nu = .3$: 13.4682, 19.5961, 24.2702, 34.8009",
    "publication: Leissa 1973, whose Ritz values are upper bounds; converged ones",
)
def test_frequencies_of_a_plate():
    a, h, nu = 0.8, 0.01, 0.3
    made = flexible.plate(a, a, h, **STEEL, poisson=nu, modes=6)
    rigidity = STEEL["young"] * h**3 / (12.0 * (1.0 - nu**2))
    number = 2.0 * np.pi * made.frequencies * a**2 * np.sqrt(STEEL["density"] * h / rigidity)
    agree(number, [13.4682, 19.5961, 24.2702, 34.8009, 34.8009, 61.0932], atol=2e-4)
    assert np.all(number <= [13.489, 19.789, 24.432, 35.024, 35.024, 61.526])


@verifies(
    "flexible.solid",
    "the first bending frequencies of a slender beam",
    "closed form: Euler, Bernoulli",
)
def test_a_solid_is_a_beam():
    pytest.importorskip("skfem")
    box = carom.Box(1.0, 0.02, 0.03)
    solid = flexible.solid(box, **STEEL, modes=4, cells=24)
    beam = flexible.beam(1.0, flexible.Rectangle(0.02, 0.03), **STEEL, modes=4)
    agree(solid.frequencies, beam.frequencies, rtol=0.01)
    agree(solid.mass, beam.mass, rtol=1e-9)
    agree(np.diag(solid.inertia), np.diag(beam.inertia), rtol=1e-9)


@verifies(
    "Modes.reduce",
    r"a row of masses on springs, one end held: $\omega_j = 2\sqrt{k/m} \sin((2j-1)\pi/(4n+2))$",
    "closed form",
)
@pytest.mark.parametrize("sparse", [False, True])
def test_modes_of_matrices(sparse):
    from scipy.sparse import csc_matrix

    n, m, k = 6, 0.1, 2e5
    line = np.diag(np.r_[np.full(n - 1, 2.0), 1.0]) - np.eye(n, k=1) - np.eye(n, k=-1)
    M, K = m * np.eye(3 * n), np.kron(k * line, np.eye(3))  # the same along all axes
    nodes = np.stack([0.1 * np.arange(n), 0.01 * np.arange(n) ** 2, np.zeros(n)], axis=1)
    made = carom.Modes.reduce(
        *(map(csc_matrix, (M, K)) if sparse else (M, K)), nodes=nodes, modes=3 * n
    )
    j = np.arange(1, n + 1)
    exact = 2.0 * np.sqrt(k / m) * np.sin((2 * j - 1) * np.pi / (4 * n + 2)) / (2.0 * np.pi)
    agree(made.frequencies, np.repeat(exact, 3), rtol=1e-10)
    assert made.supported
    agree(made.mass, n * m, rtol=1e-12)
    # the last mass pulled by 1 N: n springs in a row
    agree(made.compliance(nodes[-1] - nodes.mean(axis=0)), n / k * np.eye(3), atol=1e-9 * n / k)


def struck(modes, place, mass: float):
    """Return W and the displacements by modes at a place that a mass strikes along z."""
    phi = modes.shapes([place])[0, 2]
    return 1.0 / mass + phi @ phi, phi


@verifies(
    "add_static(modes=)",
    r"one impact, $e = 1$: $P = 2 v/W$, $W = 1/m + \Phi^T \Phi$, then $\eta = -\Phi P \sin(\omega t)/\omega$",
    "closed form",
)
@pytest.mark.parametrize("ends", ["pinned", "clamped"])
def test_a_ball_strikes_a_beam(ends):
    modes = flexible.beam(
        1.0, flexible.Rectangle(0.02, 0.02), **STEEL, ends=ends, modes=12, kinds=("bend",)
    )
    scene = carom.Scene(gravity=(0, 0, 0))
    beam = scene.add_static(carom.Box(1.0, 0.02, 0.02), modes=modes, name="beam")
    mass, radius, gap = 0.3, 0.02, 1e-4
    place = 0.1, 0, 0.01 + radius + gap
    ball = scene.add_body(
        carom.Sphere(radius), mass=mass, position=place, velocity=(0, 0, -1), name="ball"
    )
    scene.add_contact(ball, beam, restitution=1.0, friction=0.0)
    s = carom.simulate(scene, 2e-3, rtol=1e-10)
    assert len(s.impacts) == 1
    W, phi = struck(modes, (0.1, 0.0, 0.01), mass)
    P, w = 2.0 / W, 2.0 * np.pi * modes.frequencies
    agree(s["ball"].velocity[-1, 2], -1.0 + P / mass, atol=1e-6)  # shapes are splines: 1e-6 of them
    eta = -np.outer(np.sin(np.outer(s.t - gap, w)) * (s.t > gap)[:, None], np.ones(1)).reshape(
        len(s.t), -1
    )
    eta = eta * phi * P / w
    agree(s["beam"].modal, eta, atol=2e-6 * np.abs(eta).max())
    assert np.abs(s.ledger.residual).max() < 1e-8 * 0.5 * mass


@verifies(
    "add_body(modes=)",
    r"a mass $M = m$ on the end of a free bar: $v \to v_0 e^{-2}$ as modes grow",
    "closed form: waves in the bar",
)
def test_a_mass_strikes_the_end_of_a_bar():
    errors, v0 = [], 1.0
    for count in (5, 20):
        modes = flexible.beam(1.0, flexible.Circle(0.01), **STEEL, modes=count, kinds=("stretch",))
        scene = carom.Scene(gravity=(0, 0, 0))
        bar = scene.add_body(carom.Box(1.0, 0.02, 0.02), modes=modes, name="bar")
        place, sphere = (-0.55 - 1e-6, 0, 0), carom.Sphere(0.05)
        ball = scene.add_body(
            sphere, mass=modes.mass, position=place, velocity=(v0, 0, 0), name="ball"
        )
        scene.add_contact(ball, bar, restitution=0.0, friction=0.0)
        s = carom.simulate(scene, 6e-4)
        errors.append(abs(s["ball"].velocity[-1, 0] - np.exp(-2.0)))
        momentum = s["ball"].velocity[:, 0] + s["bar"].velocity[:, 0]
        np.testing.assert_allclose(momentum, v0, atol=1e-12)
        assert np.abs(s.ledger.residual).max() < 1e-5 * modes.mass
    # .0244 and .0058: like 1/n
    agree(errors[0] * 5, 0.122, atol=0.01)
    agree(errors[1] * 20, 0.116, atol=0.01)


def test_of_high_frequency_and_small_shape_it_is_the_rigid_body():
    """The bits differ, the motion does not: 1e-9 of the size."""
    box, ends = carom.Box(0.2, 0.1, 0.05), []
    for modes in (None, carom.Modes([1e5], 0.5, 2.0, lambda p: np.full((len(p), 3, 1), 1e-9))):
        scene = carom.Scene()
        how = {"mass": 2.0} if modes is None else {"modes": modes}
        body = scene.add_body(
            box, **how, position=(0, 0, 0.5), angular_velocity=(1, 2, 3), name="body"
        )
        scene.add_contact(
            body, scene.add_half_space((0, 0, 0), (0, 0, 1)), restitution=0.4, friction=0.3
        )
        ends.append(carom.simulate(scene, 0.4, rtol=1e-10)["body"].position[-1])
    np.testing.assert_allclose(ends[1], ends[0], atol=1e-7)


def test_a_beam_on_supports_hangs_by_its_weight():
    """q L^4/(8 E I) at the tip, of ten modes; it is at rest from the start."""
    section = flexible.Rectangle(0.02, 0.02)
    modes = flexible.beam(1.0, section, **STEEL, ends="clamped-free", modes=10, kinds=("bend",))
    scene = carom.Scene()
    scene.add_static(carom.Box(1.0, 0.02, 0.02), modes=modes, name="beam")
    s = carom.simulate(scene, 0.05)
    load = STEEL["density"] * section.area * 9.81
    tip = s["beam"].displacement((0.5, 0, 0))[:, 2]
    np.testing.assert_allclose(
        tip, -load / (8.0 * STEEL["young"] * section.second_moments[0]), rtol=1e-3
    )
    assert np.ptp(tip) < 1e-12
    assert np.abs(s["beam"].modal_rates).max() < 1e-12


def test_large_deflections_and_spins_are_said():
    section = flexible.Rectangle(0.002, 0.002)
    modes = flexible.beam(1.0, section, **STEEL, ends="clamped-free", modes=3, kinds=("bend",))
    scene = carom.Scene()
    scene.add_static(carom.Box(1.0, 0.002, 0.002), modes=modes, name="beam")  # hangs by .17 m
    with pytest.warns(
        carom.AccuracyWarning, match="'beam' is bent by .* more than a tenth of its size"
    ):
        carom.simulate(scene, 0.01)
    scene = carom.Scene(gravity=(0, 0, 0))
    free = flexible.beam(1.0, section, **STEEL, modes=3, kinds=("bend",))
    spin = 0.2 * 2.0 * np.pi * free.frequencies[0]
    scene.add_body(
        carom.Box(1.0, 0.002, 0.002), modes=free, angular_velocity=(0, spin, 0), name="rod"
    )
    with pytest.warns(carom.AccuracyWarning, match="'rod' turns with .* a tenth of its first"):
        carom.simulate(scene, 0.01)


def test_a_file_has_what_a_run_uses(tmp_path):
    modes = flexible.beam(1.0, flexible.Rectangle(0.04, 0.05), **STEEL, modes=6)
    scene = carom.Scene()
    bar = scene.add_body(carom.Box(1, 0.04, 0.05), modes=modes, position=(0, 0, 0.4), name="bar")
    scene.add_contact(
        bar, scene.add_half_space((0, 0, 0), (0, 0, 1)), restitution=0.3, friction=0.3
    )
    whole = carom.simulate(scene, 0.4, rtol=1e-6)
    half = carom.simulate(scene, 0.3, rtol=1e-6)
    half.save(tmp_path / "half.h5")
    again = carom.Solution.load(tmp_path / "half.h5")
    np.testing.assert_array_equal(again["bar"].modal, half["bar"].modal)
    place = (0.5, 0.02, 0.025)
    moved = half["bar"].displacement(place)
    np.testing.assert_allclose(
        again["bar"].displacement(place), moved, atol=1e-5 * np.abs(moved).max()
    )
    more = carom.resume(tmp_path / "half.h5", until=0.4)
    np.testing.assert_allclose(more.position[-1], whole.position[-1], atol=1e-4)


def test_a_body_takes_its_modes_with_it():
    modes = flexible.beam(1.0, flexible.Circle(0.01), **STEEL, modes=4)
    scene = carom.Scene()
    bar = scene.add_body(carom.Box(1, 0.02, 0.02), modes=modes, name="bar")
    assert [one.name for one in scene.bodies] == ["bar", "bar modes 1-3", "bar modes 4"]
    scene.remove(bar, dependents=True)
    assert scene.bodies == scene.forces == ()
