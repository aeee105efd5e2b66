"""Shared by the tests of the TP reader: listings put together, read, shown as RPL, run."""

from __future__ import annotations

from rpl import ir, registry
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.writing.target import WriteContext

ROBOT = "fanuc_lrmate200id"
HOME = (
    "P[1]{\n   GP1:\n\tUF : 0, UT : 1,\t\n\tJ1= 0.000 deg,\tJ2= 0.000 deg,\tJ3= 0.000 deg,\n"
    "\tJ4= 0.000 deg,\tJ5= -90.000 deg,\tJ6= 0.000 deg\n};\n"
)


def cartesian(
    number: int, x: float, y: float, z: float, config: str = "N U T, 0, 0, 0", frame: str = "0", tool: str = "1"
) -> str:
    """A position with the tool pointing down."""
    return (
        f"P[{number}]{{\n   GP1:\n\tUF : {frame}, UT : {tool},\t\tCONFIG : '{config}',\n"
        f"\tX = {x:.3f}  mm,\tY = {y:.3f}  mm,\tZ = {z:.3f}  mm,\n"
        f"\tW = 180.000 deg,\tP = 0.000 deg,\tR = 0.000 deg\n}};\n"
    )


POINTS = HOME + cartesian(2, 400, 100, 200) + cartesian(3, 400, -100, 200) + cartesian(4, 430, 0, 150)


def listing(lines: str, points: str = POINTS, name: str = "MAIN", kind: str = "", german: bool = False) -> str:
    """A whole listing from the statements, one on each line, without numbers and semicolons."""
    numbered = []
    for number, line in enumerate(lines.strip("\n").splitlines(), 1):
        text = line.strip()
        if text.startswith(":"):
            numbered[-1] = numbered[-1].removesuffix(" ;") + f"\n    :  {text[1:].strip()} ;"
        else:
            gap = "" if text[:2] in ("J ", "L ", "C ", "A ", "S ") else "  "
            numbered.append(f"{number:4d}:{gap}{text} ;")
    head = f"/PROG  {name}{' ' + kind if kind else ''}\n/ATTR\n"
    head += 'KOMMENTAR\t= "Probe";\nKONTROLLCODE\t= 00000000 00000000;\n' if german else 'COMMENT\t\t= "test";\n'
    return head + "/MN\n" + "\n".join(numbered) + "\n/POS\n" + points + "/END\n"


def read(*texts: str | bytes) -> tuple[ir.Program, Diagnostics]:
    """The program of some listings and dumps."""
    diagnostics = Diagnostics()
    sources = [
        source_from_text(f"file{n}.ls", text) if isinstance(text, str) else source_from_bytes(f"file{n}.ls", text)
        for n, text in enumerate(texts)
    ]
    return read_sources(sources, "tp", diagnostics).program, diagnostics


def reports(diagnostics: Diagnostics, least: Severity = Severity.WARNING) -> list[str]:
    return [item.code.name for item in diagnostics if item.severity >= least]


def as_rpl(program: ir.Program) -> str:
    """The program as RPL text."""
    files = registry.target("rpl").write(program, WriteContext(Diagnostics()))
    return "\n".join(file.data.decode("utf-8") for file in files)


def body(lines: str, *more: str, points: str = POINTS) -> list[str]:
    """The statements of a listing as lines of RPL, without indentation."""
    program, diagnostics = read(listing(lines, points), *more)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    text = as_rpl(program).partition("PROCEDURE MAIN")[2].partition("END PROCEDURE")[0]
    skip = ("CONST ", "VAR ", "PERSISTENT ")
    return [line.strip() for line in text.splitlines()[1:] if line.strip() and not line.strip().startswith(skip)]


def run(*texts: str, cell: str = "", robot: str | None = ROBOT, entry: str = "MAIN") -> RunResult:
    """Run listings; the first routine named MAIN is the entry."""
    program, diagnostics = read(*texts)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return run_program(program, robot, parse_cell(cell) if cell else None, entry, 120.0)


def outputs(result: RunResult) -> list[tuple[str, object]]:
    """Changes of outputs in order, without their times."""
    return [(name, value) for _, name, value in result.outputs]
