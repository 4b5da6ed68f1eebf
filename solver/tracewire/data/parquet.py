"""The columns of a Parquet table; pyarrow reads them."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.data.limits import FILE
from tracewire.data.quiet import Attempts
from tracewire.data.vectors import Column, Group
from tracewire.errors import DataError, Location
from tracewire.extras import import_extra

UNITS = (b"units", b"unit")


def groups_of_parquet(content: bytes, path: Path, place: Location) -> list[Group]:
    """The table as one group. A unit is that of a name such as `theta [deg]`, or of the metadata
    `units` or `unit` of a column."""
    purpose = f"to read '{path}', a Parquet table"
    pyarrow, parquet = (
        import_extra(
            module, "parquet", purpose, error=DataError, place=place, otherwise="Or save it as CSV."
        )
        for module in ("pyarrow", "pyarrow.parquet")
    )

    attempt = Attempts("pyarrow", "a Parquet table", path, place)
    file = attempt(lambda: parquet.ParquetFile(pyarrow.BufferReader(content)))
    schema, metadata = file.schema_arrow, file.metadata
    groups = [metadata.row_group(n) for n in range(metadata.num_row_groups)]
    if sum(group.total_byte_size for group in groups) > FILE.most_unpacked:
        what = f"'{path}' holds more than {FILE.most_unpacked / 1e9:g} GB"
        raise DataError.one(what, place, hint="Split it, or keep every n-th row.")

    def read(n: int) -> NDArray[Any]:
        column = file.read(columns=[schema.field(n).name]).column(0)
        if pyarrow.types.is_decimal(column.type):
            column = column.cast(pyarrow.float64())
        return np.asarray(column.to_numpy())

    columns = []
    for n, field in enumerate(schema):
        told = field.metadata or {}
        unit = next((told[key].decode("utf-8", "replace") for key in UNITS if key in told), "")
        in_utc = bool(getattr(field.type, "tz", None))
        columns.append(Column(field.name, partial(attempt, partial(read, n)), unit, in_utc))
    return [Group("", tuple(columns))]
