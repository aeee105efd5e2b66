"""Types that a module takes from another one that keeps them for itself."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text

USER = """MODULE one
    {use}
    PROCEDURE main({parameter})
        {inner}
    END PROCEDURE
END MODULE
"""
OWNER = """MODULE two
    {word}ENUM grade (good, bad)
    {word}RECORD gauge (n: INT)
    {word}ALIAS label: STRING[16]
END MODULE
"""


def found(user: str, owner: str) -> list[str]:
    diagnostics = Diagnostics()
    sources = [source_from_text("a/one.rpl", user), source_from_text("a/two.rpl", owner)]
    read_sources(sources, "rpl", diagnostics)
    return [item.as_text() for item in diagnostics.of(Severity.ERROR)]


USES = [
    ("VAR g: gauge", "", "", "one.rpl:2", "record gauge", "two.rpl:3"),
    ("VAR g: ARRAY[3] OF Gauge", "", "", "one.rpl:2", "record gauge", "two.rpl:3"),
    ("RECORD pair (k: grade)", "", "", "one.rpl:2", "enumeration grade", "two.rpl:2"),
    ("", "", "VAR k: grade", "one.rpl:4", "enumeration grade", "two.rpl:2"),
    ("VAR l: label", "", "", "one.rpl:2", "type label", "two.rpl:4"),
    ("", "k: grade", "", "one.rpl:3", "enumeration grade", "two.rpl:2"),
]


@pytest.mark.parametrize(("use", "parameter", "inner", "place", "what", "home"), USES)
def test_a_type_of_another_module_alone_is_named_with_both_places(
    use: str, parameter: str, inner: str, place: str, what: str, home: str
) -> None:
    user = USER.format(use=use, parameter=parameter, inner=inner)
    (said,) = found(user, OWNER.format(word=""))
    assert place in said and f"{what} is local to module two ({home})" in said and "GLOBAL" in said
    assert not found(user, OWNER.format(word="GLOBAL "))


def test_a_module_s_own_type_of_the_name_is_taken() -> None:
    user = USER.format(use="RECORD gauge (m: REAL)\n    VAR g: gauge", parameter="", inner="g.m = 1")
    assert not found(user, OWNER.format(word=""))
    assert not found(user, "MODULE two\n    RECORD gauge (n: INT)\n    VAR g: gauge\nEND MODULE\n")
