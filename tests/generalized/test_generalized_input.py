"""What is refused, and the sentence that says so; what is handed back."""

import sys

import numpy as np
import pytest
import sympy as sp

import carom
from carom import GeneralizedSystem

X, Y, DX, DY = sp.symbols("x y dx dy")
FREE = dict(metric=sp.eye(2), position=[0, 1], velocity=[0, 0])


def build(**changes):
    return GeneralizedSystem.from_sympy([X, Y], [DX, DY], **{**FREE, **changes})


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (dict(kinetic_energy=DX**2), "kinetic_energy or metric must be given, and not both"),
        (dict(metric=None, kinetic_energy=DX**2 + DY), "quadratic form"),
        (dict(metric=None, kinetic_energy=DX**2 + 1), "quadratic form"),
        (dict(metric=sp.eye(3)), r"shape \(2, 2\)"),
        (dict(metric=sp.Matrix([[1, X], [0, 1]])), "must be symmetric"),
        (dict(metric=sp.diag(1, -1)), "positive definite"),
        (dict(potential=X * sp.Symbol("k")), "parameters with a value, got k.x with k"),
        (dict(potential=DX), "in terms of coordinates"),
        (dict(forces=[1]), "forces must be 2"),
        (dict(rates=[DX**2]), "linear in the velocities"),
        (dict(rates=[DX + 1]), "linear in the velocities"),
        (dict(constraints=[X - 1]), "must satisfy the constraints"),
        (dict(position=[0, np.nan]), "position must be finite"),
        (dict(velocity=[0]), "velocity must have shape"),
        (dict(parameters={sp.Symbol("k"): "no"}), "parameters"),
        (dict(forces=[sp.zeta(X), 0]), "cannot be compiled"),
    ],
)
def test_bad_system(changes, sentence):
    with pytest.raises(ValueError, match=sentence):
        carom.simulate(build(**changes), 0.1, step=0.1)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (dict(gap=Y, restitution=1.5), "restitution must be"),
        (dict(gap=Y, restitution=0.5, friction=0.1), "friction needs a tangent"),
        (dict(gap=Y, restitution=0.5, tangent=DX**2), "linear in the velocities"),
        (dict(gap=Y, restitution=0.5, tangent=[DX, DY, DX]), "one or two"),
        (dict(gap=sp.Integer(1), restitution=0.5), "depend on the coordinates"),
        (dict(gap=len, restitution=0.5), "must be an expression"),
        (dict(gap=Y, restitution=0.5, impact_law="new"), "impact_law must be one of"),
    ],
)
def test_bad_contact(given, sentence):
    with pytest.raises(ValueError, match=sentence):
        build().add_contact(**given)


def test_a_start_inside_a_contact_or_against_a_constraint():
    system = build(position=[0, -1])
    system.add_contact(Y, restitution=0.5, name="floor")
    with pytest.raises(ValueError, match="inside a contact, got the gap -1 of 'floor'"):
        carom.simulate(system, 1.0, step=0.1)
    system = build(constraints=[X], velocity=[1, 0])
    with pytest.raises(ValueError, match="velocity must satisfy the constraints"):
        carom.simulate(system, 1.0, step=0.1)
    run = carom.simulate(system, 1.0, step=0.1, options=carom.Options(project_start=True))
    np.testing.assert_array_equal(run.v[:, 0], 0.0)


def test_methods_and_places_of_scenes_alone():
    with pytest.raises(ValueError, match="method of a system in coordinates"):
        carom.simulate(build(), 1.0, step=0.1, method="paper")
    with pytest.raises(ValueError, match="impact_location of a system in coordinates"):
        carom.simulate(build(), 1.0, step=0.1, impact_location="project")
    with pytest.raises(TypeError, match=r"carom\.GeneralizedSystem"):
        carom.simulate("pendulum", 1.0, step=0.1)


def test_functions_of_the_wrong_shape():
    start = dict(position=[0.0], velocity=[0.0])
    with pytest.raises(TypeError, match="metric must be a function"):
        GeneralizedSystem(np.eye(1), **start)
    with pytest.raises(ValueError, match=r"metric\(q\) must have shape"):
        GeneralizedSystem(lambda q: 1.0, **start)
    with pytest.raises(ValueError, match=r"force\(t, q, v\) must have shape"):
        GeneralizedSystem(lambda q: np.eye(1), force=lambda t, q, v: 0.0, **start)
    system = GeneralizedSystem(lambda q: np.eye(1), **start)
    with pytest.raises(ValueError, match=r"tangent\(q\) must have shape"):
        system.add_contact(lambda q: q[0], tangent=lambda q: 1.0, restitution=0.5)


