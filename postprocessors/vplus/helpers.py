"""Programs that a written file brings along for what V+ has no function for."""

from __future__ import annotations

from rpl.writing.brought import Brought

HELPERS = Brought.of(__package__, "library.v2", r"\.PROGRAM ([\w.]+)\(")
