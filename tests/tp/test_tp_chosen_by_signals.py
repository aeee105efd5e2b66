"""SELECT looks at a register: what decides is read into one first where it is a group of signals."""

from __future__ import annotations

from tp_translating_helpers import same_in_tp

CHOICE = """PROCEDURE main()
SWITCH gi[1]
CASE 1
SET do[1] TO ON
CASE 2
SET do[2] TO ON
DEFAULT
SET do[3] TO ON
END SWITCH
END PROCEDURE
"""


def test_a_choice_by_a_group_of_signals() -> None:
    shown, _ = same_in_tp("rpl", CHOICE)
    assert ":  R[1:step]=GI[1] ;" in shown["MAIN.LS"]
    assert ":  SELECT R[1:step]=1,JMP LBL" in shown["MAIN.LS"]
