"""Numbers in messages of V+ have the six digits that the source shows, not the noise of the seventh and eighth."""

import pytest

from tests.there_and_back import there_and_back

VALUES = ["0.1+0.2", "1/3", "123.456", "-2.5", "100000", "12345678", "1/0.007", "-0.000012345"]


@pytest.mark.parametrize("value", VALUES)
def test_a_number_is_shown_as_in_the_source(value: str) -> None:
    body = f'VAR num x:=1;\n    TPWrite "x = "\\Num:=x*({value});' if "/" in value else f'TPWrite "x = "\\Num:={value};'
    given = there_and_back({"m.mod": f"MODULE m\n  PROC main()\n    {body}\n  ENDPROC\nENDMODULE\n"}, "rapid", "vplus")
    assert not given.losses and given.prove().equal, given.text
