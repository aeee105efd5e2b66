"""Joint moves to the solution nearest to given joints, in languages that cannot calculate it."""

from __future__ import annotations

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.emulator.model import load_robot
from rpl.passes.legalise import legalise
from rpl.passes.legalise.context import Context
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "ur5e"
TARGETS = [name for name in registry.target_names() if name not in ("rpl", "urscript")]
PLACE = "p[0.40, -0.20, 0.30, 3.14159, 0, 0]"
TAUGHT = "[-0.6, -1.5708, 1.5708, -1.5708, -1.5708, 0]"
OTHER = "[-0.6, -0.6, -1.5708, -2.4, 1.5708, 0]"  # another posture of the arm
HEAD = "def job():\n  set_tcp(p[0, 0, 0.12, 0, 0, 0])\n  movej([0, -1.5708, 1.5708, -1.5708, -1.5708, 0])\n"


def read(body: str) -> ReadProgram:
    text = HEAD + "".join(f"  {line}\n" for line in body.splitlines()) + "end\n"
    return read_sources([source_from_text("job.script", text)], "urscript", Diagnostics())


def end_of(program: ir.Program, entry: str | None = None) -> list[float]:
    result = run_program(program, ROBOT, None, entry)
    assert result.status == "finished", result.fault
    assert result.joints is not None
    return list(result.joints)


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("near", [TAUGHT, OTHER])
def test_constant_places_become_their_joints(target: str, near: str) -> None:
    source = read(f"global place = {PLACE}\nglobal taught = {near}\nmovej(get_inverse_kin(place, qnear=taught))")
    diagnostics = Diagnostics()
    translation = translate_program(source, target, ROBOT, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    entry = translation.renamed.get("job", "job")
    assert end_of(back.program, entry) == pytest.approx(end_of(source.program), abs=0.02)


NOW = "get_actual_joint_positions()"
SET = "i = get_standard_analog_in(0)\n"
SET_PLACE = "p[0.4, -0.1 * i, 0.3, 3.14159, 0, 0]"
FORMS = [
    (f"{SET}movej(get_inverse_kin({SET_PLACE}, {NOW}))", 0),
    (f"{SET}q = get_inverse_kin({SET_PLACE}, {NOW})\nmovej(q)", 0),
    (f"{SET}movej(get_inverse_kin({SET_PLACE}, {TAUGHT}))", 1),
    (f"q = {NOW}\nq[0] = q[0] + get_standard_analog_in(0)\nmovej(get_inverse_kin({PLACE}, q))", 1),
]


@pytest.mark.parametrize(("body", "warnings"), FORMS)
def test_what_is_not_constant(body: str, warnings: int) -> None:
    source, diagnostics = read(body), Diagnostics()
    arm = load_robot(ROBOT)
    capabilities = registry.target("rapid").capabilities_under({})
    legalise(source.program, Context("urscript", "rapid", capabilities, diagnostics, arm, arm))
    assert sum(item.code.name == "posture-not-asked" for item in diagnostics.of(Severity.WARNING)) == warnings
