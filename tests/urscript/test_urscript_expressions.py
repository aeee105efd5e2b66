"""URScript expressions: precedence, units, poses, lists, joints, texts."""

from __future__ import annotations

import pytest
from urscript_helpers import holds, read, shown, value, variable

from rpl import ir

CASES = [
    ("1 + 2 * 3", "(1 + (2 * 3))"),
    ("10 - 4 - 3", "((10 - 4) - 3)"),
    ("7 / 2", "(7 / 2)"),
    ("7 % 4 * 2", "((7 mod 4) * 2)"),
    ("-2 ^ 2", "(- (2 ** 2))"),
    ("not 42 >= 87 and 87 <= 42", "((not (42 >= 87)) cand (87 <= 42))"),
    ("True or False and (1 == 2)", "(True cor (False cand (1 = 2)))"),
    ("True xor False and True", "(True xor (False cand True))"),
    ("1 != 2", "(1 <> 2)"),
    ("sin(1.5)", "sin(<1.5 rad>)"),
    ("atan2(1, 2)", "<atan2(1,2) rad>"),
    ("d2r(90)", "<90 rad>"),
    ("pow(2, 3)", "power(2,3)"),
    ("log(10, 100)", "(log(100) / log(10))"),
    ("norm(-2)", "abs((- 2))"),
    ("norm([3, 4])", "sqrt(((3 ** 2) + (4 ** 2)))"),
    ("length([1, 2, 3])", "3"),
    ("p[1, 2, 3, 0, 0, -1]", "pose_from_rotation_vector(<1 m>,<2 m>,<3 m>,<0 rad>,<0 rad>,<-1 rad>)"),
    ("get_standard_digital_in(2)", "digital_in:3"),
    ("get_configurable_digital_in(2)", "digital_in:11"),
    ("get_tool_digital_in(1)", "digital_in:18"),
    ("get_digital_in(8)", "digital_in:17"),
    ("get_standard_analog_in(1)", "analog_in:2"),
    ("get_tool_analog_in(0)", "analog_in:3"),
    ("get_flag(0)", "flag:1"),
    ("read_input_integer_register(24)", "group_in:input_integer_register_24"),
    ("read_output_boolean_register(64)", "digital_out:83"),
    ("read_input_boolean_register(0 + 2)", "digital_in:((0 + 2) + 19)"),
    ("read_input_float_register(24)", "analog_in:29"),
    ("is_steady()", "(not @moving)"),
    ("get_actual_tcp_pose()", "pose_of(current_target())"),
    ("get_actual_joint_positions()", "current_joints()"),
    ("get_tcp_offset()", "@tool"),
    ('"a" + "b"', "('a' & 'b')"),
    ('str_cat("a", 1)', "('a' & '1')"),
    ('str_at("abc", 0)', "text_part('abc',1,1)"),
    ('str_sub("abc", 1)', "text_part('abc',2,2)"),
    ('str_sub("abc", 1, 2)', "text_part('abc',2,2)"),
    ('str_find("abc", "c")', "(text_find('abc',1,'c') - 1)"),
    ('str_empty("")', "(text_length('') = 0)"),
    ("to_str(True)", "'True'"),
    ('socket_open("10.0.0.1", 30, "s")', '?socket_open("10.0.0.1", 30, "s")'),
    ("{{PORT}}", "?{{PORT}}"),
]


@pytest.mark.parametrize(("text", "wanted"), [case for case in CASES if "{{" not in case[0]])
def test_an_expression_in_the_ir(text: str, wanted: str) -> None:
    assert shown(value(text)) == wanted


POSES = [
    ("a[2]", "<a.z m>"),
    ("a[3]", "<rotation_vector_x(a.rot) rad>"),
    ("pose_trans(a, b)[0]", "<(a : b).x m>"),
    ("pose_inv(a)", "inverse(a)"),
    ("pose_add(a, b)", "pose_sum(a,b)"),
    ("pose_sub(a, b)", "pose_difference(a,b)"),
    ("point_dist(a, b)", "<distance(a.trans,b.trans) m>"),
    ("interpolate_pose(a, b, 0.5)", "interpolate_pose(a,b,0.5)"),
    ("get_inverse_kin(a)", "target_to_joints(a)"),
    ("get_inverse_kin(a, qnear=q)", "target_to_joints_near(a,q)"),
    ("get_inverse_kin_has_solution(a)", "is_reachable(a,current_joints())"),
    ("get_forward_kin(q)", "pose_of(joints_to_target(q))"),
    ("get_forward_kin()", "pose_of(current_target())"),
    ("q[1]", "<q.j2 rad>"),
]
_BEFORE = "a = p[0,0,0,0,0,0]\nb = a\na = b\nq = [0,0,0,0,0,0]\nmovej(q)\nq[0] = 1"


@pytest.mark.parametrize(("text", "wanted"), POSES)
def test_poses_and_joints(text: str, wanted: str) -> None:
    assert shown(value(text, _BEFORE)) == wanted


