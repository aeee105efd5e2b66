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


PASSED = """def job():
  DOOR = 0
  LAMP = 2
  def expect(number):
    if get_standard_digital_in(number):
      textmsg("come")
    end
  end
  def shine(number, seconds):
    set_standard_digital_out(number, True)
    sleep(seconds)
  end
  shine(LAMP, 0.2)
  shine(LAMP, 0.4)
  expect(DOOR)
  {more}
end
"""


@pytest.mark.parametrize("more", ["", "shine(3, 0.1)", "set_standard_digital_out(LAMP, False)"])
def test_a_parameter_that_says_the_number_of_a_signal_is_a_signal(more: str) -> None:
    """No routine over all signals in reach; constants that are no variables are passed as well."""
    journey = there_and_back({"job.script": PASSED.format(more=more)}, "urscript", "rapid")
    assert "VAR signaldi number" in journey.text and "VAR signaldo number" in journey.text
    assert "expect DOOR;" in journey.text and "shine LAMP,0.2;" in journey.text
    assert "rpl_" not in journey.text
    assert journey.prove("job").equal


@pytest.mark.parametrize("more", ["n = 2\n  shine(n + 1, 0.1)\n  n = 3", "textmsg(to_str(LAMP))\n  shine(LAMP, 0.1)"])
def test_a_number_that_is_worked_out_stays_one(more: str) -> None:
    journey = there_and_back({"job.script": PASSED.format(more=more)}, "urscript", "rapid")
    assert ("VAR signaldo number" in journey.text) == ("n = 2" not in more)
    assert journey.prove("job").equal


def test_signals_are_passed_in_val3_too() -> None:
    journey = there_and_back({"job.script": PASSED.format(more="")}, "urscript", "val3")
    assert 'name="number" type="dio"' in journey.text
    assert "call expect(DOOR)" in journey.text and "call shine(LAMP,0.2)" in journey.text
    assert journey.prove("job").equal
