"""Real tosses of a real cube
==========================

Simulated from flight to rest, with the error to motion capture. `python examples/many_runs/cube_toss.py --data
FILE --start B` runs all recorded tosses of a file (default: the even ones, to which the parameters were
fitted); `--fit` fits them anew. What is done to the data is written in `carom.paper.tosses`.
"""

import argparse
from pathlib import Path

import numpy as np

from carom.paper import tosses, tosses_figure
from carom.visual.plots import style


def main(out="out/examples", data=None, start="B", parameters=5, fit=False, most=24, halve=False):
    recordings = tosses.recordings(start, data)[:most]
    chosen = tosses.CHOSEN[start, parameters]
    if fit:
        found = tosses.fit(start, parameters, recordings)
        print(found)
        chosen = found.parameters
    print(f"start {start},", ", ".join(f"{name} {value:g}" for name, value in chosen.items()))
    runs = tosses.simulate(start, recordings, chosen)
    levels = tosses.levels(runs, recordings)
    print(f"{len(runs)} tosses: {levels}")
    failed = sum(bool(run.message) for run in runs)
    residual = max(run.residual for run in runs)
    print(f"{failed} runs failed; ledger closed to {residual:.1e} J")
    print(tosses.rest(start, recordings, chosen))
    if halve:
        finer = tosses.levels(
            tosses.simulate(start, recordings, chosen, tosses.STEP / 2), recordings
        )
        print(f"half the step: {finer}")
        moved = tosses.levels(
            tosses.simulate(start, tosses.perturbed(recordings), chosen), recordings
        )
        print(f"starts moved by 1e-6: {moved}")

    far = levels.position / np.median(levels.position), levels.rotation / np.median(levels.rotation)
    typical = int(np.argmin(np.abs(np.log(far)).sum(axis=0)))
    Path(out).mkdir(parents=True, exist_ok=True)
    with style.style():
        figure = tosses_figure.draw(recordings[typical], runs[typical], tosses.HALF[start])
        figure.savefig(Path(out) / "cube_toss.png", dpi=style.DPI)
    print(f"picture: {recordings[typical].name}, nearest the medians")
    assert failed == 0
    assert np.median(levels.position) < 15.0


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--data", help="npz with states, offsets, toss_id")
    parser.add_argument("--start", choices="AB", default="B")
    parser.add_argument("--parameters", type=int, choices=(0, 2, 5), default=5)
    parser.add_argument("--fit", action="store_true", help="fit 2 or 5 parameters to these tosses")
    parser.add_argument("--halve", action="store_true", help="also half the step, and moved starts")
    parser.add_argument("--most", type=int, help="this many tosses only")
    parser.add_argument("--out", default="out/examples")
    main(**vars(parser.parse_args()))
