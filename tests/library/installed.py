"""Libraries that are installed: a folder on the path of Python with the files of distributions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

HEAD = "from tracewire.library import Block, Effect, Input, Output, Parameter\n"
MAGNET = HEAD + (
    'magnet = Block("magnet", "Pulls iron.", inputs=(Input("x"),),'
    ' parameters=(Parameter("k"),), outputs=(Output("force", "-k/x**2"),))\n'
)
RIG = """subsystems:
  pulled:
    title: A body of iron before a magnet
    inputs: [x]
    outputs: {force: pull}
    parameters: {k: 2}
    blocks: {pull: {type: mylab.magnet, x: x, k: k}}
"""


def install(
    folder: Path,
    files: Mapping[str, str],
    name: str = "mylab",
    version: str = "1.2",
    distribution: str = "mylab-blocks",
    module: str = "",
) -> Path:
    """Write what pip writes for a distribution with a library; returns the folder of its package.

    `module` is what its entry point names, where that is not the package.
    """
    package = distribution.replace("-", "_")
    information = folder / f"{package}-{version}.dist-info"
    information.mkdir(parents=True)
    said = f"Metadata-Version: 2.1\nName: {distribution}\nVersion: {version}\n"
    (information / "METADATA").write_text(said, encoding="utf-8")
    points = f"[tracewire.blocks]\n{name} = {module or package}\n"
    (information / "entry_points.txt").write_text(points, encoding="utf-8")
    for file, text in files.items():
        target = folder / package / file
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    return folder / package
