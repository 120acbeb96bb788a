"""Siconos: Moreau-Jean steps (theta 1/2) and its event-driven scheme, with its kernel alone."""

import time

import numpy as np
import problems as p
import siconos.kernel as sk
import siconos.numerics as sn


def ball(z, velocity, force, e, ceiling=False):
    """Return a ball that moves along a line, and its contacts."""
    ds = sk.LagrangianLinearTIDS([z], [velocity], np.eye(1))
    ds.setFExtPtr(np.array([force]))
    contacts = [sk.LagrangianLinearTIR([[1.0]], [-p.RADIUS])]
    if ceiling:
        contacts.append(sk.LagrangianLinearTIR([[-1.0]], [p.CEILING - p.RADIUS]))
    return ds, [sk.Interaction(sk.NewtonImpactNSL(e), c) for c in contacts]


def go(ds, contacts, dt, duration, events=False, friction=False):
    """Run, and return processor time."""
    system = sk.NonSmoothDynamicalSystem(0, duration)
    system.insertDynamicalSystem(ds)
    for contact in contacts:
        system.link(contact, ds)
    grid = sk.TimeDiscretisation(0, dt)
    if events:
        run = sk.EventDriven(system, grid)
        run.insertIntegrator(sk.LsodarOSI())
        run.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_IMPACT)
        run.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_SMOOTH_ACC)
    elif friction:
        solver = sk.FrictionContact(2, sn.SICONOS_FRICTION_2D_LEMKE)
        run = sk.TimeStepping(system, grid, sk.MoreauJeanOSI(0.5), solver)
    else:
        run = sk.TimeStepping(system, grid, sk.MoreauJeanOSI(0.5), sk.LCP())
    begin = time.process_time()
    while run.hasNextEvent():
        if events:
            run.advanceToEvent()
            run.processEvents()
        else:
            run.computeOneStep()
            run.nextStep()
    return time.process_time() - begin


def stops(dt, events):
    ds, contacts = ball(p.CEILING / 2, -p.THROWN, 0.0, p.KEEPS, ceiling=True)
    took = go(ds, contacts, dt, p.STOPS, events)
    return ds.q()[0], took


def bounce(dt, e, events):
    ds, contacts = ball(p.RADIUS + p.DROP, 0.0, -p.G, e)
    took = go(ds, contacts, dt, p.BOUNCES[e], events)
    return ds.q()[0], took


def plane(inertia, q, v, stiffness, z, arm):
    """Return a body in the plane (height, place, angle) on a rough floor."""
    K = np.zeros((3, 3))
    K[1, 1] = stiffness
    ds = sk.LagrangianLinearTIDS(q, v, np.diag([1.0, 1.0, inertia]), K, np.zeros((3, 3)))
    ds.setFExtPtr(np.array([-p.G, 0.0, 0.0]))
    law = sk.NewtonImpactFrictionNSL(0.0, 0.0, p.MU, 2)
    relation = sk.LagrangianLinearTIR([[1.0, 0, 0], [0, 1.0, arm]], [-z, 0.0])
    return ds, [sk.Interaction(law, relation)]


def rolling(dt):
    r = p.RADIUS
    ds, contacts = plane(0.4 * r * r, [r, 0, 0], [0, p.SPEED, 0], 0.0, r, r)
    took = go(ds, contacts, dt, p.ROLLS, friction=True)
    return ds.q()[1], took


def stick_slip(dt):
    ds, contacts = plane(1.0, [p.BLOCK[2], p.DRAWN, 0], [0, 0, 0], p.SPRING, p.BLOCK[2], 0.0)
    took = go(ds, contacts, dt, p.SLIDES, friction=True)
    return ds.q()[1], took


NO_FREE = "not run, as it has no contact"
NO_EVENTS = "not set up with friction here"


def variant(name, events):
    """Return what a scheme solves."""
    every = {
        "stops": lambda dt: stops(dt, events), "bounce e=0.5": lambda dt: bounce(dt, 0.5, events),
        "bounce e=1": lambda dt: bounce(dt, 1.0, events),
    }  # fmt: skip
    if not events:
        every |= {"rolling": rolling, "stick-slip": stick_slip}
    why = {"free fall": NO_FREE, "Pleiades": NO_FREE, "rolling": NO_EVENTS, "stick-slip": NO_EVENTS}
    return p.Variant(name, False, (1e-2, 1e-3, 1e-4), every, why)


if __name__ == "__main__":
    p.main("4.4.0", [variant("Moreau-Jean", False), variant("event-driven", True)])
