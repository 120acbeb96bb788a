"""Real tosses of a real cube
==========================

A cube was tossed, and motion capture has measured its path. Each toss is run from flight to rest, and its
path is compared with the measured one. By default these are the even tosses of the record, to which the
parameters of the contact were fitted; ``--data FILE --start B`` runs all tosses of another file, and
``--fit`` fits anew.
"""

import argparse

import numpy as np

from carom.paper import tosses, tosses_figure
from carom.visual.plots import style

# %%
# How the measured data are prepared is written in `carom.paper.tosses`. Besides the runs there are two checks
# of the numbers: half the step, and starts that are moved by 1e-6.


def checked(start, recordings, chosen):
    half = tosses.simulate(start, recordings, chosen, tosses.STEP / 2)
    print(f"half the step: {tosses.levels(half, recordings)}")
    moved = tosses.simulate(start, tosses.perturbed(recordings), chosen)
    print(f"starts moved by 1e-6: {tosses.levels(moved, recordings)}")


# %%
# All tosses are run with the same parameters. We print the medians of the errors in place and rotation, and
# draw the toss that is nearest to them. No run may fail, and the energy ledger of each must close.


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
    failed, residual = sum(bool(run.message) for run in runs), max(run.residual for run in runs)
    print(f"{len(runs)} tosses: {levels}")
    print(f"{failed} runs failed; ledger closed to {residual:.1e} J")
    print(tosses.rest(start, recordings, chosen))
    if halve:
        checked(start, recordings, chosen)

    far = levels.position / np.median(levels.position), levels.rotation / np.median(levels.rotation)
    typical = int(np.argmin(np.abs(np.log(far)).sum(axis=0)))
    print(f"picture: {recordings[typical].name}, nearest the medians")
    with style.style():
        figure = tosses_figure.draw(recordings[typical], runs[typical], tosses.HALF[start])
        style.write(figure, f"{out}/cube_toss.png")
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
