"""Reserved words and placeholders of RAPID: what no declaration can be named, and what the editor leaves behind."""

from __future__ import annotations

from rpl import registry


def words(text: str) -> frozenset[str]:
    """The words of a list."""
    return frozenset(text.split())


WORDS = registry.words("rapid")
RESERVED = frozenset(WORDS.listed("reserved"))
MODULE_ATTRIBUTES = frozenset(WORDS.listed("module_attributes"))
PLACEHOLDERS = words("SMT EXP ID VAR ARG TDN DDN RDN PAR ALT DIM EIT CSE")
