"""Whether moves are joined (`blending`, V+ CPON and CPOFF) at the moves themselves, for targets without such a switch:
where a program only ever sets it to what the source's controller starts with, or to one value before all its moves, or
to something else for one move, every move that says nothing is as that value says. Where a program changes it on its
way, each move is as the value that it finds, as far as that is the same on every way to it (`modalflow`).

Where a move finds either, a variable of the program keeps what is set, and the move stands there in both forms. Only
where actions at the way or a search belong to such a move the switch stays, and later passes name what becomes of it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.facts.usage import called_names
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising

_JOINED = ir.System("blending")


@legalising(unless=lambda context: "blending" in context.capabilities.system_variables, sees=("system blending",))
def joined_moves(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the switch, and where moves that say nothing find it at one value."""
    start = rules_of(context.source).system_defaults.get("blending")
    if not isinstance(start, bool):
        return program
    start = _first_of_all(program, start)
    settings = [
        (node, value)
        for node in walk_for({"Assign", "SetForNextMove", "Move"}, *program.modules)
        for setting, value in _settings(node)
        if setting == _JOINED
    ]
    usual = ir.BoolLiteral(start)
    if not settings or any(not isinstance(value, ir.BoolLiteral) for _, value in settings):
        return program
    found = _found(program, context, start)
    if found is None:
        return program
    open_ones = frozenset(key for key, value in found.items() if value is None)
    if open_ones and not _alone(program, open_ones):
        return program
    kept_in = ir.Name(context.fresh("moves_joined")) if open_ones else None

    def change(statement: ir.Statement) -> ir.Body:
        if any(setting == _JOINED for setting, _ in _settings(statement)) and not isinstance(statement, ir.Move):
            if kept_in is not None and isinstance(statement, ir.Assign):
                return (replace(statement, target=kept_in),)
            return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
        if kept_in is not None and id(statement) in open_ones and isinstance(statement, ir.Move):
            return (_either(statement, kept_in),)
        return (inside(statement, lambda body: map_body(body, change)),)

    def moved(node: object) -> object:
        if not isinstance(node, ir.Move):
            return node
        kept = tuple(pair for pair in node.settings if pair[0] != _JOINED)
        own = next((value for setting, value in node.settings if setting == _JOINED), None)
        joined = (own or found.get(id(node), usual)) == ir.BoolLiteral(True)
        blend: ir.Blend = ir.BlendSpeed(ir.IntLiteral(100)) if joined else ir.BlendStop()
        return replace(node, settings=kept, blend=blend if node.blend is None else node.blend)

    changed = edit_all(program, lambda body: map_body(body, change))
    done = replace(program, modules=tuple(rewrite(module, moved) for module in changed.modules))
    if kept_in is None:
        return done
    data = ir.Variable(kept_in.id, ir.BoolType(), usual, scope="global")
    return with_support(done, context, (data,), (), program.modules[0].task)


def _either(move: ir.Move, joined: ir.Name) -> ir.If:
    """The move as the variable says."""
    plain = replace(move, origin=replace(move.origin, comments=()))
    through = replace(plain, blend=ir.BlendSpeed(ir.IntLiteral(100)))
    return ir.If(((joined, (through,)),), (replace(plain, blend=ir.BlendStop()),), origin=move.origin)


def _alone(program: ir.Program, moves: frozenset[int]) -> bool:
    """Are these moves without a search, and without actions at their way in front of them?"""

    def holds(body: ir.Body) -> bool:
        for at, one in enumerate(body):
            if id(one) in moves and isinstance(one, ir.Move):
                if one.search is not None or (at and isinstance(body[at - 1], ir.Trigger | ir.SetForNextMove)):
                    return False
            elif not all(map(holds, blocks(one))):
                return False
        return True

    return all(holds(body) for module in program.modules for one in module.routines for body in bodies(one))


def _found(program: ir.Program, context: Context, start: bool) -> dict[int, ir.Expression | None] | None:
    """What the moves that say nothing find, by their identity (None: either): nothing where that is what the program
    starts with throughout. None for all where one is set for the next move, whichever that is."""
    nodes = (node for node in walk_for({"Assign", "SetForNextMove"}, *program.modules) if not isinstance(node, ir.Move))
    changes = [(node, value) for node in nodes for name, value in _settings(node) if name == _JOINED]
    if all(value == ir.BoolLiteral(start) for _, value in changes):
        return {}
    if any(isinstance(node, ir.SetForNextMove) for node, _ in changes):
        return None
    flow = SettingsInForce.begun_by(program, context.source)
    found: dict[int, ir.Expression | None] = {}
    for move in (one for one in walk_for({"Move"}, *program.modules) if isinstance(one, ir.Move)):
        if id(move) not in flow.moves or move.blend is not None or any(name == _JOINED for name, _ in move.settings):
            continue
        found[id(move)] = flow.at(move)["blending"]
    return found


def _first_of_all(program: ir.Program, start: bool) -> bool:
    """The value that the program sets at its very beginning, once and for all; else the controller's."""
    found = [
        node
        for node in walk_for({"Assign"}, *program.modules)
        if isinstance(node, ir.Assign) and node.target == _JOINED
    ]
    if len(found) != 1 or not isinstance(found[0].value, ir.BoolLiteral):
        return start
    routines = [routine for module in program.modules for routine in module.routines]
    called = called_names(routines)
    alone = [one for one in routines if one.name.lower() not in called and _drives(one)]
    first = [one for one in routines if any(node is found[0] for node in one.body)]
    if len(first) != 1 or first[0].name.lower() in called or any(one is not first[0] for one in alone):
        return start
    before = first[0].body[: next(at for at, node in enumerate(first[0].body) if node is found[0])]
    quiet = not any(blocks(one) or isinstance(one, ir.CallRoutine | ir.Label) or _drives(one) for one in before)
    return found[0].value.value if quiet else start


def _drives(node: object) -> bool:
    return any(isinstance(one, ir.Move) for one in walk(node))


def _settings(node: object) -> tuple[tuple[ir.Expression, ir.Expression], ...]:
    match node:
        case ir.Assign(target=ir.System() as setting, value=value):
            return ((setting, value),)
        case ir.SetForNextMove(setting=setting, value=value):
            return ((setting, value),)
        case ir.Move(settings=settings):
            return settings
    return ()


__all__ = ["joined_moves"]
