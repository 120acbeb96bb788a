"""Benchmarks for asv, whose history shows what a change has cost: the problems of `carom.bench`."""
