"""The load that a KRL program drives with (`$LOAD`, `LOAD_DATA`) does not vanish in another language unsaid."""

from __future__ import annotations

import pytest
from there_and_back import Journey, there_and_back

ROBOT = "kuka_kr6r900_2"
PROGRAM = """DEF main()
  BAS(#INITMOV,0)
  $TOOL={{X 0,Y 0,Z 150,A 0,B 0,C 0}}
  $BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}
  {load}
  PTP {{A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}}
  PTP {{A1 5,A2 -90,A3 90,A4 0,A5 90,A6 0}}
END
"""
WHOLE = "$LOAD={M 2,CM {X 0,Y 10,Z 50,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}"
OTHERS = ["urscript", "rapid", "tp", "vplus", "inform"]


def journey(load: str, target: str) -> Journey:
    return there_and_back({"main.src": PROGRAM.format(load=load)}, "krl", target, ROBOT)


@pytest.mark.parametrize("target", OTHERS)
@pytest.mark.parametrize("load", ["$LOAD.M=2", WHOLE])
def test_the_load_is_named_with_its_mass(load: str, target: str) -> None:
    said = [item.as_text() for item in journey(load, target).found if item.code.name == "load-left-out"]
    assert len(said) == 1
    assert "$LOAD" in said[0] and "2 kg" in said[0] and "main.src:5" in said[0]


@pytest.mark.parametrize("target", OTHERS)
def test_loads_of_tools_are_named(target: str) -> None:
    load = WHOLE.replace("$LOAD", "LOAD_DATA[3]").replace("M 2", "M 4.5")
    said = [item.as_text() for item in journey(load, target).found if item.code.name == "load-left-out"]
    assert len(said) == 1
    assert "LOAD_DATA" in said[0] and "4.5 kg" in said[0]