def test_a_hole_of_a_template_is_read_and_reported() -> None:
    program, diagnostics = read("def p():\nport = {{PORT}}\nglobal x = # to fill\nglobal y = 2\n{% if A %}\nend\n")
    assert [item.code.name for item in diagnostics] == ["urscript-template"] * 3
    assert [item.origin.line for item in diagnostics] == [2, 3, 5]
    assert variable(program, "y").initial == ir.IntLiteral(2)


_SIX = ir.ArrayType(ir.IntType(), (ir.IntLiteral(5),), 0)
KINDS = [
    ("x = 1", "x", ir.IntType()),
    ("x = 1\nx = 1.5", "x", ir.RealType()),
    ("x = 7 / 2", "x", ir.RealType()),
    ("x = not True", "x", ir.BoolType()),
    ('x = "a" + "b"', "x", ir.StringType()),
    ("x = p[0,0,0,0,0,0]", "x", ir.PoseType()),
    ("x = [1, 2.5, 3]", "x", ir.ArrayType(ir.RealType(), (ir.IntLiteral(2),), 0)),
    ("x = [[1, 2], [3, 4]]", "x", ir.ArrayType(ir.IntType(), (ir.IntLiteral(1), ir.IntLiteral(1)), 0)),
    ("x = [p[0,0,0,0,0,0]]", "x", ir.ArrayType(ir.PoseType(), (ir.IntLiteral(0),), 0)),
    ("x = [1, 2]\nx = [1, 2, 3]", "x", ir.ArrayType(ir.IntType(), (None,), 0)),
    ("x = get_actual_joint_positions()", "x", ir.JointsType()),
    ("x = [0, 0, 0, 0, 0, 0]\nmovej(x)", "x", ir.JointsType()),
    (
        "x = [0, 0, 0, 0, 0, 0]\nmovej(x)\ni = 1\ni = 2\nx[i] = 3",
        "x",
        ir.ArrayType(ir.IntType(), (ir.IntLiteral(5),), 0),
    ),
    ("x = struct(a=1, b=True)", "x", ir.NamedType("x_struct")),
    ('x = rpc_factory("xmlrpc", "http://host")', "x", ir.VendorType("urscript", "handle")),
    ("x = socket_read_ascii_float(3)", "x", ir.ArrayType(ir.RealType(), (ir.IntLiteral(3),), 0)),
    ("def f(n):\nreturn n > 1\nend\nx = f(2)", "x", ir.BoolType()),
    ("thread t():\nsync()\nend\nx = run t()\ny = x + 1", "x", ir.IntType()),
]


@pytest.mark.parametrize(("lines", "name", "wanted"), KINDS)
def test_the_type_of_a_variable_follows_from_what_it_gets(lines: str, name: str, wanted: ir.Type) -> None:
    program, _ = read(f"def prog():\n{lines}\nend\n")
    assert variable(program, name).type == wanted


def test_a_name_that_changes_its_type_is_reported_where_it_does() -> None:
    _, diagnostics = read('def prog():\nx = 1\nx = "one"\nend\n', normal=False)
    (item,) = diagnostics
    assert (item.code.name, item.origin.line) == ("urscript-type-changed", 3)
    assert item.message == "x holds a whole number and gets a string here"


def test_parameters_without_a_caller_take_the_type_of_their_use() -> None:
    text = (
        "def f(n, on, where, name):\nset_digital_out(n, on)\nmovel(where)\ntextmsg(str_cat(name, 1))\n"
        "x = str_len(name)\nend\n"
    )
    program, _ = read({"lib.script": text + "def g():\nend\n"})
    types = [type(parameter.type).__name__ for parameter in program.modules[0].routines[0].parameters]
    assert types == ["IntType", "BoolType", "PoseType", "StringType"]


def test_lists_and_numbers_as_they_run() -> None:
    holds(
        "a = [1, 2, 3]\nb = a * 2 + [10, 20, 30]\nc = -a\nm = [[1, 2], [3, 4]]\nm[0, 1] = 9\nsum = 0\nfor_ = 0",
        "b[0] == 12 and b[2] == 36",
        "c[1] == -2",
        "m[0, 1] == 9 and m[1][0] == 3",
        "a == [1, 2, 3]",
        "7 / 2 == 3.5 and floor(-0.5) == -1 and ceil(0.2) == 1",
        "-7 % 4 == -3",
    )


def test_functions_pass_by_value_and_take_names_and_defaults() -> None:
    holds(
        "a = [1, 2]\ndef change(list, by=10, twice=False):\nlist[0] = list[0] + by\n"
        "if twice:\nreturn list[0] * 2\nend\n"
        "return list[0]\nend\nx = change(a)\ny = change(a, twice=True)\nz = change(by=1, list=a)",
        "x == 11",
        "y == 22",
        "z == 2",
        "a[0] == 1",
    )
