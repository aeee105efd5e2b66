"""The mass of the payload that a script asks for, run in its own and in the other languages."""

from __future__ import annotations

import pytest
from test_urscript_tasks_elsewhere import OTHERS, translated

SCRIPT = """def main():
  none = get_target_payload()
  set_payload(0.9, [0, 0, 0.04])
  set_standard_digital_out(0, get_target_payload() > 0.89 and none < 0.01)
  kg = 1.5
  set_payload(kg)
  kg = 2.5
  set_standard_digital_out(1, get_target_payload() > 1.49 and get_target_payload() < 1.51)
end
"""


@pytest.mark.parametrize("target", OTHERS)
def test_the_mass_is_what_was_set_last(target: str) -> None:
    result, losses, text = translated(SCRIPT, target)
    assert (result.status, losses) == ("finished", [])
    assert [each[2] for each in result.outputs] == [True, True]
    assert ("get_target_payload()" in text) == (target == "urscript")
