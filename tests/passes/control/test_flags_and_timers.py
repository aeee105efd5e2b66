"""Interrupts on flags where flags are data, and the flag of a timer where timers have none."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
COUNTED = """DEF COUNT()
DECL INT I
INTERRUPT DECL 12 WHEN {condition} DO NOTE()
N=0
$FLAG[5]={rest}
INTERRUPT ON 12
FOR I=1 TO 3
  $FLAG[5]=NOT {rest}
  WAIT SEC 0.2
  $FLAG[5]={rest}
  WAIT SEC 0.2
ENDFOR
INTERRUPT OFF 12
$FLAG[5]=NOT {rest}
WAIT SEC 0.2
IF N==3 THEN
  $OUT[1]=TRUE
ENDIF
END
DEF NOTE()
N=N+1
END
"""
LIMITED = """DEF COUNT()
DECL BOOL CAME
$TIMER[1]=-1500
$TIMER_STOP[1]=FALSE
WAIT FOR $IN[2] OR $TIMER_FLAG[1]
CAME=$IN[2]
$TIMER_STOP[1]=TRUE
IF NOT CAME AND $TIMER_FLAG[1] AND ($TIMER[1]<1000) THEN
  $OUT[1]=TRUE
ENDIF
END
"""
FAR = """DEF COUNT()
$FLAG[33]=TRUE
$FLAG[999]=NOT $FLAG[33]
CHANGE()
IF $FLAG[999] AND NOT $FLAG[33] THEN
  $OUT[1]=TRUE
ENDIF
END
DEF CHANGE()
$FLAG[33]=FALSE
$FLAG[999]=NOT $FLAG[33]
END
"""
DATA = "DEFDAT COUNT\nDECL INT N=0\nENDDAT\n"


def outputs(text: str, target: str) -> tuple[str, list[object]]:
    sources = [source_from_text("count.src", text), source_from_text("count.dat", DATA)]
    read = read_sources(sources, "krl", Diagnostics())
    diagnostics = Diagnostics()
    translation = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    entry = translation.renamed.get("COUNT", "COUNT")
    result = run_program(back.program, KUKA, None, entry, 20.0)
    assert result.status == "finished", result.fault
    return "".join(f.data.decode("latin-1") for f in translation.files), [value for _, _, value in result.outputs]


@pytest.mark.parametrize("target", ["rapid", "vplus"])
@pytest.mark.parametrize(
    ("condition", "rest"), [("$FLAG[5]==TRUE", "FALSE"), ("$FLAG[5]", "FALSE"), ("NOT $FLAG[5]", "TRUE")]
)
def test_each_time_that_a_flag_comes_counts(condition: str, rest: str, target: str) -> None:
    text, values = outputs(COUNTED.format(condition=condition, rest=rest), target)
    assert values == [True]
    assert target != "rapid" or ("PERS bool rpl_flag" in text and "IPers rpl_flag{5}" in text)


@pytest.mark.parametrize("target", ["tp", "rapid", "inform"])
def test_a_wait_that_a_timer_ends(target: str) -> None:
    assert outputs(LIMITED, target)[1] == [True]


@pytest.mark.parametrize("target", ["tp", "rapid", "inform", "urscript", "vplus"])
def test_flags_beyond_the_last_one_of_a_target(target: str) -> None:
    assert outputs(FAR, target)[1][-1] is True
