"""Springs, dampers and gains whose stiffness, not the motion, has limited the steps of a run.

Linearized at a state, springs and dampers with the rows J have s'' = -W (K s + C s'), W = J M^-1 J^T beside the
joints. An explicit method is stable for steps up to r/|lambda|, where r is the boundary of its region of
stability in the direction of the eigenvalue lambda (Hairer and Wanner 1996, IV.2), so stability alone requires
T |lambda|/r steps in the time T. If this is much of the steps of the run, they are limited by stiffness. Modes
that do not decay in some periods are motions that the tolerances resolve.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.dynamics.force_rows import write_force_rows
from carom.model import records as r
from carom.model.forces import FRICTIONS
from carom.scene.forces import Bushing
from carom.scene.more_forces import CurveSpring, JointForce
from carom.status import Advice

FEW_TRIALS = 1000  # trial steps below which nothing is said
MUCH = 0.3  # of the trial steps: what stability alone requires (0.45 to 0.99 where stiffness limits them)
DECAYS = 0.02  # least decay of a mode, relative to |lambda|
MODE_STATES = 5  # saved states at which modes are computed
FASTEST = 60  # forces with the fastest modes of their own that are taken together
TINY = 1e-6  # step of differences of the user's functions, relative to values and at least to 1


class Force(NamedTuple):
    """A spring, damper or gain: of which force of the scene, where kernels find it, and its coefficients."""

    index: int
    place: tuple[int, int, int]
    stiffness: float
    damping: float


def remarks(run, series, states) -> tuple[str, ...]:
    """Return a sentence about the force whose stiffness has limited the steps of a run, if one has."""
    trials, end = (
        int(run.clock["trials"][0]),
        float(min(run.clock["now"][0], run.clock["still"][0])),
    )
    if run.tolerances is None or trials < FEW_TRIALS:  # methods with tolerances are explicit
        return ()
    forces = stiff_forces(run)
    if not forces:
        return ()
    rows = np.unique(
        np.linspace(0, np.searchsorted(series["t"], end, "right") - 1, MODE_STATES).astype(int)
    )
    found = [fastest(run, forces, states[k], float(series["t"][k])) for k in rows]
    steps = end * float(np.mean([pace for pace, _ in found])) / trials
    if not steps >= MUCH:
        return ()
    force = run.scene.forces[max(found)[1]]
    return (Advice(_sentence(force, min(1.0, steps), trials, end, run)),)


def _sentence(force, part: float, trials: int, end: float, run) -> str:
    d = force.definition
    said = (
        f"The stiffness of the force {force.name!r} ({force.kind}) limits the steps: about {part:.0%} of the "
        f"{trials} trial steps, of {end / trials:.2g} s on average, are as short as the stability of the "
        "explicit method requires, not the accuracy. "
    )
    if isinstance(d, JointForce):
        said += "State its gains as forces.JointSpring(joint, stiffness, damping, rest), and use "
    elif isinstance(d, (Bushing, CurveSpring)):
        said += "Lower its damping; or replace it by forces.Spring or forces.JointSpring, and use "
    else:
        said += "Use "
    said += (
        f'method="implicit" with a step that resolves the motion, such as step={end / 2000:.1g}.'
    )
    if len(run.compiled.system.contacts):
        said += " While contacts persist all forces stay explicit: there only lower damping helps."
    return said


def stiff_forces(run) -> list[Force]:
    """Return the linear springs, dampers and gains of the compiled scene, in the order of their rows."""
    system, out = run.compiled.system, []
    for index, (kind, first, last) in sorted(run.compiled.places.items()):
        if kind == FRICTIONS:
            continue
        rows = system.forces[kind]
        of = [name for name in ("", "turn_") if f"{name}stiffness" in (rows.dtype.names or ())]
        for number in range(first, last if of else first):
            k, c = (
                np.hstack([rows[name + end][number] for name in of]).tolist()
                for end in ("stiffness", "damping")
            )
            pairs = enumerate(zip(k, c))
            out += [Force(index, (kind, number, axis), *pair) for axis, pair in pairs]
    depends = [callable(getattr(run.scene.forces[f.index].definition, "force", None)) for f in out]
    return [f for f, gains in zip(out, depends) if gains or f.stiffness + f.damping > 0.0]


def fastest(run, forces: list[Force], state, t: float) -> tuple[float, int]:
    """Return the least number of steps [1/s] that the stability of decaying modes requires, and a force."""
    system = run.compiled.system
    J, motions, values = force_rows(system, state, forces, t)
    k, c = np.array([(f.stiffness, f.damping) for f in forces]).T
    for i, force in enumerate(forces):
        function = getattr(run.scene.forces[force.index].definition, "force", None)
        if callable(function):
            k[i], c[i] = gains(function, t, *values[i])
    own = np.einsum("ibk,ibk->i", J, motions)
    chosen = np.sort(np.argsort(-np.maximum(own * c, np.sqrt(np.maximum(own * k, 0.0))))[:FASTEST])
    k, c, n = k[chosen], c[chosen], len(chosen)
    W = np.einsum("ibk,jbk->ij", J[chosen], motions[chosen])
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-W * k, -W * c]])
    if not np.all(np.isfinite(A)):
        return 0.0, forces[0].index
    modes, vectors = np.linalg.eig(A)
    size = np.abs(modes)
    decays = (size > 0.0) & (-np.real(modes) > DECAYS * size)
    if not np.any(decays):
        return 0.0, forces[0].index
    pace = np.where(decays, size / radius(run.method, np.where(decays, modes, -1.0)), 0.0)
    m = int(np.argmax(pace))
    share = np.abs(vectors[n:, m]) ** 2 * (np.abs(c) + np.abs(k) / size[m])
    return float(pace[m]), forces[chosen[int(np.argmax(share))]].index


def force_rows(system, state, forces: list[Force], t: float):
    """Return J and M^-1 J^T of the forces beside the joints, (n, N, 6) each, and their coordinates (n, 2)."""
    work, n = r.new_work(system, 1), len(forces)
    work.moment[0].time = t
    rows, values = np.zeros((2, n, len(system.bodies), 6)), np.zeros((n, 2))
    places = np.array([force.place for force in forces], dtype=np.int64)
    write_force_rows(system, state, places, work, rows, values)
    return *rows, values


def gains(function, t: float, q: float, rate: float) -> tuple[float, float]:
    """Return stiffness and damping of a user's force by central differences; 0 where it has none."""
    h, k = TINY * max(1.0, abs(q)), TINY * max(1.0, abs(rate))
    try:
        with np.errstate(all="ignore"):
            stiffness = (function(t, q - h, rate) - function(t, q + h, rate)) / (2.0 * h)
            damping = (function(t, q, rate - k) - function(t, q, rate + k)) / (2.0 * k)
        return float(stiffness), float(damping)
    except Exception:
        return 0.0, 0.0


def radius(method, modes: np.ndarray) -> np.ndarray:
    """Return the greatest |z| along each direction up to which |R(z)| <= 1, R(z) = 1 + z b.(1 - z A)^-1 1."""
    terms, power = [1.0], np.ones(len(method.b))
    for _ in method.b:
        terms.append(float(method.b @ power))
        power = method.A @ power
    sizes = np.linspace(0.1, 12.0, 120)
    z = sizes * (modes / np.abs(modes))[:, None]
    outside = np.abs(np.polyval(terms[::-1], z)) > 1.0 + 1e-6
    return sizes[np.argmax(outside, axis=1)]
