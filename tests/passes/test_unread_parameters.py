"""Records as arguments, of which a routine looks at few components, in a language whose calls have few arguments."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
FORM = """DEF JOB()
DECL LDAT D
BAS(#INITMOV,0)
D=LDAT_ACT
D.ACC=50.0
PTP {A1 0.0,A2 -80.0,A3 100.0,A4 0.0,A5 70.0,A6 0.0}
SLIN_REL {Z 10.0} WITH $VEL=SVEL_CP(0.2,,D),$ACC=SACC_CP(D),$ORI_TYPE=SORI_TYP(D),$APO=SAPO(D),$JERK=SJERK(D) C_SPL
SLIN_REL {Z 10.0}
$OUT[1]=ABS($AXIS_ACT.A1)<0.01
END
"""


def test_a_path_form_with_all_its_data_in_tp() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("job.src", FORM)], "krl", diagnostics)
    translation = translate_program(read, "tp", KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "tp", Diagnostics())
    result = run_program(back.program, KUKA, None, "JOB", 30.0)
    assert result.status == "finished", result.fault
    assert [value for _, _, value in result.outputs] == [True]


MESSAGE = """DEF JOB()
DECL KRLMSG_T M
DECL KRLMSGPAR_T P[3]
DECL KRLMSGOPT_T O
DECL INT H
M={MODUL[] "CELL",NR 1,MSG_TXT[] "hello"}
O={VL_STOP FALSE,CLEAR_P_RESET TRUE,CLEAR_P_SAW FALSE,LOG_TO_DB FALSE}
H=Set_KrlMsg(#NOTIFY,M,P[],O)
$OUT[1]=H>0
END
"""


def test_a_user_message_fits_in_a_line_of_vplus() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("job.src", MESSAGE)], "krl", diagnostics)
    translation = translate_program(read, "vplus", KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "vplus", Diagnostics())
    result = run_program(back.program, KUKA, None, translation.renamed.get("JOB", "JOB"), 10.0)
    assert result.status == "finished", result.fault
    assert [value for _, _, value in result.outputs] == [True]
