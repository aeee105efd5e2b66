"""Files, modules and tasks: what becomes of a project, a backup, a fragment, and of what is no RAPID."""

from __future__ import annotations

import pytest
from rapid_helpers import module, read

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.passes.scope import ProgramScope
from rpl.passes.typing import normalise, type_of
from rpl.source import source_from_text

DIALECT = registry.dialect("rapid")


def project(**files: str) -> tuple[ir.Program, Diagnostics]:
    diagnostics = Diagnostics()
    sources = [source_from_text(path.replace("__", "/") + ".mod", text) for path, text in files.items()]
    return DIALECT.read(sources, diagnostics).program, diagnostics


@pytest.mark.parametrize(
    ("written", "attributes"),
    [
        ("MODULE m", ()),
        ("MODULE m(SYSMODULE)", ("SYSMODULE",)),
        ("MODULE m (SYSMODULE,, READONLY)", ("SYSMODULE", "READONLY")),
        ("MODULE m(SYSMODULE READONLY)", ("SYSMODULE", "READONLY")),
        ("module m(sysmodule, NOVIEW, NOSTEPIN,\n VIEWONLY)", ("SYSMODULE", "NOVIEW", "NOSTEPIN", "VIEWONLY")),
    ],
)
def test_module_attributes_in_odd_forms(written: str, attributes: tuple[str, ...]) -> None:
    assert module(f"{written}\nENDMODULE\n").attributes == tuple((name, "") for name in attributes)


def test_the_load_header_is_kept() -> None:
    one = module("%%%\n  VERSION:1\n  LANGUAGE:ENGLISH\n%%%\n\nMODULE m\nENDMODULE")
    assert one.attributes == (("%VERSION", "1"), ("%LANGUAGE", "ENGLISH"))


def test_several_modules_in_a_file_and_several_files() -> None:
    program, diagnostics = project(a="MODULE a\nENDMODULE\nMODULE b\nENDMODULE", c="MODULE c\nENDMODULE")
    assert [one.name for one in program.modules] == ["a", "b", "c"]
    assert not diagnostics.items


def test_a_signal_is_what_no_module_of_the_project_declares() -> None:
    program, _ = project(
        a="MODULE a\nPROC main()\nIF ready=1 Stop;\nIF flag=1 Stop;\nENDPROC\nENDMODULE",
        b="MODULE b\nPERS num flag:=0;\nENDMODULE",
    )
    first, second = program.modules[0].routines[0].body
    assert isinstance(first, ir.If) and first.branches[0][0] == ir.Signal("digital_in", name="ready")
    assert isinstance(second, ir.If)
    assert second.branches[0][0] == ir.Binary("=", ir.Name("flag"), ir.IntLiteral(1))


def test_the_folders_of_a_backup_are_tasks() -> None:
    program, _ = project(
        RAPID__TASK1__PROGMOD__main="MODULE main1\nPROC main()\nMoveL p,v100,fine,tool0;\nENDPROC\nENDMODULE",
        RAPID__TASK1__SYSMOD__user="MODULE user(SYSMODULE)\nENDMODULE",
        RAPID__TASK2__PROGMOD__back="MODULE back\nPROC main()\nWaitTime 1;\nENDPROC\nENDMODULE",
    )
    assert program.tasks == (
        ir.Task("TASK1", "main", "motion", False, ("main1", "user")),
        ir.Task("TASK2", "main", "background", True, ("back",)),
    )
    assert [one.task for one in program.modules] == ["TASK1", "TASK1", "TASK2"]


def test_a_fragment_is_read_with_a_warning() -> None:
    result, diagnostics = read("MoveJ p10,v100,fine,tool0;\nWaitTime 1;\n", "cut out.mod")
    assert [item.code.name for item in diagnostics] == ["no-module"]
    (only,) = result.program.modules
    assert (only.name, [routine.name for routine in only.routines]) == ("cut_out", ["cut_out"])
    assert len(only.routines[0].body) == 2


def test_names_beyond_ascii() -> None:
    one = module(
        "MODULE m\nCONST jointtarget Klosställage;\n"
        "PROC main()\nMoveAbsJ Klosställage,v50,fine,tool0;\nENDPROC\nENDMODULE"
    )
    assert isinstance(one.declarations[0], ir.Variable) and one.declarations[0].name == "Klosställage"


