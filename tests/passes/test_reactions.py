"""Interrupts with an identity of their own, for targets where the priority says which one it is."""

from __future__ import annotations

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.interrupts.reactions import reactions

DOOR = ir.Signal("digital_in", ir.IntLiteral(1))
ACT = ir.CallRoutine("act")


def declared(identity: int, priority: int, once: bool = False, stops: bool = False) -> ir.DeclareInterrupt:
    return ir.DeclareInterrupt(
        ir.IntLiteral(priority), DOOR, ACT, identity=ir.IntLiteral(identity), once=once, stops=stops
    )


def rewritten(*body: ir.Statement, target: str = "krl") -> tuple[ir.Program, Diagnostics]:
    diagnostics = Diagnostics()
    routines = (ir.Routine("main", body=tuple(body)), ir.Routine("act"))
    context = Context("vplus", target, registry.target(target).capabilities(), diagnostics)
    return reactions(ir.Program((ir.Module("m", "vplus", (), routines),)), context), diagnostics


def priorities(program: ir.Program) -> list[object]:
    return [one.priority for one in walk(program) if isinstance(one, ir.DeclareInterrupt)]


def test_priorities_keep_their_order_and_are_handles() -> None:
    done, _ = rewritten(declared(1002, 123), declared(1001, 78), ir.ControlInterrupt("on", ir.IntLiteral(1001)))
    assert priorities(done) == [ir.IntLiteral(11), ir.IntLiteral(10)]
    (control,) = [one for one in walk(done) if isinstance(one, ir.ControlInterrupt)]
    assert control == ir.ControlInterrupt("on", ir.IntLiteral(10))


def test_deleting_is_switching_off() -> None:
    done, _ = rewritten(declared(7, 3), ir.ControlInterrupt("delete", ir.IntLiteral(7)))
    assert [one.op for one in walk(done) if isinstance(one, ir.ControlInterrupt)] == ["off"]


@pytest.mark.parametrize(("once", "stops"), [(True, False), (False, True), (True, True)])
def test_a_routine_around_the_action(once: bool, stops: bool) -> None:
    done, diagnostics = rewritten(declared(7, 3, once, stops))
    (around,) = [one for one in walk(done) if isinstance(one, ir.Routine) and one.name == "rpl_reaction"]
    wanted: list[ir.Statement] = []
    if once:
        wanted.append(ir.ControlInterrupt("off", ir.IntLiteral(10)))
    if stops:
        wanted.append(ir.StopMotion(hard=True))
    wanted.append(ACT)
    if stops:
        wanted.append(ir.ResumeLevel())
    assert list(around.body) == wanted
    assert [item.code.name for item in diagnostics] == (["reaction-drops-motion"] if stops else [])


def test_plain_interrupts_stay() -> None:
    plain = ir.DeclareInterrupt(ir.IntLiteral(5), DOOR, ACT)
    done, _ = rewritten(plain)
    assert [one for one in walk(done) if isinstance(one, ir.DeclareInterrupt)] == [plain]
