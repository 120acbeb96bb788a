"""How exact are states between saved ones? Random scenes of all families, against the motion itself.

    python benchmarks/between.py 100             100 scenes of each family, by tolerances
    python benchmarks/between.py 100 --steps     with given steps

Each run is made twice, with all states saved and with every fourth: the motion is the same, so states that were
left out are what `Solution.evaluate` should find. Its misses are told by the size of a body; beside them those
of the cubic that pictures have, and how many intervals could be stepped again.
"""

from __future__ import annotations

import argparse
import warnings

import numpy as np

import carom
from campaigns import FAMILIES
from common import report

EVERY = 4


def misses(case, how: dict) -> tuple[float, float, float] | None:
    """Return the greatest miss of `evaluate` and of the cubic by size, and the part of intervals replayed."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        whole = carom.simulate(case.scene, case.duration, throw=False, **how)
        few = carom.simulate(case.scene, case.duration, throw=False, save_every=EVERY, **how)
    if len(few.t) < 2 or not np.isin(few.t, whole.t).all():
        return None
    left_out = np.flatnonzero(~np.isin(whole.t, few.t))
    left_out = left_out[whole.t[left_out] < few.t[-1]][:: max(1, len(left_out) // 60)]
    size = few._run.bodies["extent"]
    there = whole.position[left_out]
    worst = [
        float(np.max(np.abs(found(whole.t[left_out])[0] - there) / size[:, None], initial=0.0))
        for found in (few.evaluate, few._curve)
    ]
    tried = list(vars(few)["_replay"].arrives.values()) if "_replay" in vars(few) else [True]
    return (*worst, sum(tried) / len(tried))


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("runs", type=int)
    parser.add_argument("--steps", action="store_true")
    parser.add_argument("--families", nargs="*", default=list(FAMILIES))
    parser.add_argument("--first", type=int, default=0)
    asked = parser.parse_args()
    rows = []
    for family in asked.families:
        found = []
        for seed in range(asked.first, asked.first + asked.runs):
            case = FAMILIES[family](seed)
            miss = misses(case, {"step": case.step} if asked.steps else {})
            if miss is not None:
                found.append((*miss, seed))
        if not found:
            continue
        a = np.array(found)
        median, most = np.median(a, axis=0), np.quantile(a, 0.95, axis=0)
        worst = a[np.argmax(a[:, 0])]
        rows.append([
            family, str(len(a)), f"{median[0]:.0e}", f"{most[0]:.0e}", f"{worst[0]:.0e} ({worst[3]:.0f})",
            f"{median[1]:.0e}", f"{most[1]:.0e}", f"{100 * a[:, 2].mean():.0f} %",
        ])  # fmt: skip
    report(
        "between", "States between saved ones: greatest miss of a position in a run, by size",
        ["family", "runs", "median", "95 %", "worst (seed)", "cubic: median", "95 %", "replayed"], rows,
        "By given steps." if asked.steps else "By the default tolerances.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
