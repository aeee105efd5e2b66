"""Functions as procedures, parameters as numbers and variables, variables of routines outside of them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir
from rpl.passes.capabilities import Control, Io, Limit, Local, Parameters, RoutineRule, Routines
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.elseif import nest_branches
from rpl.passes.legalise.control.functions import functions_to_procedures
from rpl.passes.legalise.control.locals import variables_of_routines
from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.control.parameters import ARGUMENTS, fit_arguments
from rpl.passes.legalise.routines.aliasing import without_shared_references
from rpl.passes.legalise.stages import Pass
from rpl.passes.legalise.statements.logic import decide_logic
from rpl.passes.legalise.statements.polling import poll_waits
from rpl.passes.rewrite import rewrite_parts
from tests.refusing import refused

from .common import PLAIN, RICH, count, legalised, nodes, read, same_run
from .shaped import program, rewritten, same, shown, step, target, when
from .test_generated import _KRL, _RAPID, bodies, handlers, krl_bodies

ROUTINES: tuple[Pass, ...] = (poll_waits, decide_logic, functions_to_procedures, fit_arguments, variables_of_routines)
WEAK = replace(
    PLAIN,
    routines=replace(
        PLAIN.routines,
        rules=PLAIN.routines.rules - {RoutineRule.FUNCTIONS},
        parameters=Parameters.NUMBERED,
        locals=PLAIN.routines.locals - {Local.VARIABLES},
    ),
)
WEAKEST = replace(
    PLAIN,
    routines=replace(
        PLAIN.routines,
        rules=PLAIN.routines.rules - {RoutineRule.FUNCTIONS},
        parameters=Parameters.NONE,
        locals=PLAIN.routines.locals - {Local.VARIABLES},
    ),
)
NO_FUNCTIONS = replace(PLAIN, routines=replace(PLAIN.routines, rules=PLAIN.routines.rules - {RoutineRule.FUNCTIONS}))
NUMBERED = replace(PLAIN, routines=replace(PLAIN.routines, parameters=Parameters.NUMBERED))


def named_again(program: ir.Program, context: Context) -> ir.Program:
    """The numbered arguments as parameters, so that the program can run on a machine without registers."""
    if context.capabilities.routines.parameters is not Parameters.NUMBERED:
        return program

    def routine(one: ir.Routine) -> ir.Routine:
        names = [parameter.name for parameter in one.parameters]

        def expression(node: ir.Expression) -> ir.Expression:
            match node:
                case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at),)) if name == ARGUMENTS:
                    # the parameter may share its name with the variable that takes its value
                    return ir.Name(f"argument_{names[at - 1]}")
            return rewrite_parts(node, expression)

        def body(statements: ir.Body) -> ir.Body:
            return tuple(rewrite_parts(statement, expression, body) for statement in statements)

        parameters = tuple(
            one if one.name.startswith(ARGUMENTS) else replace(one, name=f"argument_{one.name}")
            for one in one.parameters
        )
        return replace(one, parameters=parameters, body=body(one.body))

    modules = tuple(replace(m, routines=tuple(map(routine, m.routines))) for m in program.modules)
    return replace(program, modules=modules)


_CALLS = """DEF main()
DECL INT a, b, i
DECL INT f[3]
a = 1
b = 2
i = 1
f[1] = 5
f[2] = 6
f[3] = 7
%s
show(a)
show(b)
show(f[1]*100+f[2]*10+f[3])
END
DEF show(v:IN)
REAL v
$ANOUT[1] = v
END
DEFFCT INT twice(v:IN)
INT v
show(v)
RETURN 2*v
ENDFCT
DEFFCT INT more(v:OUT)
INT v
v = v + 1
show(v)
RETURN v
ENDFCT
DEFFCT INT down(v:IN)
INT v
v = v - 1
IF v < 0 THEN
RETURN 0
ENDIF
RETURN v
ENDFCT
DEF swap(x:OUT,y:OUT)
INT x, y, t
t = x
x = y
y = t
END
DEF forward(v:OUT,k:IN)
INT v, k
swap(v,k)
show(k)
END
"""
_BODIES = [
    "a = twice(a) + twice(b)",
    "a = twice(twice(twice(a)))",
    "a = more(a) + more(a) * a",
    "IF twice(a) > more(b) THEN\na = 9\nELSE\nIF twice(b) > 2 THEN\na = 8\nENDIF\nENDIF",
    "WHILE down(a) < 3\na = more(a) + 0*twice(1)\nENDWHILE",
    "REPEAT\na = a + 1\nUNTIL twice(a) > 8",
    "FOR i = down(3) TO twice(2)\nshow(i)\nENDFOR",
    "SWITCH twice(a)\nCASE 2\na = 5\nDEFAULT\na = 6\nENDSWITCH",
    "swap(a,b)",
    "swap(f[i],f[i+1])",
    "forward(a,b)\nforward(b,7)",
    "show(twice(a)+a)",
    "IF (twice(a) == 2) AND (more(b) == 3) THEN\na = 4\nENDIF",
]


@pytest.mark.parametrize("body", _BODIES)
@pytest.mark.parametrize(
    "capabilities", [NO_FUNCTIONS, NUMBERED, WEAK, WEAKEST], ids=lambda one: one.routines.parameters
)
def test_calls_keep_their_order_and_what_they_change(body: str, capabilities: object) -> None:
    given = read("krl", _CALLS % body)
    after = same_run(given, capabilities, *ROUTINES, named_again)  # type: ignore[arg-type]
    _checked(after, capabilities)


def _checked(after: ir.Program, capabilities: object) -> None:
    routines = [routine for module in after.modules for routine in module.routines]
    if RoutineRule.FUNCTIONS not in capabilities.routines.rules:  # type: ignore[attr-defined]
        assert not count(after, ir.Call) and not any(one.kind == "function" for one in routines)
    if capabilities.routines.parameters is Parameters.NONE:  # type: ignore[attr-defined]
        assert not any(one.parameters for one in routines)
    if capabilities.routines.parameters is Parameters.NUMBERED:  # type: ignore[attr-defined]
        assert all(p.mode == "value" for one in routines for p in one.parameters)
    if Local.VARIABLES not in capabilities.routines.locals:  # type: ignore[attr-defined]
        assert not any(isinstance(d, ir.Variable) for one in routines for d in one.declarations)


def test_a_single_result_is_taken_where_it_is_left() -> None:
    after, _ = legalised(read("krl", _CALLS % "a = twice(b) + 1"), NO_FUNCTIONS, functions_to_procedures)
    main = next(one for one in after.modules[0].routines if one.name == "main")
    at = next(i for i, s in enumerate(main.body) if isinstance(s, ir.CallRoutine) and s.name == "twice")
    given = ir.Binary("+", ir.Name("twice_result"), ir.IntLiteral(1))
    assert main.body[at + 1] == ir.Assign(ir.Name("a"), given)


def test_numbered_arguments_are_read_by_number() -> None:
    after, _ = legalised(read("krl", _CALLS % "a = 1"), NUMBERED, fit_arguments)
    show = next(one for one in after.modules[0].routines if one.name == "show")
    assert show.body == (
        ir.Assign(ir.Signal("analog_out", ir.IntLiteral(1)), ir.Index(ir.Name(ARGUMENTS), (ir.IntLiteral(1),))),
    )


def _generated_calls(body: str) -> None:
    for capabilities in (NO_FUNCTIONS, NUMBERED, WEAK, WEAKEST):
        after = same_run(read("krl", _KRL % f"i = 0\nk = 0\n{body}"), capabilities, *ROUTINES, fit_loops, named_again)
        _checked(after, capabilities)


@settings(max_examples=26, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(krl_bodies(), min_size=1, max_size=3).map("\n".join))
def test_generated_calls(body: str) -> None:
    _generated_calls(body)


@pytest.mark.slow
@settings(max_examples=80, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(krl_bodies(), min_size=1, max_size=3).map("\n".join))
def test_many_generated_calls(body: str) -> None:
    _generated_calls(body)


def _generated_calls_with_handlers(inner: str, caught: str, main: str) -> None:
    del caught
    with_loops = replace(
        RICH,
        statements=RICH.statements | {"Loop", "ExitLoop"},
        routines=replace(RICH.routines, rules=RICH.routines.rules - {RoutineRule.FUNCTIONS}),
    )
    same_run(read("rapid", _RAPID % (inner, "", main, "")), with_loops, functions_to_procedures)


@settings(max_examples=13, deadline=None, suppress_health_check=list(HealthCheck))
@given(bodies(), handlers(), st.lists(bodies(), min_size=1, max_size=3).map(" ".join))
def test_generated_calls_with_handlers(inner: str, caught: str, main: str) -> None:
    _generated_calls_with_handlers(inner, caught, main)


@pytest.mark.slow
@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(bodies(), handlers(), st.lists(bodies(), min_size=1, max_size=3).map(" ".join))
def test_many_generated_calls_with_handlers(inner: str, caught: str, main: str) -> None:
    _generated_calls_with_handlers(inner, caught, main)


# ---- recursion

_RECURSIVE = """MODULE m
  PROC show(num v) TPWrite NumToStr(v,0); ENDPROC
  FUNC num fact(num n)
    VAR num below;
    IF n<2 RETURN 1;
    below:=fact(n-1);
    RETURN n*below;
  ENDFUNC
  PROC main() show fact(4); ENDPROC
