"""An ELSE that holds nothing but an IF is one more branch where the target has ELSEIF."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

NESTED = """DEF m()
DECL INT n
n=1
IF n==1 THEN
  $OUT[1]=TRUE
ELSE
  ;second
  IF n==2 THEN
    $OUT[2]=TRUE
  ELSE
    {last}
  ENDIF
  {behind}
ENDIF
END
"""


def written(target: str, last: str = "$OUT[3]=TRUE", behind: str = "") -> list[str]:
    source = source_from_text("m.src", NESTED.format(last=last, behind=behind))
    read = read_sources([source], "krl", Diagnostics())
    done = translate_program(read, target, "kuka_kr6r900sixx", None, Diagnostics())
    return [line.strip() for line in done.files[0].data.decode().splitlines()]


def test_rapid_has_elseif() -> None:
    lines = written("rapid")
    assert [line for line in lines if line.split(" ")[0] in ("IF", "ELSE", "ELSEIF", "ENDIF")] == [
        "IF n=1 THEN",
        "ELSEIF n=2 THEN",
        "ELSE",
        "ENDIF",
    ]
    assert lines.index("!second") == lines.index("ELSEIF n=2 THEN") + 1


def test_what_stands_behind_the_inner_if_keeps_it_inside() -> None:
    lines = written("rapid", behind="$OUT[4]=TRUE")
    assert "ELSEIF n=2 THEN" not in lines and lines.count("ENDIF") == 2
