"""The compiled core: a run between Python's start and end, on plain arrays, by numba."""