ENDMODULE
"""


def test_recursion_stays_where_the_target_has_variables() -> None:
    same_run(read("rapid", _RECURSIVE), NO_FUNCTIONS, functions_to_procedures)


def test_recursion_that_cannot_be_is_reported_and_stopped() -> None:
    once = replace(
        PLAIN, routines=replace(PLAIN.routines, rules=PLAIN.routines.rules - {RoutineRule.RECURSION})
    )  # parameters with names, but only one activation
    after, context = legalised(read("rapid", _RECURSIVE), once, *ROUTINES)
    assert [(item.code.name, item.origin.line) for item in context.diagnostics] == [("recursion-lost", 6)]
    assert sum(isinstance(one, ir.Opaque) for one in nodes(after)) == 1


@pytest.mark.parametrize("target", ["tp", "inform"])
def test_recursion_is_refused_at_its_call(target: str) -> None:
    assert refused(_RECURSIVE, "rapid", target, "abb_irb1200_5_90") == [("recursion-lost", 6)]


def test_a_routine_in_two_threads_is_named() -> None:
    text = (
        "DEF main()\nINTERRUPT DECL 5 WHEN $IN[1]==TRUE DO work()\nINTERRUPT ON 5\nwork()\nEND\n"
        "DEF work()\nINT k\nk = 1\n$ANOUT[1] = k\nEND\n"
    )
    _, context = legalised(read("krl", text), WEAKEST, *ROUTINES)
    assert [item.code.name for item in context.diagnostics] == ["variables-shared"]


def test_what_a_routine_also_sees_by_name_stops_the_program() -> None:
    text = "DEF main()\nwork(g)\nEND\nDEF work(v:OUT)\nINT v\nv = 1\n$ANOUT[1] = g\nEND\n"
    data = "DEFDAT main PUBLIC\nDECL GLOBAL INT g=0\nENDDAT\n"
    from rpl.diagnostics import Diagnostics
    from rpl.project import read_sources
    from rpl.source import source_from_text

    sources = [source_from_text("main.src", text), source_from_text("main.dat", data)]
    given = read_sources(sources, "krl", Diagnostics()).program
    after, context = legalised(given, WEAKEST, without_shared_references, *ROUTINES)
    assert [item.code.name for item in context.diagnostics] == ["reference-aliased"]
    assert any(isinstance(one, ir.Vendor) for one in nodes(after))


def test_arrays_go_through_variables() -> None:
    text = (
        "DEF main()\nDECL INT f[3]\nf[1]=1\nf[2]=2\nf[3]=3\nwork(f[])\n$ANOUT[1]=f[1]+f[2]+f[3]\nEND\n"
        "DEF work(x[]:OUT)\nINT x[]\nINT i\nFOR i=1 TO 3\nx[i]=x[i]*10\nENDFOR\nEND\n"
    )
    after = same_run(read("krl", text), WEAKEST, *ROUTINES)
    assert not any(one.parameters for one in after.modules[0].routines)


# ---- else if


def test_branches_inside_of_each_other() -> None:
    a, b = (ir.Binary("=", ir.Name(name), ir.IntLiteral(1)) for name in "ab")
    choice = ir.If(((a, (step(1),)), (b, (step(2),))), (step(3),))
    after = same(
        program(choice),
        target(control=Control(limits=frozenset((Limit.ONE_BRANCH,)))),
        nest_branches,
    )
    assert after.modules[0].routines[0].body == (when(a, step(1), otherwise=(when(b, step(2), otherwise=(step(3),)),)),)


# ---- waits


def test_a_wait_is_a_loop_that_looks_again() -> None:
    condition = ir.Binary(">", ir.Name("a"), ir.IntLiteral(0))
    given = program(ir.Assign(ir.Name("a"), ir.IntLiteral(1)), ir.WaitUntil(condition), step(1))
    weak = target(frozenset(("Assign", "While", "If", "Wait", "CallRoutine", "ExitLoop")))
    after = same(given, weak, poll_waits)
    assert after.modules[0].routines[0].body[1] == ir.While(
        ir.Binary("<=", ir.Name("a"), ir.IntLiteral(0)), (ir.Wait(ir.Quantity(ir.RealLiteral(0.008), "s")),)
    )


@pytest.mark.parametrize("timeout", [ir.RealLiteral(0.05), ir.Quantity(ir.IntLiteral(50), "ms"), ir.Name("b")])
@pytest.mark.parametrize("holds", [True, False])
def test_a_time_limit_is_counted(timeout: ir.Expression, holds: bool) -> None:
    condition = ir.Binary("=", ir.Name("a"), ir.IntLiteral(1 if holds else 2))
    late = ir.Variable("late", ir.BoolType(), scope="routine")
    body = (
        ir.Assign(ir.Name("a"), ir.IntLiteral(1)),
        ir.WaitUntil(condition, timeout, ir.Name("late")),
        when(ir.Name("late"), step(7), otherwise=(step(8),)),
    )
    given = program(*body)
    (module,) = given.modules
    main = replace(module.routines[0], declarations=(late,))
    given = replace(given, modules=(replace(module, routines=(main, *module.routines[1:])),))
    weak = target(frozenset(("Assign", "While", "If", "Wait", "CallRoutine", "ExitLoop")), io=Io(wait_timeout=False))
    same(given, weak, poll_waits)


def test_a_wait_that_calls_a_function_is_a_loop_without_functions() -> None:
    given = program(ir.WaitUntil(ir.Call("ask", (ir.Argument(ir.IntLiteral(2)),))), step(1))
    after, _ = rewritten(
        given,
        target(
            routines=Routines(rules=frozenset((RoutineRule.LOCAL, RoutineRule.RECURSION, RoutineRule.TEXT_RESULTS)))
        ),
        poll_waits,
        functions_to_procedures,
    )
    assert not count(after, ir.Call) and not count(after, ir.WaitUntil)
    assert shown(after)[-1] == ("finished", None)
