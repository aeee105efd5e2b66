"""Poses that stand for tools and frames as tool and work object data, as RAPID's moves name it.

Languages that keep tools and user frames as plain poses (numbered registers, frames of an interpreter) name them in a
move, or in a function that asks where the robot stands. Global data that does so becomes a record with the pose inside:
what reads or sets the pose reads or sets that component. Anything else (a local pose, a computed one, an element of an
array) is put into a record of its own in front of the statement. No offset at all is the target's own data for that.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.headdata import with_data
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.signatures import PLACES
from rpl.passes.values import pose_of

_ZERO = ir.RealLiteral(0.0)
_NO_TURN = ir.Aggregate(
    (("q1", ir.RealLiteral(1.0)), ("q2", _ZERO), ("q3", _ZERO), ("q4", _ZERO)), type_name="rotation"
)
_ORIGIN = ir.Aggregate((("x", _ZERO), ("y", _ZERO), ("z", _ZERO)), type_name="vector")
_IDENTITY = ir.Aggregate((("trans", _ORIGIN), ("rot", _NO_TURN)), type_name="pose")
_LIGHT = ir.Aggregate(
    (
        ("mass", ir.RealLiteral(0.001)),
        ("cog", ir.Aggregate((("x", _ZERO), ("y", _ZERO), ("z", ir.RealLiteral(0.001))), type_name="vector")),
        ("axes", _NO_TURN),
        ("ix", _ZERO),
        ("iy", _ZERO),
        ("iz", _ZERO),
    ),
    type_name="load",
)


def tool_of(pose: ir.Expression = _IDENTITY) -> ir.Expression:
    """Tool data with that tool centre point, in the robot's hand, as light as the controllers allow."""
    return ir.Aggregate((("held", ir.BoolLiteral(True)), ("frame", pose), ("load", _LIGHT)), type_name="tool")


def work_object_of(pose: ir.Expression = _IDENTITY) -> ir.Expression:
    """Work object data with that user frame, fixed in the room."""
    return ir.Aggregate(
        (
            ("held", ir.BoolLiteral(False)),
            ("fixed", ir.BoolLiteral(True)),
            ("unit", ir.TextLiteral("")),
            ("user_frame", pose),
            ("object_frame", _IDENTITY),
        ),
        type_name="workobject",
    )


@dataclass(frozen=True, slots=True)
class _Kind:
    """What a pose becomes: the record's type, the component that holds the pose, the stem of generated names."""

    type: ir.Type
    component: str
    stem: str


_TOOL = _Kind(ir.ToolType(), "frame", "tool")
_FRAME = _Kind(ir.WorkObjectType(), "user_frame", "wobj")


@legalising()
def tool_data(program: ir.Program, context: Context) -> ir.Program:
    """Tools and frames of moves are records (`tooldata`, `wobjdata`)."""
    worker = _ToolData(program, context)
    done = worker.program()
    if not worker.added:
        return done
    return with_data(done, worker.added)


class _ToolData(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.records: dict[int, _Kind] = {}
        self.names: dict[tuple[str, ir.Expression], ir.Name] = {}
        self.added: list[ir.Variable] = []
        for module in program.modules:
            for routine in module.routines:
                self.find(routine, self.scopes.routine(module, routine))

    # ---- which data becomes records

    def find(self, routine: ir.Routine, scope: Scope) -> None:
        for node in walk(routine):
            match node:
                case ir.Move(tool=tool, frame=frame):
                    self.found(tool, _TOOL, scope)
                    self.found(frame, _FRAME, scope)
                case ir.Builtin(function=function, arguments=arguments) if function in PLACES:
                    for at, kind in zip(PLACES[function], (_TOOL, _FRAME), strict=True):
                        if at < len(arguments):
                            self.found(arguments[at], kind, scope)

    def found(self, place: ir.Expression | None, kind: _Kind, scope: Scope) -> None:
        variable = _global(place, scope)
        if variable is not None:
            self.records.setdefault(id(variable), kind)

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        kind = self.records.get(id(declaration))
        (done,) = made = super().declaration(declaration)
        if kind is None or not isinstance(done, ir.Variable):
            return made
        pose = done.initial if done.initial is not None else _IDENTITY
        value = tool_of(pose) if kind is _TOOL else work_object_of(pose)
        return [replace(done, type=kind.type, initial=value, storage="persistent")]

    # ---- uses

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Name():
                kind = self.record(expression)
                return expression if kind is None else ir.Field(expression, kind.component, origin=expression.origin)
            case ir.Builtin(function=function, arguments=arguments) if function in PLACES:
                tool, frame = PLACES[function]
                kinds = {tool: _TOOL, frame: _FRAME}
                done = [
                    self.place(one, kinds[at]) if at in kinds else self.expression(one)
                    for at, one in enumerate(arguments)
                ]
                return replace(expression, arguments=tuple(done))
        return super().expression(expression)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if not isinstance(statement, ir.Move):
            return super().statement(statement)
        tool = None if statement.tool is None else self.place(statement.tool, _TOOL)
        frame = None if statement.frame is None else self.place(statement.frame, _FRAME)
        bare = replace(statement, tool=None, frame=None)
        done = rewrite_parts(bare, self.expression, self.actions)
        return [replace(done, tool=tool, frame=frame)]

    def record(self, name: ir.Name) -> _Kind | None:
        variable = _global(name, self.scope)
        return None if variable is None else self.records.get(id(variable))

    def place(self, value: ir.Expression, kind: _Kind) -> ir.Expression:
        """Data of the kind that holds this pose; data of the kind as it is."""
        if not isinstance(self.type_of(value), ir.PoseType | ir.TargetType):
            return self.expression(value)
        if isinstance(value, ir.Name) and self.record(value) is kind:
            return value
        bare = self.context.capabilities.settings.bare
        if bare is not None and pose_of(constant(value, self.scope)) == rigid.IDENTITY:
            return ir.Name(bare[0] if kind is _TOOL else bare[1], origin=value.origin)
        return self.own(value, kind)

    def own(self, value: ir.Expression, kind: _Kind) -> ir.Expression:
        """A record for this pose alone, set in front of the statement unless it is a constant."""
        fixed = isinstance(value, ir.Aggregate) and constant(value, self.scope) is not None
        key = (kind.stem, value)
        if key not in self.names:
            self.names[key] = ir.Name(self.numbered(kind.stem))
            pose = value if fixed else _IDENTITY
            first = tool_of(pose) if kind is _TOOL else work_object_of(pose)
            name = self.names[key].id
            self.added.append(ir.Variable(name, kind.type, first, storage="persistent", scope="global"))
        if not fixed:
            self.before.append(ir.Assign(ir.Field(self.names[key], kind.component), self.expression(value)))
        return self.names[key]

    def numbered(self, stem: str) -> str:
        """`tool1`, `tool2`, ...: the first that nothing in the program has."""
        number = 1
        while f"{stem}{number}" in self.context.taken:
            number += 1
        return self.context.fresh(f"{stem}{number}")


def _global(place: ir.Expression | None, scope: Scope) -> ir.Variable | None:
    """The declaration of a pose that the whole program knows, when the place is one by its name."""
    symbol = scope.value(place.id) if isinstance(place, ir.Name) else None
    if symbol is None or symbol.module is None or symbol.routine is not None:
        return None
    declaration = symbol.declaration
    if isinstance(declaration, ir.Variable) and isinstance(scope.resolve(declaration.type), ir.PoseType):
        return declaration
    return None