@pytest.mark.parametrize(
    ("text", "sure"),
    [
        ("%%%\n VERSION:1\n LANGUAGE:ENGLISH\n%%%\nMODULE m\nENDMODULE", True),
        ("! made by hand\nMODULE m(SYSMODULE)\nPROC main()\nENDPROC\nENDMODULE", True),
        ("\ufeffMODULE m\nENDMODULE\n", True),
        ("PROC main()\n  MoveL p,v100,fine,tool0;\nENDPROC", True),
        ("DEF main()\nPTP HOME\nEND\n", False),
        ("PROGRAM x\nBEGIN\nEND x\n", False),
        ("module.exports = function () { return 1; };\n", False),
        ('MODULE_LICENSE("GPL");\nint main(void) { return 0; }\n', False),
        ("", False),
        ("The module m ends here. ENDMODULE", False),
    ],
)
def test_recognition_goes_by_content(text: str, sure: bool) -> None:
    found = DIALECT.recognise("x.mod", text)
    assert (found >= 60) == sure, found
    assert found == DIALECT.recognise("x.txt", text)


@pytest.mark.parametrize("filling", ["\n", "\r\n", " ", "! remark\r\n"], ids=["lines", "crlf", "blanks", "remarks"])
def test_recognition_ends_on_long_empty_texts(filling: str) -> None:
    assert DIALECT.recognise("x.dat", filling * 100_000 + "x") == 0


def test_the_predefined_data_have_their_values_and_types() -> None:
    prelude = DIALECT.prelude()
    assert prelude is not None
    values = {one.name: one for one in prelude.declarations if isinstance(one, ir.Variable)}
    speed = values["v1000"].initial
    assert isinstance(speed, ir.Aggregate)
    assert [entry for _, entry in speed.entries] == [ir.IntLiteral(n) for n in (1000, 500, 5000, 1000)]
    zone = values["z10"].initial
    assert isinstance(zone, ir.Aggregate)
    assert zone.entries[1:4] == ((None, ir.IntLiteral(10)), (None, ir.IntLiteral(15)), (None, ir.IntLiteral(15)))
    for name in ("tool0", "wobj0", "fine", "vmax", "z200", "pi", "ERR_WAIT_MAXTIME", "stEmpty", "edge"):
        assert name in values
    assert len({one.name.lower() for one in values.values()}) == len(values)


def test_the_normal_form_knows_the_components_of_all_installed_records() -> None:
    text = """MODULE m
    PROC main()
      VAR robtarget p; VAR jointtarget j; VAR tooldata t; VAR wobjdata w; VAR speeddata v; VAR zonedata z; VAR num n;
      n:=p.trans.x+p.rot.q1+p.robconf.cf4+p.extax.eax_c;
      n:=j.robax.rax_6+j.extax.eax_a+t.tframe.trans.z+t.tload.mass+t.tload.aom.q2+t.tload.ix;
      n:=w.uframe.trans.x+w.oframe.rot.q4+v.v_tcp+v.v_reax+z.pzone_tcp+z.zone_reax;
      IF t.robhold AND w.ufprog AND w.ufmec="" AND z.finep n:=0;
    ENDPROC
    ENDMODULE"""
    result, diagnostics = read(text)
    program = normalise(result.program, diagnostics)
    assert not diagnostics.items, [item.as_text() for item in diagnostics]
    one = program.modules[0]
    scope = ProgramScope(program).routine(one, one.routines[0])
    for statement in one.routines[0].body[:3]:
        assert isinstance(statement, ir.Assign)
        assert type_of(statement.value, scope) == ir.RealType()


def test_vendor_functions_take_any_arguments() -> None:
    call = 'n:=UINumEntry(\\Header:="h"\\Message:="m"\\MaxValue:=5);'
    text = f"MODULE m\nPROC main()\nVAR num n;\n{call}\nENDPROC\nENDMODULE"
    result, diagnostics = read(text)
    normalise(result.program, diagnostics)
    assert not diagnostics.items


def test_a_module_is_recognised_whose_routines_end_far_behind_its_beginning() -> None:
    point = "    MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,z1,tool0;\n"
    text = "MODULE long\n  PROC main()\n" + point * 4000 + "  ENDPROC\nENDMODULE\n"
    recognise = registry.dialect("rapid").recognise
    assert recognise("long.txt", text) == recognise("short.txt", text.replace(point, "", 3990))
