"""Exudyn: contact is a penalty whose damping is set for e (impactModel 2), with generalized-alpha.

What has no contact runs with DOPRI5 and automatic steps too; the block has its connector for dry friction.
"""

import importlib.metadata
import time
import warnings

import numpy as np
import problems as p

warnings.simplefilter("ignore")
import exudyn as exu  # noqa: E402
import exudyn.graphics  # noqa: E402
from exudyn.itemInterface import (  # noqa: E402
    CoordinateSpringDamperExt,
    MarkerNodeCoordinate,
    MassPoint,
    NodeGenericData,
    NodePoint,
    NodePointGround,
    ObjectGenericODE2,
)
from exudyn.utilities import RigidBodyInertia  # noqa: E402

SQUARE = [[-5, -5], [5, -5], [5, 5], [-5, 5]]
PLACE = exu.OutputVariableType.Position


def go(mbs, duration, dt=None, accuracy=None):
    """Run, and return processor time."""
    mbs.Assemble()
    s = exu.SimulationSettings()
    t = s.timeIntegration
    t.endTime, t.verboseMode = duration, 0
    t.numberOfSteps = round(duration / dt) if dt else 1
    s.solutionSettings.writeSolutionToFile = False
    solver = exu.DynamicSolverType.GeneralizedAlpha
    if accuracy:
        solver = exu.DynamicSolverType.DOPRI5
        t.numberOfSteps = 10
        t.relativeTolerance = t.absoluteTolerance = accuracy
        t.automaticStepSize = True
    else:
        t.generalizedAlpha.spectralRadius = 1.0
    begin = time.process_time()
    if not mbs.SolveDynamic(s, solverType=solver):
        raise RuntimeError("the solver stopped")
    return time.process_time() - begin


def system():
    """Return an empty system, with its container."""
    container = exu.SystemContainer()
    return container, container.AddSystem()


def body(mbs, inertia, position, velocity=(0, 0, 0), spin=(0, 0, 0), gravity=p.G):
    """Return a body of 1 kg."""
    return mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=1.0, inertiaTensor=np.diag(inertia)), referencePosition=list(position),
        initialVelocity=list(velocity), initialAngularVelocity=list(spin), gravity=[0, 0, -gravity],
        nodeType=exu.NodeType.RotationRotationVector, returnDict=True,
    )  # fmt: skip


def touch(mbs, ground, ball, dt, e, mu=0.0, z=0.0, down=False):
    """Let a ball touch a plane."""
    corners = [[x, y, z] for x, y in (SQUARE[::-1] if down else SQUARE)]
    how = {"restitutionCoefficient": e, "impactModel": 2} if e else {"contactDamping": 2e1}
    mbs.CreateSphereQuadContact(
        itemNumbers=[ball["bodyNumber"], ground], localPosition0=[0, 0, 0], sphereRadius=p.RADIUS,
        quadPoints=corners, contactStiffness=100 / dt, dynamicFriction=mu, frictionProportionalZone=1e-3,
        includeEdges=0, **how,
    )  # fmt: skip


def where(mbs, ball):
    """Return the place of a body."""
    return np.array(mbs.GetObjectOutputBody(ball["bodyNumber"], PLACE))


def rolling(dt):
    _, mbs = system()
    ground = mbs.CreateGround()
    ball = body(mbs, [0.004] * 3, (0, 0, p.RADIUS - p.G * dt / 100), (p.SPEED, 0, 0))
    touch(mbs, ground, ball, dt, 0.0, p.MU)
    took = go(mbs, p.ROLLS, dt)
    return where(mbs, ball)[0], took


def fall(dt=None, accuracy=None):
    _, mbs = system()
    box = body(mbs, p.inertia(p.HALF), (0, 0, 0), spin=p.SPIN)
    took = go(mbs, p.FALLS, dt, accuracy)
    R = mbs.GetObjectOutputBody(box["bodyNumber"], exu.OutputVariableType.RotationMatrix)
    return p.marked(where(mbs, box), np.array(R).reshape(3, 3)), took


def stops(dt):
    _, mbs = system()
    ground = mbs.CreateGround()
    ball = body(mbs, [0.004] * 3, (0, 0, p.CEILING / 2), (0, 0, -p.THROWN), gravity=0)
    touch(mbs, ground, ball, dt, p.KEEPS)
    touch(mbs, ground, ball, dt, p.KEEPS, z=p.CEILING, down=True)
    took = go(mbs, p.STOPS, dt)
    return where(mbs, ball)[2], took


def stick_slip(dt):
    _, mbs = system()
    point = mbs.AddNode(NodePoint(referenceCoordinates=[p.DRAWN, 0, 0]))
    mbs.AddObject(MassPoint(physicsMass=1.0, nodeNumber=point))
    fixed = mbs.AddNode(NodePointGround())
    ends = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=n, coordinate=0)) for n in (fixed, point)]
    data = mbs.AddNode(NodeGenericData(numberOfDataCoordinates=3, initialCoordinates=[0, 0, 0]))
    mbs.AddObject(
        CoordinateSpringDamperExt(
            markerNumbers=ends, nodeNumber=data, stiffness=p.SPRING, offset=-p.DRAWN,
            dynamicFrictionForce=p.MU * p.G, stickingStiffness=1e5, stickingDamping=100.0,
        )
    )  # fmt: skip
    took = go(mbs, p.SLIDES, dt)
    return p.DRAWN + mbs.GetNodeOutput(point, exu.OutputVariableType.Coordinates)[0], took


def bounce(dt, e):
    _, mbs = system()
    ground = mbs.CreateGround()
    ball = body(mbs, [0.004] * 3, (0, 0, p.RADIUS + p.DROP))
    touch(mbs, ground, ball, dt, e)
    took = go(mbs, p.BOUNCES[e], dt)
    return where(mbs, ball)[2], took


def pleiades(dt=None, accuracy=None):
    _, mbs = system()
    nodes = [
        mbs.AddNode(NodePoint(referenceCoordinates=[*x, 0], initialVelocities=[*v, 0]))
        for x, v in zip(p.STARS, p.FLY, strict=True)
    ]

    def force(mbs, t, number, q, q_t):
        f = np.zeros((7, 3))
        f[:, :2] = p.pull(p.STARS + np.reshape(q, (7, 3))[:, :2])
        return f.ravel()

    mass = np.diag(np.repeat(np.arange(1.0, 8.0), 3))
    mbs.AddObject(ObjectGenericODE2(nodeNumbers=nodes, massMatrix=mass, forceUserFunction=force))
    took = go(mbs, p.YEARS, dt, accuracy)
    return np.array([mbs.GetNodeOutput(n, PLACE)[:2] for n in nodes]), took


CONTACT = {
    "rolling": rolling, "stops": stops, "stick-slip": stick_slip,
    "bounce e=0.5": lambda dt: bounce(dt, 0.5), "bounce e=1": lambda dt: bounce(dt, 1.0), "free fall": fall,
    "Pleiades": pleiades,
}  # fmt: skip
FREE = {
    "free fall": lambda accuracy: fall(accuracy=accuracy),
    "Pleiades": lambda accuracy: pleiades(accuracy=accuracy),
}

if __name__ == "__main__":
    p.main(
        importlib.metadata.version("exudyn"),
        [
            p.Variant(
                "generalized-alpha", False, (1e-2, 1e-3, 1e-4), CONTACT, {},
            ),
            p.Variant(
                "DOPRI5", True, (1e-2, 1e-4, 1e-6, 1e-8, 1e-10), FREE,
                dict.fromkeys(CONTACT, "contact was run with generalized-alpha"),
            ),
        ],
    )  # fmt: skip
