"""Pure mathematics: rotations, autoparallels, transport, connection, splines.

Kernels for the step loop: `rotation`, `tangent` (one rotation, in scalars) and `autoparallel` (all
bodies, writing into arrays). NumPy, free of Numba, for scenes, results and the mathematics:
`quaternion`, `differential`, `spline`, `inertia`, `connection`; and `manifold`, an object that checks its
arguments and calls the kernels of `autoparallel`.
"""
