"""What a program does once at its beginning (first values, tools, tasks) is not done again by the tasks beside it."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_bytes
from rpl.translation import translate_program

_PROGRAM = """MODULE Watch
  VAR intnum part;
  VAR num hits:=0;
  VAR num other:=7;
  PROC main()
    CONNECT part WITH count;
    ISignalDI di1,1,part;
    PulseDO\\PLength:=0.2,do2;
    WaitTime 1;
    IDelete part;
    IF hits>other SetDO do1,1;
  ENDPROC
  TRAP count
    hits:=hits+1;
  ENDTRAP
ENDMODULE
"""


@pytest.mark.parametrize(("target", "starts"), [("inform", "PSTART"), ("tp", "RUN ")])
def test_only_the_entry_starts_the_tasks(target: str, starts: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_bytes("Watch.mod", _PROGRAM.encode())], "rapid", diagnostics)
    done = translate_program(read, target, None, None, diagnostics)
    texts = {file.path: file.data.decode("ascii") for file in done.files}
    beside = {path: text for path, text in texts.items() if "INTERRUPT_" in path}
    assert beside
    for path, text in beside.items():
        assert starts not in text, path
    main = next(text for path, text in texts.items() if path.startswith("MAIN"))
    assert starts in main
