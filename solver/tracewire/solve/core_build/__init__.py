"""How the library of the core is made of its Python: see `__main__`."""
