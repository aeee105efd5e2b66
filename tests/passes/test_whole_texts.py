"""Texts of values with components are put together of those of the components, also in messages."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

FRAME = """MODULE M
RECORD item num size; bool ok; pos at; ENDRECORD
VAR item it:=[2.5,TRUE,[1,2,3]]; VAR pos p:=[1,2.5,-3]; VAR orient o:=[1,0,0,0]; VAR num aN{3}:=[1,2,3];
VAR robtarget q:=[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]; VAR item aIt{2};
PROC main()
  VAR string s; VAR pose f; VAR num n:=0;
  BODY
ENDPROC
FUNC pos Moved(pos a) a.x:=a.x+1; RETURN a; ENDFUNC
ENDMODULE
"""
CASES = {
    "in a condition": 'IF ValToStr(p)="[1,2.5,-3]" SetDO do1,1;',
    "between other texts": 's:="at "+ValToStr(p)+" end"; IF s="at [1,2.5,-3] end" SetDO do1,1;',
    "a rotation": 'IF ValToStr(o)="[1,0,0,0]" SetDO do1,1;',
    "a pose": 'f:=[p,o]; IF ValToStr(f)="[[1,2.5,-3],[1,0,0,0]]" SetDO do1,1;',
    "a record": 's:=ValToStr(it); IF s="[2.5,TRUE,[1,2,3]]" SetDO do1,1;',
    "of an element": 'aIt{2}.at:=p; IF ValToStr(aIt{2}.at)="[1,2.5,-3]" SetDO do1,1;',
    "a list": 'IF ValToStr(aN)="[1,2,3]" SetDO do1,1;',
    "what a function gives": 'IF ValToStr(Moved(p))="[2,2.5,-3]" SetDO do1,1;',
    "in a loop": 'WHILE ValToStr(p)<>"[3,2.5,-3]" DO p.x:=p.x+1; n:=n+1; ENDWHILE IF n=2 SetDO do1,1;',
}
TARGETS = ["krl", "rapid", "urscript", "vplus", "inform"]


def translated(body: str, target: str) -> tuple[list[object], list[str], list[str]]:
    """The outputs, the messages and the losses of the body in the target."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", FRAME.replace("BODY", body))], "rapid", diagnostics)
    done = translate_program(read, target, "abb_irb1200_5_90", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    result = run_program(back.program, "abb_irb1200_5_90", entry=back.program.entry or done.renamed.get("main", "main"))
    lost = [item.message for item in diagnostics.of(Severity.LOSS)]
    return [value for _, _, value in result.outputs], list(result.messages), lost


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", CASES)
def test_the_text_is_the_same(name: str, target: str) -> None:
    outputs, _, lost = translated(CASES[name], target)
    assert (outputs, lost) == ([True], [])


@pytest.mark.parametrize("target", ["krl", "urscript", "vplus"])
def test_messages_show_places(target: str) -> None:
    _, messages, lost = translated('TPWrite "Place "\\Pos:=p; TPWrite "Turn "\\Orient:=o;', target)
    assert ["".join(one.split()) for one in messages] == ["Place[1,2.5,-3]", "Turn[1,0,0,0]"] and not lost


@pytest.mark.parametrize("target", ["krl", "urscript", "vplus", "inform", "tp"])
def test_what_has_no_such_text_is_refused(target: str) -> None:
    _, _, lost = translated("TPWrite ValToStr(q);", target)
    assert lost
