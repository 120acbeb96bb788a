r"""A die slides on, or turns back
==============================

A thrown die strikes a table with an edge. With little friction it slides on; with more friction the same
throw turns back. The velocity after the impact is compared with the closed form of Routh (1860).
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

mass, edge, e = 0.016, 0.02, 0.5

# %%
# One throw needs a table, a die, and the friction of their contact. The die has no motion across its
# direction of flight, so all of this happens in a plane.


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
# The slip of this impact does not change its direction s. Then the normal and the tangential impulse are
#
# .. math:: P_n = (1 + e) |u_n| / (W_{nn} - \mu s W_{nt}), \quad P_t = -\mu s P_n .
#
# The record of an impact has what this formula needs: the Delassus operator W (here ``inverse_mass``), and
# the relative velocity u before the impact.


def routh(impact, mu):  # horizontal velocity after the impact
    W, u = impact.inverse_mass, impact.relative_velocity_before
    s = np.sign(u[1])
    return 0.5 - mu * s * (1 + e) * -u[0] / (W[0, 0] - mu * s * W[0, 1]) / mass


# %%
# The two throws differ in friction alone. The film shows the second one in slow motion.


def main(out="out/examples"):
    with picture(f"{out}/die.png") as axes:
        for mu in (0.05, 0.20):
            s = throw(mu)
            found, exact = s.evaluate(s.impacts[0].time)[2][0, 0], routh(s.impacts[0], mu)
            print(f"mu = {mu:.2f}: v_x after the impact {found:+.12f} m/s, exact {exact:+.12f}")
            axes.plot(*s.position[:, 0, [0, 2]].T, label=f"mu = {mu:.2f}")
            assert abs(found - exact) < 1e-10
        axes.set(xlabel="x / m", ylabel="z / m"), axes.legend()
    assert found < 0, "with mu = 0.20 the die turns back"
    carom.film(s, f"{out}/die.gif", size=(360, 360), fps=20, speed=0.1, start=0.15, follow="die")


if __name__ == "__main__":
    main()
