"""URScript statements: how text becomes statements, whose variable a name is, threads, moves."""

from __future__ import annotations

import pytest
from urscript_helpers import body, codes, holds, read, routine, run, shown, statement, value, variable

from rpl import ir
from rpl.cell import Cell
from rpl.diagnostics import Severity

SPLIT = [
    ("a = 1 a = 2", ["Assign", "Assign"]),
    ("set_digital_out(0, True) sleep(1)", ["Assign", "Wait"]),
    ("if True: sleep(1) end", ["If"]),
    ("if a_ == 1: sleep(1) elif a_ == 2: sleep(2) else: sleep(3) end a_ = 3 a_ = 4", ["If", "Assign", "Assign"]),
    ("a =  # behind the sign\n  5\na = 6", ["Assign", "Assign"]),
    ("a = [1,\n  2, # two\n  3]\na = [4, 5, 6]", ["Assign", "Assign"]),
    ("a = 1 +\n 2\na = 0", ["Assign", "Assign"]),
    ('textmsg(\n"x",\n  1)', ["Message"]),
    ("while True: break end", ["Loop"]),
    ("\tif (True):\n\tsync()\n  end", ["If"]),
    ('$ 1 "Robot Program"\nsync()', ["Wait"]),
    ("return 1", ["Return"]),
    ("return", ["Return"]),
    ("halt", ["Halt"]),
    ("enter_critical\nsync()\nexit_critical", ["Critical", "Wait", "Critical"]),
    ("while not get_standard_digital_in(1):\nsync()\nend", ["WaitUntil"]),
    ("while get_standard_digital_in(1) == False: sync() end", ["WaitUntil"]),
    ("while not get_standard_digital_in(1):\nsleep(0.1)\nend", ["While"]),
]


@pytest.mark.parametrize(("lines", "wanted"), SPLIT)
def test_statements_are_cut_where_they_end(lines: str, wanted: list[str]) -> None:
    assert [type(s).__name__ for s in body(lines)] == wanted


def test_comments_and_step_labels_stay_with_their_statement() -> None:
    first, second = body('# before\n$ 2 "Wait" "noBreak"\nsleep(1) # behind\nsleep(2)')
    assert [c.text for c in first.origin.comments] == [" before", '$ 2 "Wait" "noBreak"', " behind"]
    assert [c.behind for c in first.origin.comments] == [False, False, True]
    assert not second.origin.comments


MOVES = [
    ("movej([0,0,0,0,0,0])", "joint", "stop", "1.05 1.4"),
    ("movej(p[0,0,0,0,0,0], 1, 2, 0, 0.01)", "joint", "0.01", "2 1"),
    ("movej(p[0,0,0,0,0,0], v=0.5, a=3)", "joint", "stop", "0.5 3"),
    ("movel(p[0,0,0,0,0,0], r=0.02)", "linear", "0.02", "0.25 1.2"),
    ("movel([0,0,0,0,0,0], t=2)", "linear", "stop", "t 2"),
    ("movep(p[0,0,0,0,0,0], v=0.1, r=0.05)", "linear", "0.05", "0.1 1.2"),
    ("movec(p[1,0,0,0,0,0], p[2,0,0,0,0,0], v=0.1)", "circular", "stop", "0.1 1.2"),
]


@pytest.mark.parametrize(("line", "kind", "blend", "speed"), MOVES)
def test_moves_with_defaults_and_named_arguments(line: str, kind: str, blend: str, speed: str) -> None:
    move = statement(line)
    assert isinstance(move, ir.Move)
    assert move.kind == kind
    match move.blend:
        case ir.BlendStop():
            assert blend == "stop"
        case ir.BlendDistance(distance=distance):
            assert shown(distance) == f"<{blend} m>"  # type: ignore[arg-type]
    given = move.speed
    assert given is not None
    if speed.startswith("t"):
        assert shown(given.duration) == f"<{speed[2:]} s>"  # type: ignore[arg-type]
        assert given.path is None and given.path_acceleration is None
        return
    units = ("rad/s", "rad/s2") if kind == "joint" else ("m/s", "m/s2")
    parts = (given.axis, given.axis_acceleration) if kind == "joint" else (given.path, given.path_acceleration)
    assert [shown(p) for p in parts if p is not None] == [
        f"<{number} {unit}>" for number, unit in zip(speed.split(), units, strict=True)
    ]


