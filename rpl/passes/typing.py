"""Types of expressions, and the normal form every later room relies on.

`normalise` gives built-in components their neutral names, decides KRL's `/` by operand types, tells text `+` from
number `+`, writes down the conversions that the source language does silently, and gives each aggregate the type of its
place. Unknown names are reported once each; what has no known type is left as it is.
"""

from __future__ import annotations

from operator import is_

from rpl import ir
from rpl.diagnostics import Code, Diagnostics, Severity, code
from rpl.passes.collector import paused_cycle_collector
from rpl.passes.rewrite import changed, each, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope, signal_type
from rpl.passes.signatures import Layout, Signature
from rpl.passes.typerules import (
    BITS,
    BOOL,
    CHAR,
    CONVERTED,
    INT,
    KIND_TYPES,
    LOGIC,
    NUMBERS,
    ORDERED,
    REAL,
    TEXT,
    arithmetic,
    clash,
    has_components,
    is_number,
    pose_result,
    quotient,
    sign,
    system_type,
)
from rpl.passes.typewords import component_names, component_type, language_word, type_word, word_type
from rpl.source import NOWHERE, Origin

__all__ = [
    "Typer",
    "component_names",
    "component_type",
    "counter_type",
    "normalise",
    "type_of",
    "type_word",
    "word_type",
]

UNKNOWN_NAME = code("unknown-name", Severity.WARNING, "{name} is not declared in what was read")
UNKNOWN_ROUTINE = code("unknown-routine", Severity.WARNING, "routine {name} is not in what was read")
MISMATCH = code("type-mismatch", Severity.ERROR, "{found} where {wanted} is needed")
UNKNOWN_COMPONENT = code("unknown-component", Severity.ERROR, "{type} has no component {name}")
ARGUMENT = code("argument-type", Severity.ERROR, "argument {number} of {name} is {found}; {wanted} is needed")
TOO_MANY = code("too-many-arguments", Severity.ERROR, "{name} takes {takes}; {given} are given")

# What most expressions of a point list are: their own normal form, of a type that their class tells.
_LITERALS: dict[type, ir.Type] = {ir.IntLiteral: INT, ir.RealLiteral: REAL, ir.BoolLiteral: BOOL, ir.Present: BOOL}
Typed = tuple[ir.Expression, ir.Type | None]


def type_of(expression: ir.Expression, scope: Scope) -> ir.Type | None:
    """The type of a normalised expression; None when it rests on something unknown."""
    typer = Typer(scope, Diagnostics())
    typer.chains = scope.chains
    return typer.infer(expression)[1]


def counter_type(loop: ir.For, scope: Scope) -> ir.Type:
    """Type of a loop's own counter: whole where it starts at a whole number and steps by whole ones."""
    parts = [loop.start] if loop.step is None else [loop.start, loop.step]
    return INT if all(isinstance(type_of(part, scope), ir.IntType) for part in parts) else REAL


def normalise(program: ir.Program, diagnostics: Diagnostics, as_read: bool = False) -> ir.Program:
    """The program in normal form. Reports unknown names and type errors; `as_read`: also by what only the source
    language refuses (passes write neutral functions more freely, and writers find the language's form)."""
    scopes = ProgramScope(program)
    with paused_cycle_collector():
        modules = each(program.modules, lambda module: _module(module, scopes, diagnostics, as_read))
        return changed(program, modules=modules)


def _module(module: ir.Module, scopes: ProgramScope, diagnostics: Diagnostics, as_read: bool) -> ir.Module:
    typer = Typer(scopes.module(module), diagnostics, as_read=as_read)
    declarations = each(module.declarations, typer.declaration)
    routines = each(
        module.routines,
        lambda routine: Typer(scopes.routine(module, routine), diagnostics, typer.reported, as_read).routine(routine),
    )
    return changed(module, declarations=declarations, routines=routines)


