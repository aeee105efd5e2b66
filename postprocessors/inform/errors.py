"""The one error of this writer's parts."""

from __future__ import annotations

from rpl.errors import RplError


class CannotSayError(RplError):
    """INFORM has no words for this; the statement is written as a guarded stop."""
