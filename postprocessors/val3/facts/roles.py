"""What the data of poses are for in movements, and the routine that an application begins with."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.kinds import walk_for

from ..expressions import NULL, root_of


def roles_of(program: ir.Program) -> dict[str, str]:
    """Variables of poses that are tools or frames of movements."""
    found: dict[str, str] = {}
    for node in walk_for({"Move", "Builtin"}, *program.modules):
        pairs: list[tuple[ir.Expression | None, str]] = []
        match node:
            case ir.Move(tool=tool, frame=frame):
                pairs = [(tool, "tool"), (frame, "frame")]
            case ir.Builtin(function="current_target", arguments=(tool, frame)):
                pairs = [(tool, "tool"), (frame, "frame")]
            case ir.Builtin(function="joints_to_target", arguments=(_, tool, frame)):
                pairs = [(tool, "tool"), (frame, "frame")]
        for value, role in pairs:
            if isinstance(value, ir.Name | ir.Index) and found.setdefault(root_of(value), role) != role:
                found[root_of(value)] = "tool"
    return found


def fathers_of(program: ir.Program, roles: dict[str, str]) -> dict[str, str]:
    """Points of the application's data that all movements use in one frame; they hang on it."""
    used: dict[str, set[str]] = {}
    for node in walk_for({"Move", "CallRoutine", "TaskControl"}, *program.modules):
        match node:
            case ir.Move(target=target, via=via, frame=frame):
                father = "world" if frame is None or frame == NULL else _named_frame(frame, roles)
                for point in (target, via):
                    if point is not None:
                        used.setdefault(_point(point), set()).add(father)
            case ir.CallRoutine(arguments=arguments) | ir.TaskControl(arguments=arguments):
                for argument in arguments:
                    if argument.value is not None:
                        used.setdefault(_point(argument.value), set()).add("world")
    data = {d.name for m in program.modules for d in m.declarations if isinstance(d, ir.Variable)}
    single = {name: next(iter(frames)) for name, frames in used.items() if len(frames) == 1 and name in data}
    return {name: father for name, father in single.items() if father not in ("", "world")}


def _named_frame(frame: ir.Expression, roles: dict[str, str]) -> str:
    """The frame as data name it; empty for one without a name of its own."""
    match frame:
        case ir.Name(id=name) if roles.get(name) == "frame":
            return name
        case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at),)) if roles.get(name) == "frame":
            return f"{name}[{at}]"
    return ""


def _point(value: ir.Expression) -> str:
    match value:
        case ir.Builtin(function="offset" | "tool_offset" | "displaced" | "displaced_in_tool", arguments=(first, *_)):
            return _point(first)
    return root_of(value)


def entry_of(program: ir.Program) -> str:
    """The routine that the application begins with: the one that is named, else the first that nobody calls."""
    if program.entry:
        return program.entry
    routines = [routine.name for module in program.modules for routine in module.routines]
    called = {node.name for node in walk_for({"CallRoutine"}, *program.modules) if isinstance(node, ir.CallRoutine)}
    started = {node.task for node in walk_for({"TaskControl"}, *program.modules) if isinstance(node, ir.TaskControl)}
    started |= {task.entry for task in program.tasks if task.kind == "background"}
    free = [name for name in routines if name not in called | started]
    return next((name for name in free if name.lower() == "main"), free[0] if free else "")
