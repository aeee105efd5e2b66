"""What a batch has done, a line of JSON for each project as soon as it is done: after an interruption it goes on there.

A line counts as long as the project's bytes and the question are the same and the files that were written are there.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from types import TracebackType
from typing import IO

from rpl.batch.rows import PASSING, Row, row_of
from rpl.errors import UsageError

NAME = ".rpl-batch.jsonl"
_KEYS = {"project", "asked", "digest", "seconds", "written", "rows"}


@dataclass(frozen=True, slots=True)
class Done:
    """A project that is done. asked: Asked.key; digest: Project.digest; written: paths of the files that were made."""

    project: str
    asked: str
    digest: str
    seconds: float
    written: tuple[str, ...]
    rows: tuple[Row, ...]

    @property
    def is_lasting(self) -> bool:
        """Would it be the same another time?"""
        return not any(row.outcome in PASSING for row in self.rows)

    def as_line(self) -> str:
        rows = [{name: value for name, value in asdict(row).items() if value is not None} for row in self.rows]
        return json.dumps(asdict(self) | {"rows": rows}, ensure_ascii=True) + "\n"


class Journal:
    """The file, open for the projects that are done from now on. Without a path nothing is kept."""

    def __init__(self, path: Path | None, kept: Mapping[str, Done]) -> None:
        self._stream: IO[str] | None = None
        if path is None:
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_name(f"{path.name}.{os.getpid()}.part")
        part.write_text("".join(kept[name].as_line() for name in sorted(kept)), encoding="utf-8")
        part.replace(path)
        self._stream = path.open("a", encoding="utf-8")

    def add(self, done: Done) -> None:
        """Keeps it, also if this process ends at once."""
        if self._stream is not None:
            self._stream.write(done.as_line())
            self._stream.flush()

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._stream is not None:
            self._stream.close()


def read_journal(path: Path) -> dict[str, Done]:
    """What the file says is done; a line that was cut off is none. Raises UsageError for a file that is no journal."""
    if not path.exists():
        return {}
    lines = path.read_text("utf-8", errors="replace").splitlines()
    found = [done for line in lines if (done := _done(line)) is not None]
    if not found and any(line.strip() for line in lines[:-1]):
        raise UsageError(f"{path} is no journal of a batch: name other results, or take it away")
    return {one.project: one for one in found}


def _done(line: str) -> Done | None:
    try:
        document = json.loads(line)
        if not isinstance(document, dict) or set(document) != _KEYS:
            return None
        document["rows"] = tuple(row_of(row) for row in document["rows"])
        document["written"] = tuple(document["written"])
        return Done(**document)
    except (ValueError, TypeError):
        return None
