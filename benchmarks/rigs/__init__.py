"""Records of a hundred and seven labs and machines, with effects that their diagrams lack.

An integrator that shares nothing with the product makes them. `python -m benchmarks rigs`.
"""
