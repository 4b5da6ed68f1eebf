"""The solvers that are timed: tracewire, and everything that it is compared with."""
