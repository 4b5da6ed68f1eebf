"""What arrays are called in signatures: their elements, and how many dimensions they have."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers of any dimensions."""
Vector = NDArray[np.float64]
"""Numbers of one dimension."""
Matrix = NDArray[np.float64]
"""Numbers of two dimensions."""
Cube = NDArray[np.float64]
"""Numbers of three dimensions."""
Complexes = NDArray[np.complex128]
"""Complex numbers of any dimensions."""
