"""Arguments that a program only reads, and that change under another name while it runs.

V+ passes variables and elements by reference (V+ Language User's Guide, "Argument passing"; M), so a program sees
such a change. Only where there is none may it as well get a copy.
"""

from __future__ import annotations

import pytest
from vplus_helpers import outputs, program_of, read, run

CHANGED = [
    (
        "an element and its array",
        "a[1] = 1\na[2] = 1\nCALL fill(a[], a[2])\nIF a[1] == 12 THEN\nSIGNAL 1\nEND",
        ".PROGRAM fill(t[], e)\nt[2] = 7\nt[1] = e+5\n.END\n",
    ),
    (
        "one variable for two parameters",
        "AUTO n, m\nn = 1\nCALL twice(n, n, m)\nIF m == 3 THEN\nSIGNAL 1\nEND",
        ".PROGRAM twice(p, q, r)\np = p+2\nr = q\n.END\n",
    ),
    (
        "two elements, of which one index is computed",
        "AUTO i, m\ni = 1\na[1] = 1\nCALL twice(a[i], a[1], m)\nIF m == 3 THEN\nSIGNAL 1\nEND",
        ".PROGRAM twice(p, q, r)\np = p+2\nr = q\n.END\n",
    ),
    (
        "a global variable through two levels",
        "gx = 1\nCALL one(gx)\nIF gm == 102 THEN\nSIGNAL 1\nEND",
        ".PROGRAM one(p)\np = p+1\nCALL two(p)\n.END\n.PROGRAM two(q)\nCALL three()\ngm = q\n.END\n"
        ".PROGRAM three()\ngx = gx+100\n.END\n",
    ),
    (
        "a parameter beside the global variable that it stands for",
        "gx = 1\nCALL one(gx)\nIF gm == 6 THEN\nSIGNAL 1\nEND",
        ".PROGRAM one(p)\np = p+1\nCALL two(gx, p)\n.END\n.PROGRAM two(q, r)\nr = 6\ngm = q\n.END\n",
    ),
]


@pytest.mark.parametrize(("steps", "more"), [row[1:] for row in CHANGED], ids=[row[0] for row in CHANGED])
def test_what_is_only_read_and_changes_under_another_name_is_seen(steps: str, more: str) -> None:
    assert outputs(run(steps, more)) == [("1", True)]


def test_what_nobody_changes_meanwhile_is_a_value() -> None:
    program, _ = read(program_of("gx = 1\nCALL one(gx, a[2])", ".PROGRAM one(p, q)\ngm = p+q\n.END\n"))
    one = next(routine for module in program.modules for routine in module.routines if routine.name == "one")
    assert [parameter.mode for parameter in one.parameters] == ["value", "value"]
