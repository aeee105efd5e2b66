"""Rules that only one language has, in another: where arrays start, what errors are called, how arcs turn the tool.

Each program switches output 1 on when its expectation holds, before and after translation.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.there_and_back import entry_of

FROM_ZERO = """
MODULE m
    VAR data: ARRAY[3] FROM 0 OF INT
    PROCEDURE main()
        VAR i: INT
        FOR i = 0 TO 3
            data[i] = i * i
        END FOR
        data[0] = 5
        SET do[1] TO total(data) = 19
    END PROCEDURE
    FUNCTION total(numbers: ARRAY[3] FROM 0 OF INT): INT
        VAR sum, i: INT
        sum = 0
        FOR i = 0 TO 3
            sum = sum + numbers[i]
        END FOR
        RETURN sum
    END FUNCTION
END MODULE
"""
# `timeout` is the program's own variable here, not the error of that name.
OWN_ERROR_NAMES = """
MODULE m
    PROCEDURE main()
        VAR timeout: REAL = 3.0
        timeout = timeout + shared(0)
        SET do[1] TO timeout = 4.0
    END PROCEDURE
    FUNCTION shared(d: INT): REAL
        VAR r: REAL
        r = 10.0 / to_real(d)
        RETURN r
    ON ERROR division_by_zero
        RETURN 1.0
    END FUNCTION
END MODULE
"""
REAL_DIVISION = """
MODULE m
    PROCEDURE main()
        VAR i, k: INT
        i = 3
        k = 4
        SET do[1] TO to_real(i) / 4 = 0.75 AND (to_real(i) + 2) / to_real(k) = 1.25 AND i DIV k = 0
    END PROCEDURE
END MODULE
"""
GIVEN_SIZE = """
MODULE m
  VAR num small{3}:=[1,2,3];
  VAR num large{2,4}:=[[1,2,3,4],[5,6,7,8]];
  PROC main()
    IF total(small)=6 AND through(large)=36 SetDO do1,1;
  ENDPROC
  FUNC num total(num list{*})
    VAR num sum:=0;
    FOR i FROM 1 TO Dim(list,1) DO
      sum:=sum+list{i};
    ENDFOR
    RETURN sum;
  ENDFUNC
  FUNC num through(num grid{*,*})
    RETURN sums(grid);
  ENDFUNC
  FUNC num sums(num grid{*,*})
    VAR num sum:=0;
    FOR i FROM 1 TO Dim(grid,1) DO
      FOR k FROM 1 TO Dim(grid,2) DO
        sum:=sum+grid{i,k};
      ENDFOR
    ENDFOR
    RETURN sum;
  ENDFUNC
ENDMODULE
"""
READ_NUMBER = """
MODULE m
  PROC main()
    VAR num n;
    IF StrToVal("42.5",n) AND n=42.5 SetDO do1,1;
  ENDPROC
ENDMODULE
"""
PROGRAMS = {
    "from-zero": ("rpl", FROM_ZERO),
    "own-error-names": ("rpl", OWN_ERROR_NAMES),
    "real-division": ("rpl", REAL_DIVISION),
    "given-size": ("rapid", GIVEN_SIZE),
    "read-number": ("rapid", READ_NUMBER),
}


def _read(language: str, text: str) -> ReadProgram:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(f"m.{language}", text)], language, diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return read


def _written(read: ReadProgram, target: str) -> tuple[ReadProgram, str, str]:
    diagnostics = Diagnostics()
    done = translate_program(read, target, None, None, diagnostics)
    assert not diagnostics.has_losses, [item.as_text() for item in diagnostics]
    again = Diagnostics()
    back = read_sources([source_from_bytes(file.path, file.data) for file in done.files], target, again)
    assert not again.has_errors, [item.as_text() for item in again]
    return back, entry_of(done, "main"), "\n".join(file.data.decode() for file in done.files)


@pytest.mark.parametrize("target", ["", "krl", "rapid"])
@pytest.mark.parametrize("name", PROGRAMS)
def test_the_expectation_holds(name: str, target: str) -> None:
    read = _read(*PROGRAMS[name])
    back, entry, _ = _written(read, target) if target else (read, "main", "")
    result = run_program(back.program, None, None, entry)
    assert result.status == "finished", result.fault
    assert [value for _, _, value in result.outputs] == [True]


def test_a_handler_names_the_error_of_the_target() -> None:
    _, _, text = _written(_read("rpl", OWN_ERROR_NAMES), "rapid")
    assert "ERROR (ERR_DIVZERO)" in text
    assert "division_by_zero" not in text


ARC = """
MODULE m
  CONST robtarget p:=[[400,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    %s
    MoveC Offs(p,10,10,0),Offs(p,0,20,0),v100,fine,tool0;
  ENDPROC
ENDMODULE
"""
ARC_KRL = "DEF m( )\n%s\nCIRC {X 410,Y 10,Z 400,A 0,B 0,C 180},{X 400,Y 20,Z 400,A 0,B 0,C 180}\nEND\n"


@pytest.mark.parametrize(
    ("language", "text", "target", "wanted", "unwanted"),
    [
        ("rapid", ARC % "", "krl", "", "$CIRC_TYPE"),
        ("rapid", ARC % "CirPathMode\\ObjectFrame;", "krl", "$CIRC_TYPE=#BASE", "#PATH"),
        ("krl", ARC_KRL % "", "rapid", "", "CirPathMode"),
        ("krl", ARC_KRL % "$CIRC_TYPE=#BASE", "rapid", "CirPathMode\\ObjectFrame;", "PathFrame"),
    ],
)
def test_arcs_keep_their_rule(language: str, text: str, target: str, wanted: str, unwanted: str) -> None:
    _, _, written = _written(_read(language, text), target)
    assert wanted in written
    assert unwanted not in written
