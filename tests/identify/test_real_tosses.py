"""Tosses of a real cube (ContactNets), from flight to rest, as the example `cube_toss` reads them."""

import runpy
from pathlib import Path

import numpy as np
import pytest

import carom
from carom.studies import identify
from verified import agree, verifies

EXAMPLE = runpy.run_path(str(Path(__file__).parents[2] / "examples" / "many_runs" / "cube_toss.py"))
EDGE = EXAMPLE["EDGE"]
FITTED = {**EXAMPLE["FITTED"], "inertia_factor": 1.22}


@pytest.fixture(scope="module")
def scene():
    """The cube with what its authors measured: e by drops, mu by tilting."""
    scene = carom.Scene(gravity=(0, 0, -9.614))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    inertia = np.full(3, 7.73e-4)
    cube = scene.add_body(
        carom.Box(EDGE, EDGE, EDGE), mass=0.37, inertia=inertia, position=(0, 0, 1)
    )
    scene.add_contact(cube, table, restitution=0.125, friction=0.18)
    return scene


@pytest.fixture(scope="module")
def tosses(scene):
    return list(EXAMPLE["recordings"](scene, 24))


@verifies(
    "simulate",
    "24 tosses of a cube, none or five parameters fitted: median errors, in edges and rad",
    "experiment: ContactNets",
)
@verifies("studies.identify.roll_outs", "the same", "experiment: ContactNets")
@pytest.mark.parametrize("parameters", [{}, FITTED], ids=["none", "five"])
def test_tosses_from_flight_to_rest(scene, tosses, parameters):
    def tossed(toss):
        return identify.varied(scene, **parameters, start=toss.start)

    runs = identify.roll_outs(tossed, tosses, step=1 / 592)
    assert not any(run.message for run in runs)
    assert max(run.residual for run in runs) < 1e-7
    errors = [identify.trajectory_error(run, toss, EDGE) for run, toss in zip(runs, tosses)]
    agree(np.median(errors, axis=0), 0.0, atol=(0.12, 0.15))


@verifies(
    "studies.identify.fit_free_flight",
    "flights of a cube: median of the residuals [m]",
    "experiment: ContactNets",
)
def test_measured_flights_are_free(scene, tosses):
    """Motion capture is good to a tenth of a millimetre."""
    noise = []
    for toss in tosses:
        x, q = toss.position[:, 0], toss.orientation[:, 0]
        n = identify.free_samples(x, q, scene.bodies[0].shape, clearance=0.003)
        noise.append(
            identify.fit_free_flight(toss.t[:n], x[:n], q[:n], scene.gravity).position_noise
        )
    agree(np.median(noise), 0.0, atol=2e-4)
