"""How RAPID writes the neutral built-in functions: a pattern over the printed arguments, or a printer of its own.

In a pattern `{0}` is the first argument. Sources as in the dialect's function table, of which this is the inverse.
"""

from __future__ import annotations

from rpl import ir

# Function -> pattern for each count of arguments that it can be written with.
# Options of StrToByte by the base.
BYTE_BASES = {16: "Hex", 8: "Okt", 2: "Bin"}

FUNCTIONS: dict[str, dict[int, str]] = {
    "abs": {1: "Abs({0})"},
    "sqrt": {1: "Sqrt({0})"},
    "sin": {1: "Sin({0})"},
    "cos": {1: "Cos({0})"},
    "tan": {1: "Tan({0})"},
    "asin": {1: "ASin({0})"},
    "acos": {1: "ACos({0})"},
    "atan": {1: "ATan({0})"},
    "atan2": {2: "ATan2({0},{1})"},
    "exp": {1: "Exp({0})"},
    "power": {2: "Pow({0},{1})"},
    "round": {1: "Round({0})", 2: "Round({0}\\Dec:={1})"},
    "trunc": {1: "Trunc({0})", 2: "Trunc({0}\\Dec:={1})"},
    "min": {2: "Min({0},{1})"},
    "max": {2: "Max({0},{1})"},
    "bit_shift_left": {2: "BitLSh({0},{1})"},  # of a byte: RAPID's own bit masks, by a computed position
    "bit_shift_right": {2: "BitRSh({0},{1})"},
    "dimension": {2: "Dim({0},{1})"},
    "offset": {4: "Offs({0},{1},{2},{3})"},
    "tool_offset": {
        4: "RelTool({0},{1},{2},{3})",
        5: "RelTool({0},{1},{2},{3}\\Rx:={4})",
        6: "RelTool({0},{1},{2},{3}\\Rx:={4}\\Ry:={5})",
        7: "RelTool({0},{1},{2},{3}\\Rx:={4}\\Ry:={5}\\Rz:={6})",
    },
    "current_target": {0: "CRobT()", 1: "CRobT(\\Tool:={0})", 2: "CRobT(\\Tool:={0}\\WObj:={1})"},
    "current_position": {0: "CPos()", 1: "CPos(\\Tool:={0})", 2: "CPos(\\Tool:={0}\\WObj:={1})"},
    "current_joints": {0: "CJointT()"},
    "current_tool": {0: "CTool()"},
    "current_frame": {0: "CWObj()"},
    "joints_to_target": {2: "CalcRobT({0},{1})", 3: "CalcRobT({0},{1}\\WObj:={2})"},
    "target_to_joints": {2: "CalcJointT({0},{1})", 3: "CalcJointT({0},{1}\\WObj:={2})"},
    "compose": {2: "PoseMult({0},{1})"},
    "inverse": {1: "PoseInv({0})"},
    "transform": {2: "PoseVect({0},{1})"},
    "euler_x": {1: "EulerZYX(\\X,{0})"},
    "euler_y": {1: "EulerZYX(\\Y,{0})"},
    "euler_z": {1: "EulerZYX(\\Z,{0})"},
    "rotation_zyx": {3: "OrientZYX({0},{1},{2})"},
    "frame_from_points": {3: "DefFrame({0},{1},{2})", 4: "DefFrame({0},{1},{2}\\Origin:={3})"},
    "distance": {2: "Distance({0},{1})"},
    "magnitude": {1: "VectMagn({0})"},
    "dot": {2: "DotProd({0},{1})"},
    "normalise": {1: "NOrient({0})"},
    "text_length": {1: "StrLen({0})"},
    "text_part": {3: "StrPart({0},{1},{2})"},
    "text_find_any": {3: "StrFind({0},{1},{2})"},
    "text_find_none": {3: "StrFind({0},{1},{2}\\NotInSet)"},
    "digits_less": {2: "StrDigCmp({0},LT,{1})"},
    "digits_equal": {2: "StrDigCmp({0},EQ,{1})"},
    "digits_sum": {2: "StrDigCalc({0},OpAdd,{1})"},
    "digits_difference": {2: "StrDigCalc({0},OpSub,{1})"},
    "digits_product": {2: "StrDigCalc({0},OpMult,{1})"},
    "digits_quotient": {2: "StrDigCalc({0},OpDiv,{1})"},
    "digits_remainder": {2: "StrDigCalc({0},OpMod,{1})"},
    "text_match": {3: "StrMatch({0},{1},{2})"},
    "text_member": {3: "StrMemb({0},{1},{2})"},
    "text_equal": {2: "({0}={1})"},
    "text_map": {3: "StrMap({0},{1},{2})"},
    "text_order": {3: "StrOrder({0},{1},{2})"},
    "text_upper": {1: "StrMap({0},STR_LOWER,STR_UPPER)"},
    "text_lower": {1: "StrMap({0},STR_UPPER,STR_LOWER)"},
    "number_text": {2: "NumToStr({0},{1})"},
    "power_text": {2: "NumToStr({0},{1}\\Exp)"},
    "value_text": {1: "ValToStr({0})"},
    "parse_value": {2: "StrToVal({0},{1})"},
    "parse_number": {2: "StrToVal({0},{1})"},
    "time_text": {0: "CTime()"},
    "date_text": {0: "CDate()"},
    "clock_seconds": {1: "ClkRead({0})"},
}
# What a program of RAPID itself may hold besides; what other languages do with texts is rewritten before.
OWN_FUNCTIONS: dict[str, dict[int, str]] = {
    "character_code": {1: "StrToByte({0}\\Char)"},
    "from_code": {1: "ByteToStr({0}\\Char)"},
}
# Numbers out of the date (YYYY-MM-DD) or the time (HH:MM:SS): the text, where they stand -> switch of GetTime.
PARTS_OF_TIME: dict[tuple[ir.Expression, ir.Expression], str] = {
    (ir.Builtin(function, ()), ir.IntLiteral(first)): switch
    for function, first, switch in (
        ("date_text", 1, "Year"),
        ("date_text", 6, "Month"),
        ("date_text", 9, "MDay"),
        ("time_text", 1, "Hour"),
        ("time_text", 4, "Min"),
        ("time_text", 7, "Sec"),
    )
}
# Arguments that RAPID takes as whole targets although only their position matters.
TARGETS_FOR_POSITIONS = {"frame_from_points": 3}
POSE_OFFSETS = ("offset", "tool_offset")  # of robtargets only
# Functions that a task beside the one that moves asks with the name of that task.
PLACES_BESIDE = {"current_target": "CRobT", "current_joints": "CJointT"}
MOTION_TASK = "T_ROB1"  # the name every controller with one robot gives it
