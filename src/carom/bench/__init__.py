"""Standard problems and how they are timed: for ``carom bench``, and for the scripts in benchmarks/.

Each problem is a file in `problems`: what moves, what its exact answer is, and the same for MuJoCo. How a
time is taken is in `measure`, which problems make the standard set in `standard`.
"""
