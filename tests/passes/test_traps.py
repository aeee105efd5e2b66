"""Interrupts of KRL whose conditions no single interrupt of RAPID can watch, and those that are switched together."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.analog_wiring import WIRED

KUKA = "kuka_kr6r900sixx"
DATA = """DEFDAT JOB PUBLIC
DECL GLOBAL INT COUNTED=0
DECL GLOBAL INT LEVEL=0
DECL GLOBAL BOOL LID=FALSE
ENDDAT
"""
# Condition -> what makes it true (each time), and what makes it false again.
CONDITIONS = {
    "$FLAG[1] AND NOT $FLAG[2]": ("$FLAG[1]=TRUE", "$FLAG[1]=FALSE"),
    "NOT ($FLAG[1] OR $OUT[5])": ("$OUT[5]=FALSE", "$OUT[5]=TRUE"),
    "($OUT[5]==FALSE) EXOR $FLAG[1]": ("$FLAG[1]=TRUE\n$OUT[5]=TRUE\n$OUT[5]=FALSE\n$FLAG[1]=FALSE", ""),
    "LID AND (LEVEL>=3)": ("LEVEL=4\nLID=TRUE\nLEVEL=5", "LID=FALSE"),
    "$ANOUT[1]>0.5": ("$ANOUT[1]=0.6", "$ANOUT[1]=0.4"),
    "$TIMER_FLAG[2]": ("$TIMER[2]=-100\n$TIMER_STOP[2]=FALSE", "$TIMER[2]=-1000"),
    "(LEVEL+1)/2==2": ("LEVEL=3", "LEVEL=1"),
}
POLLED = {"$ANOUT[1]>0.5", "$TIMER_FLAG[2]", "(LEVEL+1)/2==2"}


def written(body: str) -> tuple[str, set[str], set[int]]:
    """A KRL program as RAPID: its text, the codes of what was told, and the outputs that are on at the end."""
    diagnostics = Diagnostics()
    sources = [source_from_text("job.src", body), source_from_text("job.dat", DATA)]
    read = read_sources(sources, "krl", diagnostics)
    translation = translate_program(read, "rapid", KUKA, None, diagnostics, analog=WIRED)
    assert not diagnostics.of(Severity.LOSS)
    files = [source_from_bytes(file.path, file.data) for file in translation.files]
    result = run_program(read_sources(files, "rapid", Diagnostics()).program, KUKA, None, "main", 60.0)
    assert result.fault is None
    on = {int(name[2:]): value for _, name, value in result.outputs if name.startswith("do")}
    told = {item.code.name for item in diagnostics}
    return "".join(file.data.decode() for file in translation.files), told, {n for n, value in on.items() if value}


@pytest.mark.parametrize("condition", CONDITIONS)
def test_the_routine_is_called_each_time_that_the_condition_becomes_true(condition: str) -> None:
    true, false = CONDITIONS[condition]
    once = f"{true}\nWAIT SEC 0.4\n{false}\nWAIT SEC 0.4\n"
    each = 2 if "EXOR" in condition else 1
    body = f"""DEF JOB()
INTERRUPT DECL 20 WHEN {condition} DO COUNT()
BAS(#INITMOV,0)
$OUT[5]={"EXOR" not in condition}
$ANOUT[1]=0.0
$FLAG[1]=FALSE
$FLAG[2]=FALSE
$TIMER[2]=-5000
INTERRUPT ON 20
{once}{once}$OUT[1]=(COUNTED=={2 * each})
INTERRUPT OFF 20
{once}$OUT[2]=(COUNTED=={2 * each})
END
DEF COUNT()
COUNTED=COUNTED+1
END
"""
    _, told, on = written(body)
    assert {1, 2} <= on
    assert ("interrupt-polled" in told) == (condition in POLLED)


def test_all_interrupts_are_switched_one_by_one() -> None:
    text, told, on = written("""DEF JOB()
INTERRUPT DECL 20 WHEN $FLAG[1] DO COUNT(1)
INTERRUPT DECL 21 WHEN $OUT[5] DO COUNT(10)
$OUT[5]=FALSE
$FLAG[1]=FALSE
INTERRUPT ON
$FLAG[1]=TRUE
WAIT SEC 0.1
$OUT[5]=TRUE
WAIT SEC 0.1
$OUT[1]=(COUNTED==11)
INTERRUPT OFF
$OUT[5]=FALSE
WAIT SEC 0.1
$OUT[5]=TRUE
WAIT SEC 0.1
$OUT[2]=(COUNTED==11)
END
DEF COUNT(N:IN)
DECL INT N
COUNTED=COUNTED+N
END
""")
    assert {1, 2} <= on
    assert "interrupts-armed-undeclared" not in told
    before = text[: text.index("ISignalDO")]
    assert before.count("CONNECT") == 2  # those just declared are not connected anew


def test_all_interrupts_may_be_more_than_those_declared_so_far() -> None:
    _, told, on = written("""DEF JOB()
$OUT[5]=FALSE
READY()
INTERRUPT ON
$OUT[5]=TRUE
WAIT SEC 0.1
$OUT[1]=(COUNTED==1)
END
DEF READY()
GLOBAL INTERRUPT DECL 21 WHEN $OUT[5] DO COUNT()
END
DEF COUNT()
COUNTED=COUNTED+1
END
""")
    assert 1 in on
    assert "interrupts-armed-undeclared" in told
