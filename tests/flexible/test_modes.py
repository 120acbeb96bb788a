"""Modes as data: of beams, plates and solids, from matrices, and in files."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
import skfem
from scipy import sparse
from scipy.special import roots_legendre
from skfem.models.elasticity import lame_parameters, linear_elasticity

import carom
from carom import Modes, flexible
from verified import agree, verifies

STEEL = {"density": 7800.0, "young": 210e9}
LENGTH, SECTION = 1.3, flexible.Rectangle(0.02, 0.03)
AREA, (ABOUT_Y, ABOUT_Z) = SECTION.area, SECTION.second_moments
ENDS = ("free", "clamped", "pinned", "clamped-free", "clamped-pinned")


def steel(ends: str, modes: int, *kinds: str) -> Modes:
    return flexible.beam(LENGTH, SECTION, **STEEL, ends=ends, modes=modes, kinds=kinds)


def root(function, low: float, high: float) -> float:
    """Return where a function changes sign, by bisection."""
    sign = np.sign(function(low))
    assert np.sign(function(high)) == -sign
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.sign(function(middle)) == sign else (low, middle)
    return 0.5 * (low + high)


#: equations of b L over their growing factor, and the number of half waves before the first root
EQUATIONS = {
    "free": (lambda x: math.cos(x) - 1.0 / math.cosh(x), 0.5),
    "clamped": (lambda x: math.cos(x) - 1.0 / math.cosh(x), 0.5),
    "pinned": (math.sin, 0.0),
    "clamped-free": (lambda x: math.cos(x) + 1.0 / math.cosh(x), -0.5),
    "clamped-pinned": (lambda x: math.tan(x) - math.tanh(x), 0.25),
}


@verifies(
    "flexible.beam",
    "cos bL cosh bL = 1 and those of other ends",
    "own integration: bisection",
)
@pytest.mark.parametrize("ends", ENDS)
def test_frequencies_of_bending(ends):
    equation, waves = EQUATIONS[ends]
    roots = [
        root(equation, math.pi * (n + waves) - 0.4, math.pi * (n + waves) + 0.4)
        for n in range(1, 31)
    ]
    speed = math.sqrt(STEEL["young"] / STEEL["density"] / AREA)
    w = (np.array(roots) / LENGTH) ** 2 * speed
    both = np.sort(np.r_[w * math.sqrt(ABOUT_Y), w * math.sqrt(ABOUT_Z)])[:40]
    agree(2.0 * np.pi * steel(ends, 40, "bend").frequencies, both, rtol=1e-10)


@verifies("flexible.beam", "w = n pi c / L, or (n - 1/2) pi c / L", "closed form")
@pytest.mark.parametrize("ends", ENDS)
def test_frequencies_of_stretch_and_twist(ends):
    n = np.arange(1, 21) - (0.5 if ends == "clamped-free" else 0.0)
    bar = math.sqrt(STEEL["young"] / STEEL["density"])
    shaft = bar * math.sqrt(SECTION.twist_constant / 2.6 / (ABOUT_Y + ABOUT_Z))
    for kind, speed in (("stretch", bar), ("twist", shaft)):
        agree(2.0 * LENGTH * steel(ends, 20, kind).frequencies, n * speed, rtol=1e-13)


def whole(modes: Modes, nodes: int = 200):
    """Return places in the whole beam, displacements there, and masses, of a Gaussian quadrature."""
    along, across = roots_legendre(nodes), roots_legendre(4)
    axes = [
        0.5 * size * rule[0] for size, rule in zip((LENGTH, 0.02, 0.03), (along, across, across))
    ]
    x, y, z = (one.ravel() for one in np.meshgrid(*axes, indexing="ij"))
    share = np.einsum("i,j,k->ijk", along[1], across[1], across[1]).ravel() / 8.0
    places = np.stack([x, y, z], axis=1)
    return places, modes.shapes(places), share * modes.mass


def slopes(modes: Modes):
    """Return dv/dx and dw/dx (2, n) at places along the beam by its sections: u = -y v' - z w'."""
    s, weight = roots_legendre(200)
    x = np.stack([0.5 * LENGTH * s, 0.0 * s, 0.0 * s], axis=1)
    along = [modes.shapes(x - np.eye(3)[axis])[:, 0] - modes.shapes(x)[:, 0] for axis in (1, 2)]
    return along, 0.5 * LENGTH * weight * STEEL["density"]


@verifies(
    "flexible.beam",
    "integral of density Phi_i . Phi_k = delta_ik, 60 modes",
    "own integration: quadrature",
)
@pytest.mark.parametrize("ends", ENDS)
def test_masses_are_unit(ends):
    for kind in ("stretch", "twist"):
        _, phi, mass = whole(steel(ends, 60, kind))
        agree(np.einsum("k,kai,kaj->ij", mass, phi, phi), np.eye(60), atol=1e-12)
    bent = steel(ends, 60, "bend")
    _, phi, mass = whole(bent)
    along, line = slopes(bent)
    # the inertia of sections that turn, which the theory of Euler and Bernoulli leaves out
    turning = sum(
        second * np.einsum("k,ki,kj->ij", line, one, one)
        for one, second in zip(along, (ABOUT_Z, ABOUT_Y))
    )
    made = np.einsum("k,kai,kaj->ij", mass, phi, phi)
    agree(made - turning, np.eye(60), atol=1e-12)
    assert turning[0, 0] < 0.01 < turning[-1, -1] < 0.4  # small for long waves alone


@verifies(
    "Modes",
    "integrals of density Phi and density r x Phi = 0",
    "own integration: quadrature",
)
def test_free_modes_do_not_move_the_whole():
    for kind in ("bend", "stretch", "twist"):
        modes = steel("free", 30, kind)
        places, phi, mass = whole(modes)
        agree(np.einsum("k,kan->an", mass, phi), 0.0, atol=1e-13)
        turned = np.einsum("k,kan->an", mass, np.cross(places[:, :, None], phi, axis=1))
        if kind == "bend":  # but for the spin of the sections, second moments times the slopes
            along, line = slopes(modes)
            turned[1] += ABOUT_Y * (line @ along[1])
            turned[2] -= ABOUT_Z * (line @ along[0])
        agree(turned, 0.0, atol=1e-12)


@verifies("Modes", "integral of density Phi", "own integration: quadrature")
@pytest.mark.parametrize("ends", ENDS)
def test_participation(ends):
    modes = steel(ends, 40, "bend", "stretch", "twist")
    _, phi, mass = whole(modes)
    agree(modes.participation, np.einsum("k,kan->an", mass, phi), atol=1e-12)


def test_participation_of_all_modes_is_the_mass():
    modes = steel("clamped-free", 400, "bend")
    share = np.sum(modes.participation**2, axis=1) / modes.mass
    assert share[0] == 0.0
    assert np.all((share[1:] < 1.0) & (share[1:] > 0.997))


#: a place (share of the half length), and the deflection there by F = 1, times E I
DEFLECTIONS = {
    "clamped-free": (1.0, LENGTH**3 / 3.0),
    "pinned": (0.0, LENGTH**3 / 48.0),
    "clamped": (0.0, LENGTH**3 / 192.0),
    "clamped-pinned": (0.0, 7.0 * LENGTH**3 / 768.0),
}


@verifies("Modes", "F L^3/(3 E I), L^3/48, L^3/192, 7 L^3/768", "closed form")
@pytest.mark.parametrize("ends", DEFLECTIONS)
def test_compliance_is_the_static_deflection(ends):
    share, exact = DEFLECTIONS[ends]
    place, exact = (0.5 * share * LENGTH, 0.0, 0.0), exact / STEEL["young"] / ABOUT_Y
    errors = [1.0 - steel(ends, n, "bend").compliance(place)[2, 2] / exact for n in (20, 80, 320)]
    agree(errors[-1], 0.0, atol=4e-7)
    assert errors[0] > errors[1] > errors[2] > 0.0  # from below
    assert math.log(errors[1] / errors[2], 4.0) == pytest.approx(3.0, abs=0.1)  # sum of 1/n^4


@verifies("Modes", "F L/(E A), twist L/(G J)", "closed form")
def test_compliance_of_stretch_and_twist():
    stretched = [
        steel("clamped-free", n, "stretch").compliance((0.5 * LENGTH, 0, 0))[0, 0]
        for n in (100, 200)
    ]
    # of order 1: the remainder is that of the sum of 1/n^2
    agree(2.0 * stretched[1] - stretched[0], LENGTH / STEEL["young"] / AREA, rtol=1e-4)
    twisted = [
        steel("clamped-free", n, "twist").compliance((0.5 * LENGTH, 0, 0.015))[1, 1] / 0.015**2
        for n in (100, 200)
    ]
    stiffness = STEEL["young"] / 2.6 * SECTION.twist_constant
    agree(2.0 * twisted[1] - twisted[0], LENGTH / stiffness, rtol=1e-4)


#: J/(a b^3) of rectangles a x b by a/b (Timoshenko and Goodier, Theory of Elasticity, table of art. 109)
TWIST = {1.0: 0.1406, 1.5: 0.196, 2.0: 0.229, 3.0: 0.263, 5.0: 0.291, 10.0: 0.312}


@verifies("flexible.Rectangle", "J = k a b^3 by a/b", "publication: Timoshenko and Goodier")
def test_twist_constants():
    for ratio, exact in TWIST.items():
        for one in (flexible.Rectangle(ratio, 1.0), flexible.Rectangle(1.0, ratio)):
            agree(one.twist_constant / ratio, exact, atol=6e-4 if ratio > 1.0 else 5e-5)


@verifies("flexible.Circle", "area, second and polar moments", "own integration: quadrature")
@verifies("flexible.Tube", "area, second and polar moments", "own integration: quadrature")
def test_sections_by_quadrature():
    r, weight = roots_legendre(20)
    angle = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    for section, inner in ((flexible.Circle(0.03), 0.0), (flexible.Tube(0.03, 0.01), 0.02)):
        radius = inner + 0.5 * (0.03 - inner) * (1.0 + r)
        area = np.outer(0.5 * (0.03 - inner) * weight * radius, np.full(24, np.pi / 12.0))
        second = np.sum(area * np.outer(radius, np.cos(angle)) ** 2)
        made = section.area, *section.second_moments, section.twist_constant
        agree(made, (area.sum(), second, second, 2.0 * second), rtol=1e-12)


def test_random_beams():
    rng = np.random.default_rng(78)
    s, weight = roots_legendre(160)
    for _ in range(300):
        length, ends = 10.0 ** rng.uniform(-3, 2), str(rng.choice(ENDS))
        size = length * 10.0 ** rng.uniform(-3, -0.7, 2)
        section = (
            flexible.Circle(size[0]), flexible.Tube(size[0], size[0] * rng.uniform(0.05, 0.95)),
            flexible.Rectangle(*size),
        )[rng.integers(3)]  # fmt: skip
        kinds = [k for k in ("bend", "stretch", "twist") if rng.random() < 0.6] or ["bend"]
        n = int(rng.integers(1, 61))
        modes = flexible.beam(
            length, section, 10.0 ** rng.uniform(2, 4), 10.0 ** rng.uniform(6, 12),
            rng.uniform(0, 0.5), ends, n, kinds,
        )  # fmt: skip
        assert len(modes) == n
        assert modes.supported == (ends != "free")
        assert np.all(np.diff(modes.frequencies) >= 0.0)
        x = np.stack([0.5 * length * s, 0.0 * s, 0.0 * s], axis=1)
        phi = modes.shapes(x)
        # twist, by how a place beside the axis moves across
        polar = sum(section.second_moments) / section.area
        turn = modes.shapes(x + [0.0, 0.0, math.sqrt(polar)])[:, 1] - phi[:, 1]
        mass = 0.5 * weight * modes.mass
        gram = np.einsum("k,kai,kaj->ij", mass, phi, phi) + np.einsum(
            "k,ki,kj->ij", mass, turn, turn
        )
        np.testing.assert_allclose(gram, np.eye(n), atol=1e-10)


#: of a free square plate, ratio .3: converged (here by 40 degrees and more), and Leissa's upper bounds
SQUARE, LEISSA = (13.468, 19.596, 24.270, 34.801), (13.489, 19.789, 24.432, 35.024)


def plate(length: float, width: float, modes: int) -> np.ndarray:
    """Return w sqrt(rho h/D) of a free plate with the ratio .3."""
    made = flexible.plate(length, width, 0.01, 100.0, 12e6 * (1.0 - 0.09), modes=modes)
    return 2.0 * np.pi * made.frequencies


@verifies(
    "flexible.plate", "w a^2 sqrt(rho h/D) of a free square", "publication: Leissa 1973, converged"
)
def test_square_plate():
    made = plate(1.0, 1.0, 5)
    agree(made[:4], SQUARE, atol=6e-4)
    agree(made[4], made[3], rtol=1e-7)  # a pair
    assert np.all(made[:4] < LEISSA)
    assert np.all(made[:4] > 0.99 * np.array(LEISSA))


@verifies(
    "flexible.plate", "a strip is a beam: (b L)^2 sqrt(1 - nu^2) -> 22.373, 61.673", "closed form"
)
def test_narrow_plates_are_beams():
    free = math.sqrt(1.0 - 0.09) * np.array([4.730040744862704, 7.853204624095838]) ** 2
    for width in (0.05, 0.01):
        along, across = plate(1.0, width, 8), plate(width, 1.0, 8)
        agree(along, across, rtol=1e-7)
        for one in free:
            agree(along[np.argmin(np.abs(along - one))], one, rtol=4e-4 if width < 0.02 else 4e-3)


def test_plates_with_many_modes_agree_with_more_polynomials(monkeypatch):
    import sys

    module = sys.modules["carom.flexible.plates"]
    few = {sides: plate(*sides, 20) for sides in ((1.0, 1.0), (1.0, 0.1))}
    monkeypatch.setattr(module, "MORE", 16)
    for sides, made in few.items():
        np.testing.assert_allclose(plate(*sides, 20), made, rtol=1e-6)
    with pytest.raises(ValueError, match=r"modes must be fewer for sides of 1 and 0.001 m"):
        plate(1.0, 0.001, 200)


def test_shapes_of_plates_are_orthonormal():
    modes = flexible.plate(0.7, 0.4, 0.01, 2700.0, 70e9, modes=20)
    s, weight = roots_legendre(60)
    x, y = (one.ravel() for one in np.meshgrid(0.35 * s, 0.2 * s, indexing="ij"))
    mass = np.outer(weight, weight).ravel() / 4.0 * modes.mass
    phi = modes.shapes(np.stack([x, y, 0.0 * x], axis=1))
    np.testing.assert_allclose(np.einsum("k,kai,kaj->ij", mass, phi, phi), np.eye(20), atol=1e-9)
    np.testing.assert_allclose(np.stack([mass, mass * x, mass * y]) @ phi[:, 2], 0.0, atol=1e-9)
    # and sections stay perpendicular
    step, place = 1e-5, np.array([0.13, -0.07, 0.004])
    rise = modes.shapes([place + [step, 0, 0], place - [step, 0, 0]])[:, 2]
    np.testing.assert_allclose(
        modes.shapes([place])[0, 0], -0.004 * (rise[0] - rise[1]) / (2.0 * step), rtol=1e-6
    )


@verifies("flexible.solid", "a clamped rod of 1 m x 20 mm x 30 mm: beam", "closed form")
def test_solids_are_beams():
    exact = flexible.beam(1.0, SECTION, **STEEL, modes=3, ends="clamped-free").frequencies
    made = flexible.solid(
        carom.Box(1.0, 0.02, 0.03), **STEEL, modes=3, cells=16, fixed=lambda p: p[:, 0] < -0.4999
    )
    agree(made.frequencies, exact, rtol=0.01)
    assert made.supported
    # of the mass that moves along z and y with the first mode: 61.3 %
    agree(np.max(made.participation**2, axis=1)[1:] / made.mass, 0.6131, atol=0.003)


@verifies(
    "flexible.solid", "stretch of a block, ratio 0: c/(2 L), error as cells^-4", "closed form"
)
def test_solids_converge_with_the_fourth_power():
    made = np.array([
        flexible.solid(carom.Box(1.0, 0.5, 0.5), 1.0, 1.0, 0.0, modes=4, cells=n).frequencies
        for n in (4, 8)
    ])  # fmt: skip
    agree(made[1, 3], 0.5, atol=1e-5)
    assert np.log2((made[0, 3] - 0.5) / (made[1, 3] - 0.5)) == pytest.approx(4.0, abs=0.4)
    assert np.all(made[0] > made[1])  # from above


def test_a_free_solid_has_the_mass_of_its_box():
    box = carom.Box(0.4, 0.05, 0.08)
    made = flexible.solid(box, **STEEL, modes=4, cells=6, damping=0.01)
    assert made.mass == pytest.approx(7800.0 * 0.4 * 0.05 * 0.08, rel=1e-12)
    np.testing.assert_allclose(made.inertia, box.inertia(made.mass), atol=1e-9)
    np.testing.assert_array_equal(made.damping, 0.01)
    exact = flexible.beam(0.4, flexible.Rectangle(0.05, 0.08), **STEEL, modes=1).frequencies
    np.testing.assert_allclose(made.frequencies[0], exact, rtol=0.05)  # shear: (h/L)^2 is .04
    # by its mesh the same
    mesh = skfem.MeshTet.init_tensor(
        *(np.linspace(0.0, s, n) for s, n in zip((0.4, 0.05, 0.08), (7, 3, 3)))
    )
    for one in (mesh, (mesh.p.T, mesh.t.T)):
        again = flexible.solid(one, **STEEL, modes=4)
        np.testing.assert_allclose(again.frequencies, made.frequencies, rtol=1e-6)
        size = [np.linalg.norm(m.shapes([(0.2, 0.025, 0.04)])[0], axis=0) for m in (again, made)]
        np.testing.assert_allclose(*size, rtol=1e-5)


@pytest.mark.parametrize(
    ("fixed", "message"),
    [
        (lambda p: p[:, 0] < -9.0, "got 0 of 225"),
        (lambda p: p[:, 0] > -9.0, "got 225 of 225"),
        (
            lambda p: (p[:, 0] < -0.49) & (p[:, 1] < -0.009),
            r"fixed must hold three places .* got 5",
        ),
        (lambda p: True, r"fixed must return \(k,\) bool for places \(k, 3\), got \(\)"),
    ],
)
def test_solids_must_be_held_as_a_whole(fixed, message):
    with pytest.raises(ValueError, match=message):
        flexible.solid(carom.Box(1.0, 0.02, 0.03), **STEEL, cells=4, fixed=fixed)


def test_modes_are_copied_to_other_processes():
    places = np.array([(0.1, 0.01, 0.005), (-0.3, 0.0, -0.01)])
    made = (
        flexible.beam(1.0, SECTION, **STEEL), flexible.plate(1.0, 0.4, 0.02, **STEEL),
        flexible.solid(carom.Box(1.0, 0.1, 0.1), **STEEL, cells=4),
        flexible.beam(1.0, SECTION, **STEEL).first(2),
    )  # fmt: skip
    for modes in made:
        again = pickle.loads(pickle.dumps(modes))
        np.testing.assert_array_equal(again.shapes(places), modes.shapes(places))
        np.testing.assert_array_equal(again.frequencies, modes.frequencies)


# Matrices of another program


@pytest.fixture(scope="module")
def rod():
    """Return M and K of a free rod by finite elements, and its nodes."""
    lines = (np.linspace(2.0, 3.0, 9), np.linspace(0.0, 0.1, 2), np.linspace(0.0, 0.15, 2))
    basis = skfem.Basis(
        skfem.MeshTet.init_tensor(*lines), skfem.ElementVector(skfem.ElementTetP2())
    )
    K = skfem.asm(linear_elasticity(*lame_parameters(1e9, 0.3)), basis)
    product = skfem.BilinearForm(lambda u, v, _: 1000.0 * sum(u[k] * v[k] for k in range(3)))
    return skfem.asm(product, basis), K, basis.doflocs[:, ::3].T


def on_ground(K, nodes):
    """Return K with springs under the nodes of one end."""
    end = np.repeat(nodes[:, 0] < 2.0 + 1e-9, 3)
    return K + sparse.diags(np.where(end, 1e9, 0.0)).tocsr()


def test_free_modes_of_matrices(rod):
    M, K, nodes = rod
    made = Modes.reduce(M, K, nodes=nodes, modes=10)
    assert not made.supported
    assert made.mass == pytest.approx(15.0, rel=1e-12)
    np.testing.assert_allclose(made.inertia, carom.Box(1.0, 0.1, 0.15).inertia(15.0), atol=1e-9)
    np.testing.assert_array_equal(made.participation, 0.0)
    # the six rigid motions are removed, and no other
    dense = np.linalg.eigvals(np.linalg.solve(M.toarray(), K.toarray())).real
    w = np.sqrt(np.sort(dense)[6:16])
    np.testing.assert_allclose(2.0 * np.pi * made.frequencies, w, rtol=1e-7)
    # orthonormal, about mean axes; the origin is the mass centre
    phi = made.shapes(nodes - [2.5, 0.05, 0.075]).reshape(-1, 10)
    np.testing.assert_allclose(phi.T @ (M @ phi), np.eye(10), atol=1e-9)
    moved = np.stack([np.tile(np.eye(3)[k], len(nodes)) for k in range(3)], axis=1)
    np.testing.assert_allclose(moved.T @ (M @ phi), 0.0, atol=1e-9)


def test_sparse_matrices_are_as_dense_ones(rod, monkeypatch):
    from carom.flexible import reduction

    M, K, nodes = rod
    K = on_ground(K, nodes)
    dense = Modes.reduce(M.toarray(), K.toarray(), nodes=nodes, modes=10)
    monkeypatch.setattr(reduction, "ALL_EIGENVALUES", 10)  # so that Lanczos' method is taken
    for held, frequencies in ((K, dense.frequencies), (rod[1], None)):
        made = Modes.reduce(M, held, nodes=nodes, modes=10)
        if frequencies is None:
            monkeypatch.setattr(reduction, "ALL_EIGENVALUES", 10_000)
            frequencies = Modes.reduce(M, held, nodes=nodes, modes=10).frequencies
        np.testing.assert_allclose(made.frequencies, frequencies, rtol=1e-8)


@verifies(
    "Modes.reduce",
    "static response of the interface of Craig and Bampton: K^-1",
    "own integration: dense solve",
)
def test_interfaces_deflect_as_the_whole_model(rod):
    M, K, nodes = rod
    K = on_ground(K, nodes)
    end = np.flatnonzero(nodes[:, 0] > 3.0 - 1e-9)[:4]
    made = Modes.reduce(M, K, nodes=nodes, interface=end, modes=1)
    assert made.supported
    assert len(made) == 13
    exact = np.linalg.inv(K.toarray())
    centre = np.array([2.5, 0.05, 0.075])
    for node in end:
        block = exact[3 * node : 3 * node + 3, 3 * node : 3 * node + 3]
        agree(made.compliance(nodes[node] - centre), block, atol=1e-9 * block.max())
    few = Modes.reduce(M, K, nodes=nodes, modes=13).compliance(nodes[end[0]] - centre)
    assert abs(few[0, 0] / exact[3 * end[0], 3 * end[0]] - 1.0) > 0.05  # which free modes do not


def test_interfaces_of_free_bodies(rod):
    M, K, nodes = rod
    end = np.flatnonzero(nodes[:, 0] > 3.0 - 1e-9)[:4]
    made = Modes.reduce(M, K, nodes=nodes, interface=end, modes=20)
    assert not made.supported
    assert len(made) == 3 * 4 + 20 - 6
    exact = Modes.reduce(M, K, nodes=nodes, modes=3).frequencies
    np.testing.assert_allclose(made.frequencies[:3], exact, rtol=2e-3)
    assert np.all(made.frequencies[:3] >= exact * (1.0 - 1e-9))
    for interface in ([0], [0, 1]):
        with pytest.raises(ValueError, match="interface of a free body must have three nodes"):
            Modes.reduce(M, K, nodes=nodes, interface=interface)


def test_damping_of_matrices(rod):
    M, K, nodes = rod
    made = Modes.reduce(M, K, 3.0 * M + 2e-5 * K, nodes=nodes, modes=5)
    w = 2.0 * np.pi * made.frequencies
    np.testing.assert_allclose(made.damping, 1.5 / w + 1e-5 * w, rtol=1e-9)


def test_matrices_of_three_masses_on_springs():
    nodes = [(0.0, 0, 0), (1.0, 0, 0), (0.0, 1, 0)]
    made = Modes.reduce(2.0 * np.eye(9), 8.0 * np.eye(9), nodes=nodes, modes=9)
    np.testing.assert_allclose(made.frequencies, 1.0 / np.pi)
    np.testing.assert_allclose(
        made.participation @ made.participation.T, 6.0 * np.eye(3), atol=1e-12
    )
    with pytest.raises(ValueError, match=r"K must hold all six motions .* or none"):
        Modes.reduce(np.eye(9), np.diag([1.0, 1, 1, 0, 0, 0, 0, 0, 0]), nodes=nodes)
    with pytest.raises(ValueError, match="K must hold all parts of the body together"):
        Modes.reduce(np.eye(9), np.zeros((9, 9)), nodes=nodes)
    for line in ([(0, 0, 0)], [(0, 0, 0), (1, 0, 0), (3, 0, 0)]):
        size = 3 * len(line)
        with pytest.raises(
            ValueError, match="nodes must have three places or more that are not on"
        ):
            Modes.reduce(np.eye(size), np.eye(size), nodes=line)


def test_loose_parts_of_matrices_are_refused(rod):
    M, K, nodes = rod
    twice = sparse.block_diag([M, M]), sparse.block_diag([K, K])
    with pytest.raises(ValueError, match="K must hold all parts of the body together"):
        Modes.reduce(*twice, nodes=np.r_[nodes, nodes + 2.0], modes=4)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"M": np.eye(8)},
            r"M must have shape \(9, 9\), three rows for each of 3 nodes, got \(8, 8\)",
        ),
        ({"K": np.triu(np.ones((9, 9)))}, "K must be finite and symmetric"),
        ({"K": np.full((9, 9), np.nan)}, "K must be finite and symmetric"),
        ({"M": -np.eye(9)}, "M must have a positive mass, got -3 kg"),
        ({"C": np.eye(3)}, r"C must have shape \(9, 9\)"),
        ({"interface": [3]}, "interface must be a whole number of at least 0 and at most 2, got"),
        ({"modes": 0}, "modes must be"),
        ({"nodes": np.zeros((3, 2))}, "nodes must have shape"),
    ],
)
def test_bad_matrices(change, message):
    given = {"M": np.eye(9), "K": np.eye(9), "nodes": np.eye(3), "modes": 2} | change
    with pytest.raises(ValueError, match=message):
        Modes.reduce(given.pop("M"), given.pop("K"), given.pop("C", None), **given)


# Data


def test_first_modes():
    modes = steel("clamped-free", 12, "bend", "stretch")
    few = modes.first(5)
    np.testing.assert_array_equal(few.frequencies, modes.frequencies[:5])
    np.testing.assert_array_equal(few.participation, modes.participation[:, :5])
    places = [(0.3, 0.004, -0.01), (LENGTH / 2, 0, 0)]
    np.testing.assert_array_equal(few.shapes(places), modes.shapes(places)[..., :5])
    assert (few.mass, few.supported, len(few)) == (modes.mass, True, 5)
    mixed = Modes([3.0, 1.0, 2.0], 0.1, shapes=lambda p: np.tile([1.0, 2.0, 3.0], (len(p), 3, 1)))
    np.testing.assert_array_equal(mixed.first(2).frequencies, [1.0, 2.0])
    np.testing.assert_array_equal(mixed.first(2).shapes([(0, 0, 0)])[0, 0], [2.0, 3.0])
    with pytest.raises(ValueError, match="n must be"):
        modes.first(13)


@pytest.mark.parametrize("name", ["rod.npz", "rod"])
def test_files(tmp_path, name):
    modes = flexible.beam(LENGTH, SECTION, **STEEL, modes=6, ends="clamped-free", damping=0.01)
    grid = [np.linspace(-0.5 * s, 0.5 * s, n) for s, n in ((LENGTH, 21), (0.02, 2), (0.03, 2))]
    points = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 3)
    with pytest.raises(
        ValueError, match="points must be given for modes whose shapes are a function"
    ):
        modes.save(tmp_path / name)
    modes.save(tmp_path / name, points)
    again = Modes.load(tmp_path / name)
    for field in ("frequencies", "damping", "mass", "inertia", "supported", "participation"):
        np.testing.assert_array_equal(getattr(again, field), getattr(modes, field))
    np.testing.assert_allclose(again.shapes(points), modes.shapes(points), atol=1e-9)
    between = points + [0.01, 0.003, 0.004]
    between = between[between[:, 0] < 0.5 * LENGTH]
    np.testing.assert_allclose(again.shapes(between), modes.shapes(between), atol=0.02)
    # what is loaded is saved, and shortened, without points
    again.first(3).save(tmp_path / "again.npz")
    third = Modes.load(tmp_path / "again.npz")
    np.testing.assert_allclose(third.shapes(points), modes.shapes(points)[..., :3], atol=1e-9)


def test_files_of_something_else(tmp_path):
    (tmp_path / "text.npz").write_text("frequencies: 1, 2, 3")
    np.savez(tmp_path / "other.npz", mass=1.0)
    np.save(tmp_path / "array.npy", np.zeros(3))
    with pytest.raises(ValueError, match=r"path must be a file of Modes, got .*text.npz"):
        Modes.load(tmp_path / "text.npz")
    with pytest.raises(
        ValueError, match=r"other.npz without \['frequencies', 'points', 'shapes'\]"
    ):
        Modes.load(tmp_path / "other.npz")
    with pytest.raises(ValueError, match=r"path must be a file of Modes, got .*array.npy"):
        Modes.load(tmp_path / "array.npy")


def one(points):
    return np.zeros((len(points), 3, 1))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Modes([], shapes=one), r"frequencies must have shape \(n,\), n > 0, got"),
        (lambda: Modes(3.0, shapes=one), r"frequencies must have shape \(n,\), n > 0, got"),
        (lambda: Modes([0.0], shapes=one), r"frequencies must be above 0 \[Hz\], those of rigid"),
        (lambda: Modes([np.nan], shapes=one), "frequencies must be finite"),
        (lambda: Modes([1.0], -0.1, shapes=one), "damping must be at least 0, got -0.1"),
        (lambda: Modes([1.0], [0.1, 0.1], shapes=one), "damping must have shape"),
        (lambda: Modes([1.0], mass=0.0, shapes=one), "mass must be"),
        (lambda: Modes([1.0]), "shapes must be a function of points .*, got None"),
        (lambda: Modes([1.0, 2.0], shapes=one), r"shapes must return \(k, 3, 2\) .* got \(2, 3, 1\)"),
        (lambda: Modes([1.0], shapes=(np.zeros((4, 2)), 0)), r"shapes\[0\] must have shape"),
        (lambda: Modes([1.0], shapes=(np.eye(3), np.zeros((3, 3, 2)))), r"shapes\[1\] must have shape"),
        (lambda: Modes([1.0], shapes=one, inertia=(1.0, 1.0, 3.0)), "inertia"),
        (lambda: Modes([1.0], shapes=one, participation=np.zeros(3)), "participation must have shape"),
        (lambda: Modes([1.0], shapes=one).shapes((1.0, 2.0)), "points must have shape"),
        (lambda: Modes([1.0], shapes=one).compliance((1.0, 2.0)), "point must have shape"),
        (lambda: flexible.beam(0.0, SECTION, 1.0, 1.0), "length must be"),
        (lambda: flexible.beam(1.0, 0.01, 1.0, 1.0), "section must be"),
        (lambda: flexible.beam(1.0, SECTION, 1.0, 1.0, 0.6), "poisson must be"),
        (lambda: flexible.beam(1.0, SECTION, 1.0, 1.0, ends="fixed"), "ends must be"),
        (lambda: flexible.beam(1.0, SECTION, 1.0, 1.0, modes=0), "modes must be"),
        (lambda: flexible.beam(1.0, SECTION, 1.0, 1.0, kinds=()), "kinds must have at least one"),
        (lambda: flexible.beam(1.0, SECTION, 1.0, 1.0, kinds=("bending",)), "kinds must be"),
        (lambda: flexible.plate(1.0, 1.0, -0.1, 1.0, 1.0), "thickness must be"),
        (lambda: flexible.plate(1.0, 1.0, 0.1, 1.0, 1.0, modes=201), "modes must be"),
        (lambda: flexible.Tube(0.02, 0.02), "thickness must be below the radius 0.02 m"),
        (lambda: flexible.Circle(-1.0), "radius must be"),
        (lambda: flexible.solid(carom.Sphere(1.0), 1.0, 1.0), "shape must be a Box, or a mesh"),
        (lambda: flexible.solid(carom.Box(1, 1, 1), 1.0, 1.0, poisson=0.5), "poisson must be"),
        (lambda: flexible.solid(carom.Box(1, 1, 1), 1.0, 1.0, fixed=3), "fixed must be"),
    ],
)  # fmt: skip
def test_bad_data(make, message):
    with pytest.raises((ValueError, TypeError), match=message):
        make()
