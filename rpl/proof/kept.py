"""Reads the certificate of a proof. Anybody may have changed it: every key that is used is looked at before it is, and
what is wrong is said with file and key.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import fields
from pathlib import Path
from typing import Any

from rpl.errors import UsageError
from rpl.ir import SIGNAL_KINDS
from rpl.proof.certificate import (
    FILES_OR_NAMES,
    FORMAT,
    OPTIONAL,
    OPTIONAL_NUMBERS,
    PATHS,
    Question,
    looks_like_file,
)
from rpl.proof.tolerance import accepted_kinds
from rpl.proof.verdict import VERDICTS
from rpl.source import read_bytes

_LARGEST = 64 * 2**20  # bytes; that of a program with 100,000 statements that no run reached is a tenth of it
_LARGEST_WHOLE = 2**63
_MOST_SHOWN = 60  # signs of a key or a value in a message

_KEYS = frozenset(("format", "versions", "question", "programs", "files", "tolerance", "verdict", "result"))
_TABLES = ("versions", "question", "programs", "files", "tolerance", "result")
_TEXTS = ("a", "b", "controller")
_TEXTS_OR_NULL = ("robot", "to_robot", "cell", "entry", "to_entry", "language_a", "language_b")
_FROM_ZERO = ("path_mm", "corner_mm", "time_share")
_COUNTS = ("max_steps", "max_events")


def read_certificate(path: str | Path) -> tuple[Question, dict[str, Any]]:
    """The question of a certificate, its paths as they are from here, and the document. Raises UsageError that names
    the file, and the key where there is one, for a file that is none."""
    document = _parsed(path)
    reader = _Reader(str(path))
    reader.check_values(document)
    asked = reader.checked(document)
    here = asked | {"accept": tuple(asked["accept"])}
    here |= {name: tuple(tuple(one) for one in asked[name]) for name in OPTIONAL if name in asked}
    for name in (*PATHS, *FILES_OR_NAMES):
        value = here[name]
        if isinstance(value, str) and (name in PATHS or looks_like_file(value)):
            here[name] = str(Path(path).parent / value)
    return Question(**here), document


def _parsed(path: str | Path) -> dict[str, Any]:
    try:
        document = json.loads(read_bytes(path, _LARGEST).decode("utf-8"), object_pairs_hook=_table)
    except (OSError, ValueError) as error:
        if isinstance(error, OSError):
            raise UsageError(f"{path}: cannot read the certificate: {error.strerror}") from None
        raise UsageError(f"{path}: this is no certificate: {error}") from None
    except RecursionError:
        raise UsageError(f"{path}: this is no certificate: it is nested too deeply") from None
    form = document.get("format") if isinstance(document, dict) else None
    if not isinstance(document, dict) or form != FORMAT:
        other = f", but {_short(form)}" if form is not None else ""
        raise UsageError(f"{path}: this is no certificate: it has no format {FORMAT!r}{other}")
    return document


def _table(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        key, _ = Counter(key for key, _ in pairs).most_common(1)[0]
        raise ValueError(f"the key {_short(key)} is there more than once")
    return found


class _Reader:
    def __init__(self, path: str) -> None:
        self.path = path

    def wrong(self, key: str, words: str) -> UsageError:
        return UsageError(f"{self.path}: {key}: {words}")

    def check_values(self, document: dict[str, Any]) -> None:
        """No number and no text in it breaks what works with them."""
        left: list[tuple[str, object]] = [("", document)]
        while left:
            key, value = left.pop()
            match value:
                case dict():
                    left += [(f"{key}.{name}" if key else name, one) for name, one in value.items()]
                    left += [(f"{key}.{_short(name)}", name) for name in value if not _is_text(name)]
                case list():
                    left += [(f"{key}[{place}]", one) for place, one in enumerate(value)]
                case str() if not _is_text(value):
                    raise self.wrong(_cut(key), "must be a text without null signs and halves of signs")
                case float() if not math.isfinite(value):
                    raise self.wrong(_cut(key), f"must be a finite number, not {value}")
                case int() if abs(value) >= _LARGEST_WHOLE:
                    raise self.wrong(_cut(key), "must be a number of at most 64 bits")

    def checked(self, document: dict[str, Any]) -> dict[str, Any]:
        """The question, when it and all else that is looked at are what they should be."""
        self._keys("the certificate", document, _KEYS)
        for key in _TABLES:
            self._needs(key, document[key], isinstance(document[key], dict), "a table")
        self._needs("verdict", document["verdict"], document["verdict"] in VERDICTS, f"one of {', '.join(VERDICTS)}")
        self._programs(document["programs"])
        self._texts("files", document["files"])
        self._texts("versions", document["versions"])
        for name, value in document["tolerance"].items():
            self._needs(f"tolerance.{_cut(name)}", value, _is_number(value), "a number")
        self._question(document["question"])
        return dict(document["question"])

    def _keys(self, where: str, table: dict[str, Any], known: Iterable[str]) -> None:
        odd = sorted(set(table) ^ set(known))
        if odd:
            raise UsageError(f"{self.path}: {where} has other keys than it should: {_cut(', '.join(odd))}")

    def _needs(self, key: str, value: Any, holds: bool, what: str) -> None:
        if not holds:
            raise self.wrong(key, f"must be {what}, not {_short(value)}")

    def _texts(self, key: str, table: dict[str, Any]) -> None:
        for name, value in table.items():
            self._needs(f"{key}.{_cut(name)}", value, isinstance(value, str), "a text")

    def _programs(self, programs: dict[str, Any]) -> None:
        self._keys("programs", programs, "ab")
        for side, files in programs.items():
            self._needs(f"programs.{side}", files, isinstance(files, list), "a list of files")
            for place, file in enumerate(files):
                key = f"programs.{side}[{place}]"
                self._needs(key, file, isinstance(file, dict), "a table")
                self._keys(key, file, ("path", "sha256"))
                self._texts(key, file)
            self._needs(f"programs.{side}", files, len({one["path"] for one in files}) == len(files), "each file once")

    def _question(self, asked: dict[str, Any]) -> None:
        known = {field.name for field in fields(Question)} - ({*OPTIONAL, *OPTIONAL_NUMBERS} - set(asked))
        self._keys("the certificate's question", asked, known)
        for name in _TEXTS + _TEXTS_OR_NULL:
            value = asked[name]
            free = value is None and name in _TEXTS_OR_NULL
            self._needs(f"question.{name}", value, free or (isinstance(value, str) and value != ""), "a text")
        self._needs("question.explore", asked["explore"], isinstance(asked["explore"], bool), "true or false")
        for name in _FROM_ZERO:
            value = asked[name]
            fits = value is None or (_is_number(value) and value >= 0)
            self._needs(f"question.{name}", value, fits, "a number from 0 on")
        for name in ("max_time", *_COUNTS):
            value = asked[name]
            fits = _is_number(value) and value > 0 and (name not in _COUNTS or isinstance(value, int))
            what = "a whole number above 0" if name in _COUNTS else "a number above 0"
            self._needs(f"question.{name}", value, value is None or fits, what)
        accept = asked["accept"]
        words = isinstance(accept, list) and all(isinstance(one, str) for one in accept)
        self._needs("question.accept", accept, words, "a list of words")
        try:
            accepted_kinds(accept)
        except UsageError as error:
            raise self.wrong("question.accept", str(error)) from None
        self._rows("signals", asked, _is_signal, "a name, the kind of a signal, its number and the last one of a group")
        self._rows("names", asked, _is_pair, "two names")
        seed, most = asked.get("teach"), asked.get("teach_mm")
        self._needs(
            "question.teach", seed, seed is None or (_is_number(seed) and isinstance(seed, int)), "a whole number"
        )
        fits = most is None or (_is_number(most) and most >= 0)
        self._needs("question.teach_mm", most, fits, "a number from 0 on")
        self._rows("taught", asked, _is_pair, "two names")
        self._rows("approximations", asked, _is_approximation, "a code and how often")

    def _rows(self, name: str, asked: dict[str, Any], holds: Callable[[Any], bool], what: str) -> None:
        rows = asked.get(name, [])
        self._needs(f"question.{name}", rows, isinstance(rows, list), "a list")
        for place, row in enumerate(rows):
            self._needs(f"question.{name}[{place}]", row, holds(row), what)


def _is_signal(row: Any) -> bool:
    match row:
        case [str(), kind, int(first), None | int()] if kind in SIGNAL_KINDS:
            last = row[3]
            whole = not isinstance(first, bool) and not isinstance(last, bool)
            return whole and first >= 0 and (last is None or last >= first)
        case _:
            return False


def _is_pair(row: Any) -> bool:
    return isinstance(row, list) and len(row) == 2 and all(isinstance(one, str) for one in row)


def _is_approximation(row: Any) -> bool:
    match row:
        case [str(), int(count)]:
            return not isinstance(count, bool) and count > 0
        case _:
            return False


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_text(value: str) -> bool:
    """Can it be a name of a file, and be written?"""
    return "\0" not in value and not any("\ud800" <= sign <= "\udfff" for sign in value)


def _short(value: Any) -> str:
    """A value as a message shows it."""
    if isinstance(value, dict | list):
        return "a table" if isinstance(value, dict) else "a list"
    return _cut(ascii(value) if isinstance(value, str) else json.dumps(value))


def _cut(text: str) -> str:
    return text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}..."


__all__ = ["read_certificate"]
