"""The emission ledger misses nothing and forgives nothing."""

import pytest

from rpl import ir
from rpl.errors import InternalError
from rpl.writing.ledger import EmissionLedger, inside

ON = ir.Assign(ir.Signal("digital_out", ir.IntLiteral(1)), ir.BoolLiteral(True))
OFF = ir.Assign(ir.Signal("digital_out", ir.IntLiteral(1)), ir.BoolLiteral(False))
TRIGGER = ir.Trigger("end", OFF)
MOVE = ir.Move("linear", ir.Name("p"), triggers=(TRIGGER,))
HALT = ir.Halt()
INNER = ir.If(((ir.BoolLiteral(True), (ON,)),), (MOVE,))
SWITCH = ir.Switch(ir.Name("i"), (ir.Case((ir.IntLiteral(1),), (INNER,)),), (HALT,))
LOOP = ir.Loop((SWITCH,))
VARIABLE = ir.Variable("i", ir.IntType())
WAIT = ir.Wait(ir.IntLiteral(1))
ROUTINE = ir.Routine("main", declarations=(VARIABLE,), body=(LOOP,), handlers=(ir.Handler((), (WAIT,)),))
MODULE = ir.Module("m", "rpl", routines=(ROUTINE,))
PROGRAM = ir.Program((MODULE,))
ALL = list(inside(MODULE))


def test_every_place_of_a_program_counts() -> None:
    kinds = [node.__class__.__name__ for node in ALL]
    assert kinds == [
        "Module",
        "Routine",
        "Variable",
        "Loop",
        "Switch",
        "If",
        "Assign",
        "Move",
        "Trigger",
        "Halt",
        "Wait",
    ]


@pytest.mark.parametrize("missing", range(len(ALL)))
def test_one_unwritten_node_is_found(missing: int) -> None:
    ledger = EmissionLedger()
    for node in ALL:
        if node is not ALL[missing]:
            ledger.written(node)
    assert ledger.missed(PROGRAM) == [ALL[missing]]
    with pytest.raises(InternalError, match=ALL[missing].__class__.__name__):
        ledger.check(PROGRAM)


def test_reported_and_merged_cover_what_is_below() -> None:
    ledger = EmissionLedger()
    for node in (MODULE, ROUTINE, VARIABLE, WAIT):
        ledger.written(node)
    ledger.reported(LOOP)
    ledger.check(PROGRAM)
    assert ledger.ways == {"written": 4, "reported": 7}


def test_a_node_at_two_places_is_written_twice() -> None:
    program = ir.Program((ir.Module("m", "rpl", routines=(ir.Routine("r", body=(HALT, HALT)),)),))
    ledger = EmissionLedger()
    ledger.written(program.modules[0])
    ledger.written(program.modules[0].routines[0])
    ledger.written(HALT)
    assert ledger.missed(program) == [HALT]


def test_an_equal_node_is_not_the_same_node() -> None:
    program = ir.Program((ir.Module("m", "rpl"),))
    ledger = EmissionLedger()
    ledger.written(ir.Module("m", "rpl"))
    with pytest.raises(InternalError, match="Module m"):
        ledger.check(program)
