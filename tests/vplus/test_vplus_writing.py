"""V+ as a target: what single steps of other languages become, and that what is written is read back the same."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr6r900_2"


def written(text: str, diagnostics: Diagnostics | None = None) -> str:
    """The V+ file of an RPL text."""
    found = diagnostics if diagnostics is not None else Diagnostics()
    read = read_sources([source_from_text("main.rpl", text)], "rpl", found)
    translation = translate_program(read, "vplus", ARM, None, found)
    (file,) = translation.files
    return file.data.decode("ascii").replace("\r\n", "\n")


def steps(body: str, data: str = "") -> list[str]:
    """The steps of one program with this body, without what stands around them."""
    lines = written(f"{data}\nPROCEDURE main()\n{body}\nEND PROCEDURE\n").split("\n")
    start = next(at for at, line in enumerate(lines) if line.startswith(".PROGRAM main"))
    end = lines.index(".END", start)
    return [line.strip() for line in lines[start + 1 : end] if not line.strip().startswith("AUTO")]


@pytest.mark.parametrize(
    ("body", "wanted"),
    [
        ("SET do[3] TO ON", ["SIGNAL 3"]),
        ("SET do[3] TO OFF", ["SIGNAL -3"]),
        ("WAIT UNTIL di[4] AND NOT di[5]", ["WAIT SIG(1004) AND NOT SIG(1005)"]),
        ("WAIT 0.5 s", ["WAIT.EVENT , 0.5"]),
        ("HALT EXIT", ["HALT"]),
        ("HALT", ["PAUSE"]),
        ('MESSAGE "ready"', ['TYPE "ready"']),
        ("n = 7 DIV 2", ["n = INT(7 / 2)"]),
        ("good = n = 1 AND m < 2", ["good = (n == 1) AND (m < 2)"]),
        ("n = to_nearest(x)", ["n = INT(x+0.5*SIGN(x))"]),
        ('s = s & "a"', ['$s = $s+"a"']),
        ('CALL BY "part" & s', ['CALLS "part"+$s']),
        ('CALL BY "part" & s PASSING (1)', ['$routine1 = "part"+$s', "CALLS $routine1(1)"]),
        ("CALL BY s PASSING (n)", ["CALLS $s(n)"]),
    ],
)
def test_steps(body: str, wanted: list[str]) -> None:
    data = "VAR n: INT\nVAR m: INT\nVAR x: REAL\nVAR good: BOOL\nVAR s: STRING"
    assert steps(body, data) == wanted


CALCULATION = """
VAR total: INT = 0
VAR table: ARRAY[4] OF INT
VAR word: STRING = "ab"

PROCEDURE main()
    VAR i: INT
    FOR i = 1 TO 4
        table[i] = i * i
    END FOR
    add(table[4], total)
    SET do[1] TO total = 16
    SET do[2] TO greatest(3, 8) = 8
    SET do[3] TO word & "c" = "abc"
    SET do[4] TO 7 MOD 4 = 3 AND NOT (total < 0)
END PROCEDURE

PROCEDURE add(by: INT, REFERENCE sum: INT)
    sum = sum + by
END PROCEDURE

FUNCTION greatest(a: INT, b: INT): INT
    IF a > b THEN RETURN a
    RETURN b
END FUNCTION
"""


@pytest.mark.parametrize("text", [CALCULATION])
def test_read_back_and_run_the_same(text: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("sums.rpl", text)], "rpl", diagnostics)
    translation = translate_program(read, "vplus", ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    sources = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(sources, "vplus", diagnostics)
    assert not diagnostics.of(Severity.ERROR)
    assert prove_programs(read.program, back.program, ARM, ARM).agrees


def test_lines_are_short_and_ascii() -> None:
    long = " + ".join(f"quantity_{number} * {number}" for number in range(1, 15))
    data = "\n".join(f"VAR quantity_{number}: REAL = {number}.5" for number in range(1, 15))
    text = written(f"VAR x: REAL\n{data}\nPROCEDURE main()\nx = {long} -- größer\nEND PROCEDURE\n")
    assert all(len(line) <= 120 for line in text.split("\n"))
    assert text.isascii()


MOVES = """
VAR spot: POSE = {x: 300, y: 50, z: 200, a: 0, b: 180, c: 0}
VAR home: JOINTS = {j1: 0, j2: -90, j3: 90, j4: 0, j5: 60, j6: 0}
VAR count: INT = 3
VAR name: STRING = "box"
"""


def test_moves_stop_by_break_and_data_stand_behind_the_programs() -> None:
    text = written(f"{MOVES}\nPROCEDURE main()\nMOVE TO home\nMOVE LINEAR TO spot\nSET do[1] TO ON\nEND PROCEDURE\n")
    lines = [line.strip() for line in text.split("\n")]
    assert lines[lines.index("MOVE #home") + 1] == "BREAK"
    assert lines[lines.index("MOVES spot") + 1] == "BREAK"
    assert "spot 300 50 200 0 180 0" in lines or "spot 300 50 200 0 180 180" in lines
    assert "#home 0 -90 90 0 60 0" in lines
    assert "count 3" in lines
    assert '$name "box"' in lines


def test_what_cannot_be_said_stops_the_program() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("a.src", "DEF a()\n  BRAKE\nEND\n")], "krl", diagnostics)
    (file,) = translate_program(read, "vplus", ARM, None, diagnostics).files
    assert [item.code.name for item in diagnostics.of(Severity.LOSS)] == ["vplus-guarded-stop"]
    assert ";BRAKE\r\n        PAUSE" in file.data.decode("ascii")


def test_a_list_in_the_place_of_a_location_is_refused() -> None:
    source = """def p():
  v = [0, 0, 0, 0, 0, 0]
  via = p[0.1, 0.2, 0.3, 0, 0, 0]
  if read_input_boolean_register(1):
    via = v
  end
  movec(via, p[0.3, 0.2, 0.3, 0, 0, 0], 1, 0.2, 0, 0)
end
"""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.script", source)], "urscript", Diagnostics())
    (file,) = translate_program(read, "vplus", ARM, None, diagnostics).files
    assert "vplus-guarded-stop" in [item.code.name for item in diagnostics.of(Severity.LOSS)]
    again = Diagnostics()
    read_sources([source_from_bytes(file.path, file.data)], "vplus", again)
    assert not again.of(Severity.ERROR)


def test_own_files_are_written_as_they_were() -> None:
    source = """.PROGRAM a(x, $t)
        AUTO n
        SPEED 50, 20 ALWAYS
        ACCEL 80, 60
        FOR n = 1 TO 3
            APPROS p:TRANS(0, 0, 5), 50
            MOVES p
            BREAK
            CLOSEI
            DEPART 50
            IF n == x GOTO 10
        END
 10
        TYPE "n is ", /I3, n, $t
        LEFTY
        MOVE p
.END
"""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("a.v2", source)], "vplus", diagnostics)
    (file,) = translate_program(read, "vplus", ARM, None, diagnostics).files
    text = file.data.decode("ascii")
    for step in ("SPEED 50, 20 ALWAYS", "ACCEL 80, 60", "MOVES p", "DEPART 50", "IF n == x GOTO 10", " 10", "LEFTY"):
        assert f"{step}\r\n" in text
    assert 'TYPE "n is ", /I3, n, $t' in text
    again = read_sources([source_from_bytes(file.path, file.data)], "vplus", Diagnostics())
    assert again.program.modules[0].routines[0].body == read.program.modules[0].routines[0].body
