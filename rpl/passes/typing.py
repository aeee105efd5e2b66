"""Types of expressions, and the normal form every later room relies on.

`normalise` gives built-in components their neutral names, decides KRL's `/` by operand types, tells text `+` from
number `+`, writes down the conversions that the source language does silently, and gives each aggregate the type of its
place. Unknown names are reported once each; what has no known type is left as it is.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir, registry
from rpl.diagnostics import Code, Diagnostics, Severity, code
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import ProgramScope, Scope, signal_type
from rpl.source import NOWHERE, Origin

UNKNOWN_NAME = code("unknown-name", Severity.WARNING, "{name} is not declared in what was read")
UNKNOWN_ROUTINE = code("unknown-routine", Severity.WARNING, "routine {name} is not in what was read")
MISMATCH = code("type-mismatch", Severity.ERROR, "{found} where {wanted} is needed")
UNKNOWN_COMPONENT = code("unknown-component", Severity.ERROR, "{type} has no component {name}")
TOO_MANY = code("too-many-arguments", Severity.ERROR, "{name} takes {count} arguments, {given} are given")

_INT, _REAL, _BOOL, _CHAR, _TEXT = ir.IntType(), ir.RealType(), ir.BoolType(), ir.CharType(), ir.StringType()
_RESULT_KINDS: dict[str, ir.Type] = {
    "n": _REAL,
    "i": _INT,
    "b": _BOOL,
    "t": _TEXT,
    "c": _CHAR,
    "v": ir.VectorType(),
    "r": ir.RotationType(),
    "j": ir.JointsType(),
    "J": ir.JointsType(),
    "P": ir.PoseType(),
    "T": ir.ToolType(),
    "W": ir.WorkObjectType(),
    "L": ir.LoadType(),
}
_TYPE_WORDS: dict[type, str] = {
    ir.IntType: "int",
    ir.RealType: "real",
    ir.BoolType: "bool",
    ir.CharType: "char",
    ir.StringType: "string",
    ir.VectorType: "vector",
    ir.RotationType: "rotation",
    ir.PoseType: "pose",
    ir.ConfigType: "configuration",
    ir.ExternalType: "external",
    ir.AxesType: "axes",
    ir.TargetType: "target",
    ir.JointsType: "joints",
    ir.ToolType: "tool",
    ir.WorkObjectType: "workobject",
    ir.LoadType: "load",
    ir.SpeedType: "speed",
    ir.ZoneType: "zone",
    ir.ClockType: "clock",
    ir.InterruptType: "interrupt",
    ir.TriggerType: "trigger",
}
_WORD_TYPES: dict[str, ir.Type] = {
    "vector": ir.VectorType(),
    "rotation": ir.RotationType(),
    "pose": ir.PoseType(),
    "external": ir.ExternalType(),
    "axes": ir.AxesType(),
    "joints": ir.JointsType(),
    "tool": ir.ToolType(),
    "workobject": ir.WorkObjectType(),
    "load": ir.LoadType(),
    "speed": ir.SpeedType(),
    "zone": ir.ZoneType(),
}
_ORDERED = frozenset(("=", "<>", "<", ">", "<=", ">="))
_LOGIC = frozenset(("and", "or", "xor", "cand", "cor"))
_BITS = frozenset(("band", "bor", "bxor", "div", "mod"))
Typed = tuple[ir.Expression, ir.Type | None]


def type_word(type: ir.Type) -> str:
    """One word for a type: the neutral name, or a declared type's own name. Targets say their notation."""
    match type:
        case ir.NamedType(name=name):
            return name
        case ir.TargetType(notation=notation) | ir.ConfigType(notation=notation):
            return f"{_TYPE_WORDS[type.__class__]} {notation}"
        case ir.VendorType(name=name):
            return name
        case ir.ArrayType(element=element):
            return f"array of {type_word(element)}"
        case ir.SignalType(kind=kind):
            return kind
    return _TYPE_WORDS[type.__class__]


