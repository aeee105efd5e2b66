"""The map of a translation: what each name of the source is called in the result, and which numbers were given.

It is a small TOML file beside the output. People edit it, and a later translation that is given it keeps every name and
number although the source has changed. What the source has no more stays in it, so that it comes back as it was.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rpl.errors import UsageError
from rpl.passes.capabilities import Storage
from rpl.source import read_bytes
from rpl.tomlfile import TomlError, read_toml

FILE_NAME = "map.toml"
_KEYS = ("target", "names", "numbers", "taught")
_HEAD = """# What this translation has named and numbered. `rpl translate --map` of this file keeps all of it.
# Write another name or number to choose it; delete a line to have it chosen anew.
"""
_TAUGHT = "# Taught data as written, so that --keep-taught sees what was touched up since. Not to be edited."
_SHOWN = 60  # signs of a key in a complaint
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_NUMBER = re.compile(r"0|[1-9][0-9]{0,8}")  # no bank has more than a few thousand

Numbers = Mapping[tuple[str, int], str]


@dataclass(frozen=True, slots=True)
class NameMap:
    """`names`: of the source -> in the result. `numbers`: (bank, number) -> name in the source; banks are those of the
    target (`R`), of its programs (`main.P`) and kinds of signals (`digital_out`). `types` of what has the numbers, for
    readers. `target`: the language of the result. `path` and `text` of the file, for complaints. `taught`: values of
    taught data as they were written, by what tells them apart, where they are to be kept (proof.teaching.floor)."""

    target: str = ""
    names: Mapping[str, str] = field(default_factory=dict)
    numbers: Numbers = field(default_factory=dict)
    types: Numbers = field(default_factory=dict)
    path: str = ""
    text: str = ""
    taught: Mapping[str, str] = field(default_factory=dict)

    def complaint(self, table: str, key: str, reason: str) -> UsageError:
        """What is wrong with a key of the file, and where."""
        return _complaint(self.path, self.text, table, key, reason)

    def behind(self, earlier: NameMap) -> NameMap:
        """This map with what an earlier one says of names that the program has no more."""
        numbers: dict[tuple[str, int], str] = {}
        first: set[tuple[str, str]] = set()
        for (bank, number), name in sorted(self.numbers.items()):
            if (bank, name) not in first:  # a second one of the name is found by its place again
                first.add((bank, name))
                numbers[bank, number] = name
        here = {(bank, name.lower()) for (bank, _), name in self.numbers.items()}
        gone = {
            (bank, number): name
            for (bank, number), name in earlier.numbers.items()
            if (bank, number) not in self.numbers and (bank, name.lower()) not in here
        }
        written = {name.lower() for name in (*self.names, *self.names.values())}
        old = {
            name: new
            for name, new in earlier.names.items()
            if name.lower() not in written and new.lower() not in written
        }
        return NameMap(self.target, {**self.names, **old}, {**numbers, **gone}, self.types, self.path)


def map_text(given: NameMap) -> str:
    """The file: names in their order, numbers in the order of bank and number."""
    lines = [f"{_HEAD}target = {_quoted(given.target)}"]
    if given.names:
        names = sorted(given.names.items(), key=lambda one: (one[0].lower(), one[0]))
        lines += ["", "[names]", *(f"{_key(old)} = {_quoted(new)}" for old, new in names)]
    bank = None
    for at in sorted(given.numbers):
        if at[0] != bank:
            bank = at[0]
            lines += ["", f"[numbers.{_key(bank)}]"]
        type = given.types.get(at, "")
        lines.append(f"{at[1]} = {_quoted(given.numbers[at])}" + (f"  # {type}" if type else ""))
    if given.taught:
        lines += ["", _TAUGHT, "[taught]"]
        lines += [f"{_key(name)} = {_quoted(value)}" for name, value in sorted(given.taught.items())]
    return "\n".join(lines) + "\n"


def parse_map(text: str, path: str = "map") -> NameMap:
    """Raises UsageError with file, line and key for what is no such map."""
    try:
        table = read_toml(text)
    except TomlError as error:
        raise UsageError(f"{error.at(path)}; each name and each number stands once") from None
    for key in table:
        if key not in _KEYS:
            raise _complaint(path, text, "", key, f"a map has {', '.join(_KEYS)}")
    target = table.get("target")
    if not isinstance(target, str):
        raise _complaint(path, text, "", "target", 'a map begins with the language of the result: target = "..."')
    names = _texts(table.get("names", {}), "names", path, text)
    numbers: dict[tuple[str, int], str] = {}
    banks = table.get("numbers", {})
    if not isinstance(banks, dict):
        raise _complaint(path, text, "", "numbers", "it holds a table for each bank: [numbers.R]")
    for bank, rows in banks.items():
        where = f"numbers.{_key(bank)}"
        for number, name in _texts(rows, where, path, text).items():
            if not _NUMBER.fullmatch(number):
                raise _complaint(path, text, where, number, 'a line has a whole number and a name: 12 = "count"')
            numbers[bank, int(number)] = name
    taught = _texts(table.get("taught", {}), "taught", path, text)
    return NameMap(target, names, numbers, path=path, text=text, taught=taught)


def _texts(rows: object, table: str, path: str, text: str) -> dict[str, str]:
    if not isinstance(rows, dict):
        raise _complaint(path, text, "", table, "it is a table")
    for key, value in rows.items():
        if not isinstance(value, str) or not value.strip():
            raise _complaint(path, text, table, key, "behind the sign = stands a name in quotation marks")
    return dict(rows)


def read_map(path: Path) -> NameMap:
    """The map in a file. Raises UsageError when it cannot be read."""
    try:
        text = read_bytes(path).decode("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text in UTF-8"
        raise UsageError(f"{path}: the map cannot be read: {reason}") from None
    return parse_map(text, str(path))


def check_map(given: NameMap, target: str, storage: Storage) -> None:
    """Raises UsageError where the map is one for another language, or has numbers that no controller of it has."""
    if given.target not in ("", target):
        raise given.complaint("", "target", f"the map is one for {given.target}, and {target} is to be written")
    banks = {bank.name: bank for bank in storage.banks.values()}
    owners: dict[tuple[str, str], int] = {}
    for (name, number), owner in given.numbers.items():
        bank = storage.points if "." in name else banks.get(name)
        last = max(bank.last, bank.most) if bank is not None else number
        if bank is not None and not bank.first <= number <= last:
            reason = f"{owner!r} needs a number from {bank.first} to {last}"
        elif owners.setdefault((name, owner), number) != number:
            reason = f"{owner!r} has the number {owners[name, owner]} too: delete one of the lines"
        else:
            continue
        raise given.complaint(f"numbers.{_key(name)}", str(number), reason)


def is_map(table: Mapping[str, Any]) -> bool:
    """Is a table of TOML such a map?"""
    return "target" in table and set(table) <= set(_KEYS)


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else _quoted(name)


def _quoted(text: str) -> str:
    """A text of TOML; JSON escapes the same signs, but for the last control one."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _complaint(path: str, text: str, table: str, key: str, reason: str) -> UsageError:
    line = _line(text, table, key)
    key = key if len(key) <= _SHOWN else f"{key[:_SHOWN]}..."
    return UsageError(f"{path}:{line}: {key}: {reason}" if line else f"{path}: {key}: {reason}")


def _line(text: str, table: str, key: str) -> int:
    """The line of a key as `map_text` writes it, or of its table; 0 where it is not found."""
    inside, header = table == "", 0
    spelled = re.compile(rf"\s*(?:{re.escape(key)}|{re.escape(_quoted(key))}|'{re.escape(key)}')\s*=")
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("["):
            wanted = table or key
            inside = line.partition("#")[0].replace(" ", "") == f"[{wanted}]".replace(" ", "")
            header = number if inside else header
        elif inside and spelled.match(line):
            return number
    return header