def test_process_moves_and_circles() -> None:
    assert statement("movep(p[0,0,0,0,0,0])").motion_class == "process"  # type: ignore[union-attr]
    free = statement("movec(p[1,0,0,0,0,0], p[2,0,0,0,0,0])")
    fixed = statement("movec(p[1,0,0,0,0,0], p[2,0,0,0,0,0], mode=1)")
    assert isinstance(free, ir.Move) and isinstance(fixed, ir.Move)
    assert (free.orientation, free.circle_orientation) == (None, "base")
    assert (fixed.orientation, fixed.circle_orientation) == ("constant", "path")


SETTINGS = [
    ("set_tcp(p[0,0,0.1,0,0,0])", "Assign"),
    ("set_payload(1.5, [0, 0, 0.05])", "Assign"),
    ("set_gravity([0, 0, 9.82])", "tuning"),
    ('modbus_add_signal("10.0.0.2", 255, 1, 1, "door")', "none"),
    ('socket_send_string("go", "s")', "message"),
    ("force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,10,0,0,0], 2, [1,1,1,1,1,1])", "unknown"),
    ("write_output_float_register(3, 1.5)", "Assign"),
    ('modbus_set_output_signal("door", True)', "Assign"),
    ('popup("done", blocking=True)', "quit"),
    ('popup("done", "title", False, True)', "error"),
    ('popup("done")', "notify"),
    ('textmsg("n ", 1)', "write"),
]


@pytest.mark.parametrize(("line", "wanted"), SETTINGS)
def test_procedures(line: str, wanted: str) -> None:
    made = statement(line)
    match made:
        case ir.Vendor(effect=effect):
            assert effect == wanted
        case ir.Message(kind=kind):
            assert kind == wanted
        case _:
            assert type(made).__name__ == wanted


def test_direct_drives_are_read_as_moves_and_said_so() -> None:
    program, diagnostics = read(
        "def p():\nservoj([0,0,0,0,0,0], t=0.1)\nspeedl([0, 0, 0.1, 0, 0, 0], 0.5, 2)\nspeedj([0.1,0,0,0,0,0], 1, 1)\n"
        "speedl([0, 0, 0.1, 0, 0, 0], 0.5)\nend\n"
    )
    made = routine(program, "p").body
    assert [type(s).__name__ for s in made] == ["Move", "Move", "Move", "Move"]
    assert [m.relative for m in made if isinstance(m, ir.Move)] == [None, "base", "joints", "base"]
    assert [m.motion_class for m in made if isinstance(m, ir.Move)] == ["servo", *["velocity"] * 3]
    assert codes(diagnostics, Severity.INFO) == ["urscript-servo"]


def test_speed_times_time_and_the_ramp_behind_it() -> None:
    result = run(
        "def p():\nmovej([0, -1.57, -1.57, -1.57, 1.57, 0])\na = get_actual_tcp_pose()\n"
        "speedl([0, 0, 0.1, 0, 0, 0], 0.5, 2)\nstopl(0.5)\nb = get_actual_tcp_pose()\n"
        "set_digital_out(0, norm(b[2] - a[2] - 0.2) < 0.0001)\nend\n"
    )
    assert result.fault is None
    assert [(name, state) for _, name, state in result.outputs] == [("digital_out[0]", True)]


# ---- whose variable a name is


def test_scopes() -> None:
    holds(
        "a = 1\nglobal b = 2\ndef own():\nlocal a = 5\na = a + 1\nreturn a\nend\ndef shared():\na = 7\nfresh = 1\n"
        "global made = 9\nreturn fresh\nend\nx = own()\ny = shared()",
        "x == 6",
        "y == 1",
        "a == 7",
        "made == 9",
    )


def test_variables_of_the_program_are_global_and_others_local() -> None:
    program, _ = read("def p():\nlocal a = 1\na = 2\ndef f():\nb = 1\nb = 2\nend\nf()\nend\n")
    assert variable(program, "a").scope == "global"
    assert variable(program, "b").scope == "routine"
    assert [r.name for r in program.modules[0].routines] == ["p", "f"]


