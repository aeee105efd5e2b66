"""What a cell file does to a run."""

import pytest
from helpers import krl, rapid

from rpl.errors import RplError, UsageError


def test_initial_values_of_variables_records_and_elements() -> None:
    data = "PERS num count:=1;\nPERS pos place:=[1,2,3];\nVAR num list{3}:=[1,2,3];\nVAR robtarget p;"
    body = 'TPWrite ValToStr(count)+"/"+ValToStr(place)+"/"+ValToStr(list)+"/"+ValToStr(p.trans.z);'
    cell = "[variables]\ncount = 5\n'prog.place' = [7, 8, 9]\n'list[2]' = 20\n'p.trans.z' = 4.5\n"
    assert rapid(body, data, cell=cell).messages == ("5/[7,8,9]/[1,20,3]/4.5",)


def test_numeric_tools_and_system_variables() -> None:
    body = 'BAS(#TOOL,3)\nMsgNotify("%1 %2","",$TOOL.Z,$VEL.CP)'
    cell = (
        "[variables]\n'TOOL_DATA[3]' = { x = 0, y = 0, z = 120.0, a = 0, b = 0, c = 0 }\n[system]\npath_speed = 500.0\n"
    )
    assert krl(body, cell=cell).messages == ("120 0.5",)


@pytest.mark.parametrize(
    ("entry", "complaint"),
    [("count = 'x'", "variables.count"), ("'list[9]' = 1", "variables.list"), ("place = [1, 2]", "variables.place")],
)
def test_a_value_that_does_not_fit_names_its_key(entry: str, complaint: str) -> None:
    data = "PERS num count:=1;\nPERS pos place:=[1,2,3];\nVAR num list{3}:=[1,2,3];"
    with pytest.raises(UsageError, match=complaint):
        rapid("count:=list{1}+place.x;", data, cell=f"[variables]\n{entry}\n")


def test_a_signal_is_found_by_any_usual_name() -> None:
    for name in ("$IN[3]", "di3", "DI_3", "digital_in[3]"):
        cell = f"[[input]]\ntime = 1.0\nsignal = '{name}'\nvalue = true\n"
        assert krl("WAIT FOR $IN[3]\n$OUT[1]=TRUE", cell=cell).outputs[0][0] == 1.0
        if name.lower() != "di_3":
            assert rapid("WaitDI di3,1;\nSetDO do1,1;", cell=cell).outputs[0][0] == 1.0


def test_answers_by_text_and_after_a_time() -> None:
    cell = "[[answer]]\ntext = 'parts'\nanswer = 2\nafter = 1.5\n[[answer]]\nanswer = 3\n"
    body = 'TPReadNum n,"how many parts?";\nTPReadNum m,"what else?";\nTPWrite NumToStr(n*10+m,0);'
    result = rapid(body, "VAR num n;\nVAR num m;", cell=cell)
    assert result.messages == ("how many parts?", "what else?", "23") and result.time_s == 1.5
    typed = rapid(body, "VAR num n;\nVAR num m;", cell=cell.replace("answer = 3", "answer = '3'"))
    assert typed.messages == result.messages
    with pytest.raises(RplError, match="takes a number"):
        rapid(body, "VAR num n;\nVAR num m;", cell=cell.replace("answer = 3", "answer = 'three'"))


def test_the_value_of_a_vendor_function() -> None:
    body = "TPWrite NumToStr(OpMode(),0);"
    assert rapid(body, cell="[[vendor]]\nmatch='OpMode'\nvalue=1\n").messages == ("1",)
    unknown = rapid(body)
    assert unknown.status == "fault" and unknown.fault is not None and unknown.fault.code == "vendor"


def test_where_the_robot_stands_at_the_start() -> None:
    cell = "joints = [10, -90, 90, 0, 45, 0]"
    body = 'MsgNotify("%1","",$AXIS_ACT.A1)'
    assert krl(body, cell=cell, robot="kuka_kr6r900sixx").messages == ("10",)
    with pytest.raises(UsageError, match="joints"):
        krl(body, cell="joints = [1, 2]", robot="kuka_kr6r900sixx")


def test_a_reaction_does_not_come_at_times_that_are_left_out() -> None:
    """A gripper that misses twice: the third time its switch comes."""
    reaction = "[[reaction]]\nwhen = '$OUT[1]'\nafter = 0.1\nsignal = '$IN[1]'\nvalue = true\nexcept = [1, 2]\n"
    body = "TRIES=0\nREPEAT\n$OUT[1]=FALSE\n$OUT[1]=TRUE\nTRIES=TRIES+1\nWAIT SEC 0.3\nUNTIL $IN[1]\n"
    shown = 'MsgNotify("%1","",TRIES)'
    assert krl(f"{body}{shown}", "DECL INT TRIES", cell=reaction).messages == ("3",)
    twice = reaction + reaction  # one answer that is said twice counts once
    assert krl(f"{body}{shown}", "DECL INT TRIES", cell=twice).messages == ("3",)


@pytest.mark.parametrize("given", ["3", "[0]", "[1.5]", "[true]", "['first']"])
def test_times_that_are_left_out_are_whole_numbers_from_one(given: str) -> None:
    reaction = f"[[reaction]]\nwhen = '$OUT[1]'\nsignal = '$IN[1]'\nvalue = true\nexcept = {given}\n"
    with pytest.raises(UsageError, match=r"reaction\[1\].except"):
        krl("$OUT[1]=TRUE", cell=reaction)
