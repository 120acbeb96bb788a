"""Standard problems and their timing, for ``carom bench`` and for the scripts in benchmarks/.

Each problem is a file in `problems`: the scene, its exact result, and the same scene for MuJoCo. `measure` has
the measurement of times, and `standard` the standard set of problems.
"""
