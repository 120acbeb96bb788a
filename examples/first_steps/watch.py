"""A page that plays a run
=========================

A ball with backspin comes back; its impulses, which the page shows as arrows, are checked against momentum.

A ball that slides through its whole impact gets the impulse P (n - mu s), P = m (1 + e) times its normal speed,
s the direction of slip; so the arrows that are shown are known, as long as the slip at the contact lasts.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import carom

mass, radius, e, mu = 0.046, 0.0214, 0.7, 0.3


def throw():
    scene = carom.Scene()
    green = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="green")
    ball = scene.add_body(
        carom.Sphere(radius), mass=mass, position=(0, 0, 0.5), velocity=(1.0, 0, 0),
        angular_velocity=(0, -400, 0), name="ball",
    )  # fmt: skip
    scene.add_contact(ball, green, restitution=e, friction=mu)
    return carom.simulate(scene, 2.0, step=2e-3)


def main(out="out/examples"):
    solution, out = throw(), Path(out)
    out.mkdir(parents=True, exist_ok=True)
    written = carom.view(solution, export=out / "watch.html", title="Backspin", speed=0.5)
    print(written)

    first = solution.impacts[0]
    before = solution.evaluate(first.time, side="left")[2][0]
    after = solution.evaluate(first.time)[2][0]
    P = mass * (1 + e) * -before[2]
    error = np.max(np.abs(mass * (after - before) - P * np.array([-mu, 0, 1])))
    print(
        f"impulse {P:.6f} N s, error {error:.0e}; in the end {solution.velocity[-1, 0, 0]:+.3f} m/s"
    )

    figure = Figure(figsize=(6.5, 3), layout="constrained")
    axes = figure.subplots()
    axes.plot(*solution.position[:, 0, [0, 2]].T, lw=1.2)
    hits = solution.impacts
    axes.quiver(hits.point[:, 0], hits.point[:, 2], hits.impulse[:, 1], hits.impulse[:, 0],
                angles="xy", scale=1.2, color="#D55E00", width=0.004)  # fmt: skip
    axes.set(xlabel="x [m]", ylabel="z [m]")
    figure.savefig(out / "watch.png", dpi=150)
    assert error < 1e-12
    assert solution.velocity[-1, 0, 0] < 0 < before[0], "it comes back"
    assert written.size < 300_000


if __name__ == "__main__":
    main()
