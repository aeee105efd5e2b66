"""The map of numbered data: which number of a bank stands for which name of the source, as a small CSV file.

It is written beside the output and read back by a later translation, so that numbers stay when the source changes.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from rpl.errors import UsageError
from rpl.source import read_bytes

FILE_NAME = "registers.csv"
# No bank has more than a few thousand.
_NUMBER = re.compile(r"[0-9]{1,9}")
_HEAD = ("bank", "number", "name", "type")

Names = Mapping[tuple[str, int], str]


def registers_text(names: Names, types: Names) -> str:
    """The rows in order of bank and number."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(_HEAD)
    for bank, number in sorted(names):
        writer.writerow((bank, number, names[bank, number], types.get((bank, number), "")))
    return out.getvalue()


def parse_registers(text: str, path: str = "registers") -> dict[tuple[str, int], str]:
    """The names by bank and number. Raises UsageError for what is no such file."""
    reader = csv.reader(io.StringIO(text))
    try:
        rows = list(reader)
    except csv.Error as error:
        raise UsageError(f"{path}:{reader.line_num}: {error}") from None
    if not rows or tuple(cell.strip().lower() for cell in rows[0][:3]) != _HEAD[:3]:
        raise UsageError(f"{path}: the first line of a map of registers is {','.join(_HEAD)}")
    return dict(_row(number, row, path) for number, row in _numbered(rows[1:]))


def _numbered(rows: Iterable[list[str]]) -> list[tuple[int, list[str]]]:
    return [(number, row) for number, row in enumerate(rows, 2) if any(cell.strip() for cell in row)]


def _row(number: int, row: list[str], path: str) -> tuple[tuple[str, int], str]:
    if len(row) < 3 or not _NUMBER.fullmatch(row[1].strip()) or not row[0].strip() or not row[2].strip():
        raise UsageError(f"{path}:{number}: a line has a bank, a whole number and a name")
    return (row[0].strip(), int(row[1])), row[2].strip()


def read_registers(path: Path) -> dict[tuple[str, int], str]:
    """The map in a file. Raises UsageError when it cannot be read."""
    try:
        text = read_bytes(path).decode("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text in UTF-8"
        raise UsageError(f"{path}: the map of registers cannot be read: {reason}") from None
    return parse_registers(text, str(path))
