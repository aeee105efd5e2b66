"""Which move may come behind which: in the order of the program, whatever numbers the moves have in memory."""

from rpl import ir
from rpl.passes.legalise.facts.motion.moveorder import BEFORE, STANDS, UNKNOWN, _Rows


def test_moves_come_in_the_order_of_the_program() -> None:
    here = ir.Move("linear", ir.Name("p"))
    for first, second in ((900, 5), (5, 900)):
        rows = _Rows(moves={first: here, second: here})
        states = {first, -first, second, -second, STANDS, BEFORE, UNKNOWN}
        found = rows.in_order(states)
        assert found[3:] == [first, -first, second, -second]
        assert found[:3] == [STANDS, BEFORE, UNKNOWN]
