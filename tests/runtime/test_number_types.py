"""Numbers as the controllers keep them: four-byte reals, whole numbers of 32 bits.

RAPID Reference Manual, num: IEEE single, whole numbers from -8388607 to 8388608 exact. KRL RG 2.1.3.1: INT of 32 bits,
REAL up to 3.4E+38. KAREL reference: REAL of four bytes. INFORM: R single, an overflow is an alarm. M: each operation
rounds, and a KRL INT that overflows is a fault.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rpl
from rpl.errors import UsageError
from rpl.linking.operators import single, single_number
from tests.there_and_back import there_and_back

_RAPID = (
    "MODULE m\n  PERS num tuned:=3;\n  PERS num parts:=3;\n"
    "  PROC main()\n    VAR num x:=0;\n    VAR num n:=0;\n    {body}\n  ENDPROC\nENDMODULE\n"
)


def _outputs(text: str, name: str, language: str, tmp_path: Path) -> tuple[str, int]:
    """How a program ends, and how many outputs it has switched on."""
    file = tmp_path / name
    file.write_text(text)
    result = rpl.run(rpl.read([file], dialect=language))
    return result.status, sum(event.kind == "output" and event.data["value"] is True for event in result.trace)


@pytest.mark.parametrize(
    "body",
    [
        "WHILE x<1 DO x:=x+0.1; n:=n+1; ENDWHILE IF n=10 SetDO do1,1;",
        "WHILE x<1 DO Add x,0.1; n:=n+1; ENDWHILE IF n=10 SetDO do1,1;",
        "IF 0.1+0.2=0.3 SetDO do1,1;",
        "x:=0.1; IF x=0.1 SetDO do1,1;",
        "x:=16777216; x:=x+1; IF x=16777216 SetDO do1,1;",
        "x:=1/3; IF x*3=1 SetDO do1,1;",
        "x:=Sqrt(2); IF x=1.4142135 SetDO do1,1;",
        "x:=8388607; x:=x-1; IF x=8388606 SetDO do1,1;",
    ],
)
def test_rapid_calculates_with_four_bytes(body: str, tmp_path: Path) -> None:
    assert _outputs(_RAPID.format(body=body), "m.mod", "rapid", tmp_path) == ("finished", 1)


@pytest.mark.parametrize(
    ("language", "name", "text"),
    [
        ("krl", "a.src", "DEF a()\nDECL REAL x\nDECL INT n\nx=0\nn=0\nWHILE x<1\nx=x+0.1\nn=n+1\nENDWHILE\n"
         "IF n==10 THEN\n$OUT[1]=TRUE\nENDIF\nEND\n"),
        ("urscript", "a.script", "def a():\n  x = 0.0\n  n = 0\n  while x < 1:\n    x = x + 0.1\n    n = n + 1\n  end\n"
         "  if n == 11:\n    set_standard_digital_out(1, True)\n  end\nend\n"),
    ],
)  # fmt: skip
def test_each_language_in_its_own_precision(language: str, name: str, text: str, tmp_path: Path) -> None:
    assert _outputs(text, name, language, tmp_path) == ("finished", 1)


@pytest.mark.parametrize(
    "body", ["i=2147483647\ni=i+1", "i=-2147483647\ni=i-2", "i=100000\ni=i*i", "x=3.0E9\ni=x", "i=2147483647\ni=i-(-1)"]
)
def test_an_int_of_krl_that_overflows_is_a_fault(body: str, tmp_path: Path) -> None:
    text = f"DEF a()\nDECL INT i\nDECL REAL x\n{body}\n$OUT[1]=TRUE\nEND\n"
    assert _outputs(text, "a.src", "krl", tmp_path) == ("fault", 0)


def test_the_largest_int_of_krl_is_none(tmp_path: Path) -> None:
    text = "DEF a()\nDECL INT i\ni=2147483646\ni=i+1\ni=-2147483647\ni=i-1\n$OUT[1]=TRUE\nEND\n"
    assert _outputs(text, "a.src", "krl", tmp_path) == ("finished", 1)


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ("n = 3.5", "n: must be a whole number, not 3.5"),
        ('"l[2]" = 1.5', "must be a whole number, not 1.5"),
        ("l = [1, 2.5]", "must be a whole number, not 2.5"),
        ("n = 3000000000", "too large for a whole number of 32 bits"),
        ("n = nan", "n: must be a finite number, not nan"),
    ],
)
def test_a_cell_gives_an_int_whole_numbers_only(given: str, why: str, tmp_path: Path) -> None:
    (tmp_path / "a.src").write_text("DEF a()\nDECL INT i\ni=n+l[2]\nEND\n")
    (tmp_path / "a.dat").write_text("DEFDAT a\nDECL INT n=1\nDECL INT l[2]\nENDDAT\n")
    cell = tmp_path / "cell.toml"
    cell.write_text(f"[variables]\n{given}\n")
    program = rpl.read([tmp_path / "a.src", tmp_path / "a.dat"])
    with pytest.raises(UsageError, match=r"cell\.toml") as failed:
        rpl.run(program, cell=cell)
    assert why in str(failed.value)


def test_a_whole_number_with_a_point_is_one(tmp_path: Path) -> None:
    (tmp_path / "a.src").write_text("DEF a()\nIF n/2==1 THEN\n$OUT[1]=TRUE\nENDIF\nEND\n")
    (tmp_path / "a.dat").write_text("DEFDAT a\nDECL INT n=1\nENDDAT\n")
    cell = tmp_path / "cell.toml"
    cell.write_text("[variables]\nn = 3.0\n")
    result = rpl.run(rpl.read([tmp_path / "a.src", tmp_path / "a.dat"]), cell=cell)
    assert result.status == "finished" and any(event.kind == "output" for event in result.trace)


@given(st.floats(allow_nan=False, min_value=-3.4e38, max_value=3.4e38))
def test_rounding_is_that_of_numpy(value: float) -> None:
    assert single(value) == float(np.float32(value))


@given(st.integers(min_value=-(2**62), max_value=2**62))
def test_whole_numbers_are_rounded_beyond_24_bits(value: int) -> None:
    assert single_number(value) == int(np.float32(float(value)))


# ---- which type a number gets in another language


@pytest.mark.parametrize(
    ("target", "real", "whole"),
    [("krl", "DECL GLOBAL REAL tuned=3", "DECL GLOBAL INT parts=3"), ("urscript", "tuned = 3.0", "parts = 3")],
)
def test_a_number_that_may_be_tuned_keeps_its_fraction(target: str, real: str, whole: str) -> None:
    text = _RAPID.format(body="FOR k FROM 1 TO parts DO n:=n+1; ENDFOR IF n>2 x:=tuned*2; IF x>5 SetDO do1,1;")
    given = there_and_back({"m.mod": text}, "rapid", target)
    assert real in given.text and whole in given.text
    assert given.switched_on(given.run()) == {1}


def test_a_register_that_may_be_tuned_keeps_its_fraction() -> None:
    listing = (
        "/PROG  A\n/ATTR\n/MN\n   1:  IF R[1:share]>2,JMP LBL[1] ;\n   2:  LBL[2] ;\n   3:  R[2:count]=R[2]+1 ;\n"
        "   4:  LBL[1] ;\n   5:  R[3:state]=1 ;\n   6:  IF R[3]=1,JMP LBL[3] ;\n   7:  JMP LBL[2] ;\n   8:  LBL[3] ;\n"
        "/POS\n/END\n"
    )
    text = there_and_back({"A.LS": listing}, "tp", "krl").text
    assert "REAL share=" in text and "INT count=" in text and "INT state=" in text


# ---- what may come out otherwise elsewhere


@pytest.mark.parametrize(
    ("body", "named"),
    [
        ("WHILE x<1 DO x:=x+0.1; ENDWHILE", True),
        ("WHILE x<1 DO Add x,0.1; ENDWHILE", True),
        ("x:=tuned/3; IF x=1 SetDO do1,1;", True),
        ("IF 0.1+0.2=0.3 SetDO do1,1;", True),
        ("FOR k FROM 0 TO 1 STEP 0.1 DO n:=n+1; ENDFOR", True),
        ("WHILE x<1 DO grow x,0.1; ENDWHILE", True),
        ("WHILE x<1 DO x:=more(x); ENDWHILE", True),
        ("x:=third(1); IF x=1 SetDO do1,1;", True),
        ("IF third(n)=1 SetDO do1,1;", True),
        ("x:=tuned/3; n:=x; IF n=1 SetDO do1,1;", True),
        ("IF near(tuned,x,0.000001) SetDO do1,1;", True),
        ("IF Sqrt(tuned)=3 SetDO do1,1;", True),
        ("n:=Trunc(tuned*0.01); IF n=1 SetDO do1,1;", True),
        ("WHILE x<1 DO grow x,0.25; ENDWHILE", True),
        ("WHILE n<3 DO n:=twice(n)+1; ENDWHILE", False),
        ("IF near(tuned,x,0.01) SetDO do1,1;", False),
        ("IF Abs(tuned*0.1-x)<0.001 SetDO do1,1;", False),
        ("n:=Trunc(tuned/10); IF n=1 SetDO do1,1;", False),
        ("WHILE x<1 DO x:=x+0.25; ENDWHILE", False),
        ("WHILE n<10 DO n:=n+1; ENDWHILE", False),
        ("x:=0.1; IF x=0.1 SetDO do1,1;", False),
        ("x:=tuned/4; IF x=1 SetDO do1,1;", False),
        ("x:=tuned*1.1; IF x>2 SetDO do1,1;", False),
    ],
)
def test_what_another_precision_may_change_is_named(body: str, named: bool) -> None:
    text = _RAPID.format(body=body).replace("  PROC main", _ROUTINES + "  PROC main")
    codes = {
        target: [i.code.name for i in there_and_back({"m.mod": text}, "rapid", target).found] for target in _OTHERS
    }
    assert ("precision-differs" in codes["urscript"]) is named
    assert "precision-differs" not in codes["krl"] + codes["tp"]


@pytest.mark.parametrize(
    ("body", "named"),
    [
        ("h = (h * 257 + 3) % 65521", True),
        ("h = (h * 31 + 3) % 65521", False),
        ("h = 16777216\nh = h + 1", True),
        ("h = 16777215", False),
        ("h = h + 1", False),
    ],
)
def test_whole_numbers_beyond_what_the_target_holds_exactly_are_named(body: str, named: bool) -> None:
    text = f"def p():\nh = 1\n{body}\nset_standard_digital_out(0, h % 2 == 1)\nend\n"
    found = {
        t: there_and_back({"p.script": text}, "urscript", t, "ur5e").found for t in ("rapid", "vplus", "krl", "tp")
    }
    told = {target: "whole-number-rounded" in [item.code.name for item in items] for target, items in found.items()}
    assert told == {"rapid": named, "vplus": named, "krl": False, "tp": False}


_OTHERS = ("urscript", "krl", "tp")
_ROUTINES = (
    "  PROC grow(INOUT num v,num by) v:=v+0.1*by; ENDPROC\n"
    "  FUNC num more(num v) RETURN v+0.1; ENDFUNC\n"
    "  FUNC num third(num v) RETURN v/3; ENDFUNC\n"
    "  FUNC num twice(num v) RETURN v*2; ENDFUNC\n"
    "  FUNC bool near(num a,num b,num within) RETURN Abs(a-b)<within; ENDFUNC\n"
)
