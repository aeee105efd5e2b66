"""A share of all speeds, a highest speed, and moves of a given time, in languages that lack words for some of them."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.refusing import refused

ARM = "abb_irb1200_5_90"
HEAD = """MODULE Speeds
  CONST robtarget p:=[[450,90,310],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST speeddata vOwn:=[80,200,5000,1000];
  VAR clock ck;
  PROC main()
    VelSet 100,5000;
    MoveJ p,v200,fine,tool0;
"""
TIMES = """  ENDPROC
  FUNC num Taken(num x,speeddata v)
    ClkReset ck;
    ClkStart ck;
    MoveL Offs(p,x,0,0),v,fine,tool0;
    ClkStop ck;
    RETURN ClkRead(ck);
  ENDFUNC
ENDMODULE
"""
KNOWN = """
    ClkReset ck;
    ClkStart ck;
    {setting}
    MoveL Offs(p,80,0,0),{speed},fine,tool0;
    ClkStop ck;
    VelSet 100,5000;
    IF ClkRead(ck)>{least} AND ClkRead(ck)<{least}+0.3 SetDO do1,1;
"""
# name, what is set, the speed of a move of 80 mm, how long it takes (s)
CASES = [
    ("full", "VelSet 100,5000;", "v40", 1.95),
    ("half", "VelSet 50,800;", "v80", 1.95),
    ("half of own data", "VelSet 50,800;", "vOwn", 1.95),
    ("limited", "VelSet 100,40;", "v200", 1.95),
    ("half, then limited", "VelSet 50,40;", "v200", 1.95),
    ("half of a speed of the move", "VelSet 50,800;", "v200\\V:=80", 1.95),
]
LANGUAGES = ["rapid", "krl", "tp", "urscript", "vplus", "inform", "rpl"]


def switched(text: str, language: str) -> list[str]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Speeds.mod", text)], "rapid", diagnostics)
    translation = translate_program(read, language, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    written = [source_from_bytes(one.path, one.data) for one in translation.files]
    back = with_signal_names(read_sources(written, language, Diagnostics()).program, translation.program)
    result = run_program(back, ARM, None, translation.renamed.get("main", "main"), 60, controller="plain")
    assert result.fault is None
    happenings = [one for task in record_of(result, back).tasks.values() for one in task]
    return [name for one in happenings if one.kind == "output" and one.value for name in one.names if ":" in name]


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize(("setting", "speed", "least"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_the_time_of_a_move(setting: str, speed: str, least: float, language: str) -> None:
    body = KNOWN.format(setting=setting, speed=speed, least=least)
    assert "digital_out:1" in switched(HEAD + body + TIMES, language)


@pytest.mark.parametrize("language", ["krl", "tp", "urscript", "vplus", "inform"])
def test_a_move_at_which_the_run_decides_the_limit_is_refused(language: str) -> None:
    """Both halves of the program use one routine with a move, under two limits."""
    text = HEAD + "VelSet 100,800;IF Taken(80,v80)>1 SetDO do1,1;VelSet 100,40;IF Taken(0,v80)>1 SetDO do2,1;" + TIMES
    told = refused(text, "rapid", language, ARM)
    assert told == [("speed-share-hangs-on-run", text[: text.index("MoveL")].count("\n") + 1)]


@pytest.mark.parametrize("language", ["rapid", "tp", "urscript", "vplus", "rpl"])
def test_a_move_of_a_given_time(language: str) -> None:
    body = KNOWN.format(setting="", speed="v200\\T:=3", least=2.9)
    assert "digital_out:1" in switched(HEAD + body + TIMES, language)
