"""Routines that a translated program brings along for what its new controller does not have, written once, in RPL.

Each file beside this one is a module by a concern; its head says for which controllers it is. A routine stands in four
columns with a remark above it that says what it gives. The routines are read as any RPL program, when a translation
asks for them, and legalised with the program (`rpl.passes.legalise.rewriting.library`).
"""

import re
from collections.abc import Mapping
from functools import cache
from importlib import resources

_ROUTINE = re.compile(r"^ {4}(FUNCTION|PROCEDURE) (\w+)\(.*?^ {4}END \1$", re.MULTILINE | re.DOTALL)


@cache
def routines(name: str) -> Mapping[str, str]:
    """The texts of the routines of the file of this name, by their names."""
    text = resources.files(__name__).joinpath(f"{name}.rpl").read_text("utf-8")
    return {found[2]: found[0] for found in _ROUTINE.finditer(text)}
