"""Calls that run something, and what they hand back: systems in coordinates, runs, impacts, ensembles."""

import numpy as np

import carom
from bad_input import things
from bad_input.things import (
    W,
    kept,
    one_oscillator,
    oscillation,
    oscillator,
    runs,
    saved,
    solution,
    swing,
    thrown,
)
from carom.impact import geometry, slip_directions
from carom.studies import gradient
from carom.studies.ensembles import dice


def symbolic():
    import sympy as sp

    x, y, dx, dy, k, t = sp.symbols("x y dx dy k t")
    return carom.GeneralizedSystem.from_sympy, dict(
        coordinates=[x, y], velocities=[dx, dy], kinetic_energy=None, metric=sp.eye(2), potential=k * x**2,
        forces=[0, 0], constraints=[], rates=[], parameters={k: 1.0}, time=t, position=[0.0, 1.0],
        velocity=[0.0, 0.0], scale=1.0,
    )  # fmt: skip


def run(folder):
    """Return functions of (callable, arguments) by name; files are in a folder."""
    blow = dict(inverse_mass=W, velocity=(-1.0, 1.0, 0.0), friction=0.1, restitution=0.5)
    system = dict(metric=lambda q: np.eye(2), position=[0.0, 1.0], velocity=[0.0, 0.0])
    full = dict(
        **system, potential=lambda q: 0.0, force=lambda t, q, v: np.zeros(2), constraint=lambda q: q[:1],
        rows=lambda q: np.zeros((1, 2)), metric_derivative=lambda q: np.zeros((2, 2, 2)),
        potential_gradient=lambda q: np.zeros(2), constraint_jacobian=lambda q: np.array([[1.0, 0.0]]),
        scale=[1.0, 2.0],
    )  # fmt: skip
    found = {
        "GeneralizedSystem": lambda: (carom.GeneralizedSystem, full),
        "GeneralizedSystem.from_sympy": symbolic,
        "GeneralizedSystem.set_state": lambda: (oscillator().set_state, dict(position=[1.0], velocity=[0.0])),
        "GeneralizedSystem.add_contact": lambda: (
            carom.GeneralizedSystem(**system).add_contact,
            dict(gap=lambda q: q[1], tangent=lambda q: np.array([1.0, 0.0]),
                 gap_gradient=lambda q: np.array([0.0, 1.0]), restitution=0.5, friction=0.1,
                 impact_law="newton", tangential_restitution=0.5, name="new"),
        ),
        "GeneralizedSystem.evaluation": lambda: (one_oscillator().evaluation, {}),
        "GeneralizedSystem.metric": lambda: (one_oscillator().metric, dict(position=[1.0])),
        "GeneralizedSystem.christoffel": lambda: (one_oscillator().christoffel, dict(position=[1.0])),
        "GeneralizedSystem.gaps": lambda: (one_oscillator().gaps, dict(position=[1.0])),
        "GeneralizedSystem.autoparallel": lambda: (
            one_oscillator().autoparallel, dict(position=[1.0], velocity=[1.0]),
        ),
        "GeneralizedSystem.return_map": lambda: (
            one_oscillator().return_map, dict(position=[1.0], contact="wall"),
        ),
        "generalized.GeneralizedSolution.evaluate": lambda: (
            oscillation().evaluate, dict(t=0.01, side="left"),
        ),
    }  # fmt: skip

    given = dict(
        duration=0.02, step=0.01, method="rk4", rtol=None, atol=None, impact_location="locate", save_every=1,
        save_at=None, events=None, progress=None, options=carom.Options(), throw=True, save=None,
        save_seconds=60.0,
    )  # fmt: skip
    found |= {
        "simulate": lambda: (carom.simulate, dict(scene=thrown(), **given)),
        "simulate with steps of its own": lambda: (
            carom.simulate, dict(scene=thrown(), **{**given, "step": "auto", "rtol": 1e-6, "atol": 1e-6,
                                                    "method": "rk5"}),
        ),
        "simulate at times": lambda: (
            carom.simulate, dict(scene=thrown(), **{**given, "save_at": [0.0, 0.01, 0.02]}),
        ),
        "simulate with events": lambda: (
            carom.simulate, dict(scene=thrown(), **{**given, "events": [lambda t, state: 1.0]}),
        ),
        "simulate to a file": lambda: (
            carom.simulate, dict(scene=thrown(), **{**given, "save": folder / "run.nc"}),
        ),
        "simulate in coordinates": lambda: (carom.simulate, dict(scene=one_oscillator(), **given)),
        "Run": lambda: (
            carom.Run,
            dict(scene=thrown(), step=0.01, method="rk4", rtol=None, atol=None, save_every=1,
                 options=carom.Options()),
        ),
        "Run.advance": lambda: (carom.Run(thrown(), step=0.01).advance, dict(duration=0.02)),
        "Run.switch": lambda: (things.switched().switch, dict(part="push", off=True)),
        "Run.set_force": lambda: (things.pushed().set_force, dict(force="push", value=(0.0, 0.0, 1.0))),
        "Run.reset": lambda: (
            carom.Run(things.model()).reset,
            dict(state=carom.Run(things.model()).state, keyframe=None, qpos=[0.1], qvel=[0.2]),
        ),
        "Run.set_state": lambda: (
            carom.Run(things.model()).set_state,
            dict(state=carom.Run(things.model()).state, qpos=[0.1], qvel=[0.2]),
        ),
        "results.SystemState.joint_coordinates": lambda: (
            carom.Run(swing().scene).state.joint_coordinates, dict(joint="j", degrees=True),
        ),
        "resume": lambda: (
            carom.resume,
            dict(path=saved(folder), until=None, functions={}, system=None, save_seconds=60.0, progress=None,
                 throw=True),
        ),
        "Solution.load": lambda: (carom.Solution.load, dict(path=saved(folder), functions={})),
        "Solution.simulate": lambda: (solution().simulate, dict(duration=0.1, progress=None, throw=True)),
        "Solution.save": lambda: (solution().save, dict(path=folder / "again.nc")),
        "Solution.export": lambda: (
            solution().export,
            dict(path=folder / "run.glb", fps=30.0, speed=1.0, start=0.0, end=0.01),
        ),
        "Solution.to_xarray": lambda: (solution().to_xarray, dict(degrees=True)),
        "Solution.to_pandas": lambda: (solution().to_pandas, dict(degrees=True)),
        "Solution.evaluate": lambda: (solution().evaluate, dict(t=0.01, side="left")),
        "Solution.impact_forces": lambda: (
            solution().impact_forces, dict(k=0, stiffness=carom.Stiffness(1e6)),
        ),
        "Solution.impact_history": lambda: (solution().impact_history, dict(k=0, steps=4)),
        "Solution.surface_power": lambda: (solution().surface_power, dict(part="floor")),
        "Solution.joint_coordinates": lambda: (swing().joint_coordinates, dict(joint="j", degrees=True)),
        "results.JointView.coordinates": lambda: (swing()["j"].coordinates, dict(degrees=True)),
        "results.JointView.to_pandas": lambda: (swing()["j"].to_pandas, dict(degrees=True)),
        "Solution.body": lambda: (solution().body, dict(name="ball")),
        "Solution.contact": lambda: (solution().contact, dict(name="ball-floor")),
        "Solution.force": lambda: (things.driven().force, dict(name="push")),
        "Solution.constraint": lambda: (things.driven().constraint, dict(name="drive")),
        "Solution.joint": lambda: (swing().joint, dict(name="j")),
        "Ensemble.state": lambda: (runs().state, dict(run=0)),
        "Solution.plot": lambda: (solution().plot, dict(kind="impacts", what="ball-floor")),
        "ensemble": lambda: (
            carom.ensemble,
            dict(scene=thrown(), duration=0.02, step=0.01, vary={"ball.velocity": np.zeros((2, 3))}, runs=2,
                 seed=0, sampling="random", method="rk4", rtol=None, atol=None, options=carom.Options(),
                 observe=lambda solution: {}, executor="serial", workers=1, save=None, chunk=64,
                 progress=None),
        ),
        "Ensemble.counts": lambda: (runs().counts, {}),
        "Ensemble.to_pandas": lambda: (runs().to_pandas, {}),
        "Ensemble.save": lambda: (runs().save, dict(path=folder / "runs.nc")),
        "Ensemble.plot": lambda: (runs().plot, dict(value="ball.z", over="ball.velocity.x")),
        "Grid": lambda: (carom.Grid, dict(values=[0.1, 0.2])),
        "gradient": lambda: (
            carom.gradient,
            dict(solution=solution(), with_respect_to="ball.position.x", by="auto", throw=True),
        ),
        "Ensemble.to_xarray": lambda: (runs().to_xarray, {}),
        "Ensemble.load": lambda: (carom.Ensemble.load, dict(path=kept(folder))),
        "Ensemble.solution": lambda: (runs().solution, dict(run=0)),
        "UniformOrientation": lambda: (carom.UniformOrientation, {}),
        "UniformOrientation.ppf": lambda: (carom.UniformOrientation().ppf, dict(u=np.full((1, 3), 0.5))),
        "studies.ensembles.dice.face_up": lambda: (
            dice.face_up, dict(orientation=(1.0, 0, 0, 0)),
        ),
        "studies.ensembles.dice.fairness": lambda: (
            dice.fairness, dict(faces=[1, 2, 3]),
        ),
        "contact_inverse_mass": lambda: (
            carom.contact_inverse_mass,
            dict(scene=thrown(), body="ball", point=(0, 0, 0.05), normal=(0, 0, 1.0), other=None),
        ),
        "resolve_impact": lambda: (
            carom.resolve_impact,
            dict(**blow, law="newton", tangential_restitution=0.5, stiffness=carom.Stiffness(1e6)),
        ),
        "Impact.force": lambda: (
            carom.resolve_impact(**blow).force, dict(stiffness=carom.Stiffness(1e6)),
        ),
        "impact.ImpactForce.evaluate": lambda: (
            carom.resolve_impact(**blow).force(carom.Stiffness(1e6)).evaluate, dict(t=0.0),
        ),
        "studies.gradient.impact_derivative": lambda: (gradient.impact_derivative, dict(**blow, law="newton")),
        "impact_layer": lambda: (
            carom.impact_layer, dict(**blow, penetration=0.5, width=1e-6, law="newton", steps=2,
                                     tangential_restitution=0.5),
        ),
        "LayerHistory.evaluate": lambda: (things.layer().evaluate, dict(t=0.0)),
        "resolve_impacts": lambda: (
            carom.resolve_impacts,
            dict(inverse_mass=W, velocity=[(-1.0, 1.0, 0.0)], friction=0.1, restitution=0.5, law="newton",
                 multiple="simultaneous", stiffness=[1.0], exponent=1.0, rtol=1e-8, tangential_restitution=0.5),
        ),
        "CornerImpact.force": lambda: (
            carom.resolve_impacts(W, [(-1.0, 1.0, 0.0)], 0.1, 0.5).force, dict(stiffness=carom.Stiffness(1e6)),
        ),
        "impact.ImpactForces.evaluate": lambda: (
            carom.resolve_impacts(W, [(-1.0, 1.0, 0.0)], 0.1, 0.5).force(carom.Stiffness(1e6)).evaluate,
            dict(t=0.0),
        ),
        "solve_contacts": lambda: (
            carom.solve_contacts,
            dict(inverse_mass=W, velocity=(-1.0, 1.0, 0.0), friction=0.1, kind="sliding",
                 heading=[(1.0, 0.0)], start=(0.0, 0.0, 0.0)),
        ),
        "impact.invariant_directions": lambda: (
            slip_directions.invariant_directions, dict(inverse_mass=W, friction=0.1),
        ),
        "impact.critical_friction": lambda: (
            slip_directions.critical_friction, dict(inverse_mass=W),
        ),
        "impact.diagonal_form": lambda: (
            geometry.diagonal_form, dict(inverse_mass=W, velocity=(-1.0, 1.0, 0.0), force=(1.0, 0.0, 0.0)),
        ),
        "sensitivities": lambda: (
            carom.sensitivities,
            dict(solution=solution(), with_respect_to="ball.position", by="auto", throw=True),
        ),
        "Sensitivities.evaluate": lambda: (things.sensitivities().evaluate, dict(t=0.01)),
        "contact_sequence": lambda: (carom.contact_sequence, dict(solution=solution())),
    }  # fmt: skip
    return found
