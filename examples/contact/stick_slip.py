r"""Stick-slip on a belt
====================

A block on a belt is held by a spring. What sticks can carry more than what slips, so the block rides with the
belt, breaks away, slips back and is caught again: the limit cycle of a bowed string or a squealing brake.
In the phase plane every start outside this cycle ends on it. What starts slowly inside slips to and fro
for ever, because kinetic friction is constant.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, m, k, V, static, kinetic = 10.0, 1.0, 100.0, 0.1, 0.4, 0.25

# %%
# The belt is a plane whose surface moves in itself. The spring is at rest at the place 0.


def on_a_belt(place, velocity):
    scene = carom.Scene(gravity=(0, 0, -g))
    belt = scene.add_half_space((0, 0, 0), (0, 0, 1), surface_velocity=(V, 0, 0), name="belt")
    box = carom.Box(0.1, 0.1, 0.02)
    block = scene.add_body(
        box, mass=m, position=(place, 0, 0.01), velocity=(velocity, 0, 0), name="block"
    )
    friction = carom.Friction(static=static, kinetic=kinetic)
    scene.add_contact(block, belt, friction=friction, restitution=0.0)
    wall = (-0.5, 0, 0.01)
    spring = carom.forces.Spring(
        k, anchor_parent=wall, anchor_child=(place, 0, 0.01), rest_length=0.5
    )
    scene.add_force(spring, block)
    return scene


# %%
# The block sticks from :math:`x_k - D` to :math:`x_k + D`, with :math:`x_k = \mu_k N/k` and
# :math:`D = (\mu_s - \mu_k) N/k`, and slips back on a part of a circle about :math:`x_k`, in the period
#
# .. math:: T = \frac{2 D}{V} + \frac{2 \pi - 2 \arctan(D \omega/V)}{\omega}, \quad \omega^2 = k/m.


def main(out="out/examples"):
    centre, D, w = kinetic * m * g / k, (static - kinetic) * m * g / k, np.sqrt(k / m)
    period = 2 * D / V + (2 * np.pi - 2 * np.arctan(D * w / V)) / w
    cycle = carom.simulate(on_a_belt(0.0, V), 3.0, rtol=1e-8, atol=1e-10, save_at=0.002)
    events = cycle.events
    slips = np.unique(events.time[events.kind == "slips"].round(7))  # its corners slip together
    error = np.max(np.abs(np.diff(slips) - period))
    print(f"{len(slips)} cycles, period {np.diff(slips).mean():.6f} s, exact {period:.6f} s")

    inside = carom.simulate(on_a_belt(centre, 0.6 * V), 0.7, rtol=1e-8, atol=1e-10, save_at=0.002)
    with picture(f"{out}/stick_slip.png") as axes:
        for solution, label in ((cycle, "limit cycle"), (inside, "slow start")):
            block = solution["block"]
            axes.plot(1e3 * block.position[:, 0], block.velocity[:, 0], label=label)
        axes.plot(1e3 * centre, 0, "k+", label="rest")
        axes.set(xlabel="place of the block / mm", ylabel="its velocity / (m/s)"), axes.legend()
    place, velocity = inside["block"].position[:, 0], inside["block"].velocity[:, 0]
    ellipse = np.hypot(w * (place - centre), velocity)
    assert max(error, np.ptp(ellipse)) < 1e-6
    return cycle


if __name__ == "__main__":
    main()
