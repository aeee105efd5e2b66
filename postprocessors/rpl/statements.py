"""Statements as RPL writes them: one line each, blocks with their insides indented, comments where they were."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from rpl import ir
from rpl.errors import InternalError
from rpl.ir import words
from rpl.source import Comment, Origin

from .expressions import (
    arguments_text,
    expression_text,
    name_text,
    place_text,
    procedure_name,
    state_text,
    text_literal,
    value_text,
)
from .motion import define_trigger_text, move_external_text, move_text, path_rule_text, spline_head_text, trigger_text

INDENT = "    "
_HALTS = {kind: f"HALT {word.upper()}".strip() for word, kind in words.HALT_WORDS.items()}
_KEYWORDS: dict[type, str] = {
    ir.ExitLoop: "EXIT",
    ir.NextPass: "CONTINUE",
    ir.WaitForMotion: "WAIT FOR MOTION",
    ir.LookAhead: "LOOK AHEAD",
    ir.StartMotion: "START MOTION",
    ir.ClearMotion: "CLEAR MOTION",
    ir.ResumeLevel: "RESUME LEVEL",
    ir.Retry: "RETRY",
    ir.TryNext: "TRY NEXT",
}


def comment_texts(comments: Iterable[Comment]) -> Iterator[str]:
    """Comments as lines; a remark that holds line ends becomes several."""
    for comment in comments:
        for line in comment.text.splitlines() or [""]:
            yield f"-- {line.strip()}".rstrip()


def headed(line: str, origin: Origin, indent: str, extra: tuple[Comment, ...] = ()) -> Iterator[str]:
    """A statement's line with the comments before and behind it."""
    comments = (*origin.comments, *extra)
    before = [comment for comment in comments if not comment.behind]
    behind = " ".join(text.removeprefix("-- ") for text in comment_texts(c for c in comments if c.behind))
    yield from (indent + text for text in comment_texts(before))
    yield f"{indent}{line} -- {behind}".rstrip() if behind else indent + line


def standing(origin: Origin, indent: str, otherwise: str, last: bool) -> Iterator[str]:
    """A remark that belongs to no statement: an empty line keeps it from the next one."""
    if not origin.comments:
        yield indent + otherwise
        return
    yield from (indent + text for text in comment_texts(origin.comments))
    if not last:
        yield ""


def body_lines(body: ir.Body, indent: str, lead: tuple[Comment, ...] = ()) -> Iterator[str]:
    """The statements of a block. `lead`: comments of the block's head that have no line of their own."""
    yield from (indent + text for text in comment_texts(lead))
    for position, statement in enumerate(body):
        last = position == len(body) - 1
        if isinstance(statement, ir.Nothing):
            yield from standing(statement.origin, indent, "NOTHING", last)
        else:
            yield from statement_lines(statement, indent)


def statement_lines(statement: ir.Statement, indent: str) -> Iterator[str]:
    """One statement with its inside."""
    inner = indent + INDENT
    match statement:
        case ir.If():
            yield from _if(statement, indent)
        case ir.Switch():
            yield from _switch(statement, indent)
        case ir.For(body=body):
            yield from headed(_for_head(statement), statement.origin, indent)
            yield from body_lines(body, inner)
            yield f"{indent}END FOR"
        case ir.While(condition=condition, body=body):
            yield from headed(f"WHILE {expression_text(condition)}", statement.origin, indent)
            yield from body_lines(body, inner)
            yield f"{indent}END WHILE"
        case ir.Repeat(until=until, body=body):
            yield from headed("REPEAT", statement.origin, indent)
            yield from body_lines(body, inner)
            yield f"{indent}UNTIL {expression_text(until)}"
        case ir.Loop(body=body):
            yield from headed("LOOP", statement.origin, indent)
            yield from body_lines(body, inner)
            yield f"{indent}END LOOP"
        case ir.Spline(body=body):
            yield from headed(spline_head_text(statement), statement.origin, indent)
            yield from body_lines(body, inner)
            yield f"{indent}END SPLINE"
        case ir.Instruction(parts=parts):
            yield from body_lines(parts, indent)
        case _:
            yield from headed(line_text(statement), statement.origin, indent)


