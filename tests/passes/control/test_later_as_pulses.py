"""An output that changes later, for targets that only have pulses: it is a pulse with the opposite level, which does
nothing where the output has its level already, though another statement is about to take that away."""

import pytest

from tests.there_and_back import there_and_back

TWICE = "SetDO\\SDelay:=0.5,do1,1;\nWaitTime 0.2;\nSetDO\\SDelay:=0.5,do1,0;"
BACK = "SetDO do1,1;\nSetDO\\SDelay:=0.5,do1,1;\nWaitTime 0.2;\nSetDO do1,0;"
ALONE = "SetDO do2,1;\nSetDO\\SDelay:=0.5,do1,1;"


def _found(body: str, target: str) -> list[str]:
    text = f"MODULE m\nPROC main()\n{body}\nWaitTime 1;\nENDPROC\nENDMODULE\n"
    return [item.code.name for item in there_and_back({"m.mod": text}, "rapid", target).found]


@pytest.mark.parametrize("target", ["krl", "tp", "inform"])
@pytest.mark.parametrize("body", [TWICE, BACK], ids=["twice", "back"])
def test_other_statements_that_switch_it_are_said(body: str, target: str) -> None:
    assert "later-as-pulse" in _found(body, target)


@pytest.mark.parametrize("target", ["krl", "tp", "inform"])
def test_an_output_of_one_statement_is_plain(target: str) -> None:
    assert "later-as-pulse" not in _found(ALONE, target)
