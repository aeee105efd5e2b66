"""Shared by the VAL3 tests: an application of a few lines, read, looked at and run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from there_and_back import Journey

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.typing import normalise
from rpl.project import ReadProgram, read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import Source, source_from_text

ROBOT = "staubli_tx60"
_PROGRAM = """<?xml version="1.0" encoding="utf-8"?>
<Programs xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns="http://www.staubli.com/robotics/VAL3/Program/2">
  <Program name="{name}">
{head}    <Code><![CDATA[begin
{code}
end]]></Code>
  </Program>
</Programs>
"""
_DATA = """<?xml version="1.0" encoding="utf-8"?>
<Database xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns="http://www.staubli.com/robotics/VAL3/Data/2">
  <Datas>
{rows}
  </Datas>
</Database>
"""
# What most programs of the tests need: places, speeds, signals and numbers.
USUAL = (
    ("jHome", "jointRx", 'j1="0" j2="0" j3="90" j4="0" j5="90" j6="0"'),
    ("pA", "pointRx", 'x="380" y="-120" z="-100" rx="180" shoulder="righty" elbow="epositive" wrist="wpositive"'),
    ("pB", "pointRx", 'x="380" y="120" z="-100" rx="180" shoulder="righty" elbow="epositive" wrist="wpositive"'),
    ("mFast", "mdesc", 'accel="100" vel="80" decel="100" tmax="500" rmax="99999" blend="joint" leave="20" reach="20"'),
    ("mStop", "mdesc", 'accel="100" vel="80" decel="100" tmax="250" rmax="99999" blend="off" leave="20" reach="20"'),
    ("tGrip", "tool", 'z="100" fatherId="flange[0]" ioLink="valve1" otime="0.1" ctime="0.2"'),
    ("fPart", "frame", 'x="300" y="-50" z="-150" rz="30" fatherId="world[0]"'),
    ("pInPart", "pointRx", 'x="40" y="20" z="30" rx="180" fatherId="fPart[0]"'),
    ("diIn", "dio", 'link="BasicIO-1\\%I0"'),
    ("doOut", "dio", 'link="BasicIO-1\\%Q0"'),
    ("nX", "num", 'value="0"'),
    ("bX", "bool", 'value="false"'),
    ("sX", "string", 'value=""'),
)
Row = tuple[str, str, str] | tuple[str, str, str, Mapping[str, str]]  # of a list: its size, and its numbers by key
Rows = Sequence[Row]


def program(code: str, name: str = "start", head: str = "") -> Source:
    return source_from_text(f"{name}.pgx", _PROGRAM.format(name=name, code=code, head=head))


def data(rows: Rows) -> Source:
    return source_from_text("app.dtx", _DATA.format(rows="\n".join(map(_row, rows))))


def _row(row: Row) -> str:
    """One datum, or one list."""
    name, kind, value = row[:3]
    size, elements = (value, row[3]) if len(row) == 4 else ("1", {"0": value})
    shown = {key: f'value="{one}"' if len(row) == 4 else one for key, one in elements.items()}
    inner = "".join(f'<Value key="{key}" {one} />' for key, one in shown.items())
    return f'    <Data name="{name}" access="private" xsi:type="array" type="{kind}" size="{size}">{inner}</Data>'


def sources(code: str | Mapping[str, str], rows: Rows = ()) -> list[Source]:
    """The files of an application: programs by name (a bare text is `start`; a header is cut off at a line `---`)."""
    named = {"start": code} if isinstance(code, str) else code
    files = []
    for name, text in named.items():
        head, cut, body = text.rpartition("---\n")
        files.append(program(body if cut else text, name, head))
    return [data((*USUAL, *rows)), *files]


def read(code: str | Mapping[str, str], rows: Rows = ()) -> tuple[ir.Program, Diagnostics]:
    """The program and what was reported."""
    diagnostics = Diagnostics()
    found = registry.dialect("val3").read(sources(code, rows), diagnostics)
    return normalise(found.program, diagnostics), diagnostics


def codes(diagnostics: Diagnostics, least: Severity = Severity.WARNING) -> list[str]:
    return [item.code.name for item in diagnostics if item.severity >= least]


def body(code: str, rows: Rows = ()) -> ir.Body:
    """The statements of `start`, which reads without a report."""
    made, diagnostics = read(code, rows)
    assert not codes(diagnostics), [item.as_text() for item in diagnostics]
    return next(one.body for module in made.modules for one in module.routines if one.name == "start")


def run(code: str | Mapping[str, str], rows: Rows = (), limit_s: float = 60.0) -> RunResult:
    made, diagnostics = read(code, rows)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return run_program(made, ROBOT, None, "start", limit_s)


def outputs(result: RunResult) -> list[tuple[str, object]]:
    """What the run switched, in order."""
    return [(name, value) for _, name, value in result.as_json()["outputs"]]


def application(code: str | Mapping[str, str], rows: Rows = ()) -> ReadProgram:
    return read_sources(sources(code, rows), "val3", Diagnostics())


__all__ = ["Journey", "application", "body", "codes", "outputs", "read", "run", "sources"]
