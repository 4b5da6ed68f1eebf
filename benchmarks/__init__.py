"""Timings of tracewire beside other solvers, at equal accuracy: `python -m benchmarks`."""
