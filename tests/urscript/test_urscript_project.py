"""Projects, recognition by content, saved programs of the pendant, kept bytes, poses in the language's notation."""

from __future__ import annotations

import gzip
import tomllib
from pathlib import Path

import numpy as np
import pytest
from urscript_helpers import codes, read, routine, run, variable

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.emulator.model import load_robot
from rpl.errors import SourceError
from rpl.project import read_program, recognise
from rpl.reading.assemble import assemble
from rpl.source import source_from_text

SAMPLES = sorted(path.parent for path in (Path(__file__).parents[2] / "samples" / "urscript").glob("*/expected.toml"))


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.name)
def test_samples_read_without_a_report(sample: Path) -> None:
    files = {path.name: path.read_text("utf-8") for path in sorted(sample.glob("*.script"))}
    program, diagnostics = read(files)
    assert not [item.as_text() for item in diagnostics]
    wanted = tomllib.loads((sample / "expected.toml").read_text("utf-8"))
    assert program.entry == wanted["entry"]
    assert "quick" in wanted or any("Expected" in text for text in files.values())


def test_files_share_globals_and_functions() -> None:
    result = run(
        {
            "main_part.script": "def program():\nraise_(step)\nset_digital_out(0, height == 5)\nend\n",
            "shared.script": "global step = 2\nglobal height = 3\ndef raise_(by):\nheight = height + by\nend\n",
        }
    )
    assert [(name, state) for _, name, state in result.outputs] == [("digital_out[0]", True)]


RECOGNISED = [
    ("def p():\n  movej([0,0,0,0,0,0])\nend\n", "urscript"),
    ("def helper(a, b=1):\n  return a + b\nend\n", "urscript"),
    ("movej(p[0.1,0.2,0.3,0,0,0], a=1, v=1)\nset_digital_out(0, True)\n", "urscript"),
    ("global x = 1\nlocal y = p[0,0,0,0,0,0]\n", "urscript"),
    ("sec s():\n  set_digital_out(0, True)\nend\n", "urscript"),
    ("DEF P( )\nPTP HOME\nEND\n", "krl"),
    ("DEF P(A:IN)\nLIN X1\nEND\n", "krl"),
    ("import sys\n\ndef main():\n    print(sys.argv)\n\nfor x in main():\n    pass\n", None),
]


@pytest.mark.parametrize(("text", "wanted"), RECOGNISED)
def test_the_language_is_known_by_its_content(text: str, wanted: str | None) -> None:
    assert recognise(source_from_text("p.txt", text))[0] == wanted


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.name)
def test_every_sign_of_a_source_is_accounted_for(sample: Path) -> None:
    from rpl.dialects.urscript.splitter import split
    from rpl.dialects.urscript.syntax import Syntax, parser

    for path in sample.glob("*.script"):
        for text in (path.read_text("utf-8"), path.read_text("utf-8").replace("\n", "\r\n").replace("(", "((", 3)):
            source, diagnostics = source_from_text("p.script", text), Diagnostics()
            syntax = Syntax(diagnostics)
            done = assemble(source, "urscript", split(source), parser(), syntax.lower, syntax.build, diagnostics)
            assert not done.ledger.gaps()
            assert done.ledger.rebuilt() == text


SAVED = """<URProgram name="two points" createdIn="5.11.0">
  <children>
    <SpecialSequence type="BeforeStart"><children>
      <Assignment valueSource="Expression"><variable name="count"/>
        <expression><ExpressionChar character="0"/></expression></Assignment>
    </children></SpecialSequence>
    <MainProgram runOnlyOnce="true"><children>
      <Comment comment="go there"/>
      <Move motionType="MoveJ" speed="1.05" acceleration="1.4"><children>
        <Waypoint type="Fixed" name="first"><position><JointAngles angles="0, -1.57, -1.57, -1.57, 1.57, 0"/></position>
        </Waypoint></children></Move>
      <If type="If"><expression>
        <ExpressionVariable><ProgramVariable
          reference="../../../../../../SpecialSequence/children/Assignment/variable"/></ExpressionVariable>
        <ExpressionChar character="&#8799;"/><ExpressionChar character="0"/></expression>
        <children><Wait type="Sleep"><waitTime>0.5</waitTime></Wait></children></If>
      <If type="Else"><children><Halt/></children></If>
      <Script type="Line"><expression><ExpressionToken token="set_digital_out"/><ExpressionChar character="("/>
        <ExpressionChar character="1"/><ExpressionChar character=","/><ExpressionToken token="True"/>
        <ExpressionChar character=")"/></expression></Script>
      <Popup type="Message" message="done" haltProgram="false"/>
      <Contributed strategyProgramNodeType="Gripper"/>
    </children></MainProgram>
  </children>
</URProgram>"""


def test_a_saved_program_is_read_from_its_nodes(tmp_path: Path) -> None:
    file = tmp_path / "two_points.urp"
    file.write_bytes(gzip.compress(SAVED.encode()))
    diagnostics = Diagnostics()
    found = read_program([file], diagnostics=diagnostics)
    assert found.dialects == ("urscript",)
    assert codes(diagnostics, Severity.INFO) == ["urscript-pendant-node", "urscript-pendant"] or sorted(
        codes(diagnostics, Severity.INFO)
    ) == ["urscript-pendant", "urscript-pendant-node"]
    made = [type(s).__name__ for s in routine(found.program, "two_points").body]
    assert made == ["Move", "If", "Assign", "Message", "Vendor"]
    assert variable(found.program, "count").initial == ir.IntLiteral(0)


def test_a_damaged_saved_program_is_refused_politely(tmp_path: Path) -> None:
    file = tmp_path / "broken.urp"
    file.write_bytes(gzip.compress(b'<URProgram name="x"><children></URProgram>'))
    diagnostics = Diagnostics()
    read_program([file], diagnostics=diagnostics)
    assert codes(diagnostics, Severity.ERROR) == ["urscript-pendant-damaged"]


def test_a_pose_in_the_notation_reads_back() -> None:
    make = registry.dialect("urscript").notation
    assert make is not None
    notation, model = make(), load_robot("ur5e")
    matrix = model.forward(np.array([10.0, -80.0, 70.0, -90.0, 45.0, 5.0]))
    text = notation.format_pose(model, matrix, None)
    assert text.startswith("p[")
    again, flags = notation.parse_pose(text)
    assert flags == {} and np.allclose(again, matrix, atol=1e-5)
    with pytest.raises(SourceError):
        notation.parse_pose("p[1, 2]")


def test_a_pose_is_reached_by_the_nearest_solution() -> None:
    make = registry.dialect("urscript").notation
    assert make is not None
    model = load_robot("ur5e")
    joints = np.array([30.0, -80.0, 70.0, -90.0, -60.0, 200.0])
    chosen = make().select(model, model.forward(joints), {}, joints + 2.0)
    assert chosen.joints is not None and np.allclose(chosen.joints, joints, atol=1e-4)


NAMES = [
    ("digital_out", 1, "digital_out[0]"),
    ("digital_in", 8, "digital_in[7]"),
    ("digital_out", 9, "config_out[0]"),
    ("digital_in", 18, "tool_in[1]"),
    ("analog_in", 2, "analog_in[1]"),
    ("analog_in", 3, "tool_analog_in[0]"),
    ("flag", 1, "flag[0]"),
]


@pytest.mark.parametrize(("kind", "number", "name"), NAMES)
def test_signals_have_the_names_of_the_pendant(kind: str, number: int, name: str) -> None:
    assert registry.dialect("urscript").signal_name(kind, number) == name
