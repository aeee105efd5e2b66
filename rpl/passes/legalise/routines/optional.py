"""Optional parameters, arguments left out, and calls by a computed name, in the way that the target has them.

For a target without optional parameters each becomes an ordinary one, with a BOOL beside it where the routine asks
whether it was given; calls pass a neutral value for what they leave out. For a target with optional parameters, those
that some call leaves out (KRL `f(1,,2)`) are declared optional. A call by name becomes a choice between the procedures
that it can mean.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.errornames import spelled_among
from rpl.ir.walk import bodies
from rpl.passes.capabilities import NameRules, Parameters, Passing, RoutineRule
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks, expressions_in, statements_in
from rpl.passes.legalise.facts.entries import calls_of, never_called, reached
from rpl.passes.legalise.facts.values.heldtexts import HeldTexts, as_written_before, text_beginning
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.support import default_value
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope

NO_CANDIDATE = code(
    "dynamic-call-unknown", Severity.LOSS, "no procedure that was read can be meant by this call by name"
)


_BY_VALUE = (ir.IntType, ir.RealType, ir.StringType, ir.CharType)


@dataclass(slots=True)
class _Facts:
    """What calls leave out and what routines ask, by folded routine and parameter name."""

    left_out: set[tuple[str, str]] = field(default_factory=set)
    asked: set[tuple[str, str]] = field(default_factory=set)
    given: dict[tuple[str, str], str] = field(default_factory=dict)


def names_stay(program: ir.Program, rules: NameRules) -> bool:
    """Can the procedures keep their names, so that a text names them in the target as well?"""
    for module in program.modules:
        for routine in module.routines:
            name = routine.name.lower()
            fits = name[:1] in rules.first and all(sign in rules.further for sign in name[1:])
            longest = rules.longest_routine or rules.longest
            if routine.kind == "procedure" and (not fits or name in rules.reserved or len(name) > longest):
                return False
    return True


@legalising()
def fit_parameters(program: ir.Program, context: Context) -> ir.Program:
    """The program with parameters, arguments and calls by name as the target has them."""
    can = context.capabilities
    if (
        RoutineRule.COMPUTED_NAMES not in can.routines.rules
        or can.routines.parameters is not Parameters.NAMES
        or not names_stay(program, can.names)
    ):
        chosen = edit_routines(program, context, lambda editor, routine: edit_bodies(routine, _Dynamic(editor).body))
        program = _with_entry(program, chosen)
    facts = _facts(program)
    if facts.left_out:
        program = _asking_presence(program, facts)
        facts = _facts(program)
    optional = any(p.optional or p.switch for m in program.modules for r in m.routines for p in r.parameters)
    if Passing.OPTIONAL in context.capabilities.routines.passing:
        return _declared(program, facts) if facts.left_out else program
    if not optional and not facts.left_out and not facts.asked:
        return program
    for module in program.modules:
        for routine in module.routines:
            for parameter in routine.parameters:
                key = routine.name.lower(), parameter.name.lower()
                if key in facts.asked and not parameter.switch:
                    facts.given[key] = context.fresh(f"{parameter.name}_given")
    program = edit_routines(program, context, lambda editor, routine: _Calls(editor, facts, routine).routine())
    modules = tuple(
        replace(module, routines=tuple(_mandatory(routine, facts) for routine in module.routines))
        for module in program.modules
    )
    return replace(program, modules=modules)


def _with_entry(program: ir.Program, chosen: ir.Program) -> ir.Program:
    """The program with choices. Where a choice may call the routine that the program starts with, nobody could tell
    any more which one that is: it is named, being the only one that nobody calls and that leads to a call by name."""
    if program.entry or any(task.kind == "motion" for task in program.tasks):
        return chosen
    before, after, calls = never_called(program), never_called(chosen), calls_of(program)
    by_name = {
        routine.name.lower()
        for module in program.modules
        for routine in module.routines
        if any(
            isinstance(node, ir.CallRoutine) and node.dynamic is not None for node in walk_for({"CallRoutine"}, routine)
        )
    }
    starts = [name for name in sorted(before) if reached(name, calls) & by_name]
    if len(starts) != 1 or starts[0] in after:
        return chosen
    spelled = (routine.name for module in program.modules for routine in module.routines)
    return replace(chosen, entry=next(name for name in spelled if name.lower() == starts[0]))


def _slots(
    routine: ir.Routine, arguments: tuple[ir.Argument, ...], scope: Scope
) -> list[tuple[ir.Parameter, ir.Argument | None]]:
    """For each parameter the argument that a call gives it."""
    by_name: dict[str, ir.Argument] = {}
    ordered: list[ir.Argument] = []
    for one in arguments:
        if one.name:
            by_name[scope.fold(one.name)] = one
        else:
            ordered.append(one)
    positional = iter(ordered)
    done: list[tuple[ir.Parameter, ir.Argument | None]] = []
    for parameter in routine.parameters:
        found: ir.Argument | None = by_name.get(scope.fold(parameter.name))
        if found is None and not parameter.optional and not parameter.switch:
            found = next(positional, None)
        if found is not None and found.value is None and not found.name:
            found = None
        done.append((parameter, found))
    return done


def _facts(program: ir.Program) -> _Facts:
    facts = _Facts()
    scopes = ProgramScope(program)
    for module, routine in scopes.routines():
        scope = scopes.routine(module, routine)
        here = routine.name.lower()
        for body in bodies(routine):
            for statement in statements_in(body):
                if isinstance(statement, ir.CallRoutine) and statement.dynamic is None:
                    _call(facts, here, statement.name, statement.arguments, scope)
                for action in _actions(statement):
                    _call(facts, here, action.name, action.arguments, scope)
                for one in expressions_in(statement, {"Present", "Call"}):
                    if isinstance(one, ir.Present):
                        facts.asked.add((here, one.name.lower()))
                    elif isinstance(one, ir.Call):
                        _call(facts, here, one.name, one.arguments, scope)
    return facts


def _asking_presence(program: ir.Program, facts: _Facts) -> ir.Program:
    """`VARSTATE` of a parameter that calls leave out asks whether it was given."""

    def asked(routine: ir.Routine) -> ir.Routine:
        missing = {parameter for name, parameter in facts.left_out if name == routine.name.lower()}

        def expression(node: ir.Expression) -> ir.Expression:
            match node:
                case ir.Builtin(function="is_uninitialised", arguments=(ir.Name(id=name),)) if name.lower() in missing:
                    return ir.Unary("not", ir.Present(name, origin=node.origin), origin=node.origin)
                case ir.Unary(op="not", operand=operand):
                    return (
                        negation(expression(operand))
                        if isinstance(operand, ir.Builtin)
                        else rewrite_parts(node, expression)
                    )
            return rewrite_parts(node, expression)

        def body(statements: ir.Body) -> ir.Body:
            return tuple(rewrite_parts(statement, expression, body) for statement in statements)

        return edit_bodies(routine, body) if missing else routine

    modules = tuple(replace(module, routines=tuple(map(asked, module.routines))) for module in program.modules)
    return replace(program, modules=modules)


def _actions(statement: ir.Statement) -> list[ir.CallRoutine]:
    match statement:
        case ir.DeclareInterrupt(action=ir.CallRoutine() as action) | ir.Trigger(action=ir.CallRoutine() as action):
            return [action]
        case ir.Move(triggers=triggers):
            return [
                one.action for one in triggers if isinstance(one, ir.Trigger) and isinstance(one.action, ir.CallRoutine)
            ]
    return []


def _call(facts: _Facts, here: str, name: str, arguments: tuple[ir.Argument, ...], scope: Scope) -> None:
    for one in arguments:
        if one.if_present:
            facts.asked.add((here, one.if_present.lower()))
    routine = scope.routine(name)
    if routine is None:
        return
    for parameter, argument in _slots(routine, arguments, scope):
        if argument is None and not parameter.optional and not parameter.switch:
            facts.left_out.add((routine.name.lower(), parameter.name.lower()))


# ---- for targets with optional parameters


def _declared(program: ir.Program, facts: _Facts) -> ir.Program:
    """Parameters that calls leave out become optional; calls give them by name."""
    scopes = ProgramScope(program)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            changed = edit_bodies(routine, _Named(facts, scope).body)
            parameters = tuple(
                replace(parameter, optional=True)
                if (routine.name.lower(), parameter.name.lower()) in facts.left_out
                else parameter
                for parameter in routine.parameters
            )
            routines.append(replace(changed, parameters=parameters))
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


class _Named:
    def __init__(self, facts: _Facts, scope: Scope) -> None:
        self.facts = facts
        self.scope = scope

    def body(self, body: ir.Body) -> ir.Body:
        return tuple(self.statement(statement) for statement in body)

    def statement(self, statement: ir.Statement) -> ir.Statement:
        inner = rewrite_parts(statement, self.expression, self.body)
        if isinstance(inner, ir.CallRoutine) and inner.dynamic is None:
            return replace(inner, arguments=self.arguments(inner.name, inner.arguments))
        return inner

    def expression(self, expression: ir.Expression) -> ir.Expression:
        inner = rewrite_parts(expression, self.expression)
        if isinstance(inner, ir.Call):
            return replace(inner, arguments=self.arguments(inner.name, inner.arguments))
        return inner

    def arguments(self, name: str, arguments: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        routine = self.scope.routine(name)
        if routine is None:
            return arguments
        done = []
        for parameter, argument in _slots(routine, arguments, self.scope):
            if argument is None:
                continue
            if (routine.name.lower(), parameter.name.lower()) in self.facts.left_out:
                argument = replace(argument, name=parameter.name)
            done.append(argument)
        return tuple(done)


# ---- for targets without


def _mandatory(routine: ir.Routine, facts: _Facts) -> ir.Routine:
    parameters: list[ir.Parameter] = []
    for parameter in routine.parameters:
        if parameter.switch:
            parameters.append(ir.Parameter(parameter.name, ir.BoolType()))
            continue
        parameters.append(replace(parameter, optional=False, choice=None))
        flag = facts.given.get((routine.name.lower(), parameter.name.lower()))
        if flag:
            parameters.append(ir.Parameter(flag, ir.BoolType()))
    return replace(routine, parameters=tuple(parameters))


class _Calls:
    """Calls of one routine with all arguments in order, and its own questions after what was given."""

    def __init__(self, editor: Editor, facts: _Facts, routine: ir.Routine) -> None:
        self.editor = editor
        self.facts = facts
        self.here = routine.name.lower()
        self.source = routine
        self.switches = {p.name.lower() for p in routine.parameters if p.switch}
        self._nothing: dict[ir.Type, ir.Name] = {}

    def routine(self) -> ir.Routine:
        return edit_bodies(self.source, self.body)

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, lambda statement: (self.statement(statement),))

    def statement(self, statement: ir.Statement) -> ir.Statement:
        inner = rewrite_parts(statement, self.expression, self.body)
        if isinstance(inner, ir.CallRoutine) and inner.dynamic is None:
            arguments = self.arguments(inner.name, inner.arguments)
            return inner if arguments is inner.arguments else replace(inner, arguments=arguments)
        return inner

    def expression(self, expression: ir.Expression) -> ir.Expression:
        inner = rewrite_parts(expression, self.expression)
        match inner:
            case ir.Call(name=name, arguments=arguments):
                changed = self.arguments(name, arguments)
                return inner if changed is arguments else replace(inner, arguments=changed)
            case ir.Present(name=name):
                return self.present(name)
        return inner

    def present(self, name: str) -> ir.Expression:
        if name.lower() in self.switches:
            return ir.Name(name)
        flag = self.facts.given.get((self.here, name.lower()))
        return ir.BoolLiteral(True) if flag is None else ir.Name(flag)

    def arguments(self, name: str, arguments: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        routine = self.editor.scope.routine(name)
        if routine is None:
            return arguments
        slots = _slots(routine, arguments, self.editor.scope)
        named = any(argument.name or argument.if_present for argument in arguments)
        if not named and all(
            argument is not None and not parameter.switch and not self._flag(routine, parameter)
            for parameter, argument in slots
        ):
            return arguments
        done: list[ir.Argument] = []
        for parameter, argument in slots:
            given = self.is_given(argument)
            if parameter.switch:
                done.append(ir.Argument(given))
                continue
            value = argument.value if argument is not None else None
            done.append(ir.Argument(value if value is not None else self.neutral(parameter)))
            if self._flag(routine, parameter):
                done.append(ir.Argument(given))
        return tuple(done)

    def _flag(self, routine: ir.Routine, parameter: ir.Parameter) -> bool:
        return (routine.name.lower(), parameter.name.lower()) in self.facts.given

    def is_given(self, argument: ir.Argument | None) -> ir.Expression:
        if argument is None:
            return ir.BoolLiteral(False)
        return self.present(argument.if_present) if argument.if_present else ir.BoolLiteral(True)

    def neutral(self, parameter: ir.Parameter) -> ir.Expression:
        """What a call passes for a parameter that it leaves out: nobody looks at it."""
        type = self.editor.scope.resolve(parameter.type)
        value = default_value(type)
        if value is not None and parameter.mode != "reference":
            return value
        declared = self.editor.scope.type(type.name) if isinstance(type, ir.NamedType) else None
        if isinstance(declared, ir.EnumDeclaration) and parameter.mode != "reference":
            return ir.EnumLiteral(declared.members[0])
        if isinstance(type, ir.ArrayType):  # a parameter may be open: one element is enough
            sizes = tuple(size if size is not None else ir.IntLiteral(1) for size in type.dimensions)
            type = replace(type, dimensions=sizes)
        if type not in self._nothing:
            self._nothing[type] = self.editor.temporary("not_given", type)
        return self._nothing[type]


# ---- calls by a computed name


class _Dynamic:
    """A choice between the procedures that the text can name. A target that calls by name itself, with numbered
    arguments, does so where the procedures take only what is passed by value."""

    def __init__(self, editor: Editor) -> None:
        self.editor = editor
        can = editor.capabilities
        self.itself = RoutineRule.COMPUTED_NAMES in can.routines.rules and names_stay(
            editor.scope.program.program, can.names
        )
        self.held: HeldTexts | None = None
        self.before: ir.Body = ()  # of the statement that is looked at, in its block

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Body] = []
        for place, statement in enumerate(body):
            self.before = body[:place]
            done.append(self.statement(statement))
        pieces = iter(done)
        return map_body(body, lambda statement: next(pieces))

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.CallRoutine(dynamic=name) if name is not None:
                return self.chosen(statement, name)
        if blocks(statement):
            return (rewrite_bodies(statement, self.body),)
        return (statement,)

    def chosen(self, statement: ir.CallRoutine, name: ir.Expression) -> ir.Body:
        candidates = self.candidates(statement, name)
        if self.itself and not isinstance(name, ir.TextLiteral) and self.all_by_value(len(statement.arguments)):
            return (statement,)
        if not candidates:
            self.editor.context.diagnostics.report(NO_CANDIDATE, statement.origin)
            return (statement,)
        if isinstance(name, ir.TextLiteral):
            return (replace(statement, name=candidates[0], dynamic=None),)
        before: tuple[ir.Statement, ...] = ()
        if not isinstance(name, ir.Name):
            kept = self.editor.temporary("called", ir.StringType())
            before, name = (ir.Assign(kept, name),), kept
        branches = []
        for candidate in candidates:
            text = ir.TextLiteral(candidate)
            same = ir.Builtin("text_equal", (name, text, ir.BoolLiteral(True)))
            branches.append((same, (replace(statement, name=candidate, dynamic=None),)))
        missing = self.missing(statement)
        return expansion(statement.origin, (*before, ir.If(tuple(branches), missing)))

    def all_by_value(self, count: int) -> bool:
        """Do all routines that take so many arguments take numbers and texts by value?"""
        return not any(
            one.mode == "reference" or one.optional or not isinstance(self.editor.scope.resolve(one.type), _BY_VALUE)
            for module in self.editor.scope.program.program.modules
            for routine in module.routines
            if len(routine.parameters) == count
            for one in routine.parameters
        )

    def missing(self, statement: ir.CallRoutine) -> ir.Body:
        """No procedure of that name: an error of the program."""
        known = spelled_among("unknown_routine", self.editor.scope.rules.errors)
        origin = replace(statement.origin, comments=())
        if known is not None:
            return (ir.Raise(ir.IntLiteral(self.editor.scope.rules.errors[known]), origin=origin),)
        text = ir.TextLiteral("The procedure to call does not exist")
        return (ir.Message("error", text, origin=origin), ir.Halt("exit", origin=origin))

    def candidates(self, statement: ir.CallRoutine, name: ir.Expression) -> list[str]:
        """Names of procedures that take these arguments, by what is known of the text or of its beginning."""
        scope = self.editor.scope
        self.held = self.held or HeldTexts.of(scope.program.program)
        texts = self.held.of_name(name.id) if isinstance(name, ir.Name) else None
        held = None if texts is None else {scope.fold(text.rpartition(":")[2]) for text in texts}
        start, whole = text_beginning(as_written_before(name, self.before))
        start = scope.fold(start.rpartition(":")[2])
        found: dict[str, str] = {}
        for module in scope.program.program.modules:
            for routine in module.routines:
                key = scope.fold(routine.name)
                if routine.kind != "procedure" or scope.routine(routine.name) is not routine:
                    continue
                if held is not None and key not in held:
                    continue
                if (key == start if whole else key.startswith(start)) and self.takes(routine, statement.arguments):
                    found.setdefault(key, routine.name)
        return list(found.values())

    def takes(self, routine: ir.Routine, arguments: tuple[ir.Argument, ...]) -> bool:
        slots = _slots(routine, arguments, self.editor.scope)
        if any(a is None and not (p.optional or p.switch) for p, a in slots):
            return False
        if sum(1 for _, argument in slots if argument is not None) != len(arguments):
            return False
        for parameter, argument in slots:
            if argument is None or argument.value is None:
                continue
            type = self.editor.type_of(argument.value)
            wanted = self.editor.scope.resolve(parameter.type)
            numbers = isinstance(type, ir.NUMBER_TYPES) and isinstance(wanted, ir.NUMBER_TYPES)
            if type is not None and not numbers and type.__class__ is not wanted.__class__:
                return False
        return True
