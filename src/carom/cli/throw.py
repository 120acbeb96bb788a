"""``carom throw``: throw a die many times."""

from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Annotated

import typer

from carom.cli import CTRL_C, show
from carom.cli.outcome import warn


def run(
    count: Annotated[int, typer.Option(metavar="N", help="Throws.")] = 1000,
    edge: Annotated[float, typer.Option(metavar="M", help="Edge of the die [m].")] = 0.02,
    height: Annotated[float, typer.Option(metavar="M", help="Height of its centre at the start [m].")] = 0.3,
    speed: Annotated[float, typer.Option(metavar="X", help="Horizontal speed [m/s].")] = 0.5,
    drop: Annotated[float, typer.Option(metavar="X", help="Downward speed [m/s].")] = 0.5,
    spin: Annotated[
        float, typer.Option(metavar="X", help="Angular speed about a horizontal axis [rad/s].")
    ] = 10.0,
    restitution: Annotated[float, typer.Option(metavar="E", help="0 to 1.")] = 0.5,
    friction: Annotated[float, typer.Option(metavar="MU", help="Coefficient.")] = 0.2,
    load: Annotated[
        float, typer.Option(metavar="X", help="Fraction of the mass under face 1, at least 0 and below 1.")
    ] = 0.0,
    step: Annotated[
        float | None, typer.Option(metavar="S", help="Time step [s].", show_default="by tolerances")
    ] = None,
    seconds: Annotated[float, typer.Option(metavar="S", help="Maximum time of a throw [s].")] = 4.0,
    seed: Annotated[int, typer.Option(metavar="N", help="Seed of the random orientations.")] = 0,
    workers: Annotated[
        int | None, typer.Option(metavar="N", help="Number of threads.", show_default="all processors")
    ] = None,
    save: Annotated[
        str | None,
        typer.Option(
            metavar="DIR", show_default=False, help="Folder for the results; an interrupted run continues."
        ),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the results as JSON.")] = False,
) -> int:  # fmt: skip
    """Throw a die many times and test whether it is fair.

    The initial orientations are random. Each throw is simulated until the die is at rest, and every impact is
    located. Prints the frequency of each face and a test of fairness. With --save, an interrupted run continues
    when the command is repeated with the same arguments. Results depend on --seed, not on --workers.

    For example:
      carom throw --count 10000
      carom throw --count 100000 --load 0.3 --save loaded.zarr
    """
    import carom

    given = SimpleNamespace(
        edge=edge, height=height, speed=speed, drop=drop, spin=spin, restitution=restitution,
        friction=friction, load=load,
    )  # fmt: skip
    begin = time.perf_counter()
    with show.progress("throw") as bar:
        try:
            thrown = carom.ensemble(
                scene(given), seconds, step=step or "auto", runs=count, seed=seed, workers=workers, save=save,
                vary={"die.orientation": carom.UniformOrientation()}, progress=bar,
            )  # fmt: skip
        except KeyboardInterrupt as error:
            thrown = getattr(error, "solution", None)
            if thrown is None:
                raise
            warn("throw", str(error))
    found = summary(thrown, time.perf_counter() - begin)
    if json:
        show.as_json(found)
    else:
        print(text(found))
    return 0 if thrown.complete else CTRL_C


def scene(given):
    """Return a die above a table."""
    import carom
    from carom import checks

    checks.number("--load", given.load, least=0.0, below=1.0)
    made = carom.Scene(gravity=(0, 0, -9.81))
    table = made.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    edge = checks.number("--edge", given.edge, above=0.0, unit="m")
    shape = carom.Box(edge, edge, edge)
    if given.load > 0.0:  # a weight inside, under the face that bears 1
        weight = carom.Sphere(0.1 * edge)
        shape = carom.Compound(
            [(shape, (0, 0, 0)), (weight, (0, 0, -0.35 * edge))],
            masses=[1.0 - given.load, given.load],
        )
    die = made.add_body(
        shape, mass=2000.0 * edge**3, position=(0, 0, given.height), name="die",
        velocity=(given.speed, 0, -given.drop), angular_velocity=(0, given.spin, 0),
    )  # fmt: skip
    made.add_contact(die, table, restitution=given.restitution, friction=given.friction)
    return made


def summary(thrown, seconds: float) -> dict:
    """Return the results of the throws as plain numbers."""
    import numpy as np

    from carom.studies.ensembles.dice import face_up, fairness

    faces = face_up(thrown.orientation[:, 0])
    faces = np.where(np.isfinite(thrown.rest_time), faces, 0)
    found = {
        "throws": len(thrown), "ended": thrown.counts(), "at_rest_on_a_face": int(np.sum(faces > 0)),
        "seconds": seconds, "throws_per_second": int(thrown.done.sum()) / seconds,
    }  # fmt: skip
    if not np.any(faces > 0):
        return found
    fair = fairness(faces)
    found["faces"] = {
        str(k + 1): {
            "count": int(fair.counts[k]), "share": float(fair.share[k]),
            "low": float(fair.low[k]), "high": float(fair.high[k]),
        }
        for k in range(6)
    }  # fmt: skip
    found["chi_square"], found["p_value"] = fair.chi_square, fair.p_value
    found["impacts_mean"] = float(np.mean(thrown.impacts[faces > 0]))
    rest = thrown.rest_time[faces > 0]
    found["rest_time_mean"], found["rest_time_max"] = float(rest.mean()), float(rest.max())
    return found


def text(found: dict) -> str:
    """Return the results as text."""
    ended = ", ".join(f"{n} {word}" for word, n in found["ended"].items())
    lines = [
        f"{found['throws']} throws ({ended}) in {found['seconds']:.1f} s, "
        f"{found['throws_per_second']:.0f} per second"
    ]
    if "faces" not in found:
        return "\n".join(
            [*lines, "no die came to rest on a face: give a larger value of --seconds"]
        )
    lines.append(f"{found['at_rest_on_a_face']} came to rest on a face")
    lines.append("face   count     share   95 % interval")
    for face, row in found["faces"].items():
        lines.append(
            f"   {face} {row['count']:7d}   {row['share']:7.4f}   {row['low']:.4f} to {row['high']:.4f}"
        )
    lines.append(
        f"chi-square {found['chi_square']:.2f} with 5 degrees of freedom: a fair die has this value or a "
        f"larger one in {100 * found['p_value']:.2g} % of such samples"
    )
    lines.append(
        f"impacts {found['impacts_mean']:.1f} on average; at rest after {found['rest_time_mean']:.3f} s on "
        f"average, {found['rest_time_max']:.3f} s at most"
    )
    return "\n".join(lines)
