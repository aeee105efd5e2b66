"""Statements that write a place and call a function in another part: what is written arrives in the place itself."""

import pytest
from helpers import run

_MORE = """
FUNCTION mark(n: INT): STRING
    IF n = 3 THEN RETURN "3"
    RETURN "x"
END FUNCTION
FUNCTION seconds(): REAL
    RETURN 0.2
END FUNCTION
FUNCTION second(): INT
    i = 2
    RETURN 2
END FUNCTION
"""

CASES = {
    "append": ("text_append(s, mark(1))", 's = "abx"'),
    "append asked for its result": ("good = text_append(s, mark(1))", 's = "abx" AND good'),
    "increment": ("increment(n, second())", "n = 2"),
    "an element chosen before the call": ("i = 1\nincrement(row[i], second())", "row[1] = 2 AND row[2] = 0"),
    "a number from a text": ('good = parse_number("1" & mark(3), n)', "good AND n = 13"),
    "formatted": ('format_into(s, good, n, "%s%d", "a", second())', 's = "a2" AND good AND n = 2'),
    "an answer": ('ASK "how many " & mark(1) INTO n KIND number', "n = 7"),
    "a wait's flag": ("WAIT UNTIL di[9] TIMEOUT seconds() s FLAG good", "good"),
    "a pulse": ("PULSE do[2] TO ON FOR seconds() s\nWAIT 0.1 s\nn = 1", "n = 1 AND do[2]"),
    "an output later": ("SET do[2] TO ON AFTER seconds() s\nWAIT 0.3 s", "do[2]"),
}


@pytest.mark.parametrize(("body", "holds"), CASES.values(), ids=CASES)
def test_the_place_is_written(body: str, holds: str) -> None:
    data = 'VAR s: STRING[20] = "ab"\nVAR n: INT = 0\nVAR i: INT = 0\nVAR row: ARRAY[2] OF INT = {0, 0}\nVAR good: BOOL'
    main = f"PROCEDURE main()\n{body}\nIF {holds} THEN SET do[1] TO ON\nEND PROCEDURE\n"
    text = f"MODULE m\n{data}\n{main}{_MORE}\nEND MODULE\n"
    result = run("rpl", text, cell="[[answer]]\nanswer = 7\n", entry="main")
    assert result.status == "finished", result.fault
    assert ("do[1]", True) in [(name, value) for _, name, value in result.outputs]
