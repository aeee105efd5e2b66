"""Comments in the brackets of a position register's component, before and behind the component."""

from __future__ import annotations

import pytest
from rpl.dialects.tp.split import Note, without_notes

CASES = [
    ("R[1]=PR[41:place,1]", "R[1]=PR[41,1]", (Note("PR", 41, "place"),)),
    ("PR[41,1:place]=5", "PR[41,1]=5", None),
    ("PR[41:lay 2 , 3]=PR[40:pal,3]+R[2:h]", "PR[41 , 3]=PR[40,3]+R[2]", None),
    ("PR[41:place,R[2]]=1", "PR[41,R[2]]=1", (Note("PR", 41, "place"),)),
    ("PR[R[1:no]:place,2]=1", None, None),
    ("L PR[41:place] 200mm/sec FINE", "L PR[41] 200mm/sec FINE", (Note("PR", 41, "place"),)),
    ("R[5:a,1]=2", "R[5]=2", (Note("R", 5, "a,1"),)),
    ("L P[3:left,1] 200mm/sec FINE", "L P[3] 200mm/sec FINE", (Note("P", 3, "left,1"),)),
]


@pytest.mark.parametrize(("text", "plain", "notes"), CASES, ids=[text for text, _, _ in CASES])
def test_the_component_is_kept(text: str, plain: str | None, notes: tuple[Note, ...] | None) -> None:
    found, told = without_notes(text)
    assert plain is None or found == plain
    assert notes is None or told == notes
