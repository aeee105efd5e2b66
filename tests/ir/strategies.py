"""Hypothesis strategies for every node of the IR, each well formed by itself.

Names may be anything a language allows, keywords of RPL among them. Trees stay small (`LEAVES`), so that many fit into
a second. A program made of them need not make sense: labels may be missing, types may clash. For programs that run, see
tests/ir/programs.py.
"""

from __future__ import annotations

from dataclasses import replace

from hypothesis import strategies as st

from rpl import ir
from rpl.ir import words
from rpl.source import Comment, Origin

LEAVES = 5
_PLAIN = ("x", "y1", "Part_Count", "home", "i", "result", "xP1", "tool", "speed", "e1", "m", "value", "Größe")
_ODD = ("$POS", "a.b", "two words", "`", "\\", "", "1st", "día-2", "tab\there", "ſet", "K", "x:", "--", "line\nend")
_RESERVED = sorted(words.RESERVED | words.FUNCTION_WORDS | words.PROCEDURE_WORDS | frozenset(words.TYPE_WORDS))
_MORE = ("until", "THEN", "do", "to", "Trigger", "if", "present", "task", "in", "end", "as", "joint", "of", "into")

names = st.one_of(
    st.sampled_from(_PLAIN),
    st.sampled_from(_PLAIN),
    st.sampled_from(_ODD),
    st.sampled_from(_RESERVED),
    st.sampled_from(_MORE),
    st.text(max_size=6),
)
_TEXTS = ("", "weld", 'say "x"', "back\\slash", "two\nlines", "-- no comment", "a;b")
texts = st.one_of(st.sampled_from(_TEXTS), st.text())
dialects = st.sampled_from(("rpl", "krl", "rapid"))


# ---- expressions

ints = st.builds(ir.IntLiteral, st.one_of(st.integers(0, 300), st.integers(-(2**31), 2**31 - 1)))
reals = st.builds(ir.RealLiteral, st.floats(allow_nan=False, allow_infinity=False))
_leaf_system = st.sampled_from(sorted(name for name, row in ir.SYSTEM_VARIABLES.items() if not row.indexed))
_indexed_system = st.sampled_from(sorted(name for name, row in ir.SYSTEM_VARIABLES.items() if row.indexed))
signal_kinds = st.sampled_from(ir.SIGNAL_KINDS)
_functions = st.sampled_from(sorted({*ir.FUNCTIONS, *ir.PROCEDURES}))
units = st.sampled_from(sorted(ir.UNITS))

leaves: st.SearchStrategy[ir.Expression] = st.one_of(
    ints,
    reals,
    st.builds(ir.BoolLiteral, st.booleans()),
    st.builds(ir.TextLiteral, texts),
    st.builds(ir.EnumLiteral, names),
    st.builds(ir.Name, names),
    st.builds(ir.Name, names),
    st.builds(ir.Present, names),
    st.builds(ir.System, _leaf_system),
    st.builds(ir.Signal, signal_kinds, name=names),
    st.builds(ir.VendorValue, dialects, texts, st.sampled_from((ir.RealType(), ir.BoolType(), ir.TargetType("krl")))),
)


def signals(inner: st.SearchStrategy[ir.Expression]) -> st.SearchStrategy[ir.Signal]:
    return st.one_of(
        st.builds(ir.Signal, signal_kinds, inner),
        st.builds(ir.Signal, signal_kinds, inner, inner),
        st.builds(ir.Signal, signal_kinds, name=names),
    )


def places(inner: st.SearchStrategy[ir.Expression]) -> st.SearchStrategy[ir.Expression]:
    """What can be assigned to."""
    name = st.builds(ir.Name, names)
    some = st.lists(inner, min_size=1, max_size=3).map(tuple)
    return st.one_of(
        name,
        st.builds(ir.Index, name, some),
        st.builds(ir.Field, name, names),
        st.builds(ir.Field, st.builds(ir.Index, name, some), names),
        st.builds(ir.System, _indexed_system, some),
        signals(inner),
    )


def arguments(inner: st.SearchStrategy[ir.Expression]) -> st.SearchStrategy[tuple[ir.Argument, ...]]:
    one = st.one_of(
        st.builds(ir.Argument, inner),
        st.builds(ir.Argument, st.one_of(st.none(), inner), names, st.one_of(st.none(), names)),
        st.builds(ir.Argument, st.none()),
    )
    return st.lists(one, max_size=3).map(tuple)


