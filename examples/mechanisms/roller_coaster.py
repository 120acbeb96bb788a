r"""A roller coaster with a loop
============================

A car runs on a track, a spline through a dozen points: down a hill, through a loop, over a bump. The track
bears the weight of the car and its centripetal acceleration

.. math:: \frac{N}{m} = \Bigl| \frac{v^2}{r} \, n - g_\perp \Bigr|,

where r is the radius of curvature and n its direction.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, height, mass = 9.81, 15.0, 500.0
hill = [(-6, 0, height + 0.6), (0, 0, height), (6, 0, height - 2), (16, 0, 4), (24, 0, 0.3)]
angle = np.linspace(-0.1 * np.pi, 2.1 * np.pi, 9)
loop = [(32 + 4 * np.sin(a), 2 * a / np.pi, 4.6 - 4.2 * np.cos(a)) for a in angle]
track = carom.curves.Spline([*hill, *loop, (41, 5, 0.6), (48, 4, 3), (55, 0, 0.5), (66, -3, 1.0)])

# %%
# The car is a point of a body with a spin of its own: the joint leaves its rotation free. Dry friction and a
# buffer act along the coordinate of the joint, the arc length from the start of the car.


def coaster(friction=0.0):
    scene = carom.Scene(gravity=(0, 0, -g))
    car = scene.add_body(
        carom.Sphere(0.5), mass=mass, position=track.point(0), velocity=2.0 * track.tangent(0)
    )
    rail = scene.add_joint(carom.joints.PointOnCurve(track), carom.GROUND, car, name="rail")
    if friction > 0.0:
        scene.add_force(carom.forces.JointFriction(rail, friction), name="friction")
    scene.add_stop(rail, upper=track.length - 1.0, restitution=0.3, name="buffer")
    return carom.simulate(scene, 12.0, save_at=0.02)


# %%
# Without friction the speed is that of the height, whatever the track. The force of the rail is that of the
# curvature, which is the change of the tangent with the arc length.


def main(out="out/examples"):
    free, braked = coaster(), coaster(250.0)
    s, v = free["rail"].coordinate, free["rail"].rate
    fall = free.position[0, 0, 2] - free.position[:, 0, 2]
    before = free.t < free.impacts.time[0]
    error = np.max(np.abs(v**2 - (4.0 + 2 * g * fall))[before])
    ds = 1e-5
    bend = (track.tangent(s + ds) - track.tangent(s - ds)) / (2 * ds)
    tangent, down = track.tangent(s), np.array([0, 0, -g])
    across = down - (tangent @ down)[:, None] * tangent
    force = np.linalg.norm(v[:, None] ** 2 * bend - across, axis=1) / g
    load = np.linalg.norm(free["rail"].force, axis=1) / (mass * g)
    off = np.max(np.abs(load - force)[before])
    met, later = (run.impacts.time[0] for run in (free, braked))
    print(f"{track.length:.1f} m of track; greatest speed {np.max(v):.2f} m/s")
    print(f"v^2 = v0^2 + 2 g h within {error:.1e} m^2/s^2, load within {off:.1e} g")
    print(f"the buffer is met after {met:.2f} s, with friction after {later:.2f} s")
    assert error < 1e-4
    assert off < 1e-3
    with picture(f"{out}/roller_coaster.png", height=4.4, rows=2) as (side, time):
        points = track.point(np.linspace(0, track.length, 1000))
        side.plot(points[:, 0], points[:, 2], lw=1.2)
        side.set(xlabel="x / m", ylabel="height / m", aspect="equal")
        for run, label in ((free, "no friction"), (braked, "friction 250 N")):
            rail = run["rail"]
            load = np.linalg.norm(rail.force, axis=1) / (mass * g)
            time.plot(rail.coordinate, load, label=label)
        time.set(xlabel="arc length / m", ylabel="load of the rail / weight"), time.legend()
    carom.film(free, f"{out}/roller_coaster.gif", size=(480, 270), fps=10, speed=2)


if __name__ == "__main__":
    main()
