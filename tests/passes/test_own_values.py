"""Values that only the source's controller has: what asks for them is refused by name, in every language."""

from __future__ import annotations

import pytest

from rpl import registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

STEPS = {
    "in a condition": "if socket_open(host, 30000, name):\n  set_standard_digital_out(1, True)\nend",
    "of a loop": "while not socket_open(host, 30000, name):\n  sleep(0.1)\nend",
    "stored": "open = socket_open(host, 30000, name)\nset_standard_digital_out(1, open)",
}
TARGETS = [name for name in registry.target_names() if name not in ("urscript", "rpl")]


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", STEPS)
def test_it_is_refused_and_what_is_written_reads(name: str, target: str) -> None:
    lines = "\n".join(f"  {line}" for line in STEPS[name].splitlines())
    text = f'def main():\n  host = "1.2.3.4"\n  name = "s"\n{lines}\n  sleep(1)\nend\n'
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", text)], "urscript", diagnostics)
    files = translate_program(read, target, None, None, diagnostics).files
    losses = diagnostics.of(Severity.LOSS)
    assert losses and all(item.origin.line for item in losses)
    again = Diagnostics()
    programs = [file for file in files if not file.path.endswith(".csv")]
    read_sources([source_from_bytes(file.path, file.data) for file in programs], target, again)
    assert not again.of(Severity.ERROR)


@pytest.mark.parametrize("target", TARGETS)
def test_the_report_says_what_is_asked_for(target: str) -> None:
    text = "def main():\n  a = socket_open(x, 3, y)\n  modbus_delete_signal(1)\n  sleep(1)\nend\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", text)], "urscript", diagnostics)
    translate_program(read, target, None, None, diagnostics)
    codes = {item.code.name for item in diagnostics.of(Severity.LOSS)}
    assert "other-controllers-instruction" in codes and not any("guarded" in code for code in codes), codes


FOREIGN = {
    "a function of the controller": (
        "rapid",
        "x:=GetMotorTorque(4);\nIF GetMotorTorque(4)>3 THEN\nSetDO do1,1;\nENDIF",
    ),
    "more data than there is room": ("rapid", "FOR i FROM 1 TO 1500 DO\nmany{i}:=i+x;\nENDFOR\nx:=many{7};"),
}


@pytest.mark.parametrize("target", [name for name in registry.target_names() if name not in ("rapid", "rpl")])
@pytest.mark.parametrize("name", FOREIGN)
def test_what_can_be_written_is_written_and_reads(name: str, target: str) -> None:
    language, steps = FOREIGN[name]
    text = f"MODULE m\nVAR num x:=2.5;\nVAR num many{{1500}};\nPROC main()\n{steps}\nENDPROC\nENDMODULE\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", text)], language, diagnostics)
    files = translate_program(read, target, None, None, diagnostics).files
    assert not diagnostics.of(Severity.ERROR)
    losses = {item.code.name for item in diagnostics.of(Severity.LOSS)}
    assert losses <= {"other-controllers-value", "registers-exceeded", "undeclared-place", f"{target}-guarded-stop"} | {
        f"{target}-lost-declaration"
    }
    again = Diagnostics()
    programs = [file for file in files if not file.path.endswith(".csv")]
    read_sources([source_from_bytes(file.path, file.data) for file in programs], target, again)
    assert not again.of(Severity.ERROR)