def _if(statement: ir.If, indent: str) -> Iterator[str]:
    for position, (condition, body) in enumerate(statement.branches):
        if position == 0:
            yield from headed(f"IF {expression_text(condition)} THEN", statement.origin, indent)
        else:
            yield f"{indent}ELSEIF {expression_text(condition)} THEN"
        yield from body_lines(body, indent + INDENT)
    if statement.otherwise:
        yield f"{indent}ELSE"
        yield from body_lines(statement.otherwise, indent + INDENT)
    yield f"{indent}END IF"


def _switch(statement: ir.Switch, indent: str) -> Iterator[str]:
    # A comment of a case without a body has no line there; it goes up to the head.
    homeless = tuple(c for case in statement.cases if not case.body for c in case.origin.comments)
    yield from headed(f"SWITCH {expression_text(statement.selector)}", statement.origin, indent, homeless)
    for case in statement.cases:
        yield f"{indent}CASE {', '.join(expression_text(value) for value in case.values)}"
        yield from body_lines(case.body, indent + INDENT, case.origin.comments if case.body else ())
    if statement.default is not None:
        yield f"{indent}DEFAULT"
        yield from body_lines(statement.default, indent + INDENT)
    yield f"{indent}END SWITCH"


def _for_head(loop: ir.For) -> str:
    text = f"FOR {name_text(loop.counter)} = {expression_text(loop.start)} TO {expression_text(loop.stop)}"
    if loop.step is not None:
        text += f" STEP {expression_text(loop.step)}"
    if loop.automatic:
        text += " EITHER WAY"
    if loop.at_least_once:
        text += " AT LEAST ONCE"
    if loop.scoped:
        text += " SCOPED"
    return text + " KEEPS LAST" if loop.keeps_last else text


def line_text(statement: ir.Statement) -> str:
    """A statement that has no inside, without its comments."""
    keyword = _KEYWORDS.get(statement.__class__)
    if keyword is not None:
        return keyword
    match statement:
        case ir.Assign(target=ir.Signal() as target, value=value):
            return f"SET {expression_text(target)} TO {state_text(value)}"
        case ir.Assign(target=target, value=value):
            return f"{place_text(target)} = {value_text(value)}"
        case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
            return f"{procedure_name(name)}({arguments_text(arguments)})"
        case ir.CallRoutine(name=name, arguments=arguments, dynamic=dynamic) if dynamic is not None:
            return _call_by_name(name, arguments, dynamic)
        case ir.Do(procedure=procedure, arguments=values):
            given = ("?" if value is None else expression_text(value) for value in values)
            return f"{procedure}({', '.join(given)})"
        case ir.Move():
            return move_text(statement, line_text)
        case ir.MoveExternal():
            return move_external_text(statement)
        case ir.Trigger():
            return trigger_text(statement, line_text)
        case ir.PathRule():
            return path_rule_text(statement)
        case ir.DefineTrigger():
            return define_trigger_text(statement, line_text)
        case ir.Nothing():
            return "NOTHING"
    return _flow_text(statement)


def _call_by_name(name: str, arguments: tuple[ir.Argument, ...], dynamic: ir.Expression) -> str:
    known = f"{name_text(name)} " if name else ""
    given = f" PASSING ({arguments_text(arguments)})" if arguments else ""
    return f"CALL {known}BY {expression_text(dynamic)}{given}"


def _flow_text(statement: ir.Statement) -> str:
    match statement:
        case ir.Label(name=name):
            return f"LABEL {name_text(name)}"
        case ir.Goto(label=label):
            return f"GOTO {name_text(label)}"
        case ir.Return(value=value):
            return f"RETURN{_behind('', value)}"
        case ir.Halt(kind=kind):
            return _HALTS[kind]
        case ir.Raise(code=code):
            return f"RAISE{_behind('', code)}"
        case ir.Wait(time=time, in_position=in_position):
            return f"WAIT {expression_text(time)}{' AT REST' if in_position else ''}"
        case ir.WaitUntil():
            return _wait_until(statement)
        case ir.Pulse(signal=signal, value=value, duration=duration):
            return f"PULSE {place_text(signal)} TO {state_text(value)} FOR {expression_text(duration)}"
        case ir.SetAfter(signal=signal, value=value, delay=delay):
            return f"SET {place_text(signal)} TO {state_text(value)} AFTER {expression_text(delay)}"
        case ir.StopMotion(hard=hard):
            return "STOP MOTION HARD" if hard else "STOP MOTION"
        case ir.StoreMotion(restore=restore):
            return "RESTORE MOTION" if restore else "STORE MOTION"
        case ir.Clock(op=op, clock=clock):
            return f"CLOCK {op.upper()} {place_text(clock)}"
        case ir.TaskControl(op=op, task=task, arguments=arguments):
            given = f"({arguments_text(arguments)})" if arguments else ""
            return f"{op.upper()} TASK {name_text(task)}{given}"
        case ir.Meet():
            return _meet(statement)
        case ir.Critical(enter=enter):
            return "ENTER CRITICAL" if enter else "LEAVE CRITICAL"
        case ir.SetForNextMove(setting=setting, value=value):
            return f"FOR NEXT MOVE {place_text(setting)} = {value_text(value)}"
        case ir.OnError(routine=routine):
            return "TRAP ERRORS OFF" if routine is None else f"TRAP ERRORS WITH {name_text(routine)}"
        case ir.Vendor(dialect=dialect, text=text, effect=effect):
            return f"VENDOR {name_text(dialect)} {text_literal(text)} EFFECT {name_text(effect)}"
        case ir.Opaque(text=text):
            return f"OPAQUE {text_literal(text)}"
        case ir.Message() | ir.Dialog():
            return _operator_text(statement)
    return _interrupt_text(statement)


