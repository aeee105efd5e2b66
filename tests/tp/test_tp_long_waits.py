"""Times that one WAIT cannot hold. $WAITTMOUT counts to 32,767 hundredths of a second; M: a WAIT for a time too."""

import pytest

from tests.there_and_back import there_and_back


@pytest.mark.parametrize(
    ("seconds", "lines"),
    [("300", ["300.00"]), ("327.67", ["327.67"]), ("400", ["327.67", "72.33"]), ("655.34", ["327.67", "327.67"])],
)
def test_a_long_time_is_waited_in_parts(seconds: str, lines: list[str]) -> None:
    given = there_and_back({"a.src": f"DEF a()\nWAIT SEC {seconds}\n$OUT[1]=TRUE\nEND\n"}, "krl", "tp")
    written = [line.partition("WAIT")[2] for line in given.text.splitlines() if "WAIT" in line]
    assert [line.partition("(")[0].strip() for line in written] == lines
    assert not given.losses and given.prove("a").equal
    assert given.run("a", limit_s=1000.0).time_s == pytest.approx(float(seconds))


def test_a_limit_that_does_not_fit_is_refused() -> None:
    text = "MODULE m\n  PROC main()\n    VAR bool late;\n    WaitUntil di1=1\\MaxTime:={limit}\\TimeFlag:=late;\n"
    text += "    IF late SetDO do1,1;\n  ENDPROC\nENDMODULE\n"
    kept, refused = (
        there_and_back({"m.mod": text.replace("{limit}", limit)}, "rapid", "tp") for limit in ("300", "400")
    )
    assert not kept.losses and refused.losses
