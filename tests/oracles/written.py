"""Diagrams with effects added, in their text and in their objects."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from diagram.alike import said
from tracewire.diagram import Diagram, apply, patch
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.changes import changes_of


def with_effects(
    diagram: Diagram, chosen: Sequence[tuple[Candidate, Mapping[str, float]]]
) -> Diagram:
    """The diagram with effects in its text; that with them in its objects says the same."""
    changes = changes_of(diagram, chosen)
    written = patch(diagram, changes)
    assert said(apply(diagram, changes)) == said(written)
    return written
