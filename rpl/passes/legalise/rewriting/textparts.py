"""Helper routines for texts on controllers that cut texts into parts and join them, and can look at nothing else.

They need `text_part`, `text_length`, `&` and the comparison of texts; what is said of letters concerns those of ASCII.
Each has the name of the helper that does the same where a text is an array of characters (see helpers).
"""

from __future__ import annotations

from typing import Final

from rpl.passes.capabilities import Capabilities, RoutineRule, TextRule

# Functions of the IR -> helper.
FUNCTIONS: Final = {
    "text_find": "rpl_text_find",
    "text_find_any": "rpl_text_find_any",
    "text_match": "rpl_text_match",
    "text_member": "rpl_text_member",
    "text_upper": "rpl_text_upper",
    "text_lower": "rpl_text_lower",
    "text_map": "rpl_text_map",
    "from_code": "rpl_from_code",
    "character_code": "rpl_character_code",
}
NUMBER_TEXT, PUT = "rpl_number_text", "rpl_text_put"
PARSE_REAL, PARSE_WHOLE = "rpl_parse_number", "rpl_parse_whole"


def by_parts(capabilities: Capabilities) -> bool:
    """Does the target have texts as values with these few operations, in numbered storage or by its own word?"""
    has = {"text_part", "text_length"} <= capabilities.functions and "&" in capabilities.operators
    stored = bool(capabilities.storage.banks) or TextRule.PARTS in capabilities.texts.rules
    return has and stored and RoutineRule.TEXT_RESULTS in capabilities.routines.rules
