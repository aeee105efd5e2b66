"""The operator starts the module: the work of a `main` stands in the routine that is called like the file."""

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import Translation, translate_program

ARM = "abb_irb1200_5_90"
CELL = """MODULE Cell
  PROC main()
    Grip;
    SetDO do1,1;
  ENDPROC
  PROC Grip()
    SetDO do2,1;
  ENDPROC
ENDMODULE
"""


def in_krl(*texts: str) -> Translation:
    sources = [source_from_text(f"M{number}.mod", text) for number, text in enumerate(texts)]
    read = read_sources(sources, "rapid", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, "krl", ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    if len(texts) == 1:
        files = [source_from_bytes(file.path, file.data) for file in written.files]
        back = read_sources(files, "krl", Diagnostics())
        to_entry = written.renamed.get("main", "main")
        proof = prove_programs(read.program, back.program, ARM, entry="main", to_entry=to_entry)
        assert proof.agrees, proof.as_text()
    return written


def text_of(written: Translation, name: str) -> str:
    return next(file.data.decode("cp1252") for file in written.files if file.path == name)


def test_main_is_called_like_its_module() -> None:
    written = in_krl(CELL)
    assert written.renamed["main"] == "Cell"
    lines = text_of(written, "Cell.src").split()
    assert lines[:3] == ["DEF", "Cell(", ")"] and "main(" not in lines and lines[3] != "END"


def test_a_name_that_is_taken_is_left_alone() -> None:
    """RAPID refuses that itself, other languages do not."""
    written = in_krl(CELL.replace("Grip", "Cell"))
    assert "main" not in written.renamed
