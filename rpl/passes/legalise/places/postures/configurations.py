"""Arm configuration from the notation of the source to that of the target, through the robot's own kinematics.

A written target's flags choose one posture of the arm: flange = base : pose : inverse(tool) with the tool and frame of
the moves that the target serves. That posture is encoded anew. On another arm the posture nearest by name is chosen,
and joint targets travel through their pose. What cannot be known is reported, and the controller keeps the nearest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.columns import Stretch, as_float
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import PlaceRule, Postures
from rpl.passes.fold import constant, real
from rpl.passes.legalise.context import Arm, Context, array, rules_of
from rpl.passes.legalise.facts.targetuses import Use, Uses
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.places.postures.families import changed_posture, differing
from rpl.passes.legalise.places.postures.flagwrites import FlagFlow, FlagValues, only_turns
from rpl.passes.legalise.places.postures.givenjoints import joint_values, with_joints
from rpl.passes.legalise.places.postures.impliedflags import Known, implied_flags
from rpl.passes.legalise.places.postures.reports import (
    FLAG_ACCESS,
    JOINTS_LOST,
    NOT_CONVERTED,
    POSTURE_CHANGED,
    WITHOUT_TURNS,
)
from rpl.passes.legalise.places.postures.rowpostures import (
    all_there,
    degrees_in_rows,
    flags_in_rows,
    flanges_in_rows,
    joints_in_rows,
    joints_on_other_arm,
    stretch_of_matrix,
)
from rpl.passes.legalise.places.postures.together import Asked, Found, asked_for, found_together
from rpl.passes.legalise.places.postures.writtenplaces import check, inserted, is_taught, may_be_point
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.rewriting.walk import Rewriter, unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.typewords import component_names, type_word
from rpl.passes.values import Record, Target, moved
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation

_AXES = tuple(ir.COMPONENTS[ir.AxesType])
_CHECKS = ("joint_configuration_check", "path_configuration_check")


@legalising()
def configurations(program: ir.Program, context: Context) -> ir.Program:
    """Types, flags of constant targets and, for another arm, constant joint targets."""
    worker = _Configurations(program, context)
    if not worker.foreign and not worker.other_arm:
        return program
    done = worker.program()
    if not (worker.exact and worker.nearest):
        return done
    # Some moves have known flags and some have not: again, now that it is known which.
    return _Configurations(program, replace(context, diagnostics=Diagnostics()), worker).program()


@dataclass(frozen=True, slots=True)
class _Refused:
    """Why there are no flags. `fatal`: the arm cannot go there."""

    reason: str
    fatal: bool = False


class _Configurations(Rewriter):
    def __init__(self, program: ir.Program, context: Context, trial: _Configurations | None = None) -> None:
        super().__init__(program, context)
        self.trial = trial
        kept = context.capabilities.carries_rules or not context.foreign
        self.target_notation = context.source if kept else context.capabilities.places.notation
        sources = {module.dialect for module in program.modules}
        self.foreign = not kept and any(one != self.target_notation for one in sources)
        self.side_by_side = True  # are the flags of the target written now beside its position?
        self.arm, self.to_arm = context.robot, context.to_robot or context.robot
        self.other_arm = bool(self.arm and self.to_arm and self.arm.name != self.to_arm.name)
        self.near = self.foreign and context.capabilities.places.postures is Postures.JOINTS
        self.implications: Known = {}
        self.changed: tuple[str, str] | None = None  # the posture of the place looked at now, on one arm and the other
        self.told: set[tuple[int, int]] = set()  # source and line where single axes have been told
        self.around = NOWHERE  # the declaration or statement that is looked at now
        self.unturned = ""  # why the target looked at now has flags, but none of its turns
        self.together: dict[Asked, Found] = trial.together if trial else {}
        self.results: dict[int, dict[str, int] | _Refused] = trial.results if trial else {}
        self.loose: set[int] = trial.loose if trial else set()  # variables whose flags the program sets one by one
        self.flags: FlagFlow | None = trial.flags if trial else None
        self.exact, self.nearest = False, False  # are there joint moves to converted, to other targets?
        self.posed = False  # are there path moves to poses, which say nothing about the arm's posture?
        self.uses: Uses
        if trial is not None:
            self.uses, self.scopes = trial.uses, trial.scopes
        else:
            self.uses = Uses.of(program, self.scopes) if self.foreign or self.other_arm else Uses()

    # ---- program

    def program(self) -> ir.Program:
        if self.trial is None and self.arm is not None:
            other = self.to_arm if self.other_arm else None
            self.together = found_together(self.all_asked(), self.arm, other)
        done = super().program()
        checks = self.checks()
        if not checks:
            return done
        entries = self.entries(done)
        modules = tuple(
            replace(
                module,
                routines=tuple(
                    replace(one, body=(*checks, *one.body)) if one.name.lower() in entries else one
                    for one in module.routines
                ),
            )
            for module in done.modules
        )
        return replace(done, modules=modules)

    def all_asked(self) -> Iterator[tuple[Notation, Asked]]:
        """What `for_use` will ask for."""
        for module in self.source.modules:
            self.enter(self.scopes.module(module))
            yield from self.asked_in(module.declarations)
            for routine in module.routines:
                self.enter(self.scopes.routine(module, routine))
                yield from self.asked_in((*routine.declarations, *bodies(routine)))

    def asked_in(self, nodes: tuple[object, ...]) -> Iterator[tuple[Notation, Asked]]:
        for node in walk(*nodes):
            uses = self.uses.found.get(id(node)) if isinstance(node, ir.Aggregate) else None
            type = self.type_of(node) if uses and isinstance(node, ir.Aggregate) and may_be_point(node) else None
            if not isinstance(type, ir.TargetType) or not isinstance(node, ir.Aggregate) or not uses:
                continue
            notation, value = _notation(type.notation), constant(node, self.scope, None)
            had = self.has_flags(type, self.named(node, type))
            if notation is None or not isinstance(value, Target) or not (had or self.other_arm):
                continue
            for use in uses:
                place = moved(use.moved[0], value, list(use.moved[1])) if use.moved else value
                flange = use.frames.flange(place.pose) if isinstance(place, Target) else None
                if flange is not None:
                    yield notation, asked_for(notation, flange, _flags_of(value, notation), use.joint, had)

    def checks(self) -> tuple[ir.Statement, ...]:
        """Switch off the checks of the target's controller that the source's did not make."""
        if not (self.results or self.nearest or self.posed):
            return ()
        known = rules_of(self.context.source).system_defaults
        joint, path = _CHECKS
        wanted = [path] if self.foreign and not known.get(path, False) else []
        wanted += [joint] if self.nearest and not self.exact else []
        return tuple(check(name, False) for name in sorted(wanted) if self.can_set(name))

    def can_set(self, name: str) -> bool:
        return name in self.context.capabilities.system_variables

    def joint_move(self, move: ir.Move) -> list[ir.Statement]:
        """A joint move; where its target's flags are not known, without the check of the flags."""
        done = super().statement(move)
        if self.foreign and isinstance(self.type_of(move.target), ir.PoseType):
            self.nearest = True  # a pose says nothing about the arm's posture
            return self.unchecked(done)
        reached = self.uses.reach(move.target, self.scope)
        found = [self.results[key] for key in reached if key in self.results]
        if not self.near and not self.loose.isdisjoint(reached):
            self.nearest = True
            return self.unchecked(done)
        if not found:
            return done
        if not any(isinstance(one, _Refused) for one in found):
            self.exact = True
            return self.solved_near(done, found) if self.near else done
        self.nearest = True
        return self.unchecked(done)

    def solved_near(self, done: list[ir.Statement], found: list[dict[str, int] | _Refused]) -> list[ir.Statement]:
        """The joint move goes to the solution nearest to the joints of the source's posture (to the degree)."""
        first, last = found[0], done[-1]
        same = all(one == first for one in found)
        if not same or not isinstance(first, dict) or set(first) != set(_AXES) or not isinstance(last, ir.Move):
            return done
        joints = ir.Aggregate(tuple((name, real(as_float(value))) for name, value in first.items()), type_name="joints")
        return [*done[:-1], replace(last, target=ir.Builtin("target_to_joints_near", (last.target, joints)))]

    def unchecked(self, done: list[ir.Statement]) -> list[ir.Statement]:
        """Moves without the check of the flags, where other moves are to be checked."""
        mixed = self.trial is not None and self.trial.exact
        if not mixed or not self.can_set(_CHECKS[0]):
            return done
        return [check(_CHECKS[0], False), *done, check(_CHECKS[0], True)]

    def entries(self, program: ir.Program) -> set[str]:
        if program.entry:
            return {program.entry.lower()}
        moving = {task.entry.lower() for task in program.tasks if task.kind == "motion"}
        if moving:
            return moving
        called = {task.entry.lower() for task in program.tasks}  # beside the program, whose first routine is not named

        def expression(one: ir.Expression) -> ir.Expression:
            if isinstance(one, ir.Call):
                called.add(one.name.lower())
            return rewrite_parts(one, expression)

        def body(statements: ir.Body) -> ir.Body:
            for one in statements:
                match one:
                    case ir.CallRoutine(name=name) | ir.ConnectInterrupt(routine=name) | ir.TaskControl(task=name):
                        called.add(name.lower())
                rewrite_parts(one, expression, body)
            return statements

        rewrite_parts(program, expression, body)
        routines = [one for module in program.modules for one in module.routines]
        return {one.name.lower() for one in routines if one.kind == "procedure" and one.name.lower() not in called}

    # ---- types

    def type(self, type: ir.Type) -> ir.Type:
        match type:
            case ir.TargetType():
                return replace(type, notation=self.target_notation)
            case ir.ConfigType():
                return replace(type, notation=self.target_notation)
        return super().type(type)

    def initial(self, value: ir.Expression, declaration: ir.Variable) -> ir.Expression | None:
        self.around = declaration.origin
        if isinstance(self.scope.resolve(declaration.type), ir.ConfigType) and self.foreign:
            self.context.diagnostics.report(FLAG_ACCESS, declaration.origin, name=declaration.name)
            return None
        return super().initial(value, declaration)

    # ---- access to flags

    def at(self, expression: ir.Expression) -> Origin:
        """The place of a value, or of the declaration or statement around it."""
        return self.around if expression.origin is NOWHERE else expression.origin

    def placed(self, statement: ir.Statement) -> ir.Body:
        self.around = statement.origin
        return super().placed(statement)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Move) and statement.kind == "joint":
            return self.joint_move(statement)
        if isinstance(statement, ir.Move) and self.foreign:
            self.posed = self.posed or isinstance(self.type_of(statement.target), ir.PoseType)
        if not self.foreign:
            return super().statement(statement)
        match statement:
            case ir.Assign(target=ir.Field(name=name) as target, value=value) if self.is_flag(target):
                if self.set_alike(statement, target, value):
                    return []
                return [stopped(statement, FLAG_ACCESS, self.context, name=name)]
            case ir.Assign(target=ir.Field(base=base, name="conf"), value=value):
                return self.copied(statement, base, value)
        return super().statement(statement)

    def set_alike(self, statement: ir.Assign, target: ir.Field, value: ir.Expression) -> bool:
        """May the flag stay as it is? Where that is another one, it says how far axes turn, which is told."""
        given = self.flag_flow.given(value, target.name, self.scope)
        found = self.flag_values(target)
        if found.complete and found.places and found.places | found.set == given.places | given.set == {found.only}:
            return True
        part = isinstance(self.type_of(target.base), ir.TargetType) or isinstance(target.base, ir.Field)
        if self.arm is None or not part:
            return False
        reason = f"{target.name} is set in the program"
        if found.only is not None and not found.places:
            self.context.diagnostics.report(NOT_CONVERTED, statement.origin, reason=reason)
        elif self.says_turns(target):
            self.context.diagnostics.report(WITHOUT_TURNS, statement.origin, reason=reason)
        else:
            return False
        self.loose |= set(self.uses.roots(target.base, self.scope))
        return True

    def flag_values(self, flag: ir.Field) -> FlagValues:
        return self.flag_flow.values(flag.base, flag.name, self.scope)

    @property
    def flag_flow(self) -> FlagFlow:
        """What flags may be, followed through the program when first asked for."""
        if self.flags is None:
            names = {
                name for module in self.source.modules for name in registry.dialect(module.dialect).notation_fields
            }
            self.flags = FlagFlow.of_program(self.source, self.scopes, names, unchanged_in(self.source))
        return self.flags

    def says_turns(self, flag: ir.Field) -> bool:
        base = self.type_of(flag.base)
        notation = _notation(base.notation) if isinstance(base, ir.TargetType | ir.ConfigType) else None
        return self.arm is not None and notation is not None and only_turns(_any(self.arm), notation, flag.name)

    def copied(self, statement: ir.Assign, base: ir.Expression, value: ir.Expression) -> list[ir.Statement]:
        """One target's configuration to another's; it is copied flag by flag where targets have them side by side."""
        if not (isinstance(value, ir.Field) and value.name == "conf"):
            return [stopped(statement, FLAG_ACCESS, self.context, name="the configuration")]
        if not self.flat:
            return super().statement(statement)
        place, given = self.expression(base), self.expression(value.base)
        return [ir.Assign(ir.Field(place, name), ir.Field(given, name)) for name in self.fields]

    def is_flag(self, field: ir.Field) -> bool:
        base = self.type_of(field.base)
        notation = base.notation if isinstance(base, ir.TargetType | ir.ConfigType) else None
        return notation is not None and field.name in registry.dialect(notation).notation_fields

    @property
    def checked(self) -> bool:
        """Does the source's controller stop at flags that it cannot follow? (RAPID may be told not to.)"""
        name, nodes = _CHECKS[0], walk_for({"Assign"}, *self.source.modules)
        return not any(isinstance(one, ir.Assign) and one.target == ir.System(name) for one in nodes)

    @property
    def flat(self) -> bool:
        """Do the target's targets have their flags side by side with the position?"""
        angles = PlaceRule.QUATERNIONS not in self.context.capabilities.places.rules
        return angles if self.foreign else self.side_by_side

    @property
    def fields(self) -> tuple[str, ...]:
        return registry.dialect(self.target_notation).notation_fields

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Field(name=name) if self.foreign and self.is_flag(expression):
                known = self.flag_values(expression).only
                if known is not None:
                    return ir.IntLiteral(known, origin=expression.origin)
                return self.refused_reading(name, self.at(expression))
            case ir.Field(base=base, name=name) if self.other_arm and name in _AXES:
                if isinstance(self.type_of(base), ir.JointsType | ir.AxesType):
                    self.single_axis(self.at(expression))
            case ir.Aggregate():
                type = self.type_of(expression) if may_be_point(expression) else None
                if isinstance(type, ir.TargetType):
                    return self.target(expression, type)
                if isinstance(type, ir.JointsType) and self.other_arm:
                    return self.joints(expression)
        return super().expression(expression)

    def refused_reading(self, name: str, origin: Origin) -> ir.Expression:
        """A stop before the statement, one for all flags that it asks for; the report names each."""
        self.context.diagnostics.report(FLAG_ACCESS, origin, name=name)
        if not any(isinstance(one, ir.Opaque) and one.origin is origin for one in self.before):
            self.before.append(ir.Opaque(origin.text or name, origin=origin))
        return ir.IntLiteral(0)

    def single_axis(self, origin: Origin) -> None:
        """The angle of one axis, set or looked at, is another one on another arm; told once for each line."""
        assert self.to_arm is not None  # only with two arms
        line = (id(origin.source), origin.line)
        if origin.source is not None and line not in self.told:
            self.told.add(line)
            self.context.diagnostics.report(JOINTS_LOST, origin, arm=self.to_arm.name)

    # ---- written targets

    def target(self, expression: ir.Aggregate, type: ir.TargetType) -> ir.Expression:
        flags = set(registry.dialect(type.notation).notation_fields)
        given = self.named(expression, type)
        had = self.has_flags(type, given)
        self.side_by_side = not {"conf", "trans"} & set(given)
        entries = [(n, self.expression(v)) for n, v in given.items() if n not in flags and n != "conf"]
        word = type_word(replace(type, notation=self.target_notation))
        done = replace(expression, type_name=word)
        copied = given.get("conf")
        if isinstance(copied, ir.Field) and copied.name == "conf":
            return replace(done, entries=self.with_copy(entries, self.expression(copied.base)))
        key = id(expression)
        if key not in self.results:
            self.results[key] = self.converted(expression, had)
        found = self.results[key]
        if isinstance(found, _Refused):
            self.refused(found, expression, had)
            return replace(done, entries=tuple(entries) if self.flat else self.with_flags(entries, None))
        return replace(done, entries=self.with_flags(entries, found))

    def has_flags(self, type: ir.TargetType, given: dict[str, ir.Expression]) -> bool:
        return "conf" in given or not given.keys().isdisjoint(registry.dialect(type.notation).notation_fields)

    def named(self, expression: ir.Aggregate, type: ir.Type) -> dict[str, ir.Expression]:
        names = component_names(type, self.scope)
        return {
            written or (names[at] if at < len(names) else str(at)): value
            for at, (written, value) in enumerate(expression.entries)
        }

    def with_flags(
        self, entries: list[tuple[str, ir.Expression]], flags: dict[str, int] | None
    ) -> tuple[tuple[str | None, ir.Expression], ...]:
        """The entries with flags in their place: before the external axes. None: all zero."""
        names = tuple(name for name in self.fields if not self.flat or name in (flags or {}))
        made = [(name, ir.IntLiteral((flags or {}).get(name, 0))) for name in names]
        extra: list[tuple[str | None, ir.Expression]] = list(made)
        if not self.flat:
            word = type_word(ir.ConfigType(self.target_notation))
            extra = [("conf", ir.Aggregate(tuple(made), type_name=word))]
        return inserted(entries, extra)

    def with_copy(
        self, entries: list[tuple[str, ir.Expression]], base: ir.Expression
    ) -> tuple[tuple[str | None, ir.Expression], ...]:
        extra: list[tuple[str | None, ir.Expression]] = [("conf", ir.Field(base, "conf"))]
        if self.flat:
            extra = [(name, ir.Field(base, name)) for name in self.fields]
        return inserted(entries, extra)

    def refused(self, found: _Refused, expression: ir.Aggregate, had: bool) -> None:
        uses = self.uses.found.get(id(expression), set())
        if found.fatal and self.to_arm is not None:
            self.context.not_reached(self.at(expression), "target", found.reason)
        elif had and (any(use.joint for use in uses) or (not uses and is_taught(expression))):
            self.context.diagnostics.report(NOT_CONVERTED, self.at(expression), reason=found.reason)

    def converted(self, expression: ir.Aggregate, had: bool) -> dict[str, int] | _Refused:
        """The flags of the target's notation."""
        if self.arm is None or self.to_arm is None:
            return _Refused("no arm is named")
        value = constant(expression, self.scope, None)
        if not isinstance(value, Target):
            return _Refused("the target is computed")
        if had and not self.other_arm and value.type.notation == self.target_notation:
            return {name: flag for name, flag in value.flags if flag is not None}  # said for the target already
        uses = self.uses.found.get(id(expression), set())
        if not uses:
            return _Refused("no move uses it")
        if not (had or self.other_arm):
            return _Refused("it has none")
        self.unturned, self.changed = "", None
        flags: dict[str, int] | None = None
        refused: _Refused | None = None
        for use in sorted(uses, key=lambda one: (not one.joint, one.moved is not None, self.uses.order.get(one, 0))):
            found = self.for_use(value, use, had)
            if isinstance(found, _Refused):
                if found.fatal or (use.joint and use.moved is None):
                    return found
                refused = found
            elif flags is None:
                flags = found
            elif use.joint and found != flags and self.flat and not self.near:
                # What differs is left out: the controller then takes the shortest way.
                flags = {name: number for name, number in flags.items() if found.get(name) == number}
            elif use.joint and found != flags and use.moved is None:
                return _Refused("it is used with several tools or frames")
        if self.changed is not None:
            self.tell_changed("target", expression)
        if not had:
            return _Refused("it has none")
        if flags and self.unturned and any(use.joint for use in uses):
            self.context.diagnostics.report(WITHOUT_TURNS, self.at(expression), reason=self.unturned)
        return flags if flags else refused or _Refused("it is used with several tools or frames")

    def for_use(self, target: Target, use: Use, had: bool) -> dict[str, int] | _Refused:
        assert self.arm is not None and self.to_arm is not None  # `converted` checked
        place = moved(use.moved[0], target, list(use.moved[1])) if use.moved else target
        flange = use.frames.flange(place.pose) if isinstance(place, Target) else None
        if flange is None:
            which = "tool" if use.frames.tool is None else "frame"
            reason = f"the {which} of its moves is not constant"
            return (self.implied(target, reason) if had and use.moved is None else None) or _Refused(reason)
        notation = _notation(target.type.notation)
        if notation is None:
            return _Refused("the source language writes no configuration")
        flags = _flags_of(target, notation)
        if (had or self.other_arm) and (stretch := stretch_of_matrix(flange.matrix)) is not None:
            flanges = flanges_in_rows(stretch, flange.matrix)
            found = joints_in_rows(stretch, notation, self.arm, flanges, flags, use.joint, had)
            if self.other_arm:
                found = joints_on_other_arm(stretch, self.arm, self.to_arm, flanges, found, self.alone)
            return self.in_rows(stretch, all_there(stretch, self.to_arm, found))
        matrix = array(flange.matrix)
        known, reason = self.together.get(asked_for(notation, flange, flags, use.joint, had)), ""
        if known is not None:
            joints = known.joints
        else:
            selection = notation.select(_any(self.arm), matrix, flags, None if had else self.arm.home)
            joints, reason = selection.joints, selection.reason
        if joints is None and not use.joint:
            joints = self.arm.nearest(matrix, self.arm.home)
        wrong = joints is None and had and use.joint and use.moved is None and self.checked
        if wrong and self.arm.nearest(matrix, self.arm.home) is not None:  # there, but not with these flags
            return _Refused(reason, fatal=True)
        if self.other_arm:
            there = None if known is None else known.there
            joints = self.on_other_arm(matrix, joints) if there is None else there
            if joints is None:
                return _Refused(self.why_not(matrix), fatal=True)
        if joints is None:
            return _Refused(reason)
        if self.near:
            return {name: round(round(float(value), 6)) for name, value in zip(_AXES, joints, strict=False)}
        wanted = _notation(self.target_notation)
        return wanted.encode(_any(self.to_arm), joints) if wanted is not None else {}

    def in_rows(self, stretch: Stretch, joints: Iterator[Any]) -> dict[str, int]:
        """As the end of `for_use`, for the joints of all rows of a stretch."""
        if self.near:
            return degrees_in_rows(stretch, _AXES, joints)
        wanted = _notation(self.target_notation)
        return flags_in_rows(stretch, wanted, self.to_arm, joints) if wanted is not None else {}

    def implied(self, target: Target, reason: str) -> dict[str, int]:
        """What the source's flags say wherever the place is; empty where the target's hang on it altogether."""
        notation, wanted = _notation(target.type.notation), _notation(self.target_notation)
        if self.arm is None or notation is None or wanted is None or self.near or self.other_arm or not self.flat:
            return {}
        flags = {name: value for name, value in target.flags if name in notation.fields and value is not None}
        found = implied_flags(_any(self.arm), notation, flags, wanted, self.implications) if flags else {}
        if found and set(found) != set(wanted.fields):
            self.unturned = reason
        return found

    # ---- another arm

    def on_other_arm(self, flange: Any, joints: Any) -> Any:
        """The other arm's joints for the same flange pose: the posture with the most equal names, in the turns that the
        axes have on the arm it was written for, else minimal ones."""
        assert self.arm is not None and self.to_arm is not None  # only with two arms
        arm = self.to_arm
        posture = None if joints is None else self.arm.posture(joints).branch
        near = arm.home if joints is None else self.arm.same_posture(array(joints), arm)
        best, rank = None, (9, 0.0)
        for solution in arm.inverse(flange, near):
            # whole turns leave the posture as it is
            apart = 0 if posture is None else differing(posture, arm.posture(solution.joints).branch)
            for choice in arm.expand_turns(solution):
                # of two ways that are equal but for rounding the first one counts
                travel = round(float(abs(choice - near).sum()), 6)
                if (apart, travel) < rank:
                    best, rank = choice, (apart, travel)
        if rank[0] and best is not None and joints is not None:
            self.changed = changed_posture(self.arm, array(joints), arm, best) or self.changed
        return best

    def alone(self, flange: Any, joints: Any) -> tuple[Any, bool]:
        """`on_other_arm` for one of many flange poses, and whether the posture is another one."""
        self.changed = None
        found = self.on_other_arm(flange, joints)
        changed, self.changed = self.changed is not None, None
        return found, changed

    def tell_changed(self, what: str, expression: ir.Expression) -> None:
        assert self.to_arm is not None and self.changed is not None  # only where it was changed for another arm
        words = {"arm": self.to_arm.name, "what": what, "before": self.changed[0], "after": self.changed[1]}
        self.context.diagnostics.report(POSTURE_CHANGED, self.at(expression), **words)

    def why_not(self, flange: Any) -> str:
        assert self.to_arm is not None  # only with two arms
        found = self.to_arm.inverse(flange, self.to_arm.home)
        return "every posture exceeds a joint limit" if found else "it is out of reach"

    def joints(self, expression: ir.Aggregate) -> ir.Expression:
        assert self.arm is not None and self.to_arm is not None  # only with two arms
        value = constant(expression, self.scope, None)
        given = joint_values(value) if isinstance(value, Record) else None
        if given is None or len(given) != self.arm.axes or self.to_arm.axes > len(_AXES):
            self.context.diagnostics.report(JOINTS_LOST, self.at(expression), arm=self.to_arm.name)
            return super().expression(expression)
        flange = self.arm.forward(array(given))
        self.changed = None
        found = self.on_other_arm(flange, array(given))
        if self.changed is not None and found is not None:
            self.tell_changed("joint position", expression)
        if found is None:
            self.context.not_reached(self.at(expression), "joint position", self.why_not(flange))
            return super().expression(expression)
        new = {name: real(float(value)) for name, value in zip(_AXES, found, strict=False)}
        return with_joints(expression, new, self.named(expression, ir.JointsType()))


def _flags_of(target: Target, notation: Notation) -> dict[str, int]:
    return {name: value for name, value in target.flags if name in notation.fields}


def _notation(name: str) -> Notation | None:
    make = registry.dialect(name).notation
    return make() if make is not None else None


def _any(arm: Arm) -> Any:
    """A notation is written against the emulator's own model, which every arm is."""
    return arm
