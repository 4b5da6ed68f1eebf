"""Single steps of the integration methods: each takes a step and knows what lies inside it."""

from tracewire.solve.methods.dormand_prince import DormandPrince
from tracewire.solve.methods.rosenbrock import Rosenbrock
from tracewire.solve.methods.step import Field, Method, Step

__all__ = ["DormandPrince", "Field", "Method", "Rosenbrock", "Step"]
