"""Arm configuration that a program reads (`p.s`, `p.robconf.cf1`), for targets whose controllers write another one.

Beside a variable that is read so, a variable per flag is kept: set where the target gets its value, from the flags that
were taught, or from the joints where the value is the robot's own place, by the facts that the source's flags are made
of and the geometry of its arm. A variable that gets its value in another way stays as it is, and `configurations`,
which runs next, refuses the reading.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rpl import ir, registry
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import each_expression, each_statement
from rpl.passes.legalise.places.postures.flagwrites import FlagFlow
from rpl.passes.legalise.rewriting.walk import Rewriter, unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

if TYPE_CHECKING:
    from rpl.emulator.postures import Fact, Sine

_MOVED = frozenset(("offset", "tool_offset", "displaced", "displaced_in_tool"))
_ELSEWHERE = (ir.Label, ir.Goto, ir.ExitLoop, ir.NextPass, ir.Raise)
_AXES = ("j1", "j2", "j3", "j4", "j5", "j6")


@legalising(unless=lambda context: context.capabilities.carries_rules)
def flag_readings(program: ir.Program, context: Context) -> ir.Program:
    """The program with flags as numbers of their own, as far as they can be known."""
    can = context.capabilities
    sources = {module.dialect for module in program.modules}
    if not any(one != can.places.notation for one in sources):
        return program
    look = _Look(program, context)
    look.program()
    look.close()
    if not look.flags:
        return program
    return _Kept(program, context, look).program()


@dataclass(slots=True)
class _Known:
    """What is known of the variables: by the identity of their declaration."""

    flags: dict[int, set[str]] = field(default_factory=dict)
    broken: set[int] = field(default_factory=set)
    copies: list[tuple[int, int]] = field(default_factory=list)  # to, from
    computed: list[tuple[int, frozenset[str]]] = field(default_factory=list)  # gets a place with these flags known


class _Look(Rewriter):
    """Which variables' flags are read, and which of them get values that can be followed."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.known = _Known()
        self.arm = _facts(context)
        self.flow: FlagFlow | None = None

    @property
    def flags(self) -> dict[int, set[str]]:
        return self.known.flags

    def close(self) -> None:
        """Variables that others are copied to are followed as these are; what copies a broken one is broken."""
        known, size = self.known, -1
        while size != (size := sum(map(len, known.flags.values())) + len(known.broken)):
            for to, given in known.copies:
                known.flags.setdefault(given, set()).update(known.flags.get(to, ()))
                if given in known.broken and to in known.flags:
                    known.broken.add(to)
            for to, flags in known.computed:
                if not known.flags.get(to, set()) <= flags:
                    known.broken.add(to)
        known.flags = {key: flags for key, flags in known.flags.items() if flags and key not in known.broken}

    def key(self, name: ir.Expression) -> int | None:
        """The variable of a name that holds a target."""
        if not isinstance(name, ir.Name):
            return None
        symbol = self.scope.value(name.id)
        if symbol is None or not isinstance(self.scope.resolve(symbol.type), ir.TargetType):
            return None
        return id(symbol.declaration)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Field(base=base, name=name) if isinstance(base, ir.Name) or _conf(base):
                key = self.key(_target(base))
                if key is not None and name in self.fields(_target(base)):
                    self.known.flags.setdefault(key, set()).add(name)
            case ir.Call(arguments=arguments):
                self.passed(arguments)
        return rewrite_parts(expression, self.expression)

    def fields(self, target: ir.Expression) -> tuple[str, ...]:
        type = self.type_of(target)
        return registry.dialect(type.notation).notation_fields if isinstance(type, ir.TargetType) else ()

    def passed(self, arguments: tuple[ir.Argument, ...]) -> None:
        """Arguments may be changed by the routine, unless they are expressions."""
        for argument in arguments:
            value = None if argument.value is None else _target(argument.value)
            self.break_at(value)

    def break_at(self, place: ir.Expression | None) -> None:
        key = None if place is None else self.key(place)
        if key is not None:
            self.known.broken.add(key)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Assign(target=ir.Name() as target, value=value):
                self.assigned(target, value)
            case ir.Assign(target=ir.Field(base=base, name=name)):
                if name == "conf" or name in self.fields(_target(base)):
                    self.break_at(_target(base))
            case ir.CallRoutine(arguments=arguments):
                self.passed(arguments)
            case ir.Do(arguments=values):
                for one in values:
                    self.break_at(one)
            case ir.Move(search=ir.Search(found=found)):
                self.break_at(found)
        return super().statement(statement)

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        match declaration:
            case ir.Variable(initial=ir.Aggregate() as value) if self.written(value) is None:
                self.known.broken.add(id(declaration))
            case ir.Variable(initial=value) if value is not None and not isinstance(value, ir.Aggregate):
                self.known.broken.add(id(declaration))
            case ir.Initialise(assign=assign):
                self.break_at(_target(assign.target))
        return super().declaration(declaration)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.known.broken.update(id(parameter) for parameter in routine.parameters)
        return super().routine(module, routine)

    def assigned(self, target: ir.Name, value: ir.Expression) -> None:
        key = self.key(target)
        if key is None:
            return
        match self.origin(value):
            case ir.Name() as other if (given := self.key(other)) is not None:
                self.known.copies.append((key, given))
            case ir.Aggregate() as written if not isinstance(value, ir.Aggregate):
                self.known.computed.append((key, frozenset(self.written(written) or ())))
            case ir.Aggregate() as written if self.written(written) is not None:
                pass
            case joints if joints is not None and self.arm and isinstance(self.type_of(joints), ir.JointsType):
                pass
            case _:
                self.known.broken.add(key)

    def origin(self, value: ir.Expression) -> ir.Expression | None:
        """What a target's flags come from: joints, a written target, another variable."""
        match value:
            case ir.System(name="actual_pose") | ir.Builtin(function="current_target"):
                return ir.System("actual_joints", origin=value.origin)
            case ir.Builtin(function="joints_to_target", arguments=(ir.Name() as joints, *_)):
                return joints
            case ir.Builtin(function=name, arguments=(first, *_)) if name in _MOVED and first is not None:
                return self.origin(first)
            case ir.Name() | ir.Aggregate():
                return value
            case ir.Call() | ir.Binary(op=":"):
                return self.always(value)
        return None

    def always(self, place: ir.Expression) -> ir.Aggregate | None:
        """The flags that a computed place has, whatever it is."""
        fields = self.fields(place)
        if not fields:
            return None
        if self.flow is None:
            self.flow = FlagFlow.of_program(self.source, self.scopes, fields, unchanged_in(self.source))
        found = {name: self.flow.values(place, name, self.scope).only for name in fields}
        known = tuple((name, ir.IntLiteral(value)) for name, value in found.items() if value is not None)
        return ir.Aggregate(known) if known else None

    def written(self, target: ir.Aggregate) -> dict[str, ir.Expression] | None:
        """The flags of a written target; None when they have no names."""
        entries = dict(target.entries)
        conf = entries.get("conf")
        if isinstance(conf, ir.Aggregate):
            entries = dict(conf.entries)
        elif conf is not None:
            return None
        return None if None in entries else {name: value for name, value in entries.items() if name is not None}


