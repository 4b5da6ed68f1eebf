"""Random diagrams of all blocks of the library, with subsystems, loops, events and odd names."""

from __future__ import annotations

import random

from tracewire.library import Block, load_library

LIBRARY = load_library()
TYPES = sorted(LIBRARY)
COMMON = ("integrator", "gain", "sum", "sum", "product", "sin", "viscous", "expression")

GIVEN = {("", "seed"): 3, ("limited_integrator", "low"): -0.5}
"""Numbers of parameters that cannot be 0.5, by block, or for all blocks, and name."""


def text_of(seed: int) -> str:
    """The text of a diagram of 1 to 30 blocks, wired at random; it can always be read."""
    rng = random.Random(seed)
    inside = [f"part{n}" for n in range(rng.choice((0, 0, 1, 2)))]
    lines = ["title: a < b & 'c'", "inputs: [force, drive]", "blocks:"]
    lines += _blocks(rng, rng.randint(1, 30), ["force", "drive"], inside)
    if inside:
        lines.append("subsystems:")
    for name in inside:
        lines += [f"  {name}:", "    inputs: [a, b]", "    blocks:"]
        lines += [f"    {line}" for line in _blocks(rng, rng.randint(1, 6), ["a", "b"], [])]
        sign = rng.choice(("", "-"))
        lines.append(f"    outputs: {{y: {sign}{_known(lines)}, z: a}}")
    return "\n".join(lines) + "\n"


def _known(lines: list[str]) -> str:
    """The last block that was written, with its output."""
    name, _, rest = lines[-1].strip().partition(":")
    return _outputs(name, LIBRARY[rest.split("type: ")[1].split(",")[0].rstrip("}")])[0]


def _outputs(name: str, block: Block) -> list[str]:
    if len(block.outputs) == 1:
        return [name]
    return [f"{name}.{output.name}" for output in block.outputs]


def _blocks(rng: random.Random, count: int, inputs: list[str], parts: list[str]) -> list[str]:
    kinds = [
        rng.choice(parts) if parts and rng.random() < 0.2 else rng.choice(COMMON)
        if rng.random() < 0.7 else rng.choice(TYPES)
        for _ in range(count)
    ]  # fmt: skip
    names = [f"b{n}" + "_long_name" * rng.choice((0, 0, 0, 3)) for n in range(count)]
    signals = list(inputs)
    for name, kind in zip(names, kinds, strict=True):
        signals += [f"{name}.y", f"{name}.z"] if kind in parts else _outputs(name, LIBRARY[kind])
    lines = []
    for name, kind in zip(names, kinds, strict=True):
        fields = [f"type: {kind}"]
        if kind in parts:
            fields += [f"{port}: {rng.choice(signals)}" for port in ("a", "b")]
        else:
            fields += _fields(rng, LIBRARY[kind], signals)
        lines.append(f"  {name}: {{{', '.join(fields)}}}")
    return lines


def _fields(rng: random.Random, block: Block, signals: list[str]) -> list[str]:
    fields = []
    for port in block.inputs:
        if port.many:
            wires = [rng.choice(("", "-")) + rng.choice(signals) for _ in range(rng.randint(1, 6))]
            fields.append(f"{port.name}: [{', '.join(wires)}]")
        else:
            fields.append(f"{port.name}: {rng.choice(signals)}")
    for parameter in block.parameters:
        if parameter.kind == "points":
            fields.append(f"{parameter.name}: [[0, 0], [1, 2]]")
        elif parameter.kind == "formula":
            read = rng.sample(signals, min(len(signals), rng.randint(0, 5)))
            fields.append(f"{parameter.name}: {' + '.join(['1', *read])}")
        elif parameter.default is None:
            given = GIVEN.get((block.name, parameter.name)) or GIVEN.get(("", parameter.name))
            fields.append(f"{parameter.name}: {given or 0.5}")
    return fields
