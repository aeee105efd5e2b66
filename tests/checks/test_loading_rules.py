"""What controllers refuse is found where it stands, and what they take is not."""

from collections.abc import Iterable
from pathlib import Path

import pytest

from rpl import registry
from rpl.cli.main import run
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import check_loading, read_program
from rpl.source import source_from_text


def broken(language: str, files: Iterable[tuple[str, str]]) -> list[tuple[str, int]]:
    """The rules that the files break, with the lines."""
    loading = registry.dialect(language).loading
    assert loading is not None
    sources = [source_from_text(name, text) for name, text in files]
    return [
        (rule.name, place.listing.source.position(place.start)[0])
        for rule, place in loading().broken(sources)
        if not rule.option
    ]


def listing(*statements: str) -> tuple[str, str]:
    """A TP program called A whose statement n stands in line n + 2."""
    lines = "".join(f"{number:4}:  {text} ;\n" for number, text in enumerate(statements, 1))
    place = "".join(f"J{axis}= 0.000 deg, " for axis in range(1, 7)).removesuffix(", ")
    taught = f"P[1]{{\n   GP1:\n\tUF : F, UT : F,\n\t{place}\n}};\n"
    return "A.LS", f"/PROG  A\n/MN\n{lines}/POS\n{taught}/END\n"


TP = [
    ("IF F[1:go]=ON,JMP LBL[1]", "IF (F[1:go]),JMP LBL[1]", "tp-flag-condition"),
    ("WAIT DI[1]=ON OR F[2]=OFF", "WAIT (DI[1]=ON OR !F[2])", "tp-flag-condition"),
    ("F[R[1]]=OFF", "F[R[1]]=(OFF)", "tp-flag-value"),
    ("R[1]=SIN[30]", "R[1]=SIN[R[2:angle]]", "tp-function-argument"),
    ("R[1]=ATAN2[R[1],(-1)]", "R[1]=ATAN2[R[1],R[R[2]]]", "tp-function-argument"),
    ("R[1]=STRLEN 'PART'", "R[1]=STRLEN AR[1]", "tp-text-argument"),
    ("SR[1:name]='PART'", "CALL TEXT(1,'PART')", "tp-text-constant"),
    ("IF (SR[1]=SR[2]) THEN", "IF SR[1]=SR[2],JMP LBL[1]", "tp-text-comparison"),
    ("CALL P(R[1],-2.5)", "CALL P(R[1],(-2.5))", "tp-negative"),
    ("R[1]=R[1]*10+R[2]", "R[1]=(R[1]*10+R[2])", "tp-families"),
    ("IF R[1]=1 AND R[2]=2 OR R[3]=3,JMP LBL[1]", "IF R[1]=1 OR R[2]=2,JMP LBL[1]", "tp-and-or"),
    ("PR[1]=PR[2]*PR[3]", "PR[1]=PR[2]+PR[3]", "tp-position-product"),
    ("GO[4]=GI[3]", "GO[4]=R[3]", "tp-group-value"),
    ("AO[1]=R[1]/10", "AO[1]=R[1]", "tp-analog-value"),
    ("R[1]=2147483647", "R[1]=2147483646", "tp-number"),
    ("L P[1] AR[1]mm/sec FINE", "L P[1] R[1]mm/sec FINE", "tp-speed-argument"),
    ("L P[1] 9mm/sec FINE DB 70mm,DO[1]=ON", "L P[1] 9mm/sec FINE DB 70.0mm,DO[1]=ON", "tp-distance-decimals"),
    ("DO[1]=PULSE,25.6sec", "DO[1]=PULSE,25.5sec", "tp-pulse"),
    (f"CALL T('{'a' * 39}')", f"CALL T('{'a' * 38}')", "tp-text-length"),
    ("R[1]=$MNUTOOLNUM[1]", "R[1]=$MCR.$GENOVERRIDE", "tp-system-variable"),
    ("J P[2] 9% FINE", "J P[1:x] 9% FINE", "tp-position"),
    ("JMP LBL[2]", "JMP LBL[1]", "tp-label"),
    ("LBL[1:again]", "LBL[2]", "tp-label-once"),
    (f"!{'a' * 33}", f"!{'a' * 32}", "tp-remark"),
    (f"R[1:{'a' * 17}]=1", f"R[1:{'a' * 16}]=1", "tp-comment"),
    (f"MESSAGE[{'a' * 25}]", f"MESSAGE[{'a' * 24}]", "tp-message"),
]


@pytest.mark.parametrize(("refused", "taken", "rule"), TP)
def test_of_a_listing(refused: str, taken: str, rule: str) -> None:
    assert broken("tp", [listing("LBL[1]", refused)]) == [(rule, 4)]
    assert broken("tp", [listing("LBL[1]", taken)]) == []


