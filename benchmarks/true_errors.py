"""True errors of thousands of random scenes against the tolerance: what is asked for, and what comes.

    python benchmarks/true_errors.py throws 100                100 scenes of the campaign's throws
    python benchmarks/true_errors.py rolls 100 --first 7000    others
    python benchmarks/true_errors.py all 50 --duration 0.2     50 of each family, .2 s

Each scene is run at two tolerances and, as its reference, at `rtol=1e-11`. An error is the greatest of a place
or an arc at the end, divided by atol + rtol of the body's size. Errors above ten are printed with their seeds:
some motions are chaotic (a body that rattles, a tree of five rods), others are steps that do not follow the
tolerance.
"""

from __future__ import annotations

import argparse
import warnings

import numpy as np

import carom
from campaigns import FAMILIES
from campaigns.case import Case

TOLERANCES, FINE = (1e-6, 1e-8), 1e-11


def ends(case: Case, duration: float, rtol: float) -> carom.Solution:
    """Return a run of which only the ends are saved."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return carom.simulate(case.scene, duration, rtol=rtol, save_at=duration, throw=False)


def error(s: carom.Solution, exact: carom.Solution, rtol: float) -> float:
    """Return the greatest error of a body at the end, by the tolerance."""
    size = np.array([body.shape.size if body.shape else 1.0 for body in s.scene.bodies])
    moved = np.linalg.norm(s.position[-1] - exact.position[-1], axis=1)
    q, p = s.orientation[-1], exact.orientation[-1]
    turned = np.minimum(np.linalg.norm(q - p, axis=1), np.linalg.norm(q + p, axis=1))
    return float(np.max(np.maximum(moved, size * turned) / (rtol * (size + size.min()))))


def campaign(family: str, seeds: range, longest: float) -> None:
    """Print a line for the family, and one for each scene whose error is above ten times the tolerance."""
    rows = []
    for seed in seeds:
        case = FAMILIES[family](seed)
        duration = min(case.duration, longest)
        exact = ends(case, duration, FINE)
        runs = [ends(case, duration, rtol) for rtol in TOLERANCES]
        errors = [error(s, exact, rtol) for s, rtol in zip(runs, TOLERANCES)]
        whole = [int(s.stats["whole_steps"]) for s in (exact, *runs)]
        rows.append((errors, seed, case.label.get("kind"), len(exact.impacts), whole))
    found = np.array([row[0] for row in rows])
    for k, rtol in enumerate(TOLERANCES):
        print(
            f"{family}, rtol {rtol:g}: of {len(rows)} half below {np.median(found[:, k]):.1e}, "
            f"nine tenths below {np.quantile(found[:, k], 0.9):.1e}, above ten {np.sum(found[:, k] > 10.0)}"
        )
    for errors, seed, kind, impacts, whole in sorted(rows, key=lambda row: -max(row[0])):
        if max(errors) > 10.0:
            shown = ", ".join(f"{e:.1e}" for e in errors)
            print(f"  {seed} {kind}: {shown}; {impacts} impacts, time-stepping steps {whole}")


def main() -> None:
    """Run the scenes of one family, or of all."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("family", choices=[*FAMILIES, "all"])
    parser.add_argument("count", type=int)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--duration", type=float, default=0.3, help="longest run [s]")
    given = parser.parse_args()
    for family in FAMILIES if given.family == "all" else [given.family]:
        campaign(family, range(given.first, given.first + given.count), given.duration)


if __name__ == "__main__":
    main()
