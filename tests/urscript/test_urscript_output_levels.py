"""get_standard_analog_out tells volts or amperes of an output that is set as a share of its range."""

from __future__ import annotations

import pytest
from test_urscript_tasks_elsewhere import translated
from urscript_helpers import codes, read, run

# What the program says of its outputs, what it sets, and what it reads.
CASES = [
    ("set_analog_outputdomain(0, 1)", "set_standard_analog_out(0, 0.42)", "get_standard_analog_out(0)", 4.2),
    ("set_analog_outputdomain(1, 0)", "set_standard_analog_out(1, 0.5)", "get_standard_analog_out(1)", 0.012),
    ("set_analog_outputdomain(0, 1)", "set_analog_out(0, 1.0)", "get_analog_out(0)", 10.0),
    ("set_analog_outputdomain(0, 1)", "sync()", "get_standard_analog_out(0)", 0.0),
    ("set_analog_outputdomain(0, 0)", "sync()", "get_standard_analog_out(0)", 0.004),
    (
        "set_analog_outputdomain(0, 1)\n  set_analog_outputdomain(1, 0)",
        "set_analog_out(1, 1)",
        "get_analog_out(1)",
        0.02,
    ),
    ("set_analog_outputdomain(0, 1)", "i = 0\n  set_analog_out(0, 0.3)", "get_standard_analog_out(0 * i)", 3.0),
]
PROGRAM = """def main():
  {says}
  {sets}
  if norm({reads} - {wanted}) < 0.00001 and {reads} < 100:
    set_standard_digital_out(0, True)
  end
end
"""


@pytest.mark.parametrize(("says", "sets", "reads", "wanted"), CASES)
def test_the_level_of_an_output(says: str, sets: str, reads: str, wanted: float) -> None:
    result = run(PROGRAM.format(says=says, sets=sets, reads=reads, wanted=wanted))
    assert [value for _, name, value in result.outputs if name == "digital_out[0]"] == [True]


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript"])  # V+ reads back no analog output
def test_the_level_elsewhere(target: str) -> None:
    says, sets, reads, wanted = CASES[0]
    result, losses, text = translated(PROGRAM.format(says=says, sets=sets, reads=reads, wanted=wanted), target)
    assert losses == [] and [value for _, name, value in result.outputs if value is True] == [True], text
    if target == "urscript":
        assert "* 10" not in text


def test_without_a_word_of_the_program_the_share_is_read() -> None:
    text = PROGRAM.format(says="sync()", sets="set_analog_out(0, 0.3)", reads="get_standard_analog_out(0)", wanted=0.3)
    _, diagnostics = read(text)
    assert set(codes(diagnostics)) == {"urscript-analog-domain"}
    assert (True in [value for _, _, value in run(text).outputs]) is True


def test_a_range_that_changes_is_not_guessed() -> None:
    says = "set_analog_outputdomain(0, 1)\n  set_analog_outputdomain(0, 0)"
    _, diagnostics = read(PROGRAM.format(says=says, sets="sync()", reads="get_standard_analog_out(0)", wanted=1))
    assert "urscript-kept-as-text" in codes(diagnostics)
