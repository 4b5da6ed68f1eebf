"""What a rig hides, and what else is right to answer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

Labels = tuple[str, ...]
"""Effects, each as `effect @ place`."""


@dataclass(frozen=True)
class Truth:
    """What a rig hides, and what is right to answer.

    `hidden` are the effects, none where no block of the library is the law. `sizes` has their
    parameters in the units of the diagram (SI), as `effect.parameter`, and `words` says the rest.
    `equal` gives for a hidden effect others that are the same on these data. `answers` are sets of
    effects that are right instead of the hidden ones, `half` single ones that are a part of the
    truth. `law` is a place and the variable on which a missing force there depends, where the
    verdict `unexplained` that says so is right. `clean`: no effect at all is right. `bounds` are
    the least and the most of a parameter, by `effect @ place` and its name, without which an effect
    does not count as the one that is meant. `besides` are effects that are in the record, too, but
    so small that none has to be named: such a one is no stranger beside a hidden effect.
    """

    title: str
    hidden: Labels = ()
    sizes: Mapping[str, float] = field(default_factory=dict)
    words: str = ""
    equal: Mapping[str, Labels] = field(default_factory=dict)
    answers: tuple[Labels, ...] = ()
    half: Labels = ()
    law: tuple[str, str] | None = None
    clean: bool = False
    bounds: Mapping[tuple[str, str], tuple[float, float]] = field(default_factory=dict)
    besides: Labels = ()

    def told(self) -> str:
        """What is hidden, with its sizes."""
        sizes = ", ".join(f"{name} {value:.4g}" for name, value in self.sizes.items())
        hidden = " + ".join(self.hidden) or "no block of the library"
        return f"{hidden} ({'; '.join(filter(None, (sizes, self.words)))})"
