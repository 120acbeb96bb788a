r"""An impact hammer: a striker between an air cushion and a bit
=============================================================

In the hammer of a drill a crank moves a piston in a tube. The air behind the striker throws it against the bit,
and draws it back. Each blow drives the bit into the stone. An integration by SciPy does the same.
"""

import numpy as np
from scipy.integrate import solve_ivp

import carom
from carom import GROUND, constraints, forces, joints
from carom.visual.plots.style import picture

STROKE, SPEED, AIR, AREA = 0.015, 2 * np.pi * 30, 0.06, 4.5e-4  # crank [m, rad/s], cushion [m, m^2]
STRIKER, BIT, E, STONE, GAP, END = 0.08, 0.5, 0.7, 1500.0, 0.02, 0.4  # [kg, kg, 1, N, m, s]
lengths = np.geomspace(0.004, 0.4, 2000)
TABLE = [lengths, 1e5 * AREA * (1 - (AIR / lengths) ** 1.4)]  # tension of the air, p V^1.4 stays
CUSHION = forces.CurveSpring((0, 0, 0), (AIR, 0, 0), TABLE)


def piston(t):
    x, y = STROKE * np.cos(SPEED * t), STROKE * np.sin(SPEED * t)
    return STROKE - x, SPEED * y, SPEED**2 * x


# %%
# The cushion is a spring by its curve, the stone dry friction of the bit, the blow a stop of the difference.


def hammer():
    scene = carom.Scene(gravity=(0, 0, 0))
    along = carom.euler("y", 90)
    parts = {"piston": (0.0, 0.1, 0.02), "striker": (AIR, STRIKER, 0.02), "bit": (0.13, BIT, 0.08)}
    for name, (x, mass, length) in parts.items():
        shape = carom.Cylinder(0.012, length)
        scene.add_body(shape, mass=mass, position=(x, 0, 0), orientation=along, name=name)
        scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, name, name=f"{name}.x")
    scene.add_constraint(constraints.Driver("piston.x", motion=piston))
    scene.add_force(CUSHION, "piston", "striker")
    scene.add_force(forces.JointFriction("bit.x", STONE))
    scene.add_stop({"bit.x": 1, "striker.x": -1}, lower=-GAP, restitution=E, name="blow")
    return scene


# %%
# By SciPy: up to the next blow, or to where the bit stops.


def by_hand():
    """Return the depth of the bit at the end, and the speeds of all blows."""
    t, y, moves, speeds = 0.0, np.zeros(4), False, []

    def rates(t, y):
        pull = CUSHION.tension(AIR + y[0] - piston(t)[0])
        return y[1], -pull / STRIKER, y[3], -STONE / BIT * moves

    events = (lambda t, y: GAP + y[2] - y[0]), (lambda t, y: y[3] if moves else 1.0)
    for one in events:
        one.terminal, one.direction = True, -1
    while t < END:
        s = solve_ivp(rates, (t, END), y, "DOP853", events=events, rtol=1e-12, atol=1e-14)
        t, y, moves = s.t[-1], s.y[:, -1], len(s.t_events[1]) == 0
        if len(s.t_events[0]):
            speeds.append(y[1] - y[3])
            impulse = (1 + E) * speeds[-1] / (1 / STRIKER + 1 / BIT)
            y += (0, -impulse / STRIKER, 0, impulse / BIT)
        y[3] *= moves
    return y[2], np.array(speeds)


def main(out="out/examples"):
    s = carom.simulate(hammer(), END, rtol=1e-10, save_at=np.linspace(0, END, 1601))
    speed = -s["blow"].impacts.relative_velocity_before[:, 0]
    depth, speeds = by_hand()
    error = max(abs(s["bit.x"].coordinate[-1] - depth), *np.abs(speed - speeds))
    print(
        f"{len(speed)} blows of up to {speed.max():.2f} m/s, {1e3 * depth:.3f} mm deep; error {error:.0e}"
    )
    assert error < 1e-7
    with picture(f"{out}/impact_hammer.png", height=3.0) as ax:
        faces = s.position[:, :, 0] + (0.01, 0.01, -0.04)
        ax.plot(1e3 * s.t, 1e3 * faces, label=["piston", "striker", "bit"], lw=0.9)
        ax.set(xlabel="time / ms", ylabel="place of the faces / mm", xlim=(0, 200), ylim=(0, 115))
        ax.legend(loc="upper center", ncols=3)


if __name__ == "__main__":
    main()
