"""The forces in time of impacts of a run that take place at once.

W of all their points is that of the scene in the state before. The works of each impact give its energetic
coefficient, and stiffnesses in newton its time (`carom.impact.multiple.trace`). What is found has to be the
impact of the run; it is not if its stiffnesses had other ratios, or blows followed one after another.
"""

from __future__ import annotations

import math

import numpy as np

from carom.dynamics.contact_mass import delassus
from carom.geometry import quaternion
from carom.geometry.frames import contact_axes
from carom.impact.thresholds import COURSE_ERROR
from carom.results.stiff_impacts import stiffness_of


def impact_forces(solution, k: int, stiffness=None):
    """Return the forces of impact k of a run, of all impacts at its time; see `Solution`."""
    from carom.impact.multiple.api import stated_laws
    from carom.impact.multiple.forces import made
    from carom.impact.multiple.layout import MultipleSettings
    from carom.impact.multiple.trace import CONTACT_COLUMNS, course

    rows, impacts = solution._written.impact, solution.impacts
    times = np.array(rows.time)
    own = np.flatnonzero(times == times[k])
    rows, count = rows[own], len(own)
    if np.any(rows.contact >= len(solution.pairs.body)):
        raise ValueError("the impact must be of bodies only, got one with a stop of a joint")
    stiff, p = _stiffnesses(solution, rows, stiffness)
    mu = np.array([impacts.friction[i] for i in own.tolist()])
    if not np.all(np.isfinite(mu)):
        raise ValueError(
            "the impact must have numbers as friction, got a law, anisotropic friction, or parts of a body "
            "with different materials"
        )
    W, u = _inverse_mass(solution, rows), np.array(rows.before)
    took, gave = -np.array(rows.compression_work), np.array(rows.restitution_work)
    e = np.sqrt(np.divide(gave, took, out=np.zeros(count), where=took > 0.0))
    nothing = np.zeros(count, dtype=np.int64)
    laws = stated_laws(mu, np.minimum(e, 1.0), nothing, np.zeros(count), stiff / stiff.max())
    found = course(W, u, (laws, mu), e, stiff, MultipleSettings(exponent=p))
    off = math.inf
    if found is not None:
        last, P = found[-1, 1:].reshape(count, CONTACT_COLUMNS), np.array(rows.impulse)
        off = max(
            np.abs(last[:, 7] - P[:, 0]).max() / P[:, 0].max(),
            np.abs(last[:, 4:7] - np.array(rows.after)).max() / np.abs(u).max(),
        )
    if found is None or not off <= COURSE_ERROR:
        raise ValueError(
            "the impact was not solved with this exponent and these ratios of stiffnesses, or its blows "
            "followed one after another: relative numbers as stiffness of contacts and Options.corner_exponent "
            "decide it"
        )
    return made(found, count, tuple(own.tolist()))


def _stiffnesses(solution, rows, given) -> tuple[np.ndarray, float]:
    """Return the stiffness of each impact in newton, and their exponent."""
    from carom.impact.multiple.forces import stated_stiffness

    if given is not None:
        stated = stated_stiffness("stiffness", given, len(rows))
        if stated is None:
            raise TypeError(
                "stiffness must be a Stiffness or a Hertz, or one for each of the impacts at this time"
            )
        return stated
    found = []
    for i, number in enumerate(np.array(rows.contact).tolist()):
        one = stiffness_of(solution, number, rows[i : i + 1])
        if one is None:
            raise TypeError(
                "stiffness must be stated for each contact that strikes, in newton: carom.Stiffness or "
                "carom.Hertz, of add_contact, of materials, or here"
            )
        found.append((float(np.ravel(one[0])[0]), one[1]))
    if len({p for _, p in found}) > 1:
        raise ValueError(
            "stiffness must have one exponent, because contacts that strike together share it"
        )
    return np.array([k for k, _ in found]), found[0][1]


def _inverse_mass(solution, rows) -> np.ndarray:
    """Return W (3K, 3K) of the points of impacts, in the state before them."""
    from carom.model.compile import compile_scene
    from carom.options import Options

    if solution.scene.switches:
        raise ValueError("the impact must be one of a scene without switches")
    pairs = solution.pairs
    compiled = compile_scene(solution.scene, Options(), loops=True)
    state, (x, Q, _, _) = compiled.start.copy(), solution.evaluate(float(rows.time[0]), side="left")
    state["x"], state["Q"] = x, quaternion.multiply(Q, solution._run.to_principal)
    points = []
    for row in rows:
        number = int(row["contact"])
        sides = [(1.0, int(pairs.body[number]))]
        if pairs.plane[number] < 0:
            sides.append((-1.0, int(pairs.other[number])))
        points.append((sides, np.array(row["point"]), contact_axes(np.array(row["normal"]))))
    W = delassus(compiled.system, state, points)
    own = np.array([W[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] for i in range(len(points))])
    if not np.allclose(own, np.array(rows.W), rtol=COURSE_ERROR, atol=COURSE_ERROR * own.max()):
        raise ValueError(
            "the impact must be one of a state that can be evaluated, with plain tangents"
        )
    return W
