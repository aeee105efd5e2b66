"""Generated programs with jumps, and what a run of a program shows, for the passes about structure."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from hypothesis import strategies as st

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.capabilities import Capabilities, Errors, Io, NameRules, Places, Settings
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.stages import Pass
from rpl.passes.typing import normalise
from rpl.simulation import run_program

LONGEST = 50
ALL = frozenset(
    (
        *("Assign", "CallRoutine", "If", "Switch", "For", "While", "Repeat", "Loop", "ExitLoop", "NextPass", "Label"),
        *("Goto", "Return", "Halt", "Wait", "WaitUntil", "WaitForMotion", "Message", "Do", "Nothing", "Pulse", "Move"),
        *("SetAfter", "Raise", "Retry", "TryNext", "Clock", "Critical", "TaskControl", "OnError", "Dialog"),
        *("DeclareInterrupt", "ControlInterrupt", "StopMotion", "StartMotion", "Vendor", "Opaque"),
    )
)
STRUCTURED = ALL - {"Goto", "Label"}  # a language without jumps
JUMPING = ALL - {"If", "Switch", "For", "While", "Repeat", "Loop", "ExitLoop", "NextPass"}  # one without blocks


def target(statements: frozenset[str] = ALL, **further: Any) -> Capabilities:
    """A made-up target that can do everything but what is said."""
    given: dict[str, Any] = {
        "statements": statements,
        "functions": frozenset(ir.FUNCTIONS),
        "procedures": frozenset(ir.PROCEDURES),
        "system_variables": frozenset(ir.SYSTEM_VARIABLES),
        "operators": frozenset((*ir.BINARY_OPERATORS, *ir.UNARY_OPERATORS)),
        "types": frozenset(("IntType", "RealType", "BoolType", "StringType", "TargetType", "NamedType", "ArrayType")),
        "names": NameRules(24, False, frozenset()),
        "places": Places("krl"),
        "settings": Settings(modal=True),
        "conversions": frozenset(ir.CONVERSIONS),
        "errors": Errors(handlers=True),
        "io": Io(wait_timeout=True),
    }
    return Capabilities(**{**given, **further})


def context_for(program: ir.Program, capabilities: Capabilities) -> Context:
    made = Context(program.modules[0].dialect, "krl", capabilities, Diagnostics())
    made.taken |= names_in(program)
    return made


def rewritten(program: ir.Program, capabilities: Capabilities, *passes: Pass) -> tuple[ir.Program, Context]:
    given = context_for(program, capabilities)
    for one in passes:
        program = one(program, given)
    diagnostics = Diagnostics()
    normalise(program, diagnostics)
    assert not len(diagnostics), [item.as_text() for item in diagnostics]
    return program, given


def shown(program: ir.Program, **how: Any) -> list[tuple[str, Any]]:
    """Messages, outputs and the end of a run; times are left out."""
    diagnostics = Diagnostics()
    result = run_program(normalise(program, diagnostics), entry="main", max_statements=5000, **how)
    found: list[tuple[str, Any]] = [("message", one) for one in result.messages]
    found += [("output", (name, value)) for _, name, value in result.outputs]
    fault = None if result.fault is None else result.fault["code"] if isinstance(result.fault, dict) else result.fault
    return [*found, (result.status, fault)]


def same(program: ir.Program, capabilities: Capabilities, *passes: Pass, **how: Any) -> ir.Program:
    """The rewritten program, after checking that its run shows the same."""
    wanted = shown(program, **how)
    after, _ = rewritten(program, capabilities, *passes)
    assert shown(after, **how) == wanted
    return after


# ---- programs


def number(value: int) -> ir.Expression:
    return ir.IntLiteral(value) if value >= 0 else ir.Unary("-", ir.IntLiteral(-value))


def step(value: ir.Expression | int) -> ir.CallRoutine:
    return ir.CallRoutine("step", (ir.Argument(number(value) if isinstance(value, int) else value),))


def less(name: str, value: int) -> ir.Binary:
    return ir.Binary("<", ir.Name(name), number(value))


def assign(name: str, value: ir.Expression | int) -> ir.Assign:
    return ir.Assign(ir.Name(name), number(value) if isinstance(value, int) else value)


def when(condition: ir.Expression, *body: ir.Statement, otherwise: ir.Body = ()) -> ir.If:
    return ir.If(((condition, body),), otherwise)


def program(*body: ir.Statement, routines: tuple[ir.Routine, ...] = (), local: bool = False) -> ir.Program:
    """A program of `main` with numbers a, b, i, n; `step(k)` shows k and ends an endless run; `ask(k)` asks as well."""
    whole = ir.IntType()
    plus = assign("n", ir.Binary("+", ir.Name("n"), ir.IntLiteral(1)))
    message = ir.Message("notify", ir.Builtin("value_text", (ir.Name("k"),)))
    end = when(ir.Binary(">", ir.Name("n"), ir.IntLiteral(LONGEST)), ir.Halt("exit"))
    parameter = (ir.Parameter("k", whole),)
    answer = ir.Binary("<>", ir.Binary("mod", ir.Binary("+", ir.Name("n"), ir.Name("k")), number(3)), number(0))
    variables = tuple(ir.Variable(name, whole, ir.IntLiteral(0), scope="module") for name in "abin")
    own = tuple(replace(one, scope="routine") for one in variables if one.name != "n") if local else ()
    return ir.Program(
        (
            ir.Module(
                "m",
                "rpl",
                tuple(one for one in variables if one.name not in {v.name for v in own}),
                (
                    ir.Routine("main", body=body, declarations=own),
                    ir.Routine("step", parameters=parameter, body=(plus, message, end)),
                    ir.Routine(
                        "ask",
                        "function",
                        parameters=parameter,
                        returns=ir.BoolType(),
                        body=(plus, message, end, ir.Return(answer)),
                    ),
                    *routines,
                ),
            ),
        )
    )


_SOME = ir.Binary("+", ir.Name("n"), number(1))  # a step that is known when the program runs


def conditions() -> st.SearchStrategy[ir.Expression]:
    simple = st.one_of(
        st.builds(less, st.sampled_from("abn"), st.integers(0, 9)),
        st.integers(0, 5).map(lambda k: ir.Call("ask", (ir.Argument(ir.IntLiteral(k)),))),
        st.integers(2, 4).map(lambda k: ir.Binary("=", ir.Binary("mod", ir.Name("n"), number(k)), number(0))),
    )
    return st.one_of(
        simple,
        simple.map(lambda c: ir.Unary("not", c)),
        st.builds(ir.Binary, st.sampled_from(("and", "or", "cand", "cor")), simple, simple),
    )


def small(jumps: tuple[str, ...]) -> st.SearchStrategy[ir.Body]:
    each: list[st.SearchStrategy[ir.Body]] = [
        st.integers(1, 99).map(lambda k: (step(k),)),
        st.builds(lambda v, w: (assign(v, ir.Binary("+", ir.Name(w), number(1))),), *[st.sampled_from("ab")] * 2),
        st.just((step(ir.Name("a")), step(ir.Name("i")))),
    ]
    if jumps:
        goto = st.sampled_from(jumps).map(ir.Goto)
        each.append(st.builds(lambda c, g: (when(c, g),), conditions(), goto))
        each.append(goto.map(lambda g: (g,)))
    each.append(conditions().map(lambda c: (when(c, ir.Return()),)))
    return st.one_of(*each)


def bodies(jumps: tuple[str, ...] = (), in_loop: bool = False, depth: int = 3) -> st.SearchStrategy[ir.Body]:
    """Bodies with jumps to these labels (which are put in by `with_labels`)."""
    one = small(jumps)
    if in_loop:
        leaving = st.sampled_from((ir.ExitLoop(), ir.NextPass()))
        one = st.one_of(one, st.builds(lambda c, s: (when(c, s),), conditions(), leaving))
    if depth:
        inner, loop = bodies(jumps, in_loop, depth - 1), bodies(jumps, True, depth - 1).map(lambda b: (step(0), *b))
        bound = st.integers(-1, 4).map(number)
        blocks: list[st.SearchStrategy[ir.Statement]] = [
            st.builds(lambda c, x, y: ir.If(((c, x),), y), conditions(), inner, inner),
            st.builds(lambda c, x, d, y: ir.If(((c, x), (d, y))), conditions(), inner, conditions(), inner),
            st.builds(ir.While, conditions(), loop),
            st.builds(ir.Repeat, conditions(), loop),
            st.builds(ir.Loop, loop),
            st.builds(
                lambda a, b, s, x, once, last: ir.For(
                    "i", a, b, s, x, at_least_once=once, keeps_last=last, automatic=s is None and once
                ),
                *(bound, bound, st.sampled_from((None, number(1), number(-1), number(2), _SOME))),
                *(loop, st.booleans(), st.booleans()),
            ),
            st.builds(
                lambda v, x, y, d: ir.Switch(ir.Name(v), (_case(0, x), _case(1, y)), d),
                *(st.sampled_from("ab"), inner, inner, st.none() | inner),
            ),
        ]
        one = st.one_of(one, one, st.one_of(*blocks).map(lambda s: (s,)))
    return st.lists(one, min_size=1, max_size=3).map(lambda parts: tuple(s for part in parts for s in part))


def _case(value: int, body: ir.Body) -> ir.Case:
    return ir.Case((ir.IntLiteral(value), ir.IntLiteral(value + 2)), body)


def with_labels(body: ir.Body, places: list[int], names: tuple[str, ...]) -> ir.Body:
    """The body with the labels put in at places counted through all its lists; each shows that control came there."""
    count = _slots(body)
    wanted: dict[int, list[str]] = {}
    for place, name in zip(places, names, strict=False):
        wanted.setdefault(place % count, []).append(name)
    at = 0

    def put(inner: ir.Body) -> ir.Body:
        nonlocal at
        done: list[ir.Statement] = []
        for statement in inner:
            done.extend(here())
            done.append(_in_blocks(statement, put))
        done.extend(here())
        return tuple(done)

    def here() -> list[ir.Statement]:
        nonlocal at
        found: list[ir.Statement] = []
        for name in wanted.get(at, ()):
            found += [ir.Label(name), step(100 + int(name[1:]))]
        at += 1
        return found

    return put(body)


def _slots(body: ir.Body) -> int:
    count = 0

    def look(inner: ir.Body) -> ir.Body:
        nonlocal count
        count += len(inner) + 1
        for one in inner:
            _in_blocks(one, look)
        return inner

    look(body)
    return count


def _in_blocks(statement: ir.Statement, change: Any) -> ir.Statement:
    match statement:
        case ir.If(branches=branches, otherwise=otherwise):
            done = tuple((condition, change(body)) for condition, body in branches)
            return replace(statement, branches=done, otherwise=change(otherwise))
        case ir.Switch(cases=cases, default=default):
            cases = tuple(replace(case, body=change(case.body)) for case in cases)
            return replace(statement, cases=cases, default=None if default is None else change(default))
        case ir.While() | ir.Repeat() | ir.Loop():  # what a jump into a counting loop does nobody says
            return replace(statement, body=change(statement.body))
    return statement


LABELS = ("L0", "L1", "L2", "L3")


def jumping(count: int = 3, depth: int = 2) -> st.SearchStrategy[ir.Body]:
    """Bodies with labels anywhere and jumps to them from anywhere, also into blocks."""
    names = LABELS[:count]
    places = st.lists(st.integers(0, 200), min_size=count, max_size=count)
    return st.builds(lambda body, where: with_labels(body, where, names), bodies(names, depth=depth), places)
