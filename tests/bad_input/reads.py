"""Calls that compare and show: baselines, fits to recorded motion, models, plots, films."""

import carom
from bad_input import things
from bad_input.things import (
    TETRAHEDRON,
    XML,
    W,
    model,
    pushed,
    recording,
    samples,
    solution,
    swing,
    tetrahedron,
    thrown,
)
from carom import baselines
from carom.io import models
from carom.studies import identify
from carom.visual import films, plots, surfaces


def read(folder):
    """Return functions of (callable, arguments) by name; files are in a folder."""
    made = recording()
    found = {
        "Mesh.load": lambda: (
            carom.Mesh.load, dict(path=tetrahedron(folder), scale=1.0, parts=[TETRAHEDRON]),
        ),
        "baselines.hht_alpha_layer": lambda: (
            baselines.hht_alpha_layer,
            dict(speed=1.0, restitution=0.5, mass=1.0, width=1.0, penetration=0.2, steps=10, alpha=0.0,
                 tolerance=1e-12, max_iterations=50),
        ),
        "baselines.completing_steps": lambda: (
            baselines.completing_steps,
            dict(speed=1.0, restitution=1.0, penetration=0.5, alpha=0.0, most=5),
        ),
        "baselines.first_completing_steps": lambda: (
            baselines.first_completing_steps,
            dict(speed=1.0, restitution=1.0, penetration=0.5, alpha=0.0, most=5),
        ),
        "baselines.moreau_jean": lambda: (
            baselines.moreau_jean, dict(scene=thrown(), duration=0.02, step=0.01, theta=0.5),
        ),
        "baselines.solve_one_contact": lambda: (
            baselines.solve_one_contact, dict(inverse_mass=W, velocity=(-1.0, 1.0, 0.0), friction=0.1),
        ),
        "studies.identify.Parameter": lambda: (
            identify.Parameter, dict(start=0.5, step=0.1, lower=0.0, upper=1.0),
        ),
        "studies.identify.Recording": lambda: (
            identify.Recording,
            dict(t=made.t, position=made.position[:, 0], orientation=made.orientation[:, 0],
                 start=identify.State((0, 0, 1.0), (1.0, 0, 0, 0), (0, 0, 0.0), (0, 0, 0.0)), name="throw"),
        ),
        "studies.identify.fit_free_flight": lambda: (
            identify.fit_free_flight,
            dict(t=made.t, **samples(), gravity=(0, 0, -9.81), inertia=(1.0, 1.0, 1.0)),
        ),
        "studies.identify.free_samples": lambda: (
            identify.free_samples,
            dict(**samples(), shape=carom.Sphere(0.1), point=(0, 0, 0.0), normal=(0, 0, 1.0), clearance=0.0),
        ),
        "studies.identify.roll_out": lambda: (
            identify.roll_out,
            dict(scene=thrown(), recording=made, step=0.01, options=carom.Options()),
        ),
        "studies.identify.roll_outs": lambda: (
            identify.roll_outs,
            dict(make=lambda recording: thrown(), recordings=[made], step=0.01, options=carom.Options(),
                 workers=1),
        ),
        "studies.identify.varied": lambda: (
            identify.varied,
            dict(scene=thrown(), restitution=0.5, friction=0.1, friction_held=0.1, inertia_factor=1.0,
                 corner_radius=0.1,
                 start=identify.State((0, 0, 1.0), (1.0, 0, 0, 0), (0, 0, 0.0), (0, 0, 0.0))),
        ),
        "studies.identify.trajectory_error": lambda: (
            identify.trajectory_error, dict(simulated=made, recorded=made, length=1.0),
        ),
        "studies.identify.mean_error": lambda: (identify.mean_error, dict(length=1.0, angle=1.0)),
        "studies.identify.squared_error": lambda: (identify.squared_error, dict(length=1.0, angle=1.0)),
        "studies.identify.face_up": lambda: (
            identify.face_up, dict(orientation=(1.0, 0, 0, 0), up=(0, 0, 1.0)),
        ),
        "identify": lambda: (
            identify.identify,
            dict(scene=thrown(), recordings=[made], parameters={"restitution": (0.5, 0.1)},
                 objective=lambda simulated, recorded: 1.0, method="Nelder-Mead", restarts=0, tolerance=0.1,
                 max_evaluations=2, resamples=0, seed=0, step=0.01, options=carom.Options(), workers=1,
                 progress=None),
        ),
    }  # fmt: skip

    drawn = dict(ax=None, figsize=(3.0, 2.0), style="carom")
    look = dict(size=(64, 64), view="front", follow="ball", zoom=1.0)
    found |= {
        "load_model": lambda: (
            carom.load_model,
            dict(source=XML, restitution=0.5, friction=0.1, impact_law="newton", limit_restitution=0.0,
                 keyframe="k", qpos=[0.1], qvel=[0.0], free_root=False, contacts=True, armature=True,
                 overlaps="repair", max_hull_vertices=64, mocap={"hand": [lambda t: (0.0, 0.0, 0.0)]},
                 package_dirs=()),
        ),
        "models.Coordinate.of": lambda: (model().joints["j"].of, dict(solution=swing())),
        "models.Sensor.of": lambda: (model().sensors["q"].of, dict(solution=swing())),
        **{
            f"models.Motor.{name}": lambda name=name: (
                getattr(model().actuators["m"], name), dict(solution=swing()),
            )
            for name in ("length", "control", "force")
        },
        **{
            f"{whose}.{name}": lambda of=of, name=name: (getattr(of(), name), dict(solution=swing()))
            for whose, of in (("Model", model), ("models.Robot", lambda: model().scene.robot))
            for name in ("qpos", "qvel", "ctrl")
        },
        "models.Report.of": lambda: (model().report.of, dict(element="joint")),
        "models.Report.add": lambda: (
            models.Report().add, dict(element="joint", what="is missing", instead="none"),
        ),
        "film": lambda: (
            carom.film,
            dict(solution=solution(), path=folder / "run.gif", fps=20.0, speed=1.0, **look, start=0.0,
                 end=0.01, progress=None),
        ),
        "films.still": lambda: (films.still, dict(solution=solution(), t=0.01, **look, clock=True)),
        "view": lambda: (
            carom.view,
            dict(solution=solution(), export=folder / "run.html", title="run", follow="ball", speed=1.0,
                 frames=10, port=8080, host="127.0.0.1", open=False, block=False),
        ),
        "visual.surfaces.surface": lambda: (
            surfaces.surface, dict(shape=carom.Sphere(0.1), fineness=8),
        ),
        "plots.energy": lambda: (plots.energy, dict(solution=solution(), panel="energy", **drawn)),
        "plots.overview": lambda: (
            plots.overview, dict(solution=solution(), figsize=(6.0, 4.0), style="carom"),
        ),
        "plots.e_mu": lambda: (
            plots.e_mu,
            dict(inverse_mass=W, velocity=(-1.0, 1.0, 0.0), law="newton", most_friction=1.0, points=3, **drawn),
        ),
        "Impact.plot": lambda: (
            carom.resolve_impact(W, (-1.0, 1.0, 0.0), 0.5, 0.3).plot, dict(panel="slip", **drawn),
        ),
        "plots.impacts": lambda: (
            plots.impacts, dict(solution=solution(), contacts="ball-floor", panel="slip", **drawn),
        ),
        "plots.contacts": lambda: (
            plots.contacts, dict(solution=solution(), contacts="ball-floor", most=4, **drawn),
        ),
        "plots.hodograph": lambda: (
            plots.hodograph, dict(solution=solution(), k=0, flow=False, panel="slip", **drawn),
        ),
        "plots.impact_force": lambda: (
            plots.impact_force,
            dict(solution=solution(), k=0, stiffness=carom.Stiffness(1e6), panel="force", **drawn),
        ),
        "plots.impact_inside": lambda: (
            plots.impact_inside, dict(solution=solution(), k=0, steps=4, panel="force", **drawn),
        ),
        "plots.phase": lambda: (
            plots.phase,
            dict(solution=solution(), of="ball", axis="z", number=0, degrees=False, **drawn),
        ),
        "plots.trajectory": lambda: (
            plots.trajectory,
            dict(solution=solution(), bodies="ball", plane="xz", outlines=[0.0], ground=True, **drawn),
        ),
        "plots.joints": lambda: (
            plots.joints, dict(solution=swing(), joints="j", degrees=True, panel="rates", **drawn),
        ),
        "plots.forces": lambda: (
            plots.forces, dict(solution=pushed().solution, forces="push", **drawn),
        ),
        "plots.constraint_errors": lambda: (plots.constraint_errors, dict(solution=swing(), **drawn)),
        "plots.ensemble": lambda: (
            plots.ensemble,
            dict(found=things.runs(), value="ball.z", over="ball.velocity.x", **drawn, label="height",
                 colorbar=False),
        ),
        "plots.work_precision": lambda: (
            plots.work_precision, dict(series={"a": ([1.0], [1.0])}, error="error", **drawn),
        ),
    }  # fmt: skip
    return found