def test_functions_of_time_as_coordinates():
    # A pendulum with dynamicsymbols; small swings have the period 2 pi sqrt(l/g).
    from sympy.physics.mechanics import dynamicsymbols

    q, g, length = dynamicsymbols("q"), *sp.symbols("g l")
    system = GeneralizedSystem.from_sympy(
        [q], kinetic_energy=(length * q.diff()) ** 2 / 2, potential=-g * length * sp.cos(q),
        parameters={g: 9.81, length: 2.0}, position=[1e-4], velocity=[0],
    )  # fmt: skip
    period = 2 * np.pi * np.sqrt(2.0 / 9.81)
    run = carom.simulate(system, period, step=1e-2)
    assert run.q[-1, 0] == pytest.approx(1e-4, rel=1e-6)


def test_without_sympy(monkeypatch):
    monkeypatch.setitem(sys.modules, "sympy", None)
    with pytest.raises(ImportError, match=r'pip install "carom\[sympy\]"'):
        build()


def test_solution(capsys):
    system = build(potential=9.81 * Y)
    system.add_contact(Y, restitution=0.8, name="floor")
    run = carom.simulate(system, 1.0, step=0.1, save_every=2, progress=True)
    assert "1 events" in capsys.readouterr().err
    assert run.t.tolist() == pytest.approx([0, 0.2, 0.4, 0.6, 0.8, 1.0])
    assert "2 coordinates" in repr(run)
    assert run.success
    assert repr(run.impacts) == "<CoordinateImpactTable: 1 impacts>"
    hit = run.impacts[0]
    assert hit.contact == 0
    assert hit.law == "newton"
    with pytest.raises(IndexError):
        run.impacts[1]
    time = np.sqrt(2 / 9.81)
    for side, speed in (("left", -time * 9.81), ("right", 0.8 * time * 9.81)):
        q, v = run.evaluate(hit.time, side)
        np.testing.assert_allclose(q, [0, 0], atol=1e-14)
        np.testing.assert_allclose(v, [0, speed], rtol=0, atol=1e-13)
    t = np.linspace(0, 1, 50)
    q, v = run.evaluate(t)
    height = np.where(
        t < time, 1 - 9.81 * t**2 / 2, 0.8 * 9.81 * time * (t - time) - 9.81 * (t - time) ** 2 / 2
    )
    np.testing.assert_allclose(q[:, 1], height, rtol=0, atol=1e-13)
    with pytest.raises(ValueError, match="t must be within"):
        run.evaluate(2.0)
    with pytest.raises(ValueError, match="side"):
        run.evaluate(0.5, "up")


def test_interrupted_and_progress():
    seen = []
    run = carom.simulate(build(), 1.0, step=0.01, progress=lambda done, total: seen.append(done))
    assert run.success
    assert seen[-1] == 100

    def stop(done, total):
        if done >= 50:
            raise KeyboardInterrupt

    run = carom.simulate(build(), 1.0, step=0.01, progress=stop, throw=False)
    assert run.status is carom.Status.INTERRUPTED
    assert run.t[-1] == pytest.approx(0.5)


@pytest.mark.parametrize(
    "scale", [0.0, -1.0, [1.0], [1.0, 0.0], [[1.0], [1.0, 2.0]], "long", None, np.nan]
)
def test_a_scale_is_a_size_or_one_for_each_coordinate(scale):
    with pytest.raises((ValueError, TypeError), match="scale must"):
        build(scale=scale)


def test_a_solution_keeps_its_system_as_it_was():
    system = build()
    a, plain = (carom.simulate(one, 0.2, step=0.05) for one in (system, build()))
    system.add_contact(Y + 5, restitution=0.0)
    system.set_state([3, 3], [0, 0])
    assert a.system.position.tolist() == [0, 1]
    assert len(a.system.contacts) == 0
    np.testing.assert_array_equal(a.evaluate(0.12), plain.evaluate(0.12))
