"""The time limit of a TP wait: the seconds themselves where the program has set $WAITTMOUT on every way to the wait."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SET, WAIT = "$WAITTMOUT=200", "WAIT DI[1]=ON TIMEOUT,LBL[9]"


def rapid(*lines: str) -> str:
    body = "\n".join(f"{number:4}:  {line} ;" for number, line in enumerate(lines, 1))
    text = f"/PROG MAIN\n/MN\n{body}\n/POS\n/END\n"
    read = read_sources([source_from_text("MAIN.LS", text)], "tp", Diagnostics())
    done = translate_program(read, "rapid", "fanuc_m10ia", None, Diagnostics())
    return "\n".join(source_from_bytes(file.path, file.data).text for file in done.files)


def test_the_limit_is_a_number_and_the_variable_is_gone() -> None:
    text = rapid(SET, WAIT, "LBL[9]")
    assert "WaitDI di1,1\\MaxTime:=2\\TimeFlag" in text
    assert "WAITTMOUT" not in text


# A way that has not set it, two values, one that the run decides, one that is read.
OPEN = [
    (WAIT, SET, "LBL[9]"),
    ("IF DI[2]=ON,JMP LBL[1]", SET, "LBL[1]", WAIT, "LBL[9]"),
    ("$WAITTMOUT=100", "IF DI[2]=ON,JMP LBL[1]", SET, "LBL[1]", WAIT, "LBL[9]"),
    ("R[1]=DI[3]", "$WAITTMOUT=R[1]", WAIT, "LBL[9]"),
]


@pytest.mark.parametrize("lines", OPEN, ids=range(len(OPEN)))
def test_a_limit_that_the_run_decides_stays(lines: tuple[str, ...]) -> None:
    assert "MaxTime:=n_WAITTMOUT/100" in rapid(*lines)


def test_another_value_on_the_way_counts() -> None:
    text = rapid(SET, WAIT, "$WAITTMOUT=50", "WAIT DI[2]=ON TIMEOUT,LBL[9]", "LBL[9]")
    assert "WaitDI di1,1\\MaxTime:=2\\" in text
    assert "WaitDI di2,1\\MaxTime:=0.5\\" in text
