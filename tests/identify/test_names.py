"""`identify` and `sensitivities` take the names of `carom.ensemble`; both are functions with their parts."""

import inspect

import numpy as np
import pytest

import carom
from carom.studies.identify import Parameter, Recording, RollOut, roll_out, roll_outs, squared_error
from carom.studies.identify.parameters import Space

HEIGHT, TIMES = 0.4, np.linspace(0.0, 0.3, 7)


def ball():
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    body = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, HEIGHT), name="ball")
    scene.add_contact(body, floor, restitution=0.7, friction=0.2)
    return scene


def fallen(g):
    """A recording of free fall with gravity g: z = h - g t^2/2."""
    z = HEIGHT - 0.5 * g * TIMES[:4] ** 2
    path = np.stack([0.0 * z, 0.0 * z, z], axis=1)
    return Recording(TIMES[:4], path, [[1, 0, 0, 0]] * 4)


def test_a_component_is_fitted_by_its_name():
    fit = carom.identify(
        ball(), [fallen(5.0)], {"gravity.z": (-9.0, 1.0)}, squared_error(1e-3, 1e-3), resamples=0,
        tolerance=1e-8, workers=1,
    )  # fmt: skip
    assert abs(fit.parameters["gravity.z"] + 5.0) < 1e-6


@pytest.mark.filterwarnings("ignore:Gravity")  # far from the best, to see whether it is excluded
def test_positions_alone_are_enough():
    """The same fit without orientations, and an objective that needs them says so."""
    full = fallen(5.0)
    positions = Recording(full.t, full.position)
    fit = carom.identify(
        ball(), [positions], {"gravity.z": (-9.0, 1.0)}, squared_error(1e-3), resamples=1,
        tolerance=1e-8, workers=1,
    )  # fmt: skip
    assert abs(fit.parameters["gravity.z"] + 5.0) < 1e-6
    assert np.isnan(fit.final_turn).all()
    assert 0.0 < fit.error["gravity.z"] < 1e-3
    with pytest.raises(ValueError, match="angle must be given for a Recording with orientations"):
        squared_error(1e-3)(full, full)
    assert carom.identify.mean_error(1.0)(full, positions) == 0.0


def test_names_have_the_bounds_of_their_fields():
    names = {
        "ball-floor.restitution": (0.5, 0.1),
        "ball-floor.friction": (0.5, 0.1),
        "ball.radius": (0.1, 0.01),
    }
    space = Space({**names, "ball.velocity.x": (0.0, 1.0), "friction": 0.3}, ball())
    assert space.lower.tolist() == [0, 0, 0, -np.inf, 0]
    assert space.upper.tolist() == [1, np.inf, np.inf, np.inf, np.inf]
    for name, words in {
        "ball.velocity": "parameters must be numbers, got 'ball.velocity', .* like 'ball.velocity.x'",
        "ball-floor.impact_law": "parameters must be numbers",
        "ball.radios": "names in parameters must be .* did you mean 'ball.radius'",
    }.items():
        with pytest.raises(ValueError, match=words):
            Space({name: (0.5, 0.1)}, ball())


def test_sensitivities_by_one_component():
    run = carom.simulate(ball(), 0.5, step=0.01)
    names = ("ball.velocity.z", "gravity.z", "ball.inertia.yz", "ball.orientation.x")
    some = carom.gradient(run, names)
    assert some.labels == names
    whole = carom.sensitivities(
        run, ("ball.velocity", "gravity", "ball.inertia", "ball.orientation")
    )
    columns = [whole.labels.index(name) for name in names]
    assert np.array_equal(some.final.position, whole.final.position[..., columns])
    assert np.array_equal(some.impact_time, whole.impact_time[:, columns])
    with pytest.raises(
        ValueError, match=r"what follows 'ball.velocity' in with_respect_to must be one of 'x'"
    ):
        carom.gradient(run, "ball.velocity.xx")


def test_they_are_functions_that_have_their_parts():
    for function in (carom.identify, carom.gradient):
        assert inspect.isfunction(function)
    assert carom.gradient is carom.sensitivities
    assert carom.identify.Recording is Recording
    assert carom.identify.identify is carom.identify
    assert carom.gradient.impact_derivative(np.eye(3), (-1, 0, 0), 0.0, 0.5).error < 1e-9


def test_workers_were_called_threads():
    with pytest.warns(DeprecationWarning, match=r"roll_outs\(threads=\) is called workers="):
        (run,) = roll_outs(lambda recording: ball(), [fallen(9.81)], threads=1)
    assert isinstance(run, RollOut)
    assert np.array_equal(run.position, roll_out(ball(), fallen(9.81)).position)
    with pytest.warns(DeprecationWarning, match=r"identify\(threads=\) is called workers="):
        carom.identify(
            ball(), [fallen(9.81)], {"restitution": Parameter(0.5, 0.1)}, lambda *pair: 1.0, resamples=0,
            max_evaluations=1, threads=1, seed=np.random.default_rng(1),
        )  # fmt: skip


def test_a_stiffness_is_fitted_from_the_start_of_the_scene():
    # a bob on a spring whose length is without tension at the start: z = -1 - m g/k (1 - cos(w t)), w^2 = k/m
    def bob(stiffness):
        scene = carom.Scene()
        scene.add_body(carom.Sphere(0.05), mass=1.0, position=(0, 0, -1), name="bob")
        spring = carom.forces.Spring(stiffness, (0, 0, 0), (0, 0, -1))
        scene.add_force(spring, carom.GROUND, "bob", name="spring")
        return scene

    z = -1 - 9.81 / 40 * (1 - np.cos(np.sqrt(40) * TIMES))
    path = np.stack([0 * z, 0 * z, z], axis=1)
    free = {"spring.stiffness": (30.0, 5.0)}
    how = {"resamples": 0, "tolerance": 1e-8, "workers": 1}
    seen = Recording(TIMES, path, [[1, 0, 0, 0]] * 7)
    fit = carom.identify(bob(30), [seen], free, squared_error(1e-3, 1e-3), **how)
    assert abs(fit.parameters["spring.stiffness"] - 40) < 1e-4
    thrown = Recording(
        TIMES, path, [[1, 0, 0, 0]] * 7, ([0, 0, -1], [1, 0, 0, 0], [0] * 3, [0] * 3)
    )
    with pytest.raises(ValueError, match="left out, also of a Recording") as error:
        carom.identify(bob(30), [thrown], free, squared_error(1e-3, 1e-3), **how)
    assert not hasattr(error.value, "__notes__")  # no function of the user's has raised it