def test_names_that_differ_in_case_alone_are_told_apart() -> None:
    holds("X = 1\nx = 2\ndef f(T, t=1):\nreturn T - t\nend\nx = x + X", "x == 3 and X == 1", "f(5, t=3) == 2")
    program, _ = read("def p():\nX = 1\nx = 2\nx = x + X\nend\n")
    assert {d.name for d in program.modules[0].declarations if isinstance(d, ir.Variable)} == {"X", "x_2"}
    program, _ = read("def p():\npart = 1\nPart = 2\nPART = 3\npart = part + Part + PART\nend\n")
    names = [d.name for d in program.modules[0].declarations if isinstance(d, ir.Variable)]
    assert len({name.lower() for name in names}) == 3


def test_nested_functions_of_one_name_stay_apart() -> None:
    holds(
        "def one():\ndef helper():\nreturn 1\nend\nreturn helper()\nend\n"
        "def two():\ndef helper():\nreturn 2\nend\nreturn helper()\nend\nx = one()\ny = two()",
        "x == 1",
        "y == 2",
    )


def test_a_value_that_never_changes_is_in_its_declaration() -> None:
    program, _ = read("def p():\n# rest\nglobal home = [0, 0, 0, 0, 0, 0]\ni = 0\ni = i + 1\nmovej(home)\nend\n")
    home = variable(program, "home")
    assert home.type == ir.JointsType() and home.initial is not None
    assert [c.text for c in home.origin.comments] == [" rest"]
    assert variable(program, "i").initial is None
    assert [type(s).__name__ for s in routine(program, "p").body] == ["Assign", "Assign", "Move"]


PROGRAMS = [
    ("def p():\nend\n", "p"),
    ("def f(a):\nend\ndef p():\nf(1)\nend\n", "p"),
    ("def f():\nend\ndef p():\nf()\nend\np()\n", "p"),
    ("movej([0,0,0,0,0,0])\n", "p"),
    ("def p():\nend\nmovej([0,0,0,0,0,0])\n", "main"),
    ("sec s():\nset_digital_out(0, True)\nend\n", "s"),
    ("def a():\nend\ndef b():\nend\n", ""),
]


@pytest.mark.parametrize(("text", "entry"), PROGRAMS)
def test_which_def_is_the_program(text: str, entry: str) -> None:
    program, diagnostics = read(text)
    assert program.entry == entry
    assert not codes(diagnostics)


# ---- functions


def test_a_function_that_does_not_always_return_gives_zero() -> None:
    holds("def f(n):\nif n > 0:\nreturn 5\nend\nend\nx = f(1)\ny = f(0)", "x == 5 and y == 0")


def test_a_list_that_a_function_gives_is_made_once() -> None:
    holds("n = 0\ndef f():\nn = n + 1\nreturn [n, n]\nend\nx = f() * 2", "x[1] == 2 and n == 1")


def test_a_loop_whose_condition_needs_a_list_evaluates_it_each_time() -> None:
    holds(
        "n = 0\ndef f():\nn = n + 1\nreturn [n, n]\nend\nk = 0\nwhile norm(f() - [3, 3]) > 0.1:\nk = k + 1\nend",
        "n == 3 and k == 2",
    )


def test_parts_of_poses_are_written() -> None:
    holds(
        "a = p[0, 0, 0, 0, 0, 1]\ni = 0\nwhile i < 3:\na[i] = i\ni = i + 1\nend\na[3] = 0\na[5] = 0.5",
        "norm(a[1] - 1) < 0.000001 and norm(a[2] - 2) < 0.000001 and norm(a[5] - 0.5) < 0.000001",
    )


# ---- threads


def test_threads_are_started_joined_and_killed() -> None:
    text = "thread t():\nsleep(1)\nend\nthread u():\nsync()\nend\nh = run t()\njoin h\nkill h\nrun u()"
    made = body(text)
    ops = [(s.op, s.task) for s in made if isinstance(s, ir.TaskControl)]
    assert ops == [("start", "t"), ("join", "t"), ("stop", "t"), ("start", "u")]


def test_a_handle_of_several_threads_tells_by_its_number() -> None:
    made = body("thread t():\nsync()\nend\nthread u():\nsync()\nend\nh = 0\nh = run t()\nh = run u()\njoin h")
    switch = made[-1]
    assert isinstance(switch, ir.Switch)
    assert [case.values[0].value for case in switch.cases] == [1, 2]  # type: ignore[union-attr]


