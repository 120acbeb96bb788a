"""MuJoCo: a contact is a soft constraint. Its damping is set for e, its stiffness for the step.

As its manual says (Modeling, Restitution): negative solref, refsafe off; elliptic cones, impratio against slip.
The integrator is implicitfast, which it recommends for most models, or RK4.
"""

import time

import mujoco
import numpy as np
import problems as p


def model(dt, body, e=0.0, gravity=p.G, mu=0.0, ceiling=False, integrator="implicitfast"):
    """Return a model with a floor."""
    w = 0.3 / dt
    z = p.damping_ratio(e) if e > 0 else 1.0
    top = '<geom type="plane" size="0 0 1" pos="0 0 1.2" euler="180 0 0"/>' if ceiling else ""
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
<option timestep="{dt}" integrator="{integrator}" cone="elliptic" impratio="10" gravity="0 0 {-gravity}">
<flag refsafe="disable"/></option>
<default><geom solref="{-w * w} {-2 * z * w}" solimp=".9999 .9999 .001" condim="3"
 friction="{mu} 0 0"/></default>
<worldbody><geom type="plane" size="0 0 1"/>{top}{body}</worldbody></mujoco>""")


def ball(z):
    """Return the text of a ball."""
    return f'<body pos="0 0 {z}"><freejoint/><geom type="sphere" size=".1" mass="1"/></body>'


def go(m, dt, duration, velocity=(), position=None):
    """Take the steps."""
    d = mujoco.MjData(m)
    d.qvel[: len(velocity)] = velocity
    if position is not None:
        d.qpos[: len(position)] = position
    begin = time.process_time()
    mujoco.mj_step(m, d, round(duration / dt))
    return d, time.process_time() - begin


def rolling(dt, integrator):
    m = model(dt, ball(p.RADIUS), mu=p.MU, integrator=integrator)
    d, took = go(m, dt, p.ROLLS, (p.SPEED,))
    return d.qpos[0], took


def fall(dt, integrator):
    size = " ".join(map(str, p.HALF))
    body = f'<body><freejoint/><geom type="box" size="{size}" mass="1" contype="0" conaffinity="0"/></body>'
    d, took = go(model(dt, body, integrator=integrator), dt, p.FALLS, (0, 0, 0, *p.SPIN))
    return p.marked(d.qpos[:3], p.matrix(*d.qpos[3:7])), took


def stops(dt, integrator):
    m = model(dt, ball(p.CEILING / 2), p.KEEPS, gravity=0, ceiling=True, integrator=integrator)
    d, took = go(m, dt, p.STOPS, (0, 0, -p.THROWN))
    return d.qpos[2], took


def stick_slip(dt, integrator):
    size = " ".join(map(str, p.BLOCK))
    body = f"""<body pos="0 0 {p.BLOCK[2]}"><joint type="slide" axis="1 0 0" stiffness="{p.SPRING}"/>
<joint type="slide" axis="0 0 1"/><geom type="box" size="{size}" mass="1"/></body>"""
    d, took = go(
        model(dt, body, mu=p.MU, integrator=integrator), dt, p.SLIDES, position=(p.DRAWN, 0)
    )
    return d.qpos[0], took


def bounce(dt, e, integrator):
    d, took = go(model(dt, ball(p.RADIUS + p.DROP), e, integrator=integrator), dt, p.BOUNCES[e])
    return d.qpos[2], took


def pleiades(dt, integrator):
    bodies = "".join(
        f'<body pos="{x} {y} 0"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>'
        f'<geom type="sphere" size=".01" mass="{k + 1}" contype="0" conaffinity="0"/></body>'
        for k, (x, y) in enumerate(p.STARS)
    )
    m = model(dt, bodies, gravity=0, integrator=integrator)

    def force(m, d):
        d.qfrc_passive += p.pull(p.STARS + d.qpos.reshape(7, 2)).ravel()

    mujoco.set_mjcb_passive(force)
    d, took = go(m, dt, p.YEARS, p.FLY.ravel())
    mujoco.set_mjcb_passive(None)
    return p.STARS + np.array(d.qpos).reshape(7, 2), took


def variant(integrator):
    """Return what an integrator solves."""
    every = {
        "rolling": rolling, "free fall": fall, "stops": stops, "stick-slip": stick_slip,
        "bounce e=0.5": lambda dt, by: bounce(dt, 0.5, by),
        "bounce e=1": lambda dt, by: bounce(dt, 1.0, by), "Pleiades": pleiades,
    }  # fmt: skip
    solve = {name: lambda dt, of=of: of(dt, integrator) for name, of in every.items()}
    return p.Variant(integrator, False, (1e-2, 1e-3, 1e-4), solve, {})


if __name__ == "__main__":
    p.main(mujoco.__version__, [variant("implicitfast"), variant("RK4")])