def _larger(inner: st.SearchStrategy[ir.Expression]) -> st.SearchStrategy[ir.Expression]:
    some = st.lists(inner, min_size=1, max_size=3).map(tuple)
    entries = st.lists(st.tuples(st.one_of(st.none(), names), inner), max_size=3).map(tuple)
    type_names = st.one_of(st.none(), names, st.sampled_from(("target krl", "configuration rapid", "joints")))
    return st.one_of(
        st.builds(ir.Binary, st.sampled_from(ir.BINARY_OPERATORS), inner, inner),
        st.builds(ir.Binary, st.sampled_from(ir.BINARY_OPERATORS), inner, inner),
        st.builds(ir.Unary, st.sampled_from(ir.UNARY_OPERATORS), inner),
        st.builds(ir.Call, names, arguments(inner)),
        st.builds(ir.Builtin, _functions, st.lists(inner, max_size=3).map(tuple)),
        st.builds(ir.Convert, st.sampled_from(ir.CONVERSIONS), inner),
        st.builds(ir.Quantity, inner, units),
        st.builds(ir.Magnitude, inner, units),
        st.builds(ir.Aggregate, entries, type_names),
        st.builds(ir.Index, inner, some),
        st.builds(ir.Field, inner, names),
        st.builds(ir.System, _indexed_system, some),
        signals(inner),
    )


expressions: st.SearchStrategy[ir.Expression] = st.recursive(leaves, _larger, max_leaves=LEAVES)
small = st.recursive(leaves, _larger, max_leaves=2)
maybe = st.one_of(st.none(), small)
lvalues = places(leaves)


# ---- motion

assignments = st.builds(ir.Assign, lvalues, small)
calls = st.one_of(
    st.builds(ir.CallRoutine, names, arguments(leaves)),
    st.builds(ir.CallRoutine, names, arguments(leaves), small),
)
actions = st.one_of(assignments, calls)
speeds = st.builds(ir.Speed, *[maybe] * 8)
distances = st.builds(ir.BlendDistance, maybe, maybe)
blends = st.one_of(
    st.builds(ir.BlendStop),
    distances,
    st.builds(ir.BlendPercent, small, st.one_of(st.none(), distances, st.builds(ir.BlendSpeed, small))),
    st.builds(ir.BlendSpeed, small),
    st.builds(ir.BlendLevel, small),
    st.builds(ir.BlendZone, small, maybe, maybe),
)
triggers = st.builds(ir.Trigger, st.sampled_from(("start", "end", "middle")), actions, maybe, maybe, maybe)
searches = st.builds(
    ir.Search,
    small,
    st.one_of(st.none(), lvalues),
    st.sampled_from(("none", "stop", "path", "soft")),
    st.sampled_from(("rising", "falling", "either")),
    st.one_of(st.none(), lvalues),
)
bindings = st.lists(st.tuples(lvalues, small), max_size=2).map(tuple)


def _one(*words_: str) -> st.SearchStrategy[str | None]:
    return st.sampled_from((None, *words_))


@st.composite
def moves(draw: st.DrawFn) -> ir.Move:
    """A move with a few of its many settings."""
    settings = {
        "via": small,
        "swept": small,
        "relative": _one("base", "tool", "joints"),
        "tool": small,
        "frame": small,
        "load": small,
        "speed": speeds,
        "acceleration": small,
        "blend": blends,
        "orientation": _one("variable", "constant", "wrist"),
        "circle_orientation": _one("base", "path"),
        "configuration": _one("exact", "nearest"),
        "triggers": st.lists(st.one_of(small, triggers), max_size=2).map(tuple),
        "search": searches,
        "settings": bindings,
        "concurrent": st.booleans(),
        "without_offsets": st.booleans(),
        "group": st.integers(1, 5),
        "identity": small,
        "motion_class": st.sampled_from(("classic", "spline", "process", "velocity", "servo")),
    }
    chosen = draw(st.lists(st.sampled_from(sorted(settings)), unique=True, max_size=4))
    kind = draw(st.sampled_from(("joint", "linear", "circular", "spline")))
    return ir.Move(kind, draw(small), **{name: draw(settings[name]) for name in chosen})  # type: ignore[arg-type]


# ---- statements

