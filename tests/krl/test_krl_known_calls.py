"""Inline forms whose data is known are the settings that they make; where the run decides, the call stays."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.errors.bookkeeping import without_bookkeeping
from rpl.passes.legalise.errors.declaredvalues import declared_values
from rpl.passes.legalise.errors.knowncalls import known_calls
from rpl.passes.legalise.errors.prelude import link_prelude
from rpl.passes.legalise.errors.usedelements import used_elements
from rpl.passes.legalise.storage.unused import drop_unused
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
POINT = "X 400.0,Y 50.0,Z 500.0,A 0.0,B 90.0,C 0.0,S 2,T 3"
DATA = f"""DEFDAT forms PUBLIC
DECL GLOBAL E6POS XP1={{{POINT}}}
DECL FDAT FP1={{TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE,POINT2[] " ",TQ_STATE FALSE}}
DECL FDAT FP2={{TOOL_NO 2,BASE_NO 0,IPO_FRAME #BASE,POINT2[] " ",TQ_STATE FALSE}}
DECL PDAT PPDAT1={{VEL 100.0,ACC 100.0,APO_DIST 20.0,GEAR_JERK 50.0}}
DECL LDAT LCPDAT1={{VEL 2.0,ACC 50.0,APO_DIST 12.0,APO_FAC 50.0,ORI_TYP #VAR}}
DECL INT N=1
DECL REAL SPEED=0.3
ENDDAT
"""
CONFIG = """DEFDAT $CONFIG PUBLIC
TOOL_DATA[1]={X 0.0,Y 0.0,Z 130.0,A 0.0,B 0.0,C 0.0}
TOOL_DATA[2]={X 0.0,Y 20.0,Z 90.0,A 0.0,B 0.0,C 0.0}
BASE_DATA[2]={X 30.0,Y -20.0,Z 15.0,A 0.0,B 0.0,C 0.0}
ENDDAT
"""
JOINT = "PDAT_ACT=PPDAT1\nFDAT_ACT=FP{}\nBAS(#PTP_PARAMS,{})\nPTP XP1\n"
PATH = "LDAT_ACT=LCPDAT1\nFDAT_ACT=FP{}\nBAS(#CP_PARAMS,{})\nLIN_REL {{Z {}}} C_DIS\n"


def program_of(body: str, more: str = "", data: str = DATA) -> ir.Program:
    texts = {"forms.src": f"DEF forms()\n{body}\nEND\n{more}", "forms.dat": data, "$config.dat": CONFIG}
    diagnostics = Diagnostics()
    found = read_sources([source_from_text(name, text) for name, text in texts.items()], "krl", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return found.program


def evaluated(program: ir.Program) -> ir.Program:
    target = registry.target("rapid")
    context = Context("krl", "rapid", target.capabilities(), Diagnostics())
    context.taken |= names_in(program)
    passes = (link_prelude, known_calls, drop_unused, without_bookkeeping, used_elements, declared_values, drop_unused)
    for one in passes:
        program = one(program, context)
    return program


def calls(program: ir.Program, routine: str = "forms") -> list[str]:
    found = [one for module in program.modules for one in module.routines if one.name.lower() == routine]
    return [one.name for one in walk(*found) if isinstance(one, ir.Call | ir.CallRoutine)]


def settings_of(program: ir.Program) -> dict[str, ir.Expression]:
    """What the routine sets last, by the name of the setting."""
    body = next(one for one in program.modules[0].routines if one.name.lower() == "forms").body
    return {
        one.target.name: one.value for one in body if isinstance(one, ir.Assign) and isinstance(one.target, ir.System)
    }


def test_a_form_is_its_settings_with_tools_and_frames_by_name() -> None:
    done = evaluated(program_of(JOINT.format(1, 60)))
    found = settings_of(done)
    assert (found["tool"], found["base"]) == (ir.Name("TOOL_DATA1"), ir.Name("BASE_DATA2"))
    assert found["joint_speed"] == ir.RealLiteral(60.0)
    assert not calls(done)


def test_data_of_forms_is_gone_and_tables_are_declared_with_their_values() -> None:
    done = evaluated(program_of(JOINT.format(1, 60) + PATH.format(2, 0.4, 30)))
    declared = {one.name: one for module in done.modules for one in module.declarations if isinstance(one, ir.Variable)}
    assert {"TOOL_DATA1", "TOOL_DATA2", "BASE_DATA2", "XP1"} <= declared.keys()
    assert not {"FDAT_ACT", "PDAT_ACT", "LDAT_ACT", "FP1", "PPDAT1", "LCPDAT1"} & declared.keys()
    assert declared["TOOL_DATA1"].initial is not None
    assert not any(isinstance(one, ir.Initialise) for module in done.modules for one in module.declarations)


FORM_8 = (
    "SPTP XP1 WITH $VEL_AXIS[1]=SVEL_JOINT(70.0),$TOOL=STOOL2(FP1),$BASE=SBASE(FP1.BASE_NO),"
    "$IPO_MODE=SIPO_MODE(FP1.IPO_FRAME),$LOAD=SLOAD(FP1.TOOL_NO),$ACC_AXIS[1]=SACC_JOINT(PPDAT1),"
    "$APO=SAPO_PTP(PPDAT1),$GEAR_JERK[1]=SGEAR_JERK(PPDAT1),$COLLMON_TOL_PRO[1]=USE_CM_PRO_VALUES(0)"
)


def test_a_form_of_kss_8_calls_nothing() -> None:
    done = evaluated(program_of(FORM_8))
    (move,) = (one for one in walk(*done.modules) if isinstance(one, ir.Move))
    given = {place.name: value for place, value in move.settings if isinstance(place, ir.System)}
    assert (given["tool"], given["base"]) == (ir.Name("TOOL_DATA1"), ir.Name("BASE_DATA2"))
    assert given["joint_speed"] == ir.RealLiteral(70.0)
    assert given["blend_joint"] == ir.RealLiteral(20.0)
    assert all(isinstance(place, ir.System) for place, _ in move.settings)
    assert not calls(done)


LATER = "DEF later()\nFDAT_ACT=FP2\nEND\n"


@pytest.mark.parametrize(
    ("body", "more"),
    [
        ("PDAT_ACT=PPDAT1\nIF $IN[1] THEN\nFDAT_ACT=FP2\nELSE\nFDAT_ACT=FP1\nENDIF\nBAS(#FRAMES,0)", ""),
        ("FDAT_ACT=FP1\nLOOP\nBAS(#FRAMES,0)\nFDAT_ACT=FP2\nENDLOOP", ""),
        ("FDAT_ACT=FP1\nlater()\nBAS(#FRAMES,0)", LATER.replace("FP2", "FP2\nFDAT_ACT.TOOL_NO=N\nN=N+1")),
        ("FP1.TOOL_NO=2\nFDAT_ACT=FP1\nBAS(#FRAMES,0)", ""),
        ("FDAT_ACT=FP1\nchange(FP1)\nFDAT_ACT=FP1\nBAS(#FRAMES,0)", "DEF change(F:OUT)\nFDAT F\nF.BASE_NO=1\nEND\n"),
        (
            "INTERRUPT DECL 5 WHEN $IN[1] DO later()\nINTERRUPT ON 5\nFDAT_ACT=FP1\nWAIT SEC 1\nBAS(#FRAMES,0)",
            LATER,
        ),
    ],
)
def test_what_the_run_decides_stays_a_call(body: str, more: str) -> None:
    assert "BAS" in calls(evaluated(program_of(body, more)))


@pytest.mark.parametrize(
    ("body", "name"),
    [
        ("IF $IN[1] THEN\nFDAT_ACT=FP1\nELSE\nFDAT_ACT=FP1\nENDIF\nBAS(#FRAMES,0)", "TOOL_DATA1"),
        ("FDAT_ACT=FP1\nlater()\nBAS(#FRAMES,0)", "TOOL_DATA2"),
        ("FDAT_ACT=FP1\nWHILE $IN[1]\nBAS(#FRAMES,0)\nENDWHILE\nBAS(#FRAMES,0)", "TOOL_DATA1"),
        ("BAS(#TOOL,N+1)", "TOOL_DATA2"),
    ],
)
def test_what_all_ways_agree_on_is_known(body: str, name: str) -> None:
    done = evaluated(program_of(body, LATER))
    assert settings_of(done)["tool"] == ir.Name(name)


def test_a_speed_that_a_person_has_named_keeps_its_name() -> None:
    found = settings_of(evaluated(program_of("BAS(#VEL_CP,SPEED)")))
    assert ir.Name("SPEED") in list(walk(found["path_speed"]))


def test_the_own_routine_of_a_project_is_called() -> None:
    own = "GLOBAL DEF BAS(C:IN,V:IN)\nBAS_COMMAND C\nREAL V\n$OUT[1]=TRUE\nEND\n"
    assert calls(evaluated(program_of("BAS(#INITMOV,0)", own))) == ["BAS"]


STEPS: tuple[Callable[[int, int], str], ...] = (
    lambda a, b: JOINT.format(1 + a % 2, 20 + b),
    lambda a, b: PATH.format(1 + a % 2, 0.1 + b / 20, 10 - a),
    lambda a, b: f"FDAT_ACT=FP{1 + a % 2}\n",
    lambda a, b: f"FDAT_ACT.BASE_NO={2 * (b % 2)}\n",
    lambda a, b: "BAS(#FRAMES,0)\n",
    lambda a, b: f"BAS(#TOOL,{a % 3})\n",
    lambda a, b: f"IF N<{a % 3} THEN\n{JOINT.format(1, 30)}ENDIF\n",
    lambda a, b: f"FOR N=1 TO {1 + a % 2}\nBAS(#BASE,2)\nFDAT_ACT=FP{1 + b % 2}\nLIN_REL {{X {5 - a}}}\nENDFOR\n",
    lambda a, b: "later()\n",
    lambda a, b: f"BAS(#VEL_CP,{0.1 + b / 10})\n",
    lambda a, b: FORM_8 + "\n",
)
STEP = st.builds(lambda make, a, b: make(a, b), st.sampled_from(STEPS), st.integers(0, 9), st.integers(0, 20))


def driven(run: RunResult) -> list[tuple[float, object]]:
    return [(round(one.t, 6), one.data["joints"]) for one in run.trace if one.kind == "move"]


@settings(max_examples=8, derandomize=True, deadline=None)
@given(st.lists(STEP, min_size=2, max_size=5))
def test_a_program_runs_to_the_same_trace(steps: list[str]) -> None:
    program = program_of("BAS(#INITMOV,0)\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}\n" + "".join(steps), LATER)
    before, after = (run_program(one, ROBOT, entry="forms", max_time_s=120.0) for one in (program, evaluated(program)))
    assert driven(before) == driven(after)
    assert before.status == after.status


HOME_8 = (
    ";FOLD SPTP HOME Vel=100 % DEFAULT ;%{PE}\n;FOLD Parameters ;%{h}\n"
    ";Params IlfProvider=kukaroboter.basistech.inlineforms.movement.spline; Kuka.PointName=HOME\n;ENDFOLD\n"
    "SPTP XHOME WITH $VEL_AXIS[1]=SVEL_JOINT(100.0),$TOOL=STOOL2(FHOME),$BASE=SBASE(FHOME.BASE_NO),"
    "$IPO_MODE=SIPO_MODE(FHOME.IPO_FRAME),$LOAD=SLOAD(FHOME.TOOL_NO),$ACC_AXIS[1]=SACC_JOINT(PDEFAULT),"
    "$APO=SAPO_PTP(PDEFAULT),$GEAR_JERK[1]=SGEAR_JERK(PDEFAULT),$COLLMON_TOL_PRO[1]=USE_CM_PRO_VALUES(0)\n;ENDFOLD\n"
)


def written(files: dict[str, str]) -> tuple[list[str], Diagnostics]:
    """The lines in RAPID, remarks and empty ones left out."""
    diagnostics = Diagnostics()
    found = read_sources([source_from_text(name, text) for name, text in files.items()], "krl", diagnostics)
    done = translate_program(found, "rapid", ROBOT, None, diagnostics)
    lines = [line.strip() for file in done.files for line in file.data.decode().splitlines()]
    return [line for line in lines if line and not line.startswith("!")], diagnostics


def test_two_forms_are_two_moves() -> None:
    init = "GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )\nINTERRUPT ON 3\nBAS(#INITMOV,0)\n"
    lines, _ = written({"home8.src": f"DEF home8( )\n{init}{HOME_8 * 2}END\n"})
    assert "\n".join(["MoveAbsJ XHOME,vmax,fine,tool0;"] * 2 + ["ENDPROC"]) in "\n".join(lines)
    assert [line.split(":=")[0] for line in lines if "PERS" in line] == ["PERS jointtarget XHOME"]


def test_what_a_program_does_not_use_of_the_controllers_data_is_left_out() -> None:
    """The controller's list declares the data and records of forms itself, and hides those of the prelude."""
    config = CONFIG.replace(
        "DEFDAT $CONFIG PUBLIC\n",
        "DEFDAT $CONFIG PUBLIC\nSTRUC FDAT INT TOOL_NO,BASE_NO,IPO_M_T IPO_FRAME,CHAR POINT2[24],BOOL TQ_STATE\n"
        "DECL FDAT FDAT_ACT\nDECL FRAME TOOL_DATA[16]\nDECL FRAME BASE_DATA[32]\nDECL INT OTHERS=5\nDECL E6AXIS XFAR\n",
    )
    source = f"DEF forms()\nBAS(#INITMOV,0)\n{JOINT.format(1, 60)}END\n"
    lines, diagnostics = written({"forms.src": source, "forms.dat": DATA, "$config.dat": config})
    (move,) = (line for line in lines if line.startswith("MoveJ"))
    assert move.startswith("MoveJ XP1,v1000,fine,")
    assert "[0,0,130]" in "".join(lines)
    assert "[30,-20,15]" in "".join(lines)
    text = "\n".join(lines)
    assert not [name for name in ("FDAT", "OTHERS", "XFAR", "[0.0,20.0,90.0]", "rpl_initialise") if name in text]
    (told,) = (item.as_text() for item in diagnostics if item.code.name == "controller-data-left-out")
    assert "$CONFIG" in told
