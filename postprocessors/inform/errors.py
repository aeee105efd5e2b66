"""The one error of this writer's parts."""

from __future__ import annotations

from rpl.diagnostics import Code
from rpl.errors import RplError


class CannotSayError(RplError):
    """INFORM has no words for this; the statement is written as a guarded stop. `code`: that of the report, where it
    is not the common one."""

    def __init__(self, reason: str, code: Code | None = None) -> None:
        super().__init__(reason)
        self.code = code
