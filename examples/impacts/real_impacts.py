r"""Real impacts of a real cube
===========================

Measured first impacts against the laws of impact, at nominal and at fitted (e, mu). One corner strikes: with
:math:`W = G M^{-1} G^T` and :math:`u = G v` from the measured state before, the impulse P of
`carom.resolve_impact` gives :math:`v^+ = v + M^{-1} G^T P`, and gravity acts until the next measured sample.
What is decided about the data is written in `carom.paper.real`.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import carom
from carom.paper import real

m, J, g = real.MASS, real.INERTIA, real.GRAVITY
M_inverse = np.diag(1 / np.array([m, m, m, J, J, J]))


def after(tosses, e, mu, law):
    v = tosses.before.copy()
    for k, G in enumerate(tosses.jacobian):
        W, u = G @ M_inverse @ G.T, G @ v[k]
        v[k] += M_inverse @ G.T @ carom.resolve_impact(W, u, mu, e, law).impulse
    v[:, 2] -= g * tosses.flight
    return v


def main(out="out/examples"):
    tosses = real.load()
    figure = Figure(figsize=(4, 4), layout="constrained")
    axes = figure.subplots()
    print(f"{len(tosses.toss)} impacts; medians of the error after the impact")
    for law in ("newton", "poisson", "stronge"):
        for name, (e, mu) in (("nominal", real.NOMINAL), ("fitted", real.fit(law))):
            predicted = after(tosses, e, mu, law)
            dv, dw = real.medians(predicted)
            print(f"{law:8} {name:8} e = {e:.3f}, mu = {mu:.3f}: {dv:.3f} m/s, {dw:.2f} rad/s")
            if law == "stronge":
                axes.plot(tosses.after[:, 2], predicted[:, 2], ".", label=f"{name}")
    print("none     : {:.3f} m/s, {:.2f} rad/s".format(*real.medians(real.no_impact())))
    axes.axline((0, 0), slope=1, color="k", lw=0.5)
    axes.set(xlabel="measured v_z [m/s]", ylabel="predicted v_z [m/s]", aspect="equal")
    axes.legend()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "real_impacts.png", dpi=150)
    assert dv < 0.1
    assert dw < 2.3


if __name__ == "__main__":
    main()
