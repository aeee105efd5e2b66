"""What is done to a program right in front of the writer, also to one that was only read: with it a job that nobody has
changed is known again (`unchanged`)."""

from __future__ import annotations

from .exactends import exact_ends
from .flagbytes import flags_in_bytes
from .moveactions import actions_of_moves
from .takenbranches import taken_branches

AS_READ = (flags_in_bytes, taken_branches, actions_of_moves, exact_ends)

__all__ = ["AS_READ"]
