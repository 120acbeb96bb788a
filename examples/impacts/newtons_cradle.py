r"""Newton's cradle, by two models of its impact
============================================

Three balls hang side by side, and the first one strikes the other two. Energy and momentum alone do not say
what comes out: they leave one number open, and the model of the multiple impact decides. carom has two
models. Each is compared with its exact result.
"""

import numpy as np
from scipy.integrate import solve_ivp

import carom
from carom.visual.plots.style import picture

g, radius, length, angle = 9.81, 0.02, 0.2, np.radians(20)

# %%
# The balls hang on strings of constant length and are elastic. Only the model of the multiple impact differs
# between two runs.


def swing(multiple):
    scene = carom.Scene(gravity=(0, 0, -g))
    for k in range(3):
        pivot = np.array([2 * radius * k, 0, length])
        place = pivot - length * np.array([0, 0, 1] if k else [np.sin(angle), 0, np.cos(angle)])
        ball = scene.add_body(carom.Sphere(radius), mass=0.1, position=place)
        scene.add_joint(carom.joints.Distance(pivot, place), carom.GROUND, ball)
    scene.set_contact_default(restitution=1, multiple=multiple)
    return carom.simulate(scene, 1.5, step=1e-3)


# %%
# With ``"sequential"`` one impact follows the other, as if the balls did not quite touch. Then the last ball
# takes all of the velocity, as in textbooks.
#
# With ``"simultaneous"``, the default, the balls touch and are pressed together by Hertz's forces
# :math:`d^{3/2}`. Then all three balls move. What is expected comes from these forces, integrated by SciPy.


def hertz():  # velocities after the impact, by that of the first ball before it
    def rates(t, y):
        first, second = np.maximum(y[:2] - y[1:3], 0) ** 1.5
        return [*y[3:], -first, first - second, second]

    return solve_ivp(rates, (0, 50), [0, 0, 0, 1, 0, 0], rtol=1e-10, atol=1e-12).y[3:, -1]


# %%
# For each model we look at the velocities after the first impact. The film shows the second model.


def main(out="out/examples"):
    models = {"sequential": [0, 0, 1], "simultaneous": hertz()}
    with picture(f"{out}/newtons_cradle.png", columns=2, sharey=True) as panels:
        for axes, (multiple, exact) in zip(panels, models.items()):
            s = swing(multiple)
            before, v = (s.evaluate(s.impacts.time[0], side)[2][:, 0] for side in ("left", "right"))
            print(f"{multiple:12} {(v / before[0]).round(6)}, exact {np.round(exact, 6)}")
            x = 1e3 * (s.position[:, :, 0] - 2 * radius * np.arange(3))
            axes.plot(s.t, x, label=["ball 1", "ball 2", "ball 3"])
            axes.set(xlabel="time / s", title=f'multiple="{multiple}"', ylim=(-80, 110))
            assert np.allclose(v / before[0], exact, atol=1e-6)
        panels[0].set(ylabel="displacement / mm"), panels[0].legend(ncols=3, loc="upper center")
    carom.film(s, f"{out}/newtons_cradle.gif", size=(400, 320), fps=20, speed=0.5, view=(-75, 10))


if __name__ == "__main__":
    main()
