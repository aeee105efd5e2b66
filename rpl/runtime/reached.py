"""Which instructions a run has executed, as data that outlives it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rpl.runtime.code import Code
    from rpl.runtime.linked import Linked


@dataclass(frozen=True, slots=True, eq=False)
class Reached:
    """The linked program of a run and, for each code that it entered, its marks (see Machine.marks_of)."""

    linked: Linked
    marks: Mapping[Code, bytes]