def word_type(word: str, scope: Scope) -> ir.Type | None:
    """The type that `type_word` or the dialect's own spelling names; None when there is none."""
    head, _, notation = word.partition(" ")
    if head == "target":
        return ir.TargetType(notation)
    if head == "configuration":
        return ir.ConfigType(notation)
    declared = scope.type(word)
    if declared is not None:
        return scope.resolve(ir.NamedType(word))
    return scope.rules.type_names.get(scope.fold(word)) or _WORD_TYPES.get(word)


def component_type(base: ir.Type, name: str, scope: Scope) -> ir.Type | None:
    """Type of a component by its neutral (or record field) name; None when the type has no such component."""
    match base:
        case ir.NamedType(name=record):
            declaration = scope.type(record)
            if isinstance(declaration, ir.RecordDeclaration):
                for field_name, field_type in declaration.fields:
                    if scope.fold(field_name) == scope.fold(name):
                        return scope.resolve(field_type)
            return None
        case ir.TargetType(notation=notation):
            if name == "conf":
                return ir.ConfigType(notation)
            if name in registry.dialect(notation).notation_fields:
                return _INT
            return ir.COMPONENTS[ir.TargetType].get(name)
        case ir.ConfigType(notation=notation):
            return _REAL if name in registry.dialect(notation).notation_fields else None
    return ir.COMPONENTS.get(base.__class__, {}).get(name)


def component_names(base: ir.Type, scope: Scope) -> tuple[str, ...]:
    """Components in the order of a positional aggregate."""
    match base:
        case ir.NamedType(name=record):
            declaration = scope.type(record)
            return tuple(n for n, _ in declaration.fields) if isinstance(declaration, ir.RecordDeclaration) else ()
        case ir.ConfigType(notation=notation):
            return registry.dialect(notation).notation_fields
    return ir.POSITIONAL.get(base.__class__, ())


def type_of(expression: ir.Expression, scope: Scope) -> ir.Type | None:
    """The type of a normalised expression; None when it rests on something unknown."""
    return Typer(scope, Diagnostics()).infer(expression)[1]


def counter_type(loop: ir.For, scope: Scope) -> ir.Type:
    """Type of a loop's own counter: whole where it starts at a whole number and steps by whole ones."""
    parts = [loop.start] if loop.step is None else [loop.start, loop.step]
    return _INT if all(isinstance(type_of(part, scope), ir.IntType) for part in parts) else _REAL


def normalise(program: ir.Program, diagnostics: Diagnostics) -> ir.Program:
    """The program in normal form. Reports unknown names and type errors."""
    scopes = ProgramScope(program)
    return replace(program, modules=tuple(_module(module, scopes, diagnostics) for module in program.modules))


def _module(module: ir.Module, scopes: ProgramScope, diagnostics: Diagnostics) -> ir.Module:
    typer = Typer(scopes.module(module), diagnostics)
    declarations = tuple(typer.declaration(declaration) for declaration in module.declarations)
    routines = tuple(
        Typer(scopes.routine(module, routine), diagnostics, typer.reported).routine(routine)
        for routine in module.routines
    )
    return replace(module, declarations=declarations, routines=routines)


