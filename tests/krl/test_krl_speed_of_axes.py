"""One speed for all axes is set by the basis package, as people write it; it is read as the six settings it makes."""

from __future__ import annotations

import pytest
from there_and_back import there_and_back

HEAD = "DEF M( )\nDECL REAL V\n"


def _six(name: str, *values: str) -> str:
    given = values * 6 if len(values) == 1 else values
    return "\n".join(f"{name}[{n}]={value}" for n, value in enumerate(given, 1))


CASES = [
    (_six("$VEL_AXIS", "30"), ["BAS(#VEL_PTP,30)"]),
    (_six("$VEL_AXIS", "12.5"), ["BAS(#VEL_PTP,12.5)"]),
    (f"V=20\n{_six('$VEL_AXIS', 'V')}\nV=30", ["BAS(#VEL_PTP,V)"]),
    (_six("$VEL_AXIS", "30", "30", "30", "30", "30", "40"), ["$VEL_AXIS[1]=30", "$VEL_AXIS[6]=40"]),
    (_six("$ACC_AXIS", "30"), ["$ACC_AXIS[1]=30", "$ACC_AXIS[6]=30"]),
]


@pytest.mark.parametrize(("steps", "lines"), CASES)
def test_what_is_written_sets_the_same(steps: str, lines: list[str]) -> None:
    asked = "\n".join(f"$OUT[{n}]=$VEL_AXIS[{n}]<{n + 30}" for n in range(1, 7))
    text = f"{HEAD}{steps}\nPTP {{A1 10,A2 -90,A3 90,A4 0,A5 10,A6 0}}\n{asked}\nEND\n"
    journey = there_and_back({"m.src": text}, "krl", "krl", "kuka_kr6r900sixx")
    written = [line.strip() for line in journey.text.splitlines()]
    assert all(line in written for line in lines), journey.text
    assert ("BAS(" in journey.text) == lines[0].startswith("BAS")
    proof = journey.prove("M")
    assert proof.agrees, proof.difference