class _Kept(_Look):
    """Puts the numbers beside the variables."""

    def __init__(self, program: ir.Program, context: Context, look: _Look) -> None:
        super().__init__(program, context)
        self.scopes, self.followed, self.flow = look.scopes, look.known.flags, look.flow
        self.names: dict[tuple[int, str], str] = {}
        self.live: set[int] = set()
        self.last = False
        modules = (one for module in program.modules for one in module.declarations)
        self.shared = {id(one) for one in modules}  # variables that a called routine may look at

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Field(base=base, name=name) if isinstance(base, ir.Name) or _conf(base):
                key = self.key(_target(base))
                if key is not None and name in self.followed.get(key, ()):
                    return ir.Name(self.name(_target(base), key, name), origin=expression.origin)
        return rewrite_parts(expression, self.expression)

    def name(self, target: ir.Expression, key: int, flag: str) -> str:
        assert isinstance(target, ir.Name)  # `key` found its variable
        if (key, flag) not in self.names:
            self.names[key, flag] = self.context.fresh(f"{target.id}_{flag}")
        return self.names[key, flag]

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        done = Rewriter.declaration(self, declaration)
        flags = self.followed.get(id(declaration), set())
        if not isinstance(declaration, ir.Variable):
            return done
        given = self.written(declaration.initial) if isinstance(declaration.initial, ir.Aggregate) else {}
        for flag in sorted(flags):
            name = self.name(ir.Name(declaration.name), id(declaration), flag)
            initial = (given or {}).get(flag, ir.IntLiteral(0))
            done.append(replace(declaration, name=name, type=ir.IntType(), initial=initial))
        return done

    # ---- where targets get their values

    def body(self, body: ir.Body) -> ir.Body:
        last, self.last = self.last, False
        for at, statement in enumerate(body):
            if isinstance(statement, ir.Assign) and (key := self.key(statement.target)) in self.followed:
                assert key is not None  # it is followed
                if self.is_read(body[at + 1 :], key, last and key not in self.shared):
                    self.live.add(id(statement))
        return super().body(body)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.last = not routine.handlers  # the body comes first; behind it a variable of its own is gone
        return super().routine(module, routine)

    def is_read(self, rest: ir.Body, key: int, last: bool) -> bool:
        """May a flag be read before the variable is set again? `last`: nothing comes behind `rest`."""
        found = False

        def look(expression: ir.Expression) -> None:
            nonlocal found
            found = found or self.reads(expression, key)

        for statement in rest:
            each_expression(statement, look, inner=True)
            inner: list[ir.Statement] = []
            each_statement((statement,), inner.append)
            if found or any(isinstance(one, _ELSEWHERE) or self.copies(one, key) for one in inner):
                return True
            if key in self.shared and any(isinstance(one, ir.CallRoutine | ir.Return) for one in inner):
                return True
            if isinstance(statement, ir.Assign) and self.key(statement.target) == key:
                return False
        return not last

    def reads(self, expression: ir.Expression, key: int) -> bool:
        """Is it one of the flags, or may a routine look at them?"""
        match expression:
            case ir.Field(base=base, name=name) if isinstance(base, ir.Name) or _conf(base):
                return self.key(_target(base)) == key and name in self.followed[key]
            case ir.Call():
                return key in self.shared
        return False

    def copies(self, statement: ir.Statement, key: int) -> bool:
        """Does the statement give the value on, to a variable that is followed, too?"""
        if not isinstance(statement, ir.Assign) or self.key(statement.target) not in self.followed:
            return False
        origin = self.origin(statement.value)
        return isinstance(origin, ir.Name) and self.key(origin) == key

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        done = Rewriter.statement(self, statement)
        if not isinstance(statement, ir.Assign) or id(statement) not in self.live:
            return done
        key = self.key(statement.target)
        assert key is not None  # it is followed
        names = {flag: self.name(statement.target, key, flag) for flag in sorted(self.followed[key])}
        return [*done, *self.settings(self.origin(statement.value), names)]

    def settings(self, origin: ir.Expression | None, names: dict[str, str]) -> list[ir.Statement]:
        """Each flag of a target from what the target comes from."""
        match origin:
            case ir.Aggregate():
                given = self.written(origin) or {}
                return [_set(name, given.get(flag, ir.IntLiteral(0))) for flag, name in names.items()]
            case ir.Name() if (other := self.key(origin)) is not None:
                return [_set(name, ir.Name(self.name(origin, other, flag))) for flag, name in names.items()]
        assert origin is not None  # the variable would not be followed
        first: list[ir.Statement] = []
        joints = origin
        if not isinstance(joints, ir.Name):
            joints = self.temporary(ir.JointsType(), "joints")
            first = [ir.Assign(joints, origin)]
        return [*first, *(one for flag, name in names.items() for one in self.from_joints(flag, name, joints))]

    def from_joints(self, flag: str, name: str, joints: ir.Expression) -> list[ir.Statement]:
        """The flag as a sum of its parts."""
        arm = self.context.robot
        terms = registry.dialect(self.context.source).flag_terms("" if arm is None else arm.name).get(flag, ())
        done: list[ir.Statement] = []
        for weight, fact, axis in terms:
            if fact == "quarter":
                turn = ir.Binary("/", _axis(joints, axis), ir.RealLiteral(90.0))
                done.append(_set(name, ir.Convert("floor", turn)))
                continue
            if not done:
                done.append(_set(name, ir.IntLiteral(0)))
            total = ir.Binary("+", ir.Name(name), ir.IntLiteral(weight))
            done.append(ir.If(((self.flag_asked(fact, axis, joints), (_set(name, total),)),)))
        return done or [_set(name, ir.IntLiteral(0))]

    def flag_asked(self, fact: str, axis: int, joints: ir.Expression) -> ir.Expression:
        if fact == "negative":
            return ir.Binary("<", _axis(joints, axis), ir.RealLiteral(0.0))
        opposite = fact == "elbow_above_stretched"
        found: Fact = self.arm["behind_lower_arm" if opposite else fact]
        return _below_zero(found, joints, opposite)


