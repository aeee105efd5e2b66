"""The rows as a file: CSV or Parquet, the same bytes for the same rows."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

from rpl.batch.rows import NUMBERS, Row
from rpl.errors import UsageError

_PARQUET = ".parquet"
SUFFIXES = (".csv", _PARQUET)


def can_be_made(path: Path) -> None:
    """Raises UsageError for a file of another kind, or where the package for it is missing."""
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise UsageError(f"{path}: results are written as {' or '.join(SUFFIXES)}")
    if suffix == _PARQUET and find_spec("pyarrow") is None:
        raise UsageError(f"{path} needs the package pyarrow: pip install 'robot-rpl[parquet]' (CSV needs none)")


def table(path: Path, rows: Sequence[Row], columns: Sequence[str]) -> bytes:
    """The bytes of the file of that name."""
    return _parquet(rows, columns) if path.suffix.lower() == _PARQUET else _csv(rows, columns)


def _csv(rows: Sequence[Row], columns: Sequence[str]) -> bytes:
    """UTF-8 with a heading; what a row has no value for is empty."""
    text = io.StringIO()
    out = csv.writer(text, lineterminator="\n")
    out.writerow(columns)
    out.writerows(list(row.cells(columns).values()) for row in rows)
    return text.getvalue().encode("utf-8", "backslashreplace")


def _parquet(rows: Sequence[Row], columns: Sequence[str]) -> bytes:
    import pyarrow
    from pyarrow import parquet

    types = {"int": pyarrow.int64(), "float": pyarrow.float64()}
    schema = pyarrow.schema([(name, types.get(NUMBERS.get(name, ""), pyarrow.string())) for name in columns])
    values = [{name: _text(value) for name, value in row.cells(columns).items()} for row in rows]
    out = io.BytesIO()
    parquet.write_table(pyarrow.Table.from_pylist(values, schema), out)
    return out.getvalue()


def _text(value: object) -> object:
    """A name of a file may hold signs that UTF-8 has not."""
    return value.encode("utf-8", "backslashreplace").decode("utf-8") if isinstance(value, str) else value
