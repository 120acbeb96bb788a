r"""A ball strikes the end of an elastic bar
==========================================

How fast a ball is after an impact can be computed instead of assumed: waves run through the bar and come back
while the ball still touches it. The velocity of the ball afterwards is compared with that of the wave equation.
With many modes it does not depend on the coefficient of restitution e of the small impacts that make up the
contact.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

length, speed = 1.0, 1.0

# %%
# The bar is free, of mass m, and stretches along its axis by some of its modes. A rigid ball of mass M pushes
# its end. Until the wave is back after 2 L/c, the bar is a damper to it, M v' = -(m c/L) v, so that
#
# .. math:: v(2 L/c) = v_0 e^{-2 m/M},
#
# and then the end of the bar leaves the ball behind.


def strike(modes, restitution, ratio):
    bar_modes = carom.flexible.beam(
        length, carom.flexible.Circle(0.02), density=7800, young=210e9, modes=modes, kinds=("stretch",)
    )  # fmt: skip
    scene = carom.Scene()
    bar = scene.add_body(carom.Box(length, 0.03, 0.03), modes=bar_modes, name="bar")
    ball = scene.add_body(
        carom.Sphere(0.02), mass=ratio * bar_modes.mass, position=(-0.5201, 0, 0),
        velocity=(speed, 0, 0), name="ball",
    )  # fmt: skip
    scene.add_contact(ball, bar, restitution=restitution)
    return carom.simulate(scene, duration=0.001)


# %%
# With 5 modes the result is near already. With more of them, each impact is with a lighter part of the bar. For
# e = 1 their number grows with that of the modes; for e < 1 the impacts end in persistent contact, which takes
# over until the wave is back.


def main(out="out/examples"):
    counts = 5, 10, 20, 40, 80
    with picture(f"{out}/ball_on_bar.png") as axes:
        for ratio, name, color in ((1.0, "M = m", "C0"), (3.0, "M = 3m", "C1")):
            exact = speed * np.exp(-2.0 / ratio)
            axes.axhline(exact, color=color, lw=0.8, label=f"waves, ${name}$")
            for restitution, mark in ((0.0, "o"), (0.5, "s"), (1.0, "^")):
                runs = [strike(n, restitution, ratio) for n in counts]
                after = np.array([run["ball"].velocity[-1, 0] for run in runs])
                axes.semilogx(
                    counts, after, mark, color=color, mfc="none", label=f"e = {restitution:g}"
                )
                hits = [len(run.impacts) for run in runs]
                print(
                    f"{name}, e = {restitution:g}: {after.round(4)}, waves {exact:.4f}, {hits} impacts"
                )
                assert np.abs(after[0] - exact) < 0.03
                assert np.abs(after[-1] - exact) < 0.004
        axes.set_xticks(counts, [str(n) for n in counts], minor=False)
        axes.minorticks_off()
        axes.set(
            xlabel="modes of the bar", ylabel="velocity of the ball after / (m/s)", ylim=(0.1, 0.6)
        )
        axes.legend(loc="center right", ncols=2, columnspacing=1)


if __name__ == "__main__":
    main()
