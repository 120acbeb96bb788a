r"""Bounces of a ball whose restitution depends on the speed
========================================================

Three balls fall from one height. One has a constant coefficient of restitution, one is of a metal that yields,
and one is viscoelastic. Slow impacts are more elastic than fast ones, so the three end in different ways. The
speeds of all impacts are compared with their recurrences.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, h, radius = 9.81, 0.5, 0.02

# %%
# A metal that yields has :math:`e = e_0 (v/v_0)^{-1/4}` (Johnson 1985), which is capped here at 0.9. A
# viscoelastic sphere has :math:`e = 1 - c\,v^{1/5} + 0.6\,c^2 v^{2/5}` (Schwager and Poeschel 1998).

LAWS = {
    "constant": 0.6,
    "plastic": carom.Restitution.power(0.5, speed=1.0, maximum=0.9),
    "viscoelastic": carom.Restitution.viscoelastic(0.3),
}

# %%
# With tolerances this small the bounces are resolved down to a height of :math:`10^{-13}` m.


def drop(restitution):
    scene = carom.Scene(gravity=(0, 0, -g))
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    ball = scene.add_body(carom.Sphere(radius), mass=0.01, position=(0, 0, h + radius), name="ball")
    scene.add_contact(ball, ground, restitution=restitution, friction=0.0)
    return carom.simulate(scene, 5.0, rtol=1e-11, atol=1e-13)


# %%
# Impact number k + 1 has the speed :math:`v_{k+1} = e(v_k) v_k`. A constant e gives a geometric series. So
# does the metal, once e has reached its cap. Of the viscoelastic ball :math:`1 - e \approx c\,v^{1/5}` goes to
# 0, and
#
# .. math:: v_k \approx (5 / (c\,k))^5,
#
# which falls more slowly than any geometric series, but fast enough for the ball to come to rest.


def recurrence(e, count):
    speeds = [np.sqrt(2 * g * h)]
    for _ in range(count - 1):
        v = speeds[-1]
        speeds.append(v * float(e(v) if callable(e) else e))
    return np.array(speeds)


def main(out="out/examples"):
    with picture(f"{out}/bounces_by_speed.png") as axes:
        for name, e in LAWS.items():
            s = drop(e)
            v = -s.impacts.relative_velocity_before[:, 0]
            error = np.max(np.abs(v - recurrence(e, len(v)))) / v[0]
            rest = s.events.time[s.events.kind == "held"][0]
            print(f"{name}: {len(v)} impacts, at rest after {rest:.4f} s, error {error:.0e}")
            axes.semilogy(np.arange(1, len(v) + 1), v, ".", label=name)
            assert error < 1e-7
        k = np.arange(20, len(v) + 1)
        axes.semilogy(k, v[-1] * (len(v) / k) ** 5, "k--", lw=0.8, label="$k^{-5}$")
        axes.set(xlabel="impact", ylabel="speed / (m/s)"), axes.legend()


if __name__ == "__main__":
    main()
