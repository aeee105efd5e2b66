"""Points and the frames they were recorded with: the controller stops at a point whose UF or UT is not the active one.

The active numbers are followed through the statements of a program as far as they are known: set by a constant, lost at
a label or a call.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Diagnostics

from .dumps import Dump
from .motion import OTHER_FRAME
from .positions import Position
from .registers import Facts

Active = dict[str, int | None]
_BANKS = ("UFRAME", "UTOOL")


def check_frames(
    modules: list[ir.Module], positions: dict[int, Position], facts: Facts, dump: Dump, diagnostics: Diagnostics
) -> None:
    """Report each point that is used while another frame or tool is certainly active."""
    reported: set[tuple[str, int]] = set()
    for module in modules:
        for routine in module.routines[:1]:
            start: Active = {
                bank: dump.active.get(f"{bank}_NUM") if bank not in facts.numbers_set else None for bank in _BANKS
            }
            _Walk(positions, diagnostics, reported).body(routine.body, start)


class _Walk:
    def __init__(
        self, positions: dict[int, Position], diagnostics: Diagnostics, reported: set[tuple[str, int]]
    ) -> None:
        self.positions, self.diagnostics, self.reported = positions, diagnostics, reported
        # What a loop, by identity, entered with these numbers ends with: loops in loops are followed once each.
        self.loops: dict[tuple[int, tuple[int | None, ...]], Active] = {}

    def body(self, body: ir.Body, active: Active) -> Active:
        for statement in body:
            active = self.statement(statement, active)
        return active

    def statement(self, statement: ir.Statement, active: Active) -> Active:
        match statement:
            case ir.Assign(target=ir.Name(id="UFRAME_NUM" | "UTOOL_NUM" as name), value=value):
                known = value.value if isinstance(value, ir.IntLiteral) else None
                return {**active, name.removesuffix("_NUM"): known}
            case ir.Label() | ir.CallRoutine():
                return dict.fromkeys(_BANKS)
            case ir.Move(target=target, via=via):
                for point in (target, via):
                    self.point(point, active, statement)
            case ir.If(branches=branches, otherwise=otherwise):
                ends = [self.body(body, active) for _, body in branches]
                return _common([*ends, self.body(otherwise, active)])
            case ir.Switch(cases=cases, default=default):
                ends = [self.body(case.body, active) for case in cases]
                return _common([*ends, self.body(default or (), active)])
            case ir.For(body=body) | ir.While(body=body):
                key = id(statement), tuple(active[bank] for bank in _BANKS)
                if key not in self.loops:
                    inside = _common([active, self.body(body, dict.fromkeys(_BANKS))])
                    self.body(body, inside)
                    self.loops[key] = inside
                return self.loops[key]
        return active

    def point(self, point: ir.Expression | None, active: Active, move: ir.Move) -> None:
        if not isinstance(point, ir.Name) or not point.id[1:].isdigit() or point.id[0] != "P":
            return
        number = int(point.id[1:])
        position = self.positions.get(number)
        arm = position.groups.get(1) if position is not None else None
        if arm is None:
            return
        for bank, recorded in (("UFRAME", arm.frame), ("UTOOL", arm.tool)):
            if arm.kind == "j" and bank == "UFRAME":
                continue  # a joint position is refused for its tool only (INTP-253, measured on a virtual controller)
            now = active[bank]
            if recorded is None or now is None or now == recorded or (bank, number) in self.reported:
                continue
            self.reported.add((bank, number))
            self.diagnostics.report(
                OTHER_FRAME, move.origin, number=number, name=f"{bank}_NUM", recorded=recorded, active=now
            )


def _common(ends: list[Active]) -> Active:
    """What is certain whichever way was taken."""
    return {bank: ends[0][bank] if all(end[bank] == ends[0][bank] for end in ends) else None for bank in _BANKS}
