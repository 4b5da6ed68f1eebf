"""`tracewire analyse`: what a diagram does beyond one run, one kind of analysis each."""

from __future__ import annotations

import typer

from tracewire.cli.analyse_linear import linearise, steady
from tracewire.cli.analyse_orbits import chart, floquet, orbit
from tracewire.cli.analyse_planes import polar, portrait
from tracewire.cli.analyse_sections import bifurcation, lyapunov, section
from tracewire.cli.analyse_signals import growth, invariants, scalogram, spectrum
from tracewire.cli.multi_value import OneValueCommand
from tracewire.cli.records import with_fields
from tracewire.cli.verb_group import VerbGroup

analyse = typer.Typer(
    help="Analyse a diagram: steady states, orbits and their stability, exponents, spectra.",
    cls=VerbGroup,
    rich_markup_mode=None,
)

# One line registers a kind. A kind imports what is slow to import inside its function.
_motion = (portrait, polar, spectrum, scalogram, growth, invariants)
_stability = (steady, linearise, orbit, floquet, chart)
_chaos = (section, bifurcation, lyapunov)
for _kind in (*_motion, *_stability, *_chaos):
    analyse.command(cls=OneValueCommand)(with_fields(_kind))
