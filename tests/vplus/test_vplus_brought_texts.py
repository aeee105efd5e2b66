"""Texts in other letters, which V+ has no function for: programs that come along make them, in front of what asks."""

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