def test_a_thread_that_moves_the_robot_is_stopped() -> None:
    result = run(
        "def p():\nthread t():\nmovej([1, -1.57, -1.57, -1.57, 1.57, 0], v=0.2)\nset_digital_out(0, True)\nend\n"
        "movej([0, -1.57, -1.57, -1.57, 1.57, 0])\nh = run t()\nsleep(0.5)\nkill h\nstopj(4)\n"
        "q = get_actual_joint_positions()\nset_digital_out(1, q[0] > 0.01 and q[0] < 0.3)\n"
        "movej([0, -1.57, -1.57, -1.57, 1.57, 0])\nend\n"
    )
    assert result.fault is None and result.status == "finished"
    assert [(name, state) for _, name, state in result.outputs] == [("digital_out[1]", True)]


def test_halt_ends_the_program_from_a_thread() -> None:
    result = run("def p():\nthread t():\nsleep(1)\nhalt\nend\nrun t()\nwhile True:\nsync()\nend\nend\n")
    assert (result.status, round(result.time_s, 3)) == ("stopped", 1.0)


def test_signals_of_a_cell_have_the_names_of_the_pendant() -> None:
    from rpl.cell.cellfile import Cell as Loaded

    assert Cell is Loaded
    result = run(
        "def p():\nset_configurable_digital_out(2, True)\nset_tool_digital_out(1, True)\nset_analog_out(1, 0.5)\nend\n"
    )
    assert [name for _, name, _ in result.outputs] == ["config_out[2]", "tool_out[1]", "analog_out[1]"]


def test_overlapping_blends_are_reported_where_they_are() -> None:
    _, diagnostics = read(
        "def p():\nglobal b = p[0.05,0,0,0,0,0]\nmovel(p[0,0,0,0,0,0], r=0.03)\nmovel(b, r=0.03)\n"
        "movel(p[0.2,0,0,0,0,0])\nend\n"
    )
    (item,) = [i for i in diagnostics if i.code.name == "urscript-overlapping-blends"]
    assert item.origin.line == 4
    assert "0.03 m" in item.message and "0.05 m" in item.message


# ---- damage


def test_a_damaged_statement_costs_itself_alone() -> None:
    program, diagnostics = read("def p():\nmovej([0,0,0,0,0,0)\nsleep(1)\nx = (1 + \nif True:\nsleep(2)\nend\nend\n")
    made = routine(program, "p").body
    assert [type(s).__name__ for s in made] == ["Opaque", "Wait", "Opaque", "If"]
    assert codes(diagnostics, Severity.ERROR) == ["unreadable-statement", "unreadable-statement"]
    assert [item.origin.line for item in diagnostics] == [2, 4]


DAMAGE = [
    ("def p():\nsleep(1)\n", "missing-block-end"),
    ("def p():\nend\nend\n", "stray-block-end"),
    ("def p():\nelse:\nend\n", "urscript-second-else"),
    ("def p():\nbreak\nend\n", "urscript-no-loop"),
    ("def p():\nif True:\nelse:\nelse:\nend\nend\n", "urscript-second-else"),
    ("def p():\n1 + 2\nend\n", "unreadable-statement"),
    ("def p():\nx = p[1, 2, 3]\nend\n", "unreadable-statement"),
    ("def p():\n3 = x\nend\n", "unreadable-statement"),
    ('def p():\nx = "open\nend\n', "unreadable-statement"),
    ("def p():\nx = 1;\nend\n", ""),
]


@pytest.mark.parametrize(("text", "wanted"), DAMAGE)
def test_damage_is_reported(text: str, wanted: str) -> None:
    _, diagnostics = read(text, normal=False)
    assert codes(diagnostics, Severity.ERROR) == ([wanted] if wanted else [])


def test_wrong_arguments_are_reported_and_kept() -> None:
    program, diagnostics = read(
        "def p():\nmovej()\nsleep(1, 2, 3)\nx = sin()\nset_tcp(p[0,0,0,0,0,0], colour=1)\nend\n"
    )
    made = routine(program, "p").body
    assert [type(s).__name__ for s in made] == ["Vendor", "Vendor", "Assign", "Vendor"]
    assert codes(diagnostics) == ["urscript-kept-as-text"] * 4


def test_deep_nesting_and_odd_characters_are_no_crash() -> None:
    read("x = " + "(" * 300 + "1" + ")" * 300 + "\n")
    read("\ufeffdef p():\r\n\tsleep(1)\r\nend\x1a")
    read('def p(:\n{{\n%}\n$$\n@@@\n"\n')
    assert shown(value("((1))")) == "1"
