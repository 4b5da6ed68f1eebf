"""Records of eighty labs and machines, with effects hidden that their diagrams do not declare.

An integrator that shares nothing with the product makes them. `python -m benchmarks rigs`.
"""
