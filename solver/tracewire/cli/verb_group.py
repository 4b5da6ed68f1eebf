"""The help of several verbs: each with its first paragraph."""

from __future__ import annotations

from typing import Any

from typer.core import TyperGroup


class VerbGroup(TyperGroup):
    """A group of verbs whose help gives the whole first paragraph of each, where typer cuts it; a
    group without a verb shows its help.

    Typer's other help, with frames, would do that too, but takes 0.1 s to import.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """The arguments parsed, those of `--help` where there are none."""
        return super().parse_args(ctx, args or ["--help"])

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the verbs in their order."""
        verbs = [(name, self.get_command(ctx, name)) for name in self.list_commands(ctx)]
        with formatter.section("Commands"):
            formatter.write_dl([(name, _first_paragraph(verb)) for name, verb in verbs])


def _first_paragraph(verb: Any) -> str:
    return " ".join((verb.help or "").strip().partition("\n\n")[0].split())
