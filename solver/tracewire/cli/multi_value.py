"""Options that take one value, and those that take several: `--train a.csv b.csv`."""

from __future__ import annotations

from typing import Any

from typer.core import TyperCommand, TyperOption

DIAGRAMS = (".yaml", ".yml")


class OneValueCommand(TyperCommand):
    """A command that refuses an option that stands twice where one value counts."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """The arguments parsed; what stands twice is looked for before."""
        _, _, order = self.make_parser(ctx).parse_args(list(args))
        single = [o for o in order if isinstance(o, TyperOption) and not (o.multiple or o.is_flag)]
        for option in single:
            if single.count(option) > 1:
                name = option.opts[0]
                ctx.fail(f"{name} stands twice, and one value counts. Leave one out")
        return super().parse_args(ctx, args)


class MultiValueCommand(OneValueCommand):
    """A command whose repeatable options take all values up to the next option.

    The parser behind typer knows a fixed number of values only, so the name of the option is set
    before each of them. A diagram file ends the values, so that it may stand behind them.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """The arguments parsed with an option before each of its values."""
        names = {
            name
            for option in self.params
            if isinstance(option, TyperOption) and option.multiple
            for name in option.opts
        }
        spread: list[str] = []
        option, values = "", 0
        for n, arg in enumerate(args):
            if arg == "--":
                spread += args[n:]
                break
            if arg.startswith("-") and len(arg) > 1:
                option, values = (arg if arg in names else ""), 0
            elif option and arg.lower().endswith(DIAGRAMS) and values:
                option = ""
            elif option:
                if values:
                    spread.append(option)
                values += 1
            spread.append(arg)
        return super().parse_args(ctx, spread)
