r"""A05: the flyball governor
=========================

Two balls on hinged rods turn about a shaft and lift a slider. Springs with strong dampers stand for the lower
rods, and make the system stiff: they decay with 8100/s at the start. The height of the slider after 10 s is
compared with that of a model in two coordinates.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, K, C, l_0, a, b, m_p = 9.81, 8e5, 4e4, 0.5, 0.05, 0.01, 5.0
m_r, m = 3000 * b * b, 3000 * 0.1**3  # rod or shaft, slider
far = (m_r / 2 + m_p) / (m_r + m_p)  # of the mass centre from the hinge
across = m_r * (1 + b * b) / 12 + m_r * (far - 0.5) ** 2 + m_p * (1 - far) ** 2
up, back = np.eye(3)[2], (0, 1, 0)

# %%
# The shaft turns in a bearing and the slider slides on it. Each rod with its ball is one body, on a hinge at
# the top of the shaft.


def mechanism(alpha=np.pi / 6, s=0.5, w=2 * np.pi):
    scene, J, turning = carom.Scene(), carom.joints, dict(angular_velocity=w * up)
    shaft = scene.add_body(carom.Box(b, b, 1), mass=m_r, position=up / 2, **turning)
    slider = scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=m, position=s * up, **turning)
    scene.add_joint(J.Revolute((0, 0, 0), up), carom.GROUND, shaft, name="bearing")
    scene.add_joint(J.Prismatic(up), shaft, slider, name="slide")
    for side in (1, -1):
        hinge = np.array([side * a, 0, 1])
        along = np.array([side * np.cos(alpha), 0, -np.sin(alpha)])
        x, line = hinge + far * along, np.outer(along, along)
        rod = scene.add_body(
            mass=m_r + m_p, inertia=across * (np.eye(3) - line) + m_r * b * b / 6 * line,
            position=x, velocity=w * np.cross(up, x), **turning,
        )  # fmt: skip
        scene.add_joint(J.Revolute(hinge, back), shaft, rod, name=f"hinge{side}")
        ends = (side * a, 0, s), hinge + 0.5 * along
        scene.add_force(carom.forces.Spring(K, *ends, rest_length=l_0, damping=C), slider, rod)
    return scene


# %%
# The reference has the slope :math:`\alpha` of the rods and the height s of the slider. With the constant
# momentum H about the shaft and the length l of a spring its energies are
#
# .. math::
#    2 T = H^2/I(\alpha) + 2 I_r \dot\alpha^2 + m \dot s^2, \quad
#    V = m g s - (m_r + 2 m_p) g \sin\alpha + K (l - l_0)^2.
#
# A test integrates it; this is the height after 10 s.

END = 0.61962291706

# %%
# The explicit method rk4 needs a step below 2.785/8100 s = 0.34 ms (0.33 ms runs, 0.35 ms does not). For an
# accurate result we take 0.1 ms.


def main(out="out/examples"):
    s = carom.simulate(mechanism(), 10.0, step=1e-4, save_every=20)
    height, energy = s.position[:, 1, 2], np.max(np.abs(s.ledger.residual))
    error, kept = abs(height[-1] - END), np.max(s.constraint_errors)
    print(f"slider after 10 s {height[-1]:.10f} m, error {error:.1e} m; energy {energy:.1e} J of "
          f"{s.total_energy[0]:.1f}, constraints {kept:.1e} m and m/s")  # fmt: skip
    with picture(f"{out}/a05_governor.png", columns=2) as (place, turn):
        place.plot(s.t, height)
        turn.plot(s.t, s.joint_coordinates("bearing")[1])
        place.set(xlabel="time / s", ylabel="height of the slider / m")
        turn.set(xlabel="time / s", ylabel="rate of the shaft / rad s$^{-1}$")
    assert max(error, kept, energy / 1e3) < 1e-9


if __name__ == "__main__":
    main()