def _facts(context: Context) -> dict[str, Fact]:
    """The facts of the arm, where the program is for the arm it runs on."""
    arm = context.robot
    other = context.to_robot is not None and arm is not None and context.to_robot.name != arm.name
    return {} if arm is None or other else arm.posture_facts()


def _below_zero(fact: Fact, joints: ir.Expression, opposite: bool) -> ir.Expression:
    op = ">=" if opposite else "<"
    if len(fact.sines) == 1 and fact.sines[0].narrow and not fact.constant:
        (sine,) = fact.sines
        moving = [at for at, factor in enumerate(sine.factors) if factor]
        if len(moving) == 1 and sine.factors[moving[0]] == 1.0:
            return ir.Binary(op, _axis(joints, moving[0] + 1), ir.RealLiteral(_clean(-sine.offset)))
        return ir.Binary(op, _angle(sine, joints), ir.RealLiteral(0.0))
    total: ir.Expression | None = ir.RealLiteral(_clean(fact.constant)) if fact.constant else None
    for sine in fact.sines:
        part: ir.Expression = ir.Builtin("sin", (_angle(sine, joints),))
        if sine.amplitude != 1.0:
            part = ir.Binary("*", ir.RealLiteral(_clean(sine.amplitude)), part)
        total = part if total is None else ir.Binary("+", total, part)
    assert total is not None  # a fact has a sine
    return ir.Binary(op, total, ir.RealLiteral(0.0))