def test_remarks_and_texts_of_a_listing_are_not_statements() -> None:
    assert broken("tp", [listing("!IF F[1]=ON,JMP LBL[7]", "//F[1]=ON", "CALL T('F[1]=ON')")]) == []


RAPID = "MODULE M\n  CONST num a:=1;\n  PROC main()\n    a:=b{1,2};\n  ENDPROC\nENDMODULE\n"
KRL = "DEF A( )\nDECL INT N\nN=1\nEND\n"
INFORM = """/JOB
//NAME A
//POS
///NPOS 1,0,0,0,0,0
///PULSE
C00000=0,0,0,0,0,0
//INST
///DATE 2000/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
'remark
*AGAIN
MOVJ C00000 VJ=50.00
JUMP *AGAIN IF IN#(1)=ON
END
"""
UR = "def a():\n  global n = 1\n  def b():\n    n = 2\n  end\n  b()\nend\n"
VPLUS = ".PROGRAM a()\n        IF x == 1 GOTO 10\n        y = 1\n 10     z = 1\n.END\n"
NAMES = {"tp": "A.LS", "rapid": "M.mod", "krl": "A.src", "inform": "A.JBI", "urscript": "a.script", "vplus": "a.v2"}
LONG = "a" * 40
PLACED = "/PROG  A\n/MN\n   1:J P[32766] 9% FINE ;\n/POS\nP[32766]{\n   GP1:\n};\n/END\n"
CASES = [
    ("tp", PLACED, "/END", "P[32767]{\n   GP1:\n};\n/END", [("tp-position-number", 8)]),
    ("rapid", RAPID, "PROC main", "PROC M", [("rapid-named-twice", 3)]),
    ("rapid", RAPID, "PROC main()", "PROC main()\n    VAR num a;", []),
    ("rapid", RAPID, "{1,2}", "{1}{2}", [("rapid-index", 4)]),
    ("rapid", RAPID, "num a", f"num {LONG}", [("rapid-name-length", 2)]),
    ("rapid", RAPID, "num a", "num Step", [("rapid-reserved", 2)]),
    ("rapid", RAPID, "ENDMODULE", "  VAR num c;\nENDMODULE", [("rapid-order", 6)]),
    ("rapid", RAPID, "    a:=", f'    TPWrite "{"a" * 81}";\n    a:=', [("rapid-text-length", 4)]),
    ("rapid", RAPID, "    a:=", "    GOTO there;\n    a:=", [("rapid-label", 4)]),
    ("rapid", RAPID, "MODULE M", "MODULE N", [("rapid-file-name", 1)]),
    ("krl", KRL, "END", "END\nDEF A( )\nEND", [("krl-named-twice", 5)]),
    ("krl", KRL, "DEF A", "DEF B", [("krl-file-name", 1)]),
    ("krl", KRL, "DECL INT N\nN=1\nEND", "END\nGLOBAL DEF main( )\nN=1\nEND", [("krl-work", 1)]),
    ("krl", KRL, "N=1", f"{LONG}=1", [("krl-name-length", 3)]),
    ("krl", KRL, "INT N", "INT STEP", [("krl-reserved", 2)]),
    ("krl", KRL, "N=1", f"N=1{'+1' * 240}", [("krl-line", 3)]),
    ("krl", KRL, "N=1", "GOTO B", [("krl-label", 3)]),
    ("krl", KRL, "N=1", "INTERRUPT DECL 129 WHEN $IN[1] DO B( )", [("krl-priority", 3)]),
    ("krl", KRL, "N=1", "INTERRUPT DECL 50 WHEN $IN[1] DO B( )", [("krl-priority-reserved", 3)]),
    ("krl", "DEFDAT A\nDECL GLOBAL INT B=1\nENDDAT\n", "", "", [("krl-public", 1)]),
    ("krl", "DEFDAT A PUBLIC\nDECL GLOBAL INT B=1\nENDDAT\n", "", "", []),
    ("krl", "DEFDAT A\nDECL INT B=1\nDECL INT B=2\nENDDAT\n", "", "", [("krl-declared-twice", 3)]),
    ("inform", INFORM, "JUMP", "MOVL C00000 V=9.0\nJUMP", [("inform-step-position", 15)]),
    ("inform", INFORM, "NPOS 1", "NPOS 2", [("inform-positions", 4)]),
    ("inform", INFORM, "MOVJ C00000", "MOVJ C00001", [("inform-position", 14)]),
    ("inform", INFORM, "NAME A", f"NAME {LONG.upper()}", [("inform-name", 2), ("inform-file-name", 2)]),
    ("inform", INFORM, "NAME A", "NAME a", [("inform-name-characters", 2)]),
    ("inform", INFORM, "'remark", f"'{LONG}", [("inform-remark", 12)]),
    ("inform", INFORM, "///ATTR", f"///COMM {LONG}\n///ATTR", [("inform-comment", 9)]),
    ("inform", INFORM, "JUMP *AGAIN", "JUMP *NO", [("inform-label", 15)]),
    ("inform", INFORM, "JUMP", "*AGAIN\nJUMP", [("inform-label-once", 15)]),
    ("inform", INFORM, "*AGAIN\n", "*AGAINAGAIN\n*AGAIN\n", [("inform-label-length", 13)]),
    ("inform", INFORM, "///PULSE", "///POSTYPE USER\n///RECTAN", [("inform-relative", 10)]),
    ("inform", INFORM, "//INST", "///POSTYPE USER\n///RECTAN\nP00000=1.0,2.0,3.0,0.0,0.0,0.0\n//INST", []),
    ("inform", INFORM, "JUMP", "SET B000 256\nJUMP", [("inform-byte", 15)]),
    ("inform", INFORM, "JUMP", "SET I000 32768\nJUMP", [("inform-integer", 15)]),
    ("inform", INFORM, "JUMP", f'SET S000 "{LONG}"\nJUMP', [("inform-text", 15)]),
    ("inform", INFORM, "JUMP", f'MSG "{LONG}"\nJUMP', [("inform-message", 15)]),
    ("inform", INFORM, "JUMP", "TIMER T=700.00\nJUMP", [("inform-time", 15)]),
    ("inform", INFORM, "NOP\n", "", [("inform-frame", 11)]),
    ("inform", INFORM, "'remark", "'r\u00e9", [("inform-characters", 12)]),
    ("urscript", UR, "n = 2", 'textmsg("\u00e9")', [("urscript-characters", 4)]),
    ("urscript", UR, "global n", "global halt", [("urscript-reserved", 2)]),
    ("urscript", UR, "global n", "global 1n", [("urscript-name", 2)]),
    ("urscript", UR, "  b()", "  def b():\n    n = 1\n  end", [("urscript-defined-twice", 6)]),
    ("vplus", VPLUS, "y = 1", f"{LONG} = 1", [("vplus-name-length", 3)]),
    ("vplus", VPLUS, ".END", ".END\n.PROGRAM a()\n.END", [("vplus-program-once", 6)]),
    ("vplus", VPLUS, "y = 1", f'TYPE "{"a" * 129}"', [("vplus-text-length", 3)]),
    ("vplus", VPLUS, "GOTO 10", "GOTO 20", [("vplus-label", 2)]),
    ("vplus", VPLUS, "y = 1", '$y = "\u00e9"', [("vplus-characters", 3)]),
]