def _behind(word: str, value: ir.Expression | None) -> str:
    """A clause with a blank before it, or nothing."""
    if value is None:
        return ""
    return f" {word} {expression_text(value)}" if word else f" {expression_text(value)}"


def _place_behind(word: str, value: ir.Expression | None) -> str:
    return "" if value is None else f" {word} {place_text(value)}"


def _wait_until(wait: ir.WaitUntil) -> str:
    text = f"WAIT UNTIL {expression_text(wait.condition)}{_behind('TIMEOUT', wait.timeout)}"
    text += _place_behind("FLAG", wait.timed_out)
    if wait.error is not None:
        text += f" ERROR {name_text(wait.error)}"
    return text + " AT REST" if wait.in_position else text


def _meet(meet: ir.Meet) -> str:
    word = "AT" if meet.mode == "wait" else meet.mode.upper()
    text = f"MEET {word} {expression_text(meet.identity)}{_behind('WITH', meet.tasks)}"
    text += _behind("TIMEOUT", meet.timeout)
    if meet.error is not None:
        text += f" ERROR {name_text(meet.error)}"
    return text + " AT REST" if meet.in_position else text


def _operator_text(statement: ir.Message | ir.Dialog) -> str:
    match statement:
        case ir.Message(kind=kind, text=text, sender=sender):
            kind_text = "" if kind == "notify" else f" KIND {name_text(kind)}"
            return f"MESSAGE {expression_text(text)}{kind_text}{_behind('FROM', sender)}"
        case ir.Dialog():
            line = f"ASK {expression_text(statement.text)} INTO {place_text(statement.answer)}"
            if statement.keys:
                keys = ("?" if key is None else expression_text(key) for key in statement.keys)
                line += f" KEYS ({', '.join(keys)})"
            if statement.kind != "keys":
                line += f" KIND {name_text(statement.kind)}"
            line += _behind("TIMEOUT", statement.timeout) + _place_behind("FLAG", statement.timed_out)
            return line + _behind("FROM", statement.sender)


def _interrupt_text(statement: ir.Statement) -> str:
    match statement:
        case ir.DeclareInterrupt(priority=priority, condition=condition, action=action):
            words = ((statement.everywhere, " EVERYWHERE"), (statement.once, " ONCE"), (statement.stops, " BRAKING"))
            where = "".join(word for said, word in words if said) + _behind("NAMED", statement.identity)
            when = f"WHEN {expression_text(condition)} DO {line_text(action)}"
            return f"DECLARE INTERRUPT {expression_text(priority)}{where} {when}"
        case ir.ConnectInterrupt(handle=handle, routine=routine):
            return f"CONNECT {place_text(handle)} TO {name_text(routine)}"
        case ir.OrderInterrupt(handle=handle, event=event, condition=condition, time=time, once=once):
            text = f"ARM {place_text(handle)} ON {name_text(event)}"
            text += _behind("WHEN", condition) + _behind("TIME", time)
            return text + " ONCE" if once else text
        case ir.ControlInterrupt(op=op, handle=handle):
            return f"INTERRUPT {op.upper()}{_behind('', handle)}"
    raise InternalError(f"RPL has no form for {statement.__class__.__name__}")
