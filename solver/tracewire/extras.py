"""Packages that only some users need: each is named by the extra of tracewire that installs it."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from tracewire.errors import InstallationError, Location, Problem, TracewireError


def import_extra(
    module: str,
    extra: str,
    purpose: str,
    *,
    error: type[TracewireError] = InstallationError,
    place: Location = Location(),
    otherwise: str = "",
) -> Any:
    """The module of an optional package.

    `extra` is the extra of tracewire that installs it, `purpose` what it is needed for, `otherwise`
    what a user can do without it. Raises `error` where the package is not installed.
    """
    try:
        return import_module(module)
    except ImportError as missing:
        package = module.partition(".")[0]
        what = f"the package {package} is needed {purpose}, and it is not installed"
        hint = " ".join([f"Install it: pip install 'tracewire[{extra}]'.", otherwise]).rstrip()
        raise error([Problem(what, place, hint=hint)]) from missing
