"""Variables that only say the number of a signal: the signal has their name where signals have names."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

HEAD = "def job():\n  DOOR = 0\n  LAMP = 2\n"
CASES = {
    "said and asked": ("  set_standard_digital_out(LAMP, get_standard_digital_in(DOOR))", {"DOOR", "LAMP"}),
    "the number is shown as well": ('  set_standard_digital_out(LAMP, True)\n  textmsg("lamp", LAMP)', set()),
    "set once more": ("  LAMP = 3\n  set_standard_digital_out(LAMP, True)", set()),
    "the number of two signals": (
        "  set_standard_digital_out(LAMP, True)\n  set_standard_digital_out(LAMP + 1, True)",
        set(),
    ),
}


@pytest.mark.parametrize("target", ["krl", "rapid"])
@pytest.mark.parametrize("case", CASES)
def test_the_name_is_that_of_the_signal(case: str, target: str) -> None:
    """In its own words where it says nothing else; the run is the same either way."""
    body, names = CASES[case]
    journey = there_and_back({"job.script": f"{HEAD}{body}\nend\n"}, "urscript", target)
    said = {name for name in ("DOOR", "LAMP") if f"SIGNAL {name} " in journey.text or f"SetDO {name}" in journey.text}
    assert said == names - ({"DOOR"} if target == "rapid" else set())


@pytest.mark.parametrize("target", ["krl", "rapid"])
def test_a_number_that_is_set_in_the_run_is_a_name_as_well(target: str) -> None:
    """V+ has no declarations: the first routine sets the numbers."""
    text = ".PROGRAM job()\n lamp.on = 3\n CALL shine()\n.END\n.PROGRAM shine()\n SIGNAL lamp.on\n.END\n"
    journey = there_and_back({"job.v2": text}, "vplus", target)
    assert "lamp_on:=" not in journey.text and "lamp_on=3" not in journey.text
    assert journey.prove("job").equal
