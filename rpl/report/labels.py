"""Places in the program as a page names them: `file:line` and the text of the line, each kept once."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from pathlib import PurePath

from rpl.report.motion import line_text
from rpl.source import Origin

NO_LABEL = -1


class Labels:
    """Numbers for places. Files go by their name alone where no other one has it."""

    def __init__(self, origins: Iterable[Origin]) -> None:
        folders: dict[str, set[str]] = defaultdict(set)
        self._numbers: dict[tuple[str, int], int] = {}
        self._texts: list[str] = []
        for origin in origins:
            if origin.source is None:
                continue
            folders[PurePath(origin.file).name].add(origin.file)
            key = (origin.file, origin.line)
            if key not in self._numbers:
                self._numbers[key] = len(self._texts)
                self._texts.append(line_text(origin))
        self._ambiguous = {name for name, files in folders.items() if len(files) > 1}

    def number(self, origin: Origin) -> int:
        """The number of a place; NO_LABEL where there is none."""
        return self._numbers.get((origin.file, origin.line), NO_LABEL) if origin.source is not None else NO_LABEL

    def place(self, origin: Origin) -> str:
        """`file:line`, empty where there is no source."""
        return self._place(origin.file, origin.line) if origin.source is not None else ""

    def _place(self, file: str, line: int) -> str:
        name = PurePath(file).name
        return f"{file if name in self._ambiguous else name}:{line}"

    def table_text(self, origin: Origin) -> str:
        """The text of the line, empty where there is no source."""
        number = self.number(origin)
        return self._texts[number] if number != NO_LABEL else ""

    def table(self) -> list[tuple[str, str]]:
        """Place and text of each number."""
        return [(self._place(*key), self._texts[number]) for key, number in self._numbers.items()]
