"""``carom throw``: throw a die many times."""

from __future__ import annotations

import json
import time

_ABOUT = """\
Throw a die many times in random orientation, each throw to rest, with every impact located and resolved; say
how often each face came up, and whether that is fair."""
_END = """\
Example: carom throw --count 100000 --load 0.3 --save loaded.zarr
A run that is interrupted goes on with the same arguments if it is saved. Results depend on --seed, not on
--workers."""


def add(commands) -> None:
    """Add the command to the parser."""
    import argparse

    this = commands.add_parser(
        "throw", help="throw a die many times", description=_ABOUT, epilog=_END,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    number = {"type": float, "metavar": "X"}
    this.add_argument("--count", type=int, default=1000, metavar="N", help="throws (default 1000)")
    this.add_argument("--edge", default=0.02, help="of the die, m (0.02)", **number)
    this.add_argument("--height", default=0.3, help="of its centre at the start, m (0.3)", **number)
    this.add_argument("--speed", default=0.5, help="horizontal, m/s (0.5)", **number)
    this.add_argument("--drop", default=0.5, help="downward speed, m/s (0.5)", **number)
    this.add_argument("--spin", default=10.0, help="about the horizontal, rad/s (10)", **number)
    this.add_argument("--restitution", default=0.5, help="0 to 1 (0.5)", **number)
    this.add_argument("--friction", default=0.2, help="coefficient (0.2)", **number)
    this.add_argument(
        "--load", default=0.0, help="part of the mass under face 1, 0 to below 1 (0)", **number
    )
    this.add_argument("--step", default=2e-3, help="s (0.002)", **number)
    this.add_argument("--seconds", default=4.0, help="longest throw, s (4)", **number)
    this.add_argument("--seed", type=int, default=0, metavar="N", help="of the orientations (0)")
    this.add_argument("--workers", type=int, metavar="N", help="threads (all processors)")
    this.add_argument(
        "--save", metavar="PATH", help="folder that results are written to, and gone on with"
    )
    this.add_argument("--json", action="store_true", help="print the results as JSON")
    this.set_defaults(run=run, extra="ensemble")


def scene(given):
    """Return a die above a table."""
    import carom
    from carom import check

    check.number("--load", given.load, least=0.0, below=1.0)
    made = carom.Scene(gravity=(0, 0, -9.81))
    table = made.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    edge = check.number("--edge", given.edge, above=0.0, unit="m")
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


def run(given) -> int:
    """Throw, and report."""
    import carom

    begin = time.perf_counter()
    thrown = carom.ensemble(
        scene(given), given.seconds, step=given.step, runs=given.count, seed=given.seed,
        vary={"die.orientation": carom.UniformOrientation()}, workers=given.workers,
        save=given.save, progress=not given.json,
    )  # fmt: skip
    found = summary(thrown, time.perf_counter() - begin)
    print(json.dumps(found, indent=2) if given.json else text(found))
    return 0 if thrown.complete else 1


def summary(thrown, seconds: float) -> dict:
    """Return what came of the throws, as plain numbers."""
    import numpy as np

    from carom.ensembles.dice import face_up, fairness

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
    """Return the results for people."""
    ended = ", ".join(f"{n} {word}" for word, n in found["ended"].items())
    lines = [
        f"{found['throws']} throws ({ended}) in {found['seconds']:.1f} s, "
        f"{found['throws_per_second']:.0f} a second"
    ]
    if "faces" not in found:
        return "\n".join([*lines, "no die came to rest on a face: take more --seconds"])
    lines.append(f"{found['at_rest_on_a_face']} came to rest on a face")
    lines.append("face   count     share   95 % interval")
    for face, row in found["faces"].items():
        lines.append(
            f"   {face} {row['count']:7d}   {row['share']:7.4f}   {row['low']:.4f} to {row['high']:.4f}"
        )
    lines.append(
        f"chi-square {found['chi_square']:.2f} of 5 degrees: a fair die does so, or worse, in "
        f"{100 * found['p_value']:.2g} % of such samples"
    )
    lines.append(
        f"impacts {found['impacts_mean']:.1f} on average; at rest after {found['rest_time_mean']:.3f} s on "
        f"average, {found['rest_time_max']:.3f} s at most"
    )
    return "\n".join(lines)
