"""The core: a run between Python's start and end, on plain arrays; compiled before it is used."""
