"""Texts that may get longer than the target's: told where that is so, and given room where it is declared."""

import pytest

from tests.there_and_back import there_and_back

GROWN = 'FOR n = 1 TO 12\nt = t & "0123456789"\nEND FOR\n'
TOLD = "text-may-not-fit"


def program(body: str, more: str = "") -> dict[str, str]:
    head = 'ENTRY main\nVAR whole: STRING = ""\nPROCEDURE main()\nVAR t: STRING\nVAR n: INT\nt = ""\n'
    return {"main.rpl": f"{head}{body}SET do[1] TO text_length(t) = n\nEND PROCEDURE\n{more}"}


@pytest.mark.parametrize(
    ("body", "more", "found"),
    [
        (GROWN, "", {"rapid": 80, "vplus": 128, "krl": 255}),
        # Put together once, and known to be short enough for some.
        (f't = "{"a" * 60}"\nt = t & "{"b" * 40}"\nn = 100\n', "", {"rapid": 80}),
        (f't = "{"a" * 30}"\nt = t & "{"b" * 40}"\nn = 70\n', "", {}),
        # What a routine puts to a text of the project each time that it is called.
        ('FOR n = 1 TO 3\nnote("ab")\nEND FOR\n', 'PROCEDURE note(s: STRING)\nwhole = whole & s\nEND PROCEDURE\n',
         {"rapid": 80, "vplus": 128, "krl": 255}),
        ('note("ab")\nnote("cd")\n', 'PROCEDURE note(s: STRING)\nwhole = whole & s\nEND PROCEDURE\n', {}),
        ('note("ab")\n', 'PROCEDURE note(s: STRING)\nwhole = whole & s\nnote(s)\nEND PROCEDURE\n',
         {"rapid": 80, "vplus": 128, "krl": 255}),
        # Jumps: forward is once, back is a loop.
        ('GOTO on\nt = t & "abc"\nLABEL on\nt = t & "d"\nn = 1\n', "", {}),
        ('LABEL again\nt = t & "abc"\nn = n + 1\nIF n < 50 THEN GOTO again\n', "",
         {"rapid": 80, "vplus": 128, "krl": 255}),
        # A text that a routine begins anew stays short.
        ("show(1)\n",
         'PROCEDURE show(k: INT)\nVAR s: STRING\ns = "k"\ns = s & "="\nMESSAGE s\nEND PROCEDURE\n', {}),
        # Handed to a parameter and back, and a part of a long one.
        (f"{GROWN}t = text_part(t, 1, 3)\n", "", {"rapid": 80, "vplus": 128, "krl": 255}),
    ],
)  # fmt: skip
def test_what_may_be_too_long_is_told(body: str, more: str, found: dict[str, int]) -> None:
    for target in ("rapid", "vplus", "krl", "rpl", "urscript"):
        trip = there_and_back(program(body, more), "rpl", target, "kuka_kr6r900sixx")
        told = [one.message for one in trip.found if one.code.name == TOLD]
        assert len(told) == (target in found), (target, told)
        assert all(f"longer than {found[target]} characters" in one for one in told)


def test_long_texts_have_room_in_krl() -> None:
    trip = there_and_back(program(f"{GROWN}n = 120\n"), "rpl", "krl", "kuka_kr6r900sixx")
    assert trip.switched_on(trip.run()) == {1}
    short = there_and_back(program('t = "ab"\nn = 2\n'), "rpl", "krl", "kuka_kr6r900sixx")
    assert "CHAR t[80]" in short.text
    assert short.switched_on(short.run()) == {1}
