"""Files of points for `fk` and `ik`: rows of joints or of targets, converted in one go as columns of numbers.

A row that cannot be read or reached is reported with its line, the others are converted all the same. The languages'
notations come through `rpl.emulator.configuration`; nothing here knows one of them.
"""

from __future__ import annotations

import csv
import io
import math
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import click

from rpl.cli.output import print_json, print_text, say
from rpl.errors import SourceError, UsageError
from rpl.source import LARGEST_FILE, read_bytes
from rpl.tomlfile import FARTHEST

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray

points_option = click.option(
    "--points", metavar="FILE", help="A file of points instead of one (CSV, or a target a line); - is standard input."
)
# What is worked on at a time: memory stays the same for any length of file.
CHUNK = 4096
_LONGEST_CELL = 40  # what is quoted of one in a report
PREVIOUS = "previous"
_TEXT_COLUMNS = ("target", "pose")
_JOINT = re.compile(r"(?:j|a|joint_?|axis_?)(\d)$")
# The unit that joints and poses have anyway, behind a column's name: x_mm, x [mm], j1 (deg).
_UNIT = re.compile(r"(?<=\S)(?:\s*[\[(]\s*(?:mm|deg|°)\s*[\])]|[\s_](?:mm|deg))$")
_DECIMAL = re.compile(r"^([-+]?\d*),(\d+(?:[eE][-+]?\d+)?)$")
# A line that begins like a target of some language is no line of columns.
_TARGET = re.compile(r"\s*(?:[{\[]|p\s*\[|(?:DECL|TRANS|SET|CONFIG|C\d|P\d)\b)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the file: its number, and its cells in the order of the columns."""

    line: int
    cells: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """What the file holds. `columns` are the lower-case names of the cells, empty where the file has no header."""

    name: str
    columns: tuple[str, ...]
    rows: tuple[Row, ...]

    def places(self, wanted: Sequence[str]) -> list[int] | None:
        """Where these columns stand, None when one is missing."""
        if any(name not in self.columns for name in wanted):
            return None
        return [self.columns.index(name) for name in wanted]


@dataclass(slots=True)
class Outcome:
    """Rows written, and what was wrong with the others: line, code, words."""

    header: tuple[str, ...]
    rows: list[tuple[int, tuple[object, ...]]] = field(default_factory=list)
    errors: list[tuple[int, str, str]] = field(default_factory=list)
    external: list[int] = field(default_factory=list)  # lines whose external axes are left out


def read_table(path: str) -> Table:
    """The rows of a file, empty ones and those that begin with # left out. Raises UsageError when it cannot be read."""
    try:
        text = sys.stdin.read(LARGEST_FILE) if path == "-" else _text_of(path)
    except OSError as error:
        raise UsageError(f"--points: {path} cannot be read: {error.strerror}") from None
    except UnicodeError:
        raise UsageError(f"--points: {path} is no text in UTF-8") from None
    name = "<stdin>" if path == "-" else path
    if len(text) == LARGEST_FILE:
        raise UsageError(f"--points: {name} is larger than {LARGEST_FILE // 2**20} MiB")
    lines = [(number, line) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]
    lines = [(number, line) for number, line in lines if not line.lstrip().startswith("#")]
    if not lines:
        raise UsageError(f"--points: {name} has no points")
    if _TARGET.match(lines[0][1]):
        return Table(name, ("target",), tuple(Row(number, (line.strip(),)) for number, line in lines))
    separator = max(",;\t", key=lines[0][1].count)
    split = [Row(number, _cells(name, number, line, separator)) for number, line in lines]
    if any(_number(cell) is None and cell for cell in split[0].cells):
        columns = tuple(_UNIT.sub("", cell.lower()) for cell in split[0].cells)
        twice = next((one for one in columns if one and columns.count(one) > 1), None)
        if twice is not None:
            raise UsageError(f"--points: {name} has the column {twice} twice")
        return Table(name, columns, tuple(split[1:]))
    return Table(name, (), tuple(split))


def _text_of(path: str) -> str:
    return read_bytes(path, LARGEST_FILE).decode("utf-8-sig")


def _cells(name: str, number: int, line: str, separator: str) -> tuple[str, ...]:
    try:
        found = next(csv.reader(io.StringIO(line), delimiter=separator, skipinitialspace=True))
    except csv.Error as error:
        raise UsageError(f"--points: {name}:{number}: {error}") from None
    cells = tuple(cell.strip() for cell in found)
    # Where commas do not part the cells, they are decimal ones.
    return cells if separator == "," else tuple(_DECIMAL.sub(r"\1.\2", cell) for cell in cells)


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if abs(value) <= FARTHEST else None


def _short(cell: str) -> str:
    """The cell as it is quoted, and why a number is none."""
    try:
        far = abs(float(cell)) > FARTHEST
    except ValueError:
        far = False
    shown = repr(cell if len(cell) <= _LONGEST_CELL else f"{cell[:_LONGEST_CELL]}..")
    return f"{shown}, beyond {FARTHEST:,.0f}" if far else shown


def chunks(rows: Sequence[Row]) -> Iterator[Sequence[Row]]:
    for start in range(0, len(rows), CHUNK):
        yield rows[start : start + CHUNK]


def matrix_of(
    table: Table, rows: Sequence[Row], places: Sequence[int], outcome: Outcome, gaps: Sequence[int] = ()
) -> tuple[list[Row], FloatArray]:
    """The rows whose cells are numbers, and these as (k, c); a cell of `gaps` may be empty (NaN)."""
    import numpy as np

    good: list[Row] = []
    values: list[list[float]] = []
    width = len(table.columns) or len(table.rows[0].cells)
    for row in rows:
        if len(row.cells) > width and any(row.cells[width:]):
            outcome.errors.append((row.line, "bad-point", f"{len(row.cells)} cells, the first line has {width}"))
            continue
        found: list[float] = []
        for place in places:
            cell = row.cells[place] if place < len(row.cells) else ""
            number = math.nan if place in gaps and cell in ("", "-") else _number(cell)
            if number is None:
                name = table.columns[place] if table.columns else f"column {place + 1}"
                outcome.errors.append((row.line, "bad-point", f"{name} is {_short(cell)}, a number is needed"))
                break
            found.append(number)
        else:
            good.append(row)
            values.append(found)
    return good, np.array(values, dtype=np.float64).reshape(len(values), len(places))


def joint_places(table: Table, axes: int) -> list[int]:
    """Where the joints stand. Raises UsageError when the columns are not clear."""
    if not table.columns:
        if table.rows and len(table.rows[0].cells) != axes:
            raise UsageError(f"--points: {axes} joints are needed, {table.name} has {len(table.rows[0].cells)} columns")
        return list(range(axes))
    found = {int(match[1]): place for place, name in enumerate(table.columns) if (match := _JOINT.fullmatch(name))}
    missing = [f"j{axis}" for axis in range(1, axes + 1) if axis not in found]
    if missing:
        raise UsageError(f"--points: {table.name} has no column {', '.join(missing)}, it has {_listed(table)}")
    return [found[axis] for axis in range(1, axes + 1)]


def _listed(table: Table) -> str:
    return ", ".join(name or "one without a name" for name in table.columns)


@dataclass(frozen=True, slots=True, eq=False)
class Targets:
    """Rows with their poses (k, 4, 4) and flags (k, f), NaN for a flag not given."""

    rows: list[Row]
    poses: FloatArray
    flags: FloatArray


def targets_of(table: Table, rows: Sequence[Row], notation: Notation, outcome: Outcome) -> Targets:
    """The targets of some rows in a language's notation; the bad ones go to the outcome."""
    from rpl.emulator.configuration import BatchNotation

    text = next((table.columns.index(name) for name in _TEXT_COLUMNS if name in table.columns), None)
    numbers = isinstance(notation, BatchNotation) and table.places(notation.pose_fields) is not None
    if text is not None and not numbers:
        return _texts(rows, text, notation, outcome)
    if not isinstance(notation, BatchNotation):
        raise UsageError(f"--points: targets of {notation.name} are read from a column 'target' with their text")
    return _columns(table, rows, notation, outcome)


def _texts(rows: Sequence[Row], place: int, notation: Notation, outcome: Outcome) -> Targets:
    import numpy as np

    from rpl.emulator.configuration import ExternalAxes

    good: list[Row] = []
    poses, flags = [], []
    for row in rows:
        target = row.cells[place] if place < len(row.cells) else ""
        try:
            pose, given = notation.parse_pose(target)
        except SourceError as error:
            outcome.errors.append((row.line, "bad-point", str(error)))
            continue
        if isinstance(notation, ExternalAxes) and notation.external_axes(target):
            outcome.external.append(row.line)
        good.append(row)
        poses.append(pose)
        flags.append([math.nan if given.get(name) is None else float(given[name] or 0) for name in notation.fields])
    shape = (len(good), len(notation.fields))
    return Targets(good, np.array(poses).reshape(-1, 4, 4), np.array(flags, dtype=np.float64).reshape(shape))


def _columns(table: Table, rows: Sequence[Row], notation: Notation, outcome: Outcome) -> Targets:
    import numpy as np

    from rpl.emulator.configuration import BatchNotation, WordedFlags

    assert isinstance(notation, BatchNotation)
    pose, width = notation.pose_fields, len(notation.pose_fields)
    if table.columns:
        places = table.places(pose)
        if places is None:
            needed = f"{table.name} needs the columns {', '.join(pose)} (or target, a text)"
            raise UsageError(f"--points: {needed}, it has {_listed(table)}")
        present = [name for name in notation.fields if name in table.columns]
    else:
        count = len(table.rows[0].cells) if table.rows else width
        if count not in (width, width + len(notation.fields)):
            wanted = ", ".join((*pose, *notation.fields))
            raise UsageError(f"--points: {table.name} has {count} columns; without a header these are {wanted}")
        places, present = list(range(width)), list(notation.fields) if count > width else []
    flag_places = [table.columns.index(name) if table.columns else width + i for i, name in enumerate(present)]
    good, values = matrix_of(table, rows, [*places, *flag_places], outcome, flag_places)
    given = values[:, width:]
    broken = ~(np.isnan(given) | (given == np.round(given)))
    for row, bad in zip(good, broken.tolist(), strict=True):
        if any(bad):
            words = f"{present[bad.index(True)]} is a flag, a whole number is needed"
            outcome.errors.append((row.line, "bad-point", words))
    good = [row for row, bad in zip(good, broken.any(axis=1), strict=True) if not bad]
    values = values[~broken.any(axis=1)]
    flags = np.full((len(good), len(notation.fields)), np.nan)
    for place, name in enumerate(present):
        flags[:, notation.fields.index(name)] = values[:, width + place]
    if "config" in table.columns and isinstance(notation, WordedFlags):
        place = table.columns.index("config")
        for one, row in enumerate(good):
            worded = notation.parse_flags(row.cells[place] if place < len(row.cells) else "")
            for name, flag in (worded or {}).items():
                if flag is not None:
                    flags[one, notation.fields.index(name)] = flag
    poses = notation.poses_of(values[:, :width])
    whole = np.asarray(np.isfinite(poses).all(axis=(1, 2)))
    for row, fine in zip(good, whole, strict=True):
        if not fine:
            outcome.errors.append((row.line, "bad-point", "the orientation is none"))
    return Targets([row for row, fine in zip(good, whole, strict=True) if fine], poses[whole], flags[whole])


def solved(
    model: RobotModel, notation: Notation, targets: Targets, near: FloatArray | None, follow: bool, outcome: Outcome
) -> tuple[list[Row], FloatArray, FloatArray, FloatArray | None]:
    """Rows that the arm reaches as the flags ask, their flange poses (k, 4, 4) and joints (k, n), and the last joints.

    `follow`: each target is reached from the one before. A row that is not reached goes to the outcome with the reason.
    """
    import numpy as np

    from rpl.emulator.configuration import BatchNotation
    from rpl.emulator.postures import out_of_reach

    if isinstance(notation, BatchNotation) and not follow:
        joints = notation.select_all(model, targets.poses, targets.flags, near).joints
    else:
        joints = np.full((len(targets.rows), model.axes), np.nan)
    for place, row in enumerate(targets.rows):
        if not np.isnan(joints[place, 0]):
            continue
        given = {name: _flag(value) for name, value in zip(notation.fields, targets.flags[place], strict=True)}
        selection = notation.select(model, targets.poses[place], given, near)
        if selection.joints is None:
            reason = out_of_reach(model, targets.poses[place]) or selection.reason
            outcome.errors.append((row.line, "unreachable-point", reason))
            continue
        joints[place] = selection.joints
        near = selection.joints if follow else near
    reached = ~np.isnan(joints[:, 0])
    rows = [row for row, fine in zip(targets.rows, reached, strict=True) if fine]
    return rows, targets.poses[reached], joints[reached], near


def _flag(value: float) -> int | None:
    return None if math.isnan(value) else int(value)


def target_columns(notation: Notation) -> tuple[str, ...]:
    """Names of what `target_cells` gives."""
    from rpl.emulator.configuration import BatchNotation

    pose = notation.pose_fields if isinstance(notation, BatchNotation) else ()
    return (*pose, *notation.fields, "target")


def target_cells(
    model: RobotModel, notation: Notation, poses: FloatArray, joints: FloatArray
) -> list[tuple[object, ...]]:
    """For each pose (k, 4, 4) with joints (k, n): the numbers of the language, its flags, its text."""
    from rpl.emulator.configuration import BatchNotation

    texts = [notation.format_pose(model, pose, one) for pose, one in zip(poses, joints, strict=True)]
    if not isinstance(notation, BatchNotation):
        return [(*notation.encode(model, one).values(), text) for one, text in zip(joints, texts, strict=True)]
    values, flags = notation.values_of(poses).tolist(), notation.encode_all(model, joints).tolist()
    return [(*map(_rounded, row), *flag, text) for row, flag, text in zip(values, flags, texts, strict=True)]


def joint_cells(joints: FloatArray) -> list[tuple[object, ...]]:
    return [tuple(map(_rounded, row)) for row in joints.tolist()]


def _rounded(value: float) -> float:
    return round(value, 9) + 0.0


def kept_columns(table: Table, made: Sequence[str]) -> list[int]:
    """Columns of the file that are carried along: names and remarks, whatever was not made anew."""
    used = {*made, "line", "outside_limits", *_TEXT_COLUMNS}
    return [place for place, name in enumerate(table.columns) if name not in used and not _JOINT.fullmatch(name)]


def report(table: Table, outcome: Outcome, facts: dict[str, object], as_json: bool) -> int:
    """Write the rows, in the order of the file, and the errors; the exit status."""
    outcome.errors.sort()
    if as_json:
        points = [dict(zip(outcome.header, (line, *cells), strict=True)) for line, cells in outcome.rows]
        errors = [{"line": line, "code": code, "message": words} for line, code, words in outcome.errors]
        document = {**facts, "points": points, "errors": errors, "external_axes_left_out": outcome.external}
        print_json(document)
    else:
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(outcome.header)
        writer.writerows((line, *map(_cell, cells)) for line, cells in outcome.rows)
        print_text(out.getvalue())
    for line, code, words in outcome.errors:
        say(f"{table.name}:{line}:1: error {code} {' '.join(words.splitlines())}", err=True)
    if outcome.external:
        many = f" of {len(outcome.external)} targets" if len(outcome.external) > 1 else ""
        say(
            f"{table.name}:{outcome.external[0]}:1: warning external-axes the external axes{many} are left out",
            err=True,
        )
    return 1 if outcome.errors else 0


def _cell(value: object) -> object:
    if isinstance(value, float):
        return int(value) if value.is_integer() else f"{value:.9f}".rstrip("0")
    return value
