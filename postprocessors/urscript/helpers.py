"""Functions that a written program brings along where the controller has none."""

from __future__ import annotations

from rpl.writing.brought import Brought

HELPERS = Brought.of(__package__, "library.script", r"def (\w+)\(")