BARE: tuple[ir.Statement, ...] = (
    ir.ExitLoop(),
    ir.NextPass(),
    ir.WaitForMotion(),
    ir.LookAhead(),
    ir.StartMotion(),
    ir.ClearMotion(),
    ir.ResumeLevel(),
    ir.Retry(),
    ir.TryNext(),
    ir.Nothing(),
)
IN_SPLINE = (
    ir.Nothing(),
    ir.PathRule("time_start"),
    ir.PathRule("constant_end", ir.RealLiteral(-5.0), "start"),
    ir.Vendor("krl", "TIME_BLOCK START", "time"),
    ir.Opaque("?"),
)
simple: st.SearchStrategy[ir.Statement] = st.one_of(
    assignments,
    calls,
    moves(),
    moves(),
    st.builds(ir.MoveExternal, small, st.one_of(st.none(), speeds), st.one_of(st.none(), blends)),
    triggers,
    st.builds(ir.DefineTrigger, lvalues, triggers, maybe),
    st.sampled_from(BARE),
    st.builds(ir.Label, names),
    st.builds(ir.Goto, names),
    st.builds(ir.Return, maybe),
    st.builds(ir.Halt, st.sampled_from(("stop", "exit", "cycle"))),
    st.builds(ir.Wait, small, st.booleans()),
    st.builds(ir.WaitUntil, small, maybe, st.one_of(st.none(), lvalues), st.one_of(st.none(), names), st.booleans()),
    st.builds(ir.Pulse, lvalues, small, small),
    st.builds(ir.SetAfter, lvalues, small, small),
    st.builds(ir.DeclareInterrupt, small, small, actions, st.booleans(), maybe, st.booleans(), st.booleans()),
    st.builds(ir.ConnectInterrupt, lvalues, names),
    st.builds(
        ir.OrderInterrupt,
        lvalues,
        st.sampled_from(("edge", "timer", "change", "error")),
        maybe,
        maybe,
        st.booleans(),
    ),
    st.builds(ir.ControlInterrupt, st.sampled_from(("on", "off", "enable", "disable", "delete", "mask")), maybe),
    st.builds(ir.StopMotion, st.booleans()),
    st.builds(ir.StoreMotion, st.booleans()),
    st.builds(ir.Raise, maybe),
    st.builds(ir.Message, st.sampled_from(("notify", "state", "quit", "write", "error", "clear")), small, maybe),
    st.builds(
        ir.Dialog,
        lvalues,
        small,
        st.lists(maybe, max_size=3).map(tuple),
        st.sampled_from(("keys", "number", "text")),
        maybe,
        st.one_of(st.none(), lvalues),
        maybe,
    ),
    st.builds(ir.Clock, st.sampled_from(("reset", "start", "stop")), lvalues),
    st.builds(ir.Do, st.sampled_from(sorted(ir.PROCEDURES)), st.lists(maybe, max_size=3).map(tuple)),
    st.builds(ir.TaskControl, st.sampled_from(("start", "stop", "pause", "resume", "join")), names, arguments(leaves)),
    st.builds(ir.Vendor, dialects, texts, st.sampled_from(("none", "message", "time", "unknown"))),
    st.builds(ir.Critical, st.booleans()),
    st.builds(
        ir.Meet,
        small,
        maybe,
        st.sampled_from(("wait", "together", "apart")),
        maybe,
        st.one_of(st.none(), names),
        st.booleans(),
    ),
    st.builds(ir.SetForNextMove, lvalues, small),
    st.builds(ir.OnError, st.one_of(st.none(), names)),
    st.builds(ir.Opaque, texts),
)
_remarks = st.sampled_from(("", "remark", "a -- b", "x\ny", '"'))
comments = st.lists(st.builds(Comment, _remarks, st.booleans()), max_size=2)


@st.composite
def _commented(draw: st.DrawFn) -> ir.Statement:
    statement = draw(simple)
    given = draw(comments)
    return replace(statement, origin=Origin(comments=tuple(given))) if given else statement


