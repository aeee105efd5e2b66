"""Controller files: which controller is meant, and the model of how it moves an arm that its file gives.

A language's folder holds its controller's `controller.toml`; a user may write one (`rpl run --controller F.toml`) or
let `rpl fit` make one from a recorded log. A robot file may hold what was measured on that arm under its own
controller. What no file says is the plain model: constant acceleration, corners that are parabolas.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

from rpl import registry
from rpl.errors import UsageError
from rpl.motionmodel import NUMBERS, PLAIN, PLAIN_NAME, UNCERTAIN, MotionModel, wrong_number
from rpl.source import read_bytes
from rpl.tomlfile import Lines, TomlError, key_lines, line_of, read_toml


@cache
def controller_named(name_or_path: str) -> MotionModel:
    """The controller of a language, `plain`, or that of a `.toml` file. Raises UsageError when there is none."""
    if name_or_path == PLAIN_NAME:
        return PLAIN
    if name_or_path.endswith(".toml"):
        try:
            text = read_bytes(name_or_path).decode("utf-8")
        except OSError as error:
            raise UsageError(f"controller file {name_or_path} cannot be read: {error.strerror}") from error
        except UnicodeDecodeError:
            raise UsageError(f"controller file {name_or_path} is no text in UTF-8") from None
        return parse_controller(text, Path(name_or_path).stem, name_or_path)
    name = registry.dialect_meant(name_or_path)
    if name not in registry.dialect_names():
        names = [PLAIN_NAME, *registry.dialect_names()]
        close = difflib.get_close_matches(name_or_path, names, 1)
        hint = f"; did you mean {close[0]}?" if close else ""
        raise UsageError(f"no controller named {name_or_path!r}: there are {', '.join(names)} and .toml files{hint}")
    text = registry.controller_text(name)
    return PLAIN if not text else parse_controller(text, name, f"controller.toml of {name}")


def parse_controller(text: str, name: str, place: str) -> MotionModel:
    """A controller file's text as a model. Raises UsageError naming `place` and the key that is wrong."""
    try:
        data = read_toml(text)
    except TomlError as error:
        raise UsageError(error.at(f"controller file {place}")) from error
    file = _File(place, key_lines(text))
    known = {"title", "source", "overlap", "joint_ramps_s", "uncertainty", *NUMBERS}
    for key in data:
        if key not in known:
            close = difflib.get_close_matches(key, known, 1)
            raise file.wrong(key, f"unknown key '{key}'" + (f"; meant {close[0]}?" if close else ""))
    given: dict[str, Any] = {key: file.number(data[key], key) for key in NUMBERS if key in data}
    given |= {key: str(data[key]) for key in ("title", "source") if key in data}
    uncertain = data.get("uncertainty", {})
    if not isinstance(uncertain, dict):
        raise file.wrong("uncertainty", "'uncertainty' must be a table")
    for key in uncertain:
        if key not in UNCERTAIN:
            raise file.wrong(f"uncertainty.{key}", f"uncertainty of '{key}', which is no parameter")
    uncertainty = {key: file.number(value, f"uncertainty.{key}") for key, value in uncertain.items()}
    ramps = data.get("joint_ramps_s", [])
    if not isinstance(ramps, list):
        raise file.wrong("joint_ramps_s", "'joint_ramps_s' must be a list of times, one per axis")
    return MotionModel(
        name=name,
        overlap=file.overlap(data.get("overlap", [])),
        joint_ramps_s=tuple(file.number(each, "joint_ramps_s") for each in ramps),
        uncertainty=uncertainty,
        **given,
    )


def as_toml(model: MotionModel) -> str:
    """The text of a controller file; `parse_controller` reads it back."""
    lines = [f'title = "{_quoted(model.title)}"', f'source = "{_quoted(model.source)}"']
    lines += [f"{key} = {float(getattr(model, key)):.9g}" for key in NUMBERS if getattr(model, key) is not None]
    if model.joint_ramps_s:
        lines.append("joint_ramps_s = [" + ", ".join(f"{ramp:.9g}" for ramp in model.joint_ramps_s) + "]")
    if model.overlap:
        lines.append(
            "overlap = [" + ", ".join(f"[{percent:.9g}, {share:.9g}]" for percent, share in model.overlap) + "]"
        )
    if model.uncertainty:
        lines += ["", "[uncertainty]", *(f"{key} = {value:.9g}" for key, value in model.uncertainty.items())]
    return "\n".join(lines) + "\n"


def _quoted(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"')


@dataclass(frozen=True, slots=True)
class _File:
    """Where a controller file's complaints stand."""

    place: str
    lines: Lines

    def wrong(self, key: str, what: str) -> UsageError:
        line = line_of(self.lines, key)
        return UsageError(f"controller file {self.place}{f':{line}' if line else ''}: {what}")

    def number(self, value: object, key: str) -> float:
        wrong = wrong_number(value, key)
        if wrong or not isinstance(value, int | float):
            raise self.wrong(key, wrong)
        return float(value)

    def overlap(self, value: object) -> tuple[tuple[float, float], ...]:
        rows = value if isinstance(value, list) else [None]
        pairs = []
        for row in rows:
            if not isinstance(row, list) or len(row) != 2:
                raise self.wrong("overlap", "'overlap' must be a list of pairs [percent, share of a ramp]")
            pairs.append((self.number(row[0], "overlap"), self.number(row[1], "overlap")))
        rising = all(a[0] < b[0] for a, b in pairwise(pairs))
        if not rising or any(share > 1.0 for _, share in pairs):
            raise self.wrong("overlap", "'overlap' needs rising percents and shares of at most 1")
        return tuple(pairs)
