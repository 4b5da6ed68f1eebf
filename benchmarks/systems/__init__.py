"""The systems of the benchmarks, written for peers that know neither diagrams nor events."""
