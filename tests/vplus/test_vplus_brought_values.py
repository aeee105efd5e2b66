"""Texts in other letters and powers, which V+ has no function for: programs that come along, in front of what asks."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ASKED = """PROCEDURE main()
VAR t: STRING
VAR u: STRING
VAR n: INT
SET t TO "a"
SET u TO text_upper(t)
MESSAGE u
WHILE text_upper(t) <> "AAAA"
SET t TO t & "a"
SET n TO n + 1
END WHILE
IF n = 3 OR ELSE text_lower(u) = "b" THEN SET do[1] TO ON
REPEAT
SET t TO t & "b"
UNTIL text_equal(t, "AaaaBb", TRUE)
MESSAGE text_map(t, "ab", "xy")
END PROCEDURE
"""


def test_they_are_made_anew_wherever_they_are_asked_for() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("asked.rpl", ASKED)], "rpl", diagnostics)
    written = translate_program(read, "vplus", "adept_viper_s650", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    [file] = [file for file in written.files if file.path.endswith(".v2")]
    lines = [line.strip() for line in file.data.decode("ascii").splitlines()]
    assert "CALL rpl.upper(($t), $u)" in lines  # straight into the variable that gets it
    asks = lines.index("WHILE TRUE DO")
    assert lines[asks + 1].startswith("CALL rpl.upper(($t), $t")
    back = read_sources([source_from_bytes(file.path, file.data)], "vplus", Diagnostics())
    proof = prove_programs(read.program, back.program, "adept_viper_s650")
    assert proof.agrees, proof.as_text()


POWERS = """PROCEDURE main()
VAR x: REAL
VAR n: INT
SET n TO 3
SET x TO power(1.5, n)
WHILE power(x, 0.25) < 1.5
SET x TO x + power(2.0, -n)
END WHILE
SET x TO power(x, 3)
IF x > 134.6 AND x < 134.7 THEN SET do[1] TO ON
END PROCEDURE
"""


def test_powers_of_any_exponent() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("powers.rpl", POWERS)], "rpl", diagnostics)
    written = translate_program(read, "vplus", "adept_viper_s650", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    [file] = [file for file in written.files if file.path.endswith(".v2")]
    lines = [line.strip() for line in file.data.decode("ascii").splitlines()]
    assert "CALL rpl.power(1.5, (n), x)" in lines
    assert "x = x*x*x" in lines
    back = read_sources([source_from_bytes(file.path, file.data)], "vplus", Diagnostics())
    proof = prove_programs(read.program, back.program, "adept_viper_s650")
    assert proof.agrees, proof.as_text()