class Typer:
    """Infers and rewrites inside one scope."""

    def __init__(
        self, scope: Scope, diagnostics: Diagnostics, reported: set[str] | None = None, as_read: bool = False
    ) -> None:
        self.scope = scope
        self.as_read = as_read
        self.exact = as_read and scope.rules.exact_types
        self.rules = scope.rules
        self.diagnostics = diagnostics
        self.reported: set[str] = set() if reported is None else reported
        self.here = NOWHERE
        # Asked again and again within one scope, and never another answer.
        self.chains: dict[int, tuple[ir.Binary, Typed]] | None = None
        self._names: dict[str, ir.Type | None] = {}
        self._layouts: dict[ir.Type, Layout] = {}
        self._signatures: dict[str, Signature] = {}
        self._joints: dict[tuple[str | None, ...], bool] = {}

    # ---- declarations and statements

    def declaration(self, declaration: ir.Declaration) -> ir.Declaration:
        self.here = declaration.origin
        match declaration:
            case ir.Variable(type=type, initial=initial) if initial is not None:
                value = self.assigned(initial, self.scope.resolve(type))
                return changed(declaration, initial=value, type=self.type(type))
            case ir.Variable(type=type):
                return changed(declaration, type=self.type(type))
            case ir.Initialise(assign=assign):
                done = self.statement(assign)
                return changed(declaration, assign=done) if isinstance(done, ir.Assign) else declaration
        return declaration

    def type(self, type: ir.Type) -> ir.Type:
        """Array bounds and capacities are expressions too."""
        return rewrite_parts(type, self.value) if isinstance(type, ir.ArrayType | ir.StringType) else type

    def routine(self, routine: ir.Routine) -> ir.Routine:
        return changed(
            routine,
            declarations=each(routine.declarations, self.declaration),
            body=self.body(routine.body),
            handlers=each(routine.handlers, self.handler),
            undo=self.body(routine.undo),
            backward=self.body(routine.backward),
        )

    def handler(self, handler: ir.Handler) -> ir.Handler:
        return changed(handler, codes=each(handler.codes, self.value), body=self.body(handler.body))

    def body(self, body: ir.Body) -> ir.Body:
        if not any(statement.__class__ is ir.Run for statement in body):
            return each(body, self.statement)
        done = [self.run(one) if isinstance(one, ir.Run) else (self.statement(one),) for one in body]
        return tuple(statement for part in done for statement in part)

    def run(self, run: ir.Run) -> ir.Body:
        """A run by its sample, where nothing is reported or converted that the other moves would meet differently."""
        first = self.move(run.sample)
        quiet = Typer(self.scope, Diagnostics(), self.reported, self.as_read)
        typed = run.rewritten(first, quiet.move)
        if typed is not None and not len(quiet.diagnostics):
            return (typed,)
        return (first, *map(self.statement, run.moves(1)))

    def statement(self, statement: ir.Statement) -> ir.Statement:
        self.here = statement.origin
        match statement:
            case ir.Assign(target=target, value=value):
                lvalue, wanted = self.infer(target)
                return changed(statement, target=lvalue, value=self.assigned(value, wanted))
            case ir.CallRoutine(dynamic=None):
                name = statement.name
                return changed(statement, arguments=self.arguments(name, statement.arguments, statement.origin))
            case ir.For(scoped=True):
                counter = ir.Variable(statement.counter, counter_type(statement, self.scope))
                inner = Typer(self.scope.with_value(counter), self.diagnostics, self.reported, self.as_read)
                body = inner.body(statement.body)
                return changed(rewrite_parts(changed(statement, body=()), self.value, self.body), body=body)
            case ir.Switch(selector=selector):
                chosen, wanted = self.infer(selector)
                cases = tuple(
                    changed(case, values=tuple(self.coerced(v, wanted) for v in case.values), body=self.body(case.body))
                    for case in statement.cases
                )
                default = None if statement.default is None else self.body(statement.default)
                return changed(statement, selector=chosen, cases=cases, default=default)
            case ir.Return(value=value) if value is not None:
                routine = self.scope.routine_here
                wanted = routine.returns if routine else None
                return changed(statement, value=self.assigned(value, self.scope.resolve(wanted) if wanted else None))
            case ir.ConnectInterrupt(routine=name):
                self.known_routine(name, statement.origin)
            case ir.Move():
                return self.move(statement)
        return rewrite_parts(statement, self.value, self.body)

    def move(self, move: ir.Move) -> ir.Move:
        """The move with everything written out in it (targets, speeds, zones, settings) in typed form."""
        done: dict[str, object] = {}
        speed, blend = move.speed, move.blend
        if speed is not None and isinstance(speed.profile, ir.Aggregate):
            profile = self.assigned(speed.profile, ir.SpeedType())
            done["speed"] = rewrite_parts(speed, self.value, given={"profile": profile})
        if isinstance(blend, ir.BlendZone) and isinstance(blend.zone, ir.Aggregate):
            zone = self.assigned(blend.zone, ir.ZoneType())
            done["blend"] = rewrite_parts(blend, self.value, given={"zone": zone})
        done["target"] = self.place(move.target)
        if move.via is not None:
            done["via"] = self.place(move.via)
        if move.settings:
            done["settings"] = tuple(
                (self.value(name), self.assigned(value, self.infer(name)[1])) for name, value in move.settings
            )
        return rewrite_parts(move, self.value, self.body, done)

    def place(self, target: ir.Expression) -> ir.Expression:
        """A motion target; an aggregate written there is joints or a target by the components it names."""
        if not isinstance(target, ir.Aggregate) or target.type_name:
            return self.value(target)
        written = tuple([name for name, _ in target.entries])
        joints = self._joints.get(written)
        if joints is None:
            joints = self._joints[written] = self.are_joints(written)
        return self.assigned(target, ir.JointsType() if joints else ir.TargetType(self.rules.name))

    def are_joints(self, written: tuple[str | None, ...]) -> bool:
        if written and all(name is None for name in written):
            return len(written) == len(ir.POSITIONAL[ir.JointsType])
        axes = self.rules.components.get("JointsType", {})
        neutral = {axes.get(name.lower(), name.lower()) for name in written if name}
        return bool(neutral & set(ir.POSITIONAL[ir.AxesType]))

    # ---- expressions

    def value(self, expression: ir.Expression) -> ir.Expression:
        return self.infer(expression)[0]

    def assigned(
        self, expression: ir.Expression, wanted: ir.Type | None, place: tuple[str, int] | None = None
    ) -> ir.Expression:
        """The expression as it is stored in a place of type `wanted`: a variable, or an argument (routine, number)."""
        return self.coerced(expression, wanted, True, place)

    def coerced(
        self,
        expression: ir.Expression,
        wanted: ir.Type | None,
        strict: bool = False,
        place: tuple[str, int] | None = None,
    ) -> ir.Expression:
        if wanted.__class__ is ir.RealType and is_number(expression):
            return expression
        done, found = self.infer(expression, wanted)
        if wanted is None or found is None or wanted == found:
            return done
        match wanted, found:
            case ir.IntType(), ir.RealType() if self.rules.real_to_int:
                return self.convert(self.rules.real_to_int, done)
            case ir.IntType(), ir.CharType() if self.rules.char_numbers:
                return self.convert("code", done)
            case ir.CharType(), ir.IntType() if self.rules.char_numbers:
                return self.convert("char", done)
        if strict:
            self.fitting(expression, wanted, found, place)
        return done

    def fitting(
        self,
        expression: ir.Expression,
        wanted: ir.Type | None,
        found: ir.Type | None,
        place: tuple[str, int] | None = None,
    ) -> bool:
        """Report a value that certainly does not fit where it stands; may it?"""
        if wanted is None or found is None or not self.clashes(wanted, found):
            return True
        words = {"found": language_word(found, self.rules), "wanted": language_word(wanted, self.rules)}
        if place is None:
            self.report(MISMATCH, expression.origin, **words)
        else:
            self.report(ARGUMENT, expression.origin, name=place[0], number=place[1], **words)
        return False

    def clashes(self, wanted: ir.Type, found: ir.Type) -> bool:
        """Do two types certainly not fit? Of a record that was not read nothing is certain."""
        unread = (
            isinstance(type, ir.NamedType) and not isinstance(self.scope.type(type.name), ir.RecordDeclaration)
            for type in (wanted, found)
        )
        return not any(unread) and clash(wanted, found, self.exact)

    def convert(self, how: str, operand: ir.Expression) -> ir.Expression:
        if isinstance(operand, ir.Convert) and operand.how == how:
            return operand
        return ir.Convert(how, operand, origin=operand.origin)

    def infer(self, expression: ir.Expression, wanted: ir.Type | None = None) -> Typed:
        """The normal form of an expression and its type. `wanted` is what its place expects (for aggregates)."""
        match expression:
            case ir.IntLiteral() | ir.RealLiteral() | ir.BoolLiteral() | ir.Present():
                return expression, _LITERALS[expression.__class__]
            case ir.Name():
                return self.name(expression)
            case ir.Aggregate():
                return self.aggregate(expression, wanted)
            case ir.Unary(op=op, operand=operand):
                inner, type = self.infer(operand)
                return changed(expression, operand=inner), BOOL if op == "not" else type
            case ir.Binary():
                return self.binary(expression)
            case ir.TextLiteral(value=text):
                short = self.rules.char_numbers and len(text) == 1 and isinstance(wanted, ir.CharType | ir.IntType)
                return expression, CHAR if short else TEXT
            case ir.EnumLiteral(member=member):
                declaration = self.scope.enum_of(member)
                return expression, ir.NamedType(declaration.name) if declaration else None
            case ir.Index():
                return self.index(expression)
            case ir.Field():
                return self.field(expression)
            case ir.Call(name=name, arguments=arguments):
                routine = self.scope.routine(name)
                done = changed(expression, arguments=self.arguments(name, arguments, expression.origin))
                returns = routine.returns if routine else None
                return done, self.scope.resolve(returns) if returns else None
            case ir.Builtin():
                return self.builtin(expression)
            case ir.System(name=name):
                return rewrite_parts(expression, self.value), system_type(name, self.rules.name)
            case ir.Signal():
                return rewrite_parts(expression, self.value), signal_type(expression)
            case ir.Quantity() | ir.Magnitude():
                return rewrite_parts(expression, self.value), REAL
            case ir.Convert(how=how):
                return rewrite_parts(expression, self.value), CONVERTED[how]
            case ir.VendorValue(type=type):
                return expression, self.scope.resolve(type)

    def name(self, expression: ir.Name) -> Typed:
        name = expression.id
        if name in self._names:
            return expression, self._names[name]
        symbol = self.scope.value(name)
        if symbol is None:
            self.report_once(UNKNOWN_NAME, name, expression.origin)
        type = self._names[name] = None if symbol is None else self.scope.resolve(symbol.type)
        return expression, type

    def index(self, expression: ir.Index) -> Typed:
        base, type = self.infer(expression.base)
        indices = each(
            expression.indices, lambda index: self.coerced(index, INT) if self.rules.real_to_int else self.value(index)
        )
        match type:
            case ir.ArrayType(element=element, dimensions=dimensions):
                count, inner = len(dimensions), self.scope.resolve(element)
                if len(indices) > count and isinstance(inner, ir.StringType):
                    row = changed(expression, base=base, indices=indices[:count])
                    return changed(expression, base=row, indices=indices[count:]), CHAR
                if len(indices) < count:
                    rest = ir.ArrayType(element, dimensions[len(indices) :], type.base)
                    return changed(expression, base=base, indices=indices), rest
                return changed(expression, base=base, indices=indices), inner
            case ir.StringType():
                return changed(expression, base=base, indices=indices), CHAR
        return changed(expression, base=base, indices=indices), None

    def neutral(self, base: ir.Type, name: str) -> str:
        """A component's neutral name from the language's own."""
        if isinstance(base, ir.NamedType):
            return name
        lower = name.lower()
        return self.rules.components.get(base.__class__.__name__, {}).get(lower, lower)

    def field(self, expression: ir.Field) -> Typed:
        base, type = self.infer(expression.base)
        if type is None:
            return changed(expression, base=base), None
        name = self.neutral(type, expression.name)
        found = component_type(type, name, self.scope)
        if found is None and not (isinstance(type, ir.NamedType) and self.scope.type(type.name) is None):
            self.report(
                UNKNOWN_COMPONENT, expression.origin, type=language_word(type, self.rules), name=expression.name
            )
            return changed(expression, base=base), None
        return changed(expression, base=base, name=name), found

    def binary(self, expression: ir.Binary) -> Typed:
        chain = isinstance(expression.left, ir.Binary) or isinstance(expression.right, ir.Binary)
        if self.chains is None or not chain:
            return self.operation(expression)
        known = self.chains.get(id(expression))
        if known is None:
            known = self.chains[id(expression)] = expression, self.operation(expression)
        return known[1]

    def operation(self, expression: ir.Binary) -> Typed:
        op = expression.op
        wanted = ir.PoseType() if op == ":" else None
        left, left_type = self.infer(expression.left, wanted if self.is_pose(expression.left) else None)
        right, right_type = self.infer(expression.right, wanted if self.is_pose(expression.right) else None)
        if left_type is None and isinstance(left, ir.Aggregate) and has_components(right_type):
            left, left_type = self.infer(expression.left, right_type)  # written out: of the other side's type
        elif right_type is None and isinstance(right, ir.Aggregate) and has_components(left_type):
            right, right_type = self.infer(expression.right, left_type)
        if op in ORDERED:
            left, right = self.comparable(left, left_type, right, right_type)
            return changed(expression, left=left, right=right), BOOL
        if op in LOGIC:
            return changed(expression, left=left, right=right), BOOL
        if op in BITS:
            whole = right_type if left_type is None else left_type
            return changed(expression, left=left, right=right), whole
        if op == ":":
            return changed(expression, left=left, right=right), right_type
        if op == "quo":
            op, type = quotient(left_type, right_type)
        else:
            op, type = arithmetic(op, left_type, right_type, self.rules.text_plus)
        return changed(expression, op=op, left=left, right=right), type

    def is_pose(self, expression: ir.Expression) -> bool:
        """Does an aggregate name components of a pose only (no flags, no external axes)?"""
        if not isinstance(expression, ir.Aggregate) or expression.type_name:
            return False
        known = ir.COMPONENTS[ir.PoseType]
        return all(name is not None and self.neutral(ir.PoseType(), name) in known for name, _ in expression.entries)

    def comparable(
        self, left: ir.Expression, left_type: ir.Type | None, right: ir.Expression, right_type: ir.Type | None
    ) -> tuple[ir.Expression, ir.Expression]:
        if self.rules.char_numbers:
            left_type, right_type = sign(left, left_type), sign(right, right_type)
            if isinstance(left_type, ir.CharType) and isinstance(right_type, ir.NUMBER_TYPES):
                return self.convert("code", left), right
            if isinstance(right_type, ir.CharType) and isinstance(left_type, ir.NUMBER_TYPES):
                return left, self.convert("code", right)
        return left, right

    def aggregate(self, expression: ir.Aggregate, wanted: ir.Type | None) -> Typed:
        type = wanted
        if type is None or isinstance(type, ir.CharType):
            type = word_type(expression.type_name, self.scope) if expression.type_name else None
        if type is None:
            return rewrite_parts(expression, self.value), None
        if isinstance(type, ir.ArrayType):
            rest = type.dimensions[1:]
            element = ir.ArrayType(type.element, rest, type.base) if rest else self.scope.resolve(type.element)
            items = each(expression.entries, lambda entry: self.element(entry, element))
            return changed(expression, entries=items), type
        layout = self.layout(type)
        done = []
        same = True
        for position, entry in enumerate(expression.entries):
            written, value = entry
            if written is None:
                name, inner = None, layout.positional[position] if position < len(layout.positional) else None
            else:
                name, inner = layout.named.get(written) or self.component(type, layout, written)
            if inner is None and layout.complete:
                what = written or f"number {position + 1}"
                self.report(UNKNOWN_COMPONENT, expression.origin, type=layout.word, name=what)
            kind = value.__class__
            if inner.__class__ is ir.RealType and (kind in NUMBERS or is_number(value)):
                new = value  # as `coerced` has it; most of what there is in a list of points
            elif isinstance(value, ir.Aggregate) and inner is not None and inner.__class__ is not ir.CharType:
                new = self.aggregate(value, inner)[0]
            else:
                new = self.assigned(value, inner)
            if new is not value or name != written:
                same, entry = False, (name, new)
            done.append(entry)
        if same and expression.type_name == layout.word:
            return expression, type
        entries = expression.entries if same else tuple(done)
        return ir.Aggregate(entries, layout.word, origin=expression.origin), type

    def element(self, entry: tuple[str | None, ir.Expression], wanted: ir.Type) -> tuple[str | None, ir.Expression]:
        done = self.assigned(entry[1], wanted)
        return entry if done is entry[1] else (entry[0], done)

    def layout(self, type: ir.Type) -> Layout:
        found = self._layouts.get(type)
        if found is None:
            places = tuple([component_type(type, name, self.scope) for name in component_names(type, self.scope)])
            unknown_record = isinstance(type, ir.NamedType) and self.scope.type(type.name) is None
            found = self._layouts[type] = Layout(type_word(type), places, not unknown_record)
        return found

    def component(self, type: ir.Type, layout: Layout, written: str) -> tuple[str, ir.Type | None]:
        name = self.neutral(type, written)
        found = layout.named[written] = name, component_type(type, name, self.scope)
        return found

    def builtin(self, expression: ir.Builtin) -> Typed:
        arguments: list[ir.Expression] = []
        types: list[ir.Type | None] = []
        function = ir.FUNCTIONS.get(expression.function)
        kinds = function.parameters.replace("?", "") if function else ""
        spelled, *words = self.rules.functions.get(expression.function, ("",))
        for position, argument in enumerate(expression.arguments):
            word = words[position] if position < len(words) else ""
            whole = self.whole_argument(argument, word, (spelled, position + 1))
            if whole is not None:
                arguments.append(whole)
                types.append(None)
                continue
            wanted = None
            if isinstance(argument, ir.Aggregate) and not argument.type_name and position < len(kinds):
                wanted = self.written_kind(kinds[position], argument)
            done, type = self.infer(argument, wanted)
            arguments.append(done)
            named = None if isinstance(argument, ir.Aggregate) else self.rules.type_names.get(word)
            types.append(type if self.fitting(argument, named, type, (spelled, position + 1)) else None)
        result: ir.Type | None
        kind = function.result if function else "x"
        if kind.isdigit():
            result = types[int(kind)] if int(kind) < len(types) else None
        elif kind == "p":
            result = pose_result(expression.function, types, self.rules.name)
        else:
            result = KIND_TYPES.get(kind)
        return changed(expression, arguments=tuple(arguments)), result

    def whole_argument(self, argument: ir.Expression, word: str, place: tuple[str, int]) -> ir.Expression | None:
        """The argument where the reader takes a component of what was written, and that is of another type."""
        word, _, part = word.partition(".")
        wanted = self.rules.type_names.get(word)
        if not part or not isinstance(argument, ir.Field) or wanted is None:
            return None
        if isinstance(argument.base, ir.Aggregate):
            whole, _ = self.infer(argument.base, wanted)
            assert isinstance(whole, ir.Aggregate)
            names = component_names(wanted, self.scope)
            parts = {name or at: value for at, (name, value) in zip(names, whole.entries, strict=False)}
            return parts.get(self.neutral(wanted, part)) or self.value(argument)
        base, found = self.infer(argument.base)
        if found is None or not self.clashes(wanted, found):
            return None
        self.fitting(argument, wanted, found, place)
        return changed(argument, base=base)

    def written_kind(self, kind: str, argument: ir.Aggregate) -> ir.Type | None:
        """The type of an aggregate written as an argument of a built-in function."""
        if kind != "p":
            return KIND_TYPES.get(kind)
        whole = len(argument.entries) == len(ir.POSITIONAL[ir.TargetType])
        named = any(name is not None for name, _ in argument.entries)
        pose = self.is_pose(argument) if named else not whole
        return ir.PoseType() if pose else ir.TargetType(self.rules.name)

    def arguments(self, name: str, given: tuple[ir.Argument, ...], origin: Origin) -> tuple[ir.Argument, ...]:
        """Arguments in normal form, converted to their parameters' types where they are passed by value."""
        signature = self._signatures.get(name) or self.signature(name, origin)
        positional = iter(signature.positional)
        done = []
        for number, argument in enumerate(given, 1):
            parameter: ir.Parameter | None
            if argument.name:
                parameter = signature.by_name.get(self.scope.fold(argument.name))
            else:
                parameter = next(positional, None)
            if argument.value is None:
                done.append(argument)
                continue
            if parameter is None and not signature.open_ended:
                self.report(TOO_MANY, origin, name=name, takes=signature.takes, given=len(given))
            wanted = None if parameter is None else self.scope.resolve(parameter.type)
            if parameter is None or parameter.mode == "reference":
                value, found = self.infer(argument.value, wanted)
                if self.exact:
                    self.fitting(argument.value, wanted, found, (name, number))
                done.append(changed(argument, value=value))
            else:
                done.append(changed(argument, value=self.assigned(argument.value, wanted, (name, number))))
        return given if all(map(is_, done, given)) else tuple(done)

    def signature(self, name: str, origin: Origin) -> Signature:
        routine = self.known_routine(name, origin)
        parameters = routine.parameters if routine else ()
        required = tuple([parameter for parameter in parameters if not parameter.optional])
        by_name = {self.scope.fold(parameter.name): parameter for parameter in parameters}
        found = Signature(parameters, by_name, required, routine is None or routine.open_ended)
        self._signatures[name] = found
        return found

    def known_routine(self, name: str, origin: Origin) -> ir.Routine | None:
        routine = self.scope.routine(name)
        if routine is None and name:  # the call of no name stands for an interrupt's own routine
            self.report_once(UNKNOWN_ROUTINE, name, origin)
        return routine

    def report_once(self, what: Code, name: str, origin: Origin) -> None:
        key = self.scope.fold(name)
        if key not in self.reported:
            self.reported.add(key)
            self.report(what, origin, name=name)

    def report(self, what: Code, origin: Origin, /, **arguments: object) -> None:
        """Report at the expression, or at its statement where a reader keeps no places of expressions."""
        self.diagnostics.report(what, origin if origin.source else self.here, **arguments)
