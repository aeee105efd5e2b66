"""Shifts by a count of bits that is computed."""

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """PROCEDURE main()
    VAR i, bits: INT
    bits = 0
    FOR i = 7 TO 0 STEP -2
        bits = bits BOR bit_shift_left(1, i)
    END FOR
    SET do[1] TO bits = 170
    i = 3
    SET do[2] TO bit_shift_left(5, i) = 40 AND bit_shift_right(40, i) = 5
END PROCEDURE
"""


def test_a_computed_shift() -> None:
    read = read_sources([source_from_text("p.rpl", PROGRAM)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, "vplus", "kuka_kr6r900sixx", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "vplus", Diagnostics())
    result = prove_programs(read.program, back.program, "kuka_kr6r900sixx", entry="main", to_entry="main")
    assert result.agrees, result.as_text()
