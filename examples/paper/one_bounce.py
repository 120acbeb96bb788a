r"""Where the error of time stepping comes from
===========================================

One bounce of a die, by three methods. A step that contains the impact (Moreau and Jean) and a step that is
brought back to the surface (the method of the paper) have an error that shrinks only slowly with the step,
and irregularly. A step that ends at the impact is exact here, with any step. The reference is a closed form.
"""

import numpy as np

import carom
from carom.baselines import moreau_jean
from carom.visual.plots.style import picture

mass, edge, e, mu, T = 0.016, 0.02, 0.5, 0.05, 0.21
STEPS = 2e-3 / 2.0 ** np.arange(6)

# %%
# The die strikes the table with an edge, which slips, and flies on.


def throw():
    scene = carom.Scene(gravity=(0, 0, -9.81))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    die = scene.add_body(
        carom.Box(edge, edge, edge), mass=mass, position=(0, 0, 0.3), velocity=(0.5, 0, -0.5),
        angular_velocity=(0, 10, 0), name="die",
    )  # fmt: skip
    scene.add_contact(die, table, restitution=e, friction=mu)
    return scene


# %%
# The closed form is free fall, then the impulse of an edge that slips in the direction s (Routh, 1860),
# :math:`P = (1 + e) |u_n| / (W_{nn} - \mu s W_{nt})`, then free fall.


def exact():
    s = carom.simulate(throw(), T, step=1e-3)
    t, W, u = s.impacts.time[0], s.impacts.inverse_mass[0], s.impacts.relative_velocity_before[0]
    P = (1 + e) * -u[0] / (W[0, 0] - mu * np.sign(u[1]) * W[0, 1])
    v = np.array([0.5 - mu * np.sign(u[1]) * P / mass, -0.5 - 9.81 * t + P / mass])
    x = np.array([0.5 * t, 0.3 - 0.5 * t - 9.81 * t**2 / 2])
    return x + v * (T - t) - [0, 9.81 * (T - t) ** 2 / 2]


# %%
# The return to the surface changes the energy, so the method of the paper gets a large tolerance for it.


def runs(h):
    rough = carom.Options(energy_tolerance=0.1)
    paper = {"method": "paper", "impact_location": "project", "options": rough}
    return {
        "Moreau-Jean": moreau_jean(throw(), T, step=h),
        "paper, projected": carom.simulate(throw(), T, step=h, **paper),
        "located": carom.simulate(throw(), T, step=h),
    }


# %%
# The error is that of the place after the bounce, for six steps.


def main(out="out/examples"):
    true, errors = exact(), {}
    for h in STEPS:
        for name, run in runs(h).items():
            errors.setdefault(name, []).append(np.linalg.norm(run.position[-1, 0, [0, 2]] - true))
    print(*(f"{name}: {np.array(error)} m" for name, error in errors.items()), sep="\n")
    with picture(f"{out}/one_bounce.png", height=2.9) as axes:
        for name, error in errors.items():
            axes.loglog(1e3 * STEPS, error, "o-", label=name)
        axes.set(xlabel="step / ms", ylabel="error after one bounce / m"), axes.legend(loc="center")
    assert max(errors["located"]) < 1e-12


if __name__ == "__main__":
    main()
