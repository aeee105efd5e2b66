"""A setting from a register that no file gives stays as it was in a run, and that is said."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.passes.given import with_given
from rpl.passes.unsetsettings import settings_as_they_were
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes


def listing(*lines: str) -> str:
    body = "".join(f"{number:4}:  {line} ;\n" for number, line in enumerate(lines, 1))
    return f"/PROG  MAIN\n/ATTR\n/MN\n{body}/POS\n/END\n"


@pytest.mark.parametrize(
    ("lines", "given", "status", "left"),
    [
        (("OVERRIDE=R[50:Speed]", "DO[1]=ON"), {}, "finished", ["R[50:Speed]"]),
        (("OVERRIDE=R[50]", "DO[1]=ON"), {"R50": 80}, "finished", []),
        (("R[50]=40", "OVERRIDE=R[50]", "DO[1]=ON"), {}, "finished", []),
        (("R[50]=0", "OVERRIDE=R[50]", "DO[1]=ON"), {}, "fault", []),  # the program's own mistake
    ],
)
def test_an_override_from_a_register(
    lines: tuple[str, ...], given: dict[str, object], status: str, left: list[str]
) -> None:
    source = source_from_bytes("MAIN.LS", listing(*lines).encode())
    program = read_sources([source], "tp", Diagnostics()).program
    diagnostics, known = Diagnostics(), with_given(program, given)
    settled = settings_as_they_were(known, known, diagnostics)
    assert run_program(settled).status == status
    assert [str(dict(item.arguments)["name"]) for item in diagnostics] == left
