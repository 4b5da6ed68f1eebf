"""A generated diagram of many blocks, and the same right-hand side in numpy and scipy.

Cells of five blocks: an integrator x, a gain that damps it, two gains from other cells, and the sum
of the three. In every fifth cell the second is a switch that passes the first on while the cell it
comes from is positive: continuous, so that nothing slides. A sine drives the first cell.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from benchmarks.systems.hybrid import Vector

CELL = 5
SWITCH_EVERY = 5


@dataclass(frozen=True, eq=False)
class Network:
    """The numbers of a network of `blocks` blocks."""

    blocks: int
    damping: Vector
    near: Vector
    far: Vector
    to: np.ndarray  # which cell the far gain reads

    @property
    def cells(self) -> int:
        """How many integrators there are."""
        return len(self.damping)

    @property
    def text(self) -> str:
        """The diagram in YAML."""
        lines = ["title: Network", "span: [0, 5]", "record: [x0]", "blocks:"]
        lines.append("  drive: {type: sine, amplitude: 1, omega: 2}")
        lines.append("  zero: {type: constant, value: 0}")
        for i in range(self.cells):
            d, n, f = (repr(float(v[i])) for v in (self.damping, self.near, self.far))
            switched = i % SWITCH_EVERY == 0
            of = f"d{i}, n{i}, f{i}" + (", drive" if i == 0 else "")
            lines += [
                f"  x{i}: {{type: integrator, of: s{i}, start: {(i % 7 - 2.5) / 10}}}",
                f"  d{i}: {{type: gain, of: x{i}, k: -{d}}}",
                f"  n{i}: {{type: gain, of: x{self.to[i] if switched else i - 1}, k: {n}}}",
                f"  f{i}: {{type: switch, control: x{self.to[i]}, above: n{i}, below: zero}}"
                if switched
                else f"  f{i}: {{type: gain, of: x{self.to[i]}, k: {f}}}",
                f"  s{i}: {{type: sum, of: [{of}]}}",
            ]
        return "\n".join(lines) + "\n"

    def start(self) -> Vector:
        """The states at the start, x0 first."""
        return (np.arange(self.cells) % 7 - 2.5) / 10

    def rates(self) -> NumpyRates:
        """The same right-hand side as numpy and scipy.sparse write it best."""
        n = np.arange(self.cells)
        plain = n % SWITCH_EVERY != 0
        rows = np.concatenate([n, n, n[plain]])
        columns = np.concatenate([n, np.where(plain, n - 1, self.to), self.to[plain]])
        values = np.concatenate([-self.damping, self.near, self.far[plain]])
        shape = (self.cells, self.cells)
        return NumpyRates(csr_array((values, (rows, columns)), shape=shape), self, n[~plain])


class NumpyRates:
    """x' = A x + switched + drive."""

    def __init__(self, matrix: csr_array, network: Network, switched: np.ndarray) -> None:
        self.matrix, self.switched = matrix, switched
        self.control = network.to[switched]
        self.near = network.near[switched]

    def __call__(self, t: float, x: Vector) -> Vector:
        out: Vector = self.matrix @ x
        control = x[self.control]
        out[self.switched] += np.where(control >= 0, self.near * control, 0.0)
        out[0] += np.sin(2 * t)
        return out


def network(blocks: int) -> Network:
    """The network of that many blocks; the same each time."""
    cells = blocks // CELL
    random = np.random.default_rng(blocks)
    return Network(
        blocks,
        damping=random.uniform(0.5, 1.5, cells),
        near=random.uniform(-0.4, 0.4, cells),
        far=random.uniform(-0.4, 0.4, cells),
        to=random.integers(0, cells, cells),
    )
