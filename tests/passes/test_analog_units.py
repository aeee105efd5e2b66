"""Analogue values keep their level across controllers: volts or milliamperes, not the number."""

import pytest

from rpl.cell import Cell, parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.errors import UsageError
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import Translation, translate_program

KRL = "DEF main()\nREAL v\nv=0.2\n{}\nEND\n"
RAPID = "MODULE m\nPROC main()\n{}\nENDPROC\nENDMODULE\n"
TP = "/PROG MAIN\n/MN\n{}\n/POS\n/END\n"
JOB = "/JOB\n//NAME MAIN\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2020/01/01 10:00\n///ATTR SC,RW\nNOP\n{}\nEND\n"
UR = "def main():\n  {}\nend\n"
VPLUS = ".PROGRAM main()\n{}\n.END\n"
RPL = "PROCEDURE main()\n{}\nEND PROCEDURE\n"
TEXTS = {"krl": KRL, "rapid": RAPID, "tp": TP, "inform": JOB, "urscript": UR, "vplus": VPLUS, "rpl": RPL}
FILES = {"krl": "main.src", "rapid": "m.mod", "tp": "MAIN.LS", "inform": "MAIN.JBI", "urscript": "main.script"}
FILES |= {"vplus": "main.v2", "rpl": "main.rpl"}

CONFIGURED = """
[analog.tp]
"AO[1]" = { numbers = [0, 2000], volts = [0, 10] }
"AI[1]" = { numbers = [0, 1000], volts = [0, 10] }
[analog.rapid]
ao1 = { numbers = [0, 100], volts = [0, 10] }
ai1 = { numbers = [-5, 5], volts = [0, 10] }
"""


def read(language: str, body: str) -> ReadProgram:
    found = Diagnostics()
    done = read_sources([source_from_text(FILES[language], TEXTS[language].format(body))], language, found)
    assert not found.has_errors, [item.as_text() for item in found]
    return done


def written(language: str, body: str, target: str, cell: str = "") -> tuple[str, Translation, Diagnostics]:
    found = Diagnostics()
    done = translate_program(read(language, body), target, None, None, found, analog=parse_cell(cell).analog)
    return "\n".join(file.data.decode("latin-1") for file in done.files), done, found


def codes(found: Diagnostics, severity: Severity) -> list[str]:
    return [item.code.name for item in found.of(severity)]


# source, target, cell, statement, what has to be written. KRL: a share of the module's range, 1 is 10 V
# (robot-forum.com thread 44124). UR: 0 and 1 are 0 and 10 V, or 4 and 20 mA (forum.universal-robots.com t/716).
# INFORM: volts, or 0.01 V in a whole-number variable. RAPID, TP: as the I/O configuration says. V+: M. RPL: volts
# (docs/rpl.md).
PAIRS = [
    ("krl", "inform", "", "$ANOUT[1]=0.5", "AOUT AO#(1) 5"),
    ("inform", "krl", "", "AOUT AO#(1) 5.0", "$ANOUT[1]=0.5"),
    ("inform", "krl", "", "SET I000 250\nAOUT AO#(1) I000", "/ 10.0"),
    ("krl", "urscript", "", "$ANOUT[1]=0.5", "set_standard_analog_out(0, 0.5)"),
    ("urscript", "inform", "", "set_standard_analog_out(0, 0.5)", "AOUT AO#(1) 5"),
    ("krl", "vplus", "", "$ANOUT[1]=0.5", "AIO.OUT 1 = 0.5"),
    ("vplus", "inform", "", "AIO.OUT 1 = 0.25", "AOUT AO#(1) 2.5"),
    ("rpl", "krl", "", "SET ao[1] TO 5", "$ANOUT[1]=0.5"),
    ("rpl", "inform", "", "SET ao[1] TO 5", "AOUT AO#(1) 5"),
    ("krl", "tp", CONFIGURED, "$ANOUT[1]=0.5", "AO[1]=1000"),
    ("krl", "rapid", CONFIGURED, "$ANOUT[1]=0.5", "SetAO ao1, 50"),
    ("rapid", "krl", CONFIGURED, "SetAO ao1,50;", "$ANOUT[1]=0.5"),
    ("tp", "rapid", CONFIGURED, "   1:  AO[1]=1000 ;", "SetAO ao1, 50"),
    ("rapid", "krl", CONFIGURED, "WaitAI ai1,\\GT,0;", "WAIT FOR $ANIN[1] > 0.5"),
    ("krl", "rapid", CONFIGURED, "IF $ANIN[1]>0.5 THEN\n$OUT[1]=TRUE\nENDIF", "IF ai1 > 0"),
    ("krl", "rapid", CONFIGURED, "IF 0.5<$ANIN[1] THEN\n$OUT[1]=TRUE\nENDIF", "IF ai1 > 0"),
    ("krl", "inform", "", "IF $ANIN[1]>0.5 THEN\n$OUT[1]=TRUE\nENDIF", "5"),
    ("urscript", "inform", "", "x = get_standard_analog_in(0)\n  set_digital_out(0, x > 2)", "AI#(1)"),
]


@pytest.mark.parametrize(("source", "target", "cell", "body", "wanted"), PAIRS, ids=range(len(PAIRS)))
def test_the_level_stays(source: str, target: str, cell: str, body: str, wanted: str) -> None:
    text, done, _ = written(source, body, target, cell)
    assert done.losses == ()
    assert wanted.replace(" ", "") in text.replace(" ", ""), text


