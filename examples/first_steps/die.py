r"""A die goes on, or turns back
============================

A thrown die strikes a table with an edge, and friction turns it back. Slip keeps its direction s, so the
impulse is known in closed form (Routh):

.. math:: P_n = (1 + e) |u_n| / (W_{nn} - \mu s W_{nt}), \quad P_t = -\mu s P_n .
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import carom

mass, edge, e = 0.016, 0.02, 0.5

# %%
# One throw: a scene with a table and a die, and the friction between them. The die has no motion across its
# way, so all of this happens in a plane.


def throw(mu):
    scene = carom.Scene(gravity=(0, 0, -9.81))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    die = scene.add_body(
        carom.Box(edge, edge, edge), mass=mass, position=(0, 0, 0.3), velocity=(0.5, 0, -0.5),
        angular_velocity=(0, 10, 0), name="die",
    )  # fmt: skip
    scene.add_contact(die, table, restitution=e, friction=mu)
    return carom.simulate(scene, 0.42, step=1e-3)


# %%
# Two throws, which differ in friction alone. The record of an impact has what Routh's formula needs: W, and the
# velocity before. What the formula says of the horizontal speed is compared with the run.


def main(out="out/examples"):
    figure = Figure(figsize=(6, 3), layout="constrained")
    axes = figure.subplots()
    for mu in (0.05, 0.20):
        solution = throw(mu)
        impact = solution.impacts[0]
        W, u = impact.inverse_mass, impact.relative_velocity_before
        s = np.sign(u[1])
        P = (1 + e) * -u[0] / (W[0, 0] - mu * s * W[0, 1])
        v_x = 0.5 - mu * s * P / mass
        found = solution.evaluate(impact.time)[2][0, 0]
        print(f"mu = {mu:.2f}: v_x after the impact {found:+.12f} m/s, exact {v_x:+.12f}")
        axes.plot(*solution.position[:, 0, [0, 2]].T, label=f"mu = {mu:.2f}")
        assert abs(found - v_x) < 1e-10
    assert found < 0, "with mu = 0.20 the die goes back"

    axes.set(xlabel="x [m]", ylabel="z [m]", aspect="equal")
    axes.legend()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "die.png", dpi=150)


if __name__ == "__main__":
    main()
