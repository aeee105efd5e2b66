"""Installed routines that only an ABB controller has: instructions with their effect, functions with their type.

One table each. An instruction becomes a vendor statement with that effect; a function becomes a predefined routine
whose result a run has to be told. effect: none, message, time, unknown (see ir.Vendor). An instruction of the neutral
tables stands here too when some of its options have no neutral form.
"""

from __future__ import annotations

from rpl.words import lowered

from .words import WORDS


def _by_name(*tables: str) -> dict[str, str]:
    """The name of each routine in the tables -> the list that it stands in."""
    return {name: kind for table in tables for kind, names in WORDS.pairs(table).items() for name in names.split()}


EFFECTS = lowered(_by_name("vendor_instructions", "more_vendor_instructions"))
FUNCTION_RESULTS = _by_name("vendor_functions", "more_vendor_functions")