@pytest.mark.parametrize("language", NAMES)
def test_what_is_right_is_taken(language: str) -> None:
    good = {"tp": PLACED, "rapid": RAPID, "krl": KRL, "inform": INFORM, "urscript": UR, "vplus": VPLUS}
    assert broken(language, [(NAMES[language], good[language])]) == []


@pytest.mark.parametrize(("language", "text", "old", "new", "rules"), CASES)
def test_of_the_other_languages(language: str, text: str, old: str, new: str, rules: list[tuple[str, int]]) -> None:
    assert broken(language, [(NAMES[language], text.replace(old, new, 1))]) == rules


def test_names_are_compared_among_the_modules_of_a_task() -> None:
    task = RAPID.replace("MODULE M", "MODULE N")
    other = task.replace("main", "further")
    assert broken("rapid", [("M.mod", RAPID), ("N.mod", other)]) == [("rapid-named-twice", 2)]
    assert broken("rapid", [("M.mod", RAPID), ("N.mod", other.replace("CONST", "LOCAL CONST"))]) == []
    assert broken("rapid", [("M.mod", RAPID), ("N.mod", task)]) == []


def test_a_rule_warns_and_nothing_is_lost(tmp_path: Path) -> None:
    file = tmp_path / "A.LS"
    file.write_text(listing("F[1]=ON")[1])
    diagnostics = Diagnostics()
    read = read_program([file], None, diagnostics)
    check_loading(read, diagnostics)
    [item] = [item for item in diagnostics if item.code.name.startswith("load-")]
    assert (item.code.name, item.severity, item.origin.line) == ("load-tp-flag-value", Severity.WARNING, 3)
    assert sum(report.opaque for report in read.files) == 0


def test_check_tells_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "A.LS").write_text(listing("F[1]=ON")[1])
    assert run(["check", str(tmp_path / "A.LS")]) == 0
    assert "write F[1]=(ON)" in capsys.readouterr().err
