"""Arrays that belong to one module of several: their first values are written."""

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

MAIN = """MODULE Main
  PROC main()
    IF Total()=210 SetDO do1,1;
  ENDPROC
ENDMODULE
"""
STATIONS = """MODULE Stations
  LOCAL VAR num nOffs{4}:=[0,35,70,105];
  FUNC num Total()
    VAR num sum:=0;
    FOR h FROM 1 TO 4 DO
      sum:=sum+nOffs{h};
    ENDFOR
    RETURN sum;
  ENDFUNC
ENDMODULE
"""


def test_an_array_of_a_further_module_keeps_its_values() -> None:
    sources = [source_from_text("Main.mod", MAIN), source_from_text("Stations.mod", STATIONS)]
    diagnostics = Diagnostics()
    made = translate_program(
        read_sources(sources, "rapid", Diagnostics()), "vplus", "abb_irb1200_5_90", None, diagnostics
    )
    assert not diagnostics.of(Severity.LOSS)
    text = made.files[0].data.decode("ascii").lower()
    assert "noffs[2] 35" in text and "noffs[4] 105" in text