def _angle(sine: Sine, joints: ir.Expression) -> ir.Expression:
    """The sum of joints that a sine is of, in degrees."""
    total: ir.Expression | None = None
    for at, factor in enumerate(sine.factors):
        if factor:
            part = _axis(joints, at + 1)
            if total is None:
                total = part if factor == 1.0 else ir.Binary("*", ir.RealLiteral(factor), part)
            else:
                size = part if abs(factor) == 1.0 else ir.Binary("*", ir.RealLiteral(abs(factor)), part)
                total = ir.Binary("+" if factor > 0 else "-", total, size)
    assert total is not None  # every angle is of a joint
    if not sine.offset:
        return total
    return ir.Binary("+" if sine.offset > 0 else "-", total, ir.RealLiteral(_clean(abs(sine.offset))))


def _clean(value: float) -> float:
    """Without the noise of binary fractions; a millionth of a degree or millimetre decides no flag."""
    return round(value, 6) + 0.0


def _axis(joints: ir.Expression, number: int) -> ir.Field:
    return ir.Field(joints, _AXES[number - 1])


def _set(name: str, value: ir.Expression) -> ir.Assign:
    return ir.Assign(ir.Name(name), value)


def _conf(base: ir.Expression) -> bool:
    return isinstance(base, ir.Field) and base.name == "conf" and isinstance(base.base, ir.Name)


def _target(base: ir.Expression) -> ir.Expression:
    """The target that a component or its configuration belongs to."""
    return base.base if isinstance(base, ir.Field) and base.name == "conf" else base


__all__ = ["flag_readings"]
