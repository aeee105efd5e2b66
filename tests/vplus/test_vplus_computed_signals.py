"""Signals whose numbers are sums of what the project knows: of one kind, or of the kinds that are possible."""

from __future__ import annotations

import pytest

from rpl.cell import Cell, Input
from tests.there_and_back import there_and_back

PROGRAM = """.PROGRAM main()
 AUTO w
 SIGNAL -130
 WAIT SIG(-1030)
 FOR w = 0 TO 1
 CALL grip(w)
 END
.END
.PROGRAM grip(which)
 AUTO valve, sensor
 valve = 101+10*which
 sensor = 1002+10*which
 SIGNAL valve, -(valve+1)
 WAIT SIG(sensor)
 WAIT SIG(-(1003+10*which))
 SIGNAL -valve, which+1
.END
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"])
def test_a_valve_and_its_sensor(target: str) -> None:
    journey = there_and_back({"main.v2": PROGRAM}, "vplus", target)
    assert not journey.losses
    result = journey.run(cell=Cell(inputs=(Input(0.5, "1002", True), Input(1.0, "1012", True))))
    assert result.status == "finished", result.fault
    assert journey.switched_on(result) == {101, 111, 1, 2}
    if target == "vplus":
        assert "SIGNAL valve" in journey.text


@pytest.mark.parametrize("step", ["valve = valve*2", "valve = 100+TIMER(1)", "READ (5) valve"])
def test_what_can_be_anything_is_asked_by_size(step: str) -> None:
    text = f".PROGRAM main()\n AUTO valve\n valve = 101\n {step}\n SIGNAL valve\n.END\n"
    assert "ABS(valve) <= 999" in there_and_back({"main.v2": text}, "vplus", "vplus").text
