"""A plant's own macros: they replace those of a target, what they write reads back the same, and faults are told."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from importlib import resources
from pathlib import Path

import pytest

from rpl import registry
from rpl.cli.main import run
from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError
from rpl.project import read_sources
from rpl.source import decode, source_from_text
from rpl.translation import translate_program
from rpl.writing.house import house_files
from rpl.writing.templates import TemplateError, macro_files, macro_texts

ROOT = Path(__file__).parents[2]
ARM = "abb_irb120_3_58"
SOURCE = """MODULE Cell
  CONST robtarget pPick:=[[300,50,250],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pOver:=[[300,50,350],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num nParts:=0;
  PROC main()
    ! Takes a part.
    MoveJ pOver,v200,fine,tool0;
    MoveL pPick,v100,fine,tool0;
    SetDO do1,1;
    WaitTime 0.5;
    nParts:=nParts+1;
    IF nParts>3 THEN
      nParts:=0;
    ENDIF
    MoveL pOver,v100,fine,tool0;
  ENDPROC
ENDMODULE
"""
WITH_TEMPLATES = [name for name in registry.target_names() if macro_files(registry.target_package(name))]


def translated(target: str, house: Mapping[str, str] | None = None) -> tuple[str, Diagnostics]:
    """All that is written for the target, and what was said."""
    said = Diagnostics()
    read = read_sources([source_from_text("Cell.mod", SOURCE)], "rapid", said)
    assert not said.has_errors
    done = translate_program(read, target, ARM, None, said, templates=house)
    return "\n".join(decode(file.data)[0] for file in done.files), said


def macro(head: str, *lines: str) -> str:
    return "\n".join((f"{{% macro {head} %}}", *lines, "{% endmacro %}", ""))


@pytest.mark.parametrize("target", WITH_TEMPLATES)
def test_a_plants_style_of_remarks_stands_in_every_language(target: str) -> None:
    shipped = macro_texts(registry.target_package(target))["remark"].text
    own, said = translated(target, {"own.j2": shipped.replace("{{ text }}", "{{ text | upper }}")})
    assert not said.has_errors, [item.message for item in said]
    assert "TAKES A PART." in own
    assert "TAKES A PART." not in translated(target)[0]


# How a plant wants a statement, and what then stands in the program.
OVERLAYS = [
    ("rapid", macro("wait(time, stand)", "WaitTime{{ '\\\\InPos,' if stand else ' ' }}{{ time }}; ! rest"), "; ! rest"),
    ("krl", macro("if_head(condition)", "IF ({{ condition }}) THEN"), "IF ("),
    (
        "tp",
        macro(
            "move(letter, target, speed, term, options)",
            "{{ letter }} {{ target }}  {{ speed }}  {{ term }}{{ options }}",
        ),
        "  FINE",
    ),
    ("inform", macro("move(word, tags)", "{{ word }}  {{ tags | join('  ') }}"), "MOVL  C"),
    ("urscript", macro("wait(time)", "sleep( {{ time }} )  # rest"), "sleep( 0.5 )  # rest"),
    ("vplus", macro("move(word, places)", "{{ word | lower }} {{ places }}"), "moves "),
]


@pytest.mark.parametrize(("target", "text", "expected"), OVERLAYS, ids=[one[0] for one in OVERLAYS])
def test_a_macro_of_the_plant_stands_in_place_of_the_targets(target: str, text: str, expected: str) -> None:
    plain, _ = translated(target)
    own, said = translated(target, {"own.j2": text})  # which also reads both back and compares them
    assert not said.has_errors, [item.message for item in said]
    assert expected in own
    assert expected not in plain


@pytest.mark.parametrize("target", WITH_TEMPLATES)
def test_the_targets_own_macros_as_those_of_a_plant_change_nothing(target: str) -> None:
    copies = macro_files(registry.target_package(target))
    assert translated(target, copies)[0] == translated(target)[0]


@pytest.mark.parametrize("target", WITH_TEMPLATES)
def test_each_macro_is_called_and_says_what_it_is_for(target: str) -> None:
    package = registry.target_package(target)
    folder = ROOT / "postprocessors" / target
    words = {
        node.value
        for path in folder.glob("**/*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }
    texts = macro_texts(package)
    assert [name for name in texts if name not in words] == []
    assert [name for name, one in texts.items() if not one.note] == []
    written = sum(text.count("{% macro ") for text in macro_files(package).values())
    assert written == len(texts), "a name stands twice"
    assert resources.files(package).joinpath("templates").is_dir()


FAULTS = [
    (macro("mvoe(word)", "x"), "there is no macro 'mvoe'; did you mean move?"),
    (macro("move(word, taget)", "x"), "the macro move gets no word 'taget'; did you mean target?"),
    ("{% macro move(word) %}\n{{ word \n{% endmacro %}\n", "own.j2:3: "),
    (macro("move(word)", "{{ wrod }};"), "own.j2:2: the macro move fails: 'wrod' is undefined, at the statement in"),
    (macro("move(word)", "{{ 1 // 0 }}"), "at the statement in Cell.mod:7"),
    (macro("move(word)", ""), "the macro move gives no text"),
    (macro("move(word)", "{{ word }}\a;"), "control characters"),
    ("x", "no macro stands in it"),
]


@pytest.mark.parametrize(("text", "reason"), FAULTS)
def test_a_macro_that_cannot_be_used_is_refused_with_its_place(text: str, reason: str) -> None:
    with pytest.raises(TemplateError) as found:
        translated("rapid", {"own.j2": text})
    assert reason in str(found.value)
    assert str(found.value).startswith("own.j2")


MOVE = macro_texts(registry.target_package("rapid"))["move"].text
CHANGES = [
    (MOVE.replace('{{ "\\\\WObj:=" ~ frame if frame }}', "").replace("{{ speed }}", "v5"), "MoveJ"),
    (macro("assign(target, value)", "{{ target }}:={{ value }};", "Stop;"), "Stop"),
    (macro("wait(time, stand)", "! a rest"), "IF"),
]


@pytest.mark.parametrize(("text", "place"), CHANGES)
def test_a_macro_that_writes_another_program_is_an_error(text: str, place: str) -> None:
    _, said = translated("rapid", {"own.j2": text})
    errors = [item for item in said if item.code.name == "template-changes-program"]
    assert len(errors) == 1
    assert errors[0].origin.file == "Cell.mod"
    assert errors[0].origin.line > 0


def test_what_cannot_be_read_back_is_an_error() -> None:
    _, said = translated("rapid", {"own.j2": macro("wait(time, stand)", "Wait for {{ time }} seconds ((;")})
    assert [item.code.name for item in said if item.code.name.startswith("template-")] != []


def test_a_house_may_put_its_lines_around_the_shipped_ones() -> None:
    text = (
        "{% macro module(header, remarks, name, attributes, behind, declarations, routines) %}\n"
        "! House of parts, line 4\n"
        "{{ shipped.module(header, remarks, name, attributes, behind, declarations, routines) }}\n"
        "{% endmacro %}\n"
    )
    own, said = translated("rapid", {"own.j2": text})
    assert not said.has_errors
    assert own.startswith("! House of parts, line 4\nMODULE Cell")


def test_the_folder_of_a_plant_is_looked_at(tmp_path: Path) -> None:
    names = registry.target_names()
    with pytest.raises(UsageError, match="there is no folder"):
        house_files(tmp_path / "none", "rapid", names)
    (tmp_path / "rapdi").mkdir()
    with pytest.raises(UsageError, match="did you mean rapid"):
        house_files(tmp_path, "rapid", names)
    (tmp_path / "rapdi").rename(tmp_path / "rapid")
    with pytest.raises(UsageError, match="no template for rapid"):
        house_files(tmp_path, "rapid", names)
    (tmp_path / "rapid" / "own.j2").write_text("x", "utf-8")
    assert list(house_files(tmp_path, "rapid", names).values()) == ["x"]


def test_the_command_lists_macros_and_copies_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["templates", "rapid"]) == 0
    assert "move(word, options, via, target" in capsys.readouterr().out
    assert run(["templates", "krl", "-o", str(tmp_path)]) == 0
    assert (tmp_path / "krl" / "statements.j2").read_text("utf-8").count("macro move(") == 1
    program = tmp_path / "Cell.mod"
    program.write_text(SOURCE, "utf-8")
    asked = ["translate", str(program), "--to", "krl", "--robot", ARM]
    capsys.readouterr()
    assert run([*asked]) in (0, 3)
    plain = capsys.readouterr().out
    assert run([*asked, "--templates", str(tmp_path)]) in (0, 3)
    assert capsys.readouterr().out == plain
