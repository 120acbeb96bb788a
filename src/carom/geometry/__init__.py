"""Pure mathematics: rotations, the differential of their exponential, splines of states.

Kernels for the step loop: `rotation` (one rotation, in scalars). NumPy, free of Numba, for scenes and results:
`quaternion`, `attitude`, `frames`, `differential`, `spline`.
"""


def __dir__() -> list[str]:
    return ["quaternion", "spline"]