UNKNOWN = [
    ("krl", "tp", "$ANOUT[1]=0.5"),
    ("krl", "rapid", "$ANOUT[1]=0.5"),
    ("rapid", "krl", "SetAO aoGlue,50;"),
    ("tp", "krl", "   1:  AO[1]=1000 ;"),
    ("tp", "rapid", "   1:  AO[1]=1000 ;"),
    ("tp", "inform", "   1:  R[1]=AI[1] ;\n   2:  WAIT R[1]=5 ;"),
    ("krl", "rapid", "IF $ANIN[1]>0.5 THEN\n$OUT[1]=TRUE\nENDIF"),
    ("krl", "tp", "WAIT FOR $ANIN[1]>0.5"),
    ("urscript", "krl", "write_output_float_register(3, 0.5)"),  # a register has no unit
]


@pytest.mark.parametrize(("source", "target", "body"), UNKNOWN)
def test_what_the_configuration_alone_knows_is_a_loss(source: str, target: str, body: str) -> None:
    text, _, found = written(source, body, target)
    assert codes(found, Severity.LOSS) == ["analog-unit-unknown"], [item.as_text() for item in found]
    again = Diagnostics()
    files = written(source, body, target)[1].files
    back = read_sources([source_from_bytes(file.path, file.data) for file in files], target, again)
    assert run_program(back.program).status == "stopped", text


def test_a_current_is_no_voltage() -> None:
    body = "set_analog_outputdomain(0, 0)\n  set_standard_analog_out(0, 0.5)"
    _, _, found = written("urscript", body, "krl")
    assert codes(found, Severity.LOSS) == ["analog-other-unit"]
    cell = '[analog.krl]\n"$ANOUT[1]" = { numbers = [0, 1], milliamperes = [0, 20] }'
    text, done, _ = written("urscript", body, "krl", cell)
    assert done.losses == () and "$ANOUT[1]=0.6" in text


def test_what_is_usual_is_said_once() -> None:
    _, _, found = written("krl", "$ANOUT[1]=0.5\n$ANOUT[1]=0.6", "inform")
    assert codes(found, Severity.WARNING).count("analog-usual-range") == 1
    _, _, found = written("krl", "$ANOUT[1]=0.5", "urscript")
    assert "analog-usual-range" not in codes(found, Severity.WARNING)


def test_a_computed_value_is_scaled() -> None:
    text, _, _ = written("krl", "$ANOUT[1]=v", "rapid", CONFIGURED)
    assert "SetAO ao1,v*100;" in text


def test_the_same_language_is_left_alone() -> None:
    text, _, found = written("rapid", "SetAO ao1,50;", "rapid")
    assert "SetAO ao1" in text and "50" in text and not found.has_losses


def proof(source: str, target: str, body: str, cell: Cell, spoil: tuple[str, str] = ("", "")) -> bool:
    program = read(source, body)
    done = translate_program(program, target, None, None, Diagnostics(), analog=cell.analog)
    files = [(file.path, file.data.decode("latin-1").replace(*spoil)) for file in done.files]
    back = read_sources([source_from_text(*file) for file in files], target, Diagnostics())
    return prove_programs(program.program, with_signal_names(back.program, done.program), cell=cell).equal


def test_the_proof_compares_levels() -> None:
    cell = parse_cell(CONFIGURED)
    for source, target, body in (
        ("krl", "inform", "$ANOUT[1]=0.5"),
        ("krl", "rapid", "$ANOUT[1]=0.5"),
        ("krl", "tp", "$ANOUT[1]=0.5\n$ANOUT[1]=v"),
    ):
        assert proof(source, target, body, cell), (source, target)
    assert not proof("krl", "inform", "$ANOUT[1]=0.5", cell, ("AO#(1) 5", "AO#(1) 4"))


def test_inputs_of_the_cell_come_in_each_language_s_numbers() -> None:
    cell = parse_cell(CONFIGURED + '[[input]]\ntime = 1\nsignal = "$ANIN[1]"\nvalue = 0.75\n')
    body = "WAIT FOR $ANIN[1]>0.5\nv=$ANIN[1]\n$ANOUT[1]=v"
    for target in ("rapid", "tp", "urscript", "vplus"):
        assert proof("krl", target, body, cell), target
    too_soon = ("WaitUntil ai1>0;", "WaitTime 0;")
    assert not proof("krl", "rapid", body, cell, too_soon)


def test_the_trace_says_the_level() -> None:
    (event,) = (one for one in run_program(read("krl", "$ANOUT[1]=0.5").program).trace if one.kind == "output")
    assert (event.data["value"], event.data["level"], event.data["unit"]) == (0.5, 5.0, "V")


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("analog = 3", "analog"),
        ("[analog.cobol]\nx = { numbers = [0, 1], volts = [0, 1] }", "analog.cobol"),
        ("[analog.tp]\nx = 3", "analog.tp.x"),
        ("[analog.tp]\nx = { volts = [0, 1] }", "analog.tp.x.numbers"),
        ("[analog.tp]\nx = { numbers = [0, 1] }", "volts"),
        ("[analog.tp]\nx = { numbers = [1, 1], volts = [0, 1] }", "analog.tp.x.numbers"),
        ("[analog.tp]\nx = { numbers = [0, nan], volts = [0, 1] }", "analog.tp.x.numbers"),
        ("[analog.tp]\nx = { numbers = [0, 1], volts = [0, 1], milliamperes = [4, 20] }", "milliamperes"),
        ("[analog.tp]\nx = { numbers = [0, 1], volts = [0, 1], more = 1 }", "analog.tp.x.more"),
    ],
)
def test_a_wrong_setting_is_named(text: str, named: str) -> None:
    with pytest.raises(UsageError, match=named.replace(".", r"\.")):
        parse_cell(text)
