"""What a flexible body may not do: bend by more than a tenth of its size, or spin near its first frequency."""

from __future__ import annotations

import numpy as np

from carom.flexible.grid import box_of

LARGE_DEFLECTION = 0.1  # part of the size of a body
LARGE_SPIN = 0.1  # part of its first frequency


def remarks(run, state, t: np.ndarray) -> list[str]:
    """Return sentences about deflections and spins at saved times for which modes are no longer right.

    Displacements Phi eta are small against the body, and what the spin w adds to the stiffness, of the order
    (w/w_1)^2 for the first frequency w_1, is left out.
    """
    system, found = run.everything.system, []
    flexible = system.flexible
    for b in np.flatnonzero(system.bodies["modes"]).tolist():
        body, one = run.scene.bodies[b], flexible.bodies[int(system.bodies["flexible"][b]) - 1]
        count = int(system.bodies["modes"][b])
        most = flexible.most[int(one["first_most"]) :][: 3 * count]
        bound = np.abs(state["x"][:, b + 1 : b + 1 + count]).reshape(len(t), -1) @ most
        k = int(np.argmax(bound))
        if bound[k] > LARGE_DEFLECTION * body.shape.size:
            corners = body.modes.shapes(places(body.shape))
            eta = state["x"][k, b + 1 : b + 1 + count].ravel()[: len(body.modes)] * np.sqrt(
                body.mass
            )
            bent = float(np.linalg.norm(corners @ eta, axis=1).max())
            if bent > LARGE_DEFLECTION * body.shape.size:
                found.append(
                    f"{body.name!r} is bent by {bent:.2g} m at t = {t[k]:.6g} s, more than a tenth of its "
                    "size: modes are right for small deflections only"
                )
        spin = np.linalg.norm(state["w"][:, b], axis=1)
        first = 2.0 * np.pi * float(np.min(body.modes.frequencies))
        k = int(np.argmax(spin))
        if spin[k] > LARGE_SPIN * first:
            found.append(
                f"{body.name!r} turns with {spin[k]:.3g} rad/s at t = {t[k]:.6g} s, more than a tenth of its "
                f"first frequency ({first:.3g} rad/s): forces by the spin, which modes leave out, bend it"
            )
    return found


def places(shape) -> np.ndarray:
    """Return the corners (8, 3) of the box around a shape."""
    low, high = box_of(shape)
    signs = np.array(np.meshgrid(*3 * [(0.0, 1.0)])).reshape(3, -1).T
    return low + signs * (high - low)