class Typer:
    """Infers and rewrites inside one scope."""

    def __init__(self, scope: Scope, diagnostics: Diagnostics, reported: set[str] | None = None) -> None:
        self.scope = scope
        self.rules = scope.rules
        self.diagnostics = diagnostics
        self.reported: set[str] = set() if reported is None else reported
        self.here = NOWHERE

    # ---- declarations and statements

    def declaration(self, declaration: ir.Declaration) -> ir.Declaration:
        self.here = declaration.origin
        match declaration:
            case ir.Variable(type=type, initial=initial) if initial is not None:
                value = self.assigned(initial, self.scope.resolve(type))
                return replace(declaration, initial=value, type=self.type(type))
            case ir.Variable(type=type):
                return replace(declaration, type=self.type(type))
            case ir.Initialise(assign=assign):
                done = self.statement(assign)
                return replace(declaration, assign=done) if isinstance(done, ir.Assign) else declaration
        return declaration

    def type(self, type: ir.Type) -> ir.Type:
        """Array bounds and capacities are expressions too."""
        return rewrite_parts(type, self.value) if isinstance(type, ir.ArrayType | ir.StringType) else type

    def routine(self, routine: ir.Routine) -> ir.Routine:
        return replace(
            routine,
            declarations=tuple(self.declaration(declaration) for declaration in routine.declarations),
            body=self.body(routine.body),
            handlers=tuple(
                replace(handler, codes=tuple(map(self.value, handler.codes)), body=self.body(handler.body))
                for handler in routine.handlers
            ),
            undo=self.body(routine.undo),
            backward=self.body(routine.backward),
        )

    def body(self, body: ir.Body) -> ir.Body:
        return tuple(self.statement(statement) for statement in body)

    def statement(self, statement: ir.Statement) -> ir.Statement:
        self.here = statement.origin
        match statement:
            case ir.Assign(target=target, value=value):
                lvalue, wanted = self.infer(target)
                return replace(statement, target=lvalue, value=self.assigned(value, wanted))
            case ir.CallRoutine(dynamic=None):
                name = statement.name
                return replace(statement, arguments=self.arguments(name, statement.arguments, statement.origin))
            case ir.For(scoped=True):
                counter = ir.Variable(statement.counter, counter_type(statement, self.scope))
                inner = Typer(self.scope.with_value(counter), self.diagnostics, self.reported)
                body = inner.body(statement.body)
                return replace(rewrite_parts(replace(statement, body=()), self.value, self.body), body=body)
            case ir.Switch(selector=selector):
                chosen, wanted = self.infer(selector)
                cases = tuple(
                    replace(case, values=tuple(self.coerced(v, wanted) for v in case.values), body=self.body(case.body))
                    for case in statement.cases
                )
                default = None if statement.default is None else self.body(statement.default)
                return replace(statement, selector=chosen, cases=cases, default=default)
            case ir.Return(value=value) if value is not None:
                routine = self.scope.routine_here
                wanted = routine.returns if routine else None
                return replace(statement, value=self.assigned(value, self.scope.resolve(wanted) if wanted else None))
            case ir.ConnectInterrupt(routine=name):
                self.known_routine(name, statement.origin)
            case ir.Move():
                return rewrite_parts(self.written_move(statement), self.value, self.body)
        return rewrite_parts(statement, self.value, self.body)

    def written_move(self, move: ir.Move) -> ir.Move:
        """The move with everything written out in it (targets, speeds, zones, settings) in typed form."""
        speed, blend = move.speed, move.blend
        if speed is not None and isinstance(speed.profile, ir.Aggregate):
            speed = replace(speed, profile=self.assigned(speed.profile, ir.SpeedType()))
        if isinstance(blend, ir.BlendZone) and isinstance(blend.zone, ir.Aggregate):
            blend = replace(blend, zone=self.assigned(blend.zone, ir.ZoneType()))
        return replace(
            move,
            target=self.place(move.target),
            via=None if move.via is None else self.place(move.via),
            settings=tuple(
                (self.value(name), self.assigned(value, self.infer(name)[1])) for name, value in move.settings
            ),
            speed=speed,
            blend=blend,
        )

    def place(self, target: ir.Expression) -> ir.Expression:
        """A motion target; an aggregate written there is joints or a target by the components it names."""
        if not isinstance(target, ir.Aggregate) or target.type_name:
            return self.value(target)
        written = [name for name, _ in target.entries]
        if written and all(name is None for name in written):
            joints = len(written) == len(ir.POSITIONAL[ir.JointsType])
        else:
            axes = self.rules.components.get("JointsType", {})
            neutral = {axes.get(name.lower(), name.lower()) for name in written if name}
            joints = bool(neutral & set(ir.POSITIONAL[ir.AxesType]))
        return self.assigned(target, ir.JointsType() if joints else ir.TargetType(self.rules.name))

    # ---- expressions

    def value(self, expression: ir.Expression) -> ir.Expression:
        return self.infer(expression)[0]

    def assigned(self, expression: ir.Expression, wanted: ir.Type | None) -> ir.Expression:
        """The expression as it is stored in a place of type `wanted`."""
        return self.coerced(expression, wanted, strict=True)

    def coerced(self, expression: ir.Expression, wanted: ir.Type | None, strict: bool = False) -> ir.Expression:
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
        if strict and _clash(wanted, found):
            self.report(MISMATCH, expression.origin, found=type_word(found), wanted=type_word(wanted))
        return done

    def convert(self, how: str, operand: ir.Expression) -> ir.Expression:
        if isinstance(operand, ir.Convert) and operand.how == how:
            return operand
        return ir.Convert(how, operand, origin=operand.origin)

    def infer(self, expression: ir.Expression, wanted: ir.Type | None = None) -> Typed:
        """The normal form of an expression and its type. `wanted` is what its place expects (for aggregates)."""
        match expression:
            case ir.IntLiteral():
                return expression, _INT
            case ir.RealLiteral():
                return expression, _REAL
            case ir.BoolLiteral() | ir.Present():
                return expression, _BOOL
            case ir.TextLiteral(value=text):
                short = self.rules.char_numbers and len(text) == 1 and isinstance(wanted, ir.CharType | ir.IntType)
                return expression, _CHAR if short else _TEXT
            case ir.EnumLiteral(member=member):
                declaration = self.scope.enum_of(member)
                return expression, ir.NamedType(declaration.name) if declaration else None
            case ir.Name():
                return self.name(expression)
            case ir.Index():
                return self.index(expression)
            case ir.Field():
                return self.field(expression)
            case ir.Unary(op=op, operand=operand):
                inner, type = self.infer(operand)
                return replace(expression, operand=inner), _BOOL if op == "not" else type
            case ir.Binary():
                return self.binary(expression)
            case ir.Aggregate():
                return self.aggregate(expression, wanted)
            case ir.Call(name=name, arguments=arguments):
                routine = self.scope.routine(name)
                done = replace(expression, arguments=self.arguments(name, arguments, expression.origin))
                returns = routine.returns if routine else None
                return done, self.scope.resolve(returns) if returns else None
            case ir.Builtin():
                return self.builtin(expression)
            case ir.System(name=name):
                return rewrite_parts(expression, self.value), self.system_type(name)
            case ir.Signal():
                return rewrite_parts(expression, self.value), signal_type(expression)
            case ir.Quantity() | ir.Magnitude():
                return rewrite_parts(expression, self.value), _REAL
            case ir.Convert(how=how):
                return rewrite_parts(expression, self.value), _CONVERTED[how]

    def name(self, expression: ir.Name) -> Typed:
        symbol = self.scope.value(expression.id)
        if symbol is None:
            self.report_once(UNKNOWN_NAME, expression.id, expression.origin)
            return expression, None
        return expression, self.scope.resolve(symbol.type)

    def index(self, expression: ir.Index) -> Typed:
        base, type = self.infer(expression.base)
        indices = tuple(self.coerced(index, _INT) if self.rules.real_to_int else self.value(index)
                        for index in expression.indices)  # fmt: skip
        match type:
            case ir.ArrayType(element=element, dimensions=dimensions):
                count, inner = len(dimensions), self.scope.resolve(element)
                if len(indices) > count and isinstance(inner, ir.StringType):
                    row = replace(expression, base=base, indices=indices[:count])
                    return replace(expression, base=row, indices=indices[count:]), _CHAR
                if len(indices) < count:
                    rest = ir.ArrayType(element, dimensions[len(indices) :], type.base)
                    return replace(expression, base=base, indices=indices), rest
                return replace(expression, base=base, indices=indices), inner
            case ir.StringType():
                return replace(expression, base=base, indices=indices), _CHAR
        return replace(expression, base=base, indices=indices), None

    def neutral(self, base: ir.Type, name: str) -> str:
        """A component's neutral name from the language's own."""
        if isinstance(base, ir.NamedType):
            return name
        lower = name.lower()
        return self.rules.components.get(base.__class__.__name__, {}).get(lower, lower)

    def field(self, expression: ir.Field) -> Typed:
        base, type = self.infer(expression.base)
        if type is None:
            return replace(expression, base=base), None
        name = self.neutral(type, expression.name)
        found = component_type(type, name, self.scope)
        if found is None and not (isinstance(type, ir.NamedType) and self.scope.type(type.name) is None):
            self.report(UNKNOWN_COMPONENT, expression.origin, type=type_word(type), name=expression.name)
            return replace(expression, base=base), None
        return replace(expression, base=base, name=name), found

    def binary(self, expression: ir.Binary) -> Typed:
        op = expression.op
        wanted = ir.PoseType() if op == ":" else None
        left, left_type = self.infer(expression.left, wanted if self.is_pose(expression.left) else None)
        right, right_type = self.infer(expression.right, wanted if self.is_pose(expression.right) else None)
        if left_type is None and isinstance(left, ir.Aggregate) and _has_components(right_type):
            left, left_type = self.infer(expression.left, right_type)  # written out: of the other side's type
        elif right_type is None and isinstance(right, ir.Aggregate) and _has_components(left_type):
            right, right_type = self.infer(expression.right, left_type)
        if op in _ORDERED:
            left, right = self.comparable(left, left_type, right, right_type)
            return replace(expression, left=left, right=right), _BOOL
        if op in _LOGIC:
            return replace(expression, left=left, right=right), _BOOL
        if op in _BITS:
            whole = right_type if left_type is None else left_type
            return replace(expression, left=left, right=right), whole
        if op == ":":
            return replace(expression, left=left, right=right), right_type
        if op == "quo":
            op, type = self.quotient(left_type, right_type)
        else:
            op, type = self.arithmetic(op, left_type, right_type)
        return replace(expression, op=op, left=left, right=right), type

    def is_pose(self, expression: ir.Expression) -> bool:
        """Does an aggregate name components of a pose only (no flags, no external axes)?"""
        if not isinstance(expression, ir.Aggregate) or expression.type_name:
            return False
        known = ir.COMPONENTS[ir.PoseType]
        return all(name is not None and self.neutral(ir.PoseType(), name) in known for name, _ in expression.entries)

    def quotient(self, left: ir.Type | None, right: ir.Type | None) -> tuple[str, ir.Type | None]:
        if isinstance(left, ir.IntType) and isinstance(right, ir.IntType):
            return "div", _INT
        if isinstance(left, ir.RealType) or isinstance(right, ir.RealType):
            return "/", _REAL
        return "quo", None

    def arithmetic(self, op: str, left: ir.Type | None, right: ir.Type | None) -> tuple[str, ir.Type | None]:
        texts = (ir.StringType, ir.CharType)
        if op == "&" or (op == "+" and self.rules.text_plus and (isinstance(left, texts) or isinstance(right, texts))):
            return "&", _TEXT
        if op == "*" and isinstance(left, ir.VectorType) and isinstance(right, ir.VectorType):
            return "@", left
        if op == "*" and isinstance(left, ir.RotationType):
            return ":", left
        for type in (left, right):
            if isinstance(type, ir.VectorType):
                return op, type
        if op in ("/", "**"):
            return op, _REAL
        if left is None or right is None:
            return op, None
        if isinstance(left, ir.IntType) and isinstance(right, ir.IntType):
            return op, _INT
        return op, _REAL

    def comparable(
        self, left: ir.Expression, left_type: ir.Type | None, right: ir.Expression, right_type: ir.Type | None
    ) -> tuple[ir.Expression, ir.Expression]:
        if self.rules.char_numbers:
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
            entries = tuple((name, self.assigned(value, element)) for name, value in expression.entries)
            return replace(expression, entries=entries), type
        names = component_names(type, self.scope)
        done = []
        for position, (written, value) in enumerate(expression.entries):
            name = written if written is None else self.neutral(type, written)
            place = name or (names[position] if position < len(names) else "")
            inner = component_type(type, place, self.scope)
            if inner is None and not self._unknown_record(type):
                self.report(
                    UNKNOWN_COMPONENT, expression.origin, type=type_word(type), name=written or f"number {position + 1}"
                )
            done.append((name, self.assigned(value, inner)))
        return replace(expression, entries=tuple(done), type_name=type_word(type)), type

    def _unknown_record(self, type: ir.Type) -> bool:
        return isinstance(type, ir.NamedType) and self.scope.type(type.name) is None

    def builtin(self, expression: ir.Builtin) -> Typed:
        arguments, types = [], []
        function = ir.FUNCTIONS.get(expression.function)
        kinds = function.parameters.replace("?", "") if function else ""
        for position, argument in enumerate(expression.arguments):
            wanted = None
            if isinstance(argument, ir.Aggregate) and not argument.type_name and position < len(kinds):
                wanted = self.written_kind(kinds[position], argument)
            done, type = self.infer(argument, wanted)
            arguments.append(done)
            types.append(type)
        result: ir.Type | None
        kind = function.result if function else "x"
        if kind.isdigit():
            result = types[int(kind)] if int(kind) < len(types) else None
        elif kind == "p":
            result = _pose_result(expression.function, types, self.rules.name)
        else:
            result = _RESULT_KINDS.get(kind)
        return replace(expression, arguments=tuple(arguments)), result

    def written_kind(self, kind: str, argument: ir.Aggregate) -> ir.Type | None:
        """The type of an aggregate written as an argument of a built-in function."""
        if kind != "p":
            return _RESULT_KINDS.get(kind)
        whole = len(argument.entries) == len(ir.POSITIONAL[ir.TargetType])
        named = any(name is not None for name, _ in argument.entries)
        pose = self.is_pose(argument) if named else not whole
        return ir.PoseType() if pose else ir.TargetType(self.rules.name)

    def system_type(self, name: str) -> ir.Type | None:
        row = ir.SYSTEM_VARIABLES.get(name)
        if row is None:
            return None
        if row.type == "P" and row.access == "r" and name.endswith("_pose"):
            return ir.TargetType(self.rules.name)
        return _RESULT_KINDS.get(row.type)

    def arguments(self, name: str, given: tuple[ir.Argument, ...], origin: Origin) -> tuple[ir.Argument, ...]:
        """Arguments in normal form, converted to their parameters' types where they are passed by value."""
        routine = self.known_routine(name, origin)
        parameters = routine.parameters if routine else ()
        by_name = {self.scope.fold(parameter.name): parameter for parameter in parameters}
        required = [parameter for parameter in parameters if not parameter.optional]
        positional = iter(required if any(p.optional for p in parameters) else parameters)
        done = []
        for argument in given:
            parameter = by_name.get(self.scope.fold(argument.name)) if argument.name else next(positional, None)
            if routine and not routine.open_ended and parameter is None and argument.value is not None:
                self.report(TOO_MANY, origin, name=name, count=len(parameters), given=len(given))
            if argument.value is None:
                done.append(argument)
            elif parameter is None or parameter.mode == "reference":
                wanted = None if parameter is None else self.scope.resolve(parameter.type)
                done.append(replace(argument, value=self.infer(argument.value, wanted)[0]))
            else:
                done.append(replace(argument, value=self.assigned(argument.value, self.scope.resolve(parameter.type))))
        return tuple(done)

    def known_routine(self, name: str, origin: Origin) -> ir.Routine | None:
        routine = self.scope.routine(name)
        if routine is None:
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


_CONVERTED: dict[str, ir.Type] = {
    "real": _REAL,
    "round_half_away": _INT,
    "trunc": _INT,
    "bit": _INT,
    "truth": _BOOL,
    "code": _INT,
    "char": _CHAR,
}


def _pose_result(function: str, types: list[ir.Type | None], notation: str) -> ir.Type | None:
    """Poses keep the kind of what they are made from; positions of the robot are targets."""
    if function in ("current_target", "joints_to_target"):
        return ir.TargetType(notation)
    if function == "compose":
        return types[-1] if types else None
    return ir.PoseType()


def _has_components(type: ir.Type | None) -> bool:
    return isinstance(type, ir.NamedType | ir.ArrayType) or type.__class__ in ir.POSITIONAL


def _clash(wanted: ir.Type, found: ir.Type) -> bool:
    """Certainly incompatible: a text, number or BOOL where another of these is needed."""
    kinds = []
    for type in (wanted, found):
        match type:
            case ir.IntType() | ir.RealType():
                kinds.append("number")
            case ir.StringType() | ir.CharType():
                kinds.append("text")
            case ir.BoolType():
                kinds.append("bool")
            case _:
                return False
    return kinds[0] != kinds[1]