def _blocks(inner: st.SearchStrategy[ir.Statement]) -> st.SearchStrategy[ir.Statement]:
    body = st.lists(inner, max_size=2).map(tuple)
    branches = st.lists(st.tuples(small, body), min_size=1, max_size=2).map(tuple)
    cases = st.lists(
        st.builds(ir.Case, st.lists(small, min_size=1, max_size=2).map(tuple), body), min_size=1, max_size=2
    ).map(tuple)
    return st.one_of(
        st.builds(ir.If, branches, body),
        st.builds(ir.Switch, small, cases, st.one_of(st.none(), body)),
        st.builds(ir.For, names, small, small, maybe, body, *[st.booleans()] * 4),
        st.builds(ir.While, small, body),
        st.builds(ir.Repeat, small, body),
        st.builds(ir.Loop, body),
        st.builds(
            ir.Spline,
            st.sampled_from(("path", "joint")),
            st.lists(st.one_of(moves(), triggers, assignments, st.sampled_from(IN_SPLINE)), max_size=2).map(tuple),
            st.one_of(st.none(), blends),
            bindings,
        ),
    )


statements: st.SearchStrategy[ir.Statement] = st.recursive(_commented(), _blocks, max_leaves=LEAVES)
bodies = st.lists(statements, max_size=3).map(tuple)


# ---- types and declarations

PLAIN_TYPES: tuple[ir.Type, ...] = (*words.TYPE_WORDS.values(), ir.JointsType(external=False))
_plain_types = st.sampled_from(PLAIN_TYPES)
_types: st.SearchStrategy[ir.Type] = st.one_of(
    _plain_types,
    st.builds(ir.NamedType, names),
    st.builds(ir.StringType, maybe),
    st.builds(ir.TargetType, dialects, st.booleans()),
    st.builds(ir.ConfigType, dialects),
    st.builds(ir.SignalType, signal_kinds),
    st.builds(ir.VendorType, dialects, names),
)
types = st.one_of(
    _types,
    st.builds(ir.ArrayType, _types, st.lists(maybe, min_size=1, max_size=3).map(tuple), st.integers(0, 1)),
)
scopes = st.sampled_from(ir.SCOPES)
declarations: st.SearchStrategy[ir.Declaration] = st.one_of(
    st.builds(ir.Variable, names, types, maybe, st.sampled_from(("constant", "variable", "persistent")), scopes),
    st.builds(ir.RecordDeclaration, names, st.lists(st.tuples(names, types), max_size=3).map(tuple), scopes),
    st.builds(ir.EnumDeclaration, names, st.lists(names, max_size=3).map(tuple), scopes),
    st.builds(ir.AliasDeclaration, names, types, scopes),
    st.builds(ir.SignalDeclaration, names, signals(leaves), scopes),
    st.builds(ir.ExternalDeclaration, names, texts),
    st.builds(ir.Initialise, assignments),
    st.builds(ir.Unread, texts),
    st.just(ir.Unread("", origin=Origin(comments=(Comment("alone"),)))),
)
parameters = st.builds(
    ir.Parameter,
    names,
    types,
    st.sampled_from(("value", "reference", "readonly")),
    st.booleans(),
    st.booleans(),
    st.one_of(st.none(), st.integers(0, 9)),
)
handlers = st.builds(ir.Handler, st.lists(small, max_size=2).map(tuple), bodies)


@st.composite
def routines(draw: st.DrawFn) -> ir.Routine:
    """A routine with some of its sections."""
    return ir.Routine(
        draw(names),
        draw(st.sampled_from(("procedure", "function", "trap"))),
        tuple(draw(st.lists(parameters, max_size=2, unique_by=lambda one: one.name.lower()))),
        draw(st.one_of(st.none(), types)),
        tuple(draw(st.lists(declarations, max_size=2))),
        draw(bodies),
        tuple(draw(st.lists(handlers, max_size=1))),
        draw(st.one_of(st.just(()), bodies)),
        draw(st.one_of(st.just(()), bodies)),
        draw(st.sampled_from(("module", "task", "global"))),
        open_ended=draw(st.booleans()),
    )


modules = st.builds(
    ir.Module,
    names,
    dialects,
    st.lists(declarations, max_size=3).map(tuple),
    st.lists(routines(), max_size=2).map(tuple),
    st.lists(st.tuples(texts, texts), max_size=1).map(tuple),
    st.one_of(st.just(""), names),
    st.booleans(),
)
tasks = st.builds(
    ir.Task,
    names,
    names,
    st.sampled_from(("motion", "background")),
    st.booleans(),
    st.lists(names, max_size=2).map(tuple),
)
programs = st.builds(
    ir.Program,
    st.lists(modules, max_size=2).map(tuple),
    st.lists(tasks, max_size=1).map(tuple),
    st.one_of(st.just(""), names),
)
