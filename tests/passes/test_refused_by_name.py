"""Constructs that no rewriting serves: each is named at its line, and the target's own stop stands there."""

from __future__ import annotations

import pytest

from tests.refusing import refused

VIPER, KUKA, ABB, UR = "adept_viper_s650", "kuka_kr6r900sixx", "abb_irb1200_5_90", "ur10e"
RANDOM = """.PROGRAM main()
 SIGNAL 1
 IF RANDOM < 0.5 THEN
 SIGNAL 2
 END
.END
"""
FIXED_ARC = """def main():
  movel(p[0.3, -0.2, 0.3, 3.14, 0, 0], v=0.1)
  movec(p[0.33, -0.17, 0.3, 3.14, 0, 0], p[0.36, -0.2, 0.3, 3.14, 0, 0], a=0.8, v=0.1, r=0, mode=1)
end
"""
ONE_ORIENTATION = """DEF main( )
$TOOL=$NULLFRAME
PTP {X 500.0,Y 0.0,Z 400.0,A 180.0,B 0.0,C 180.0,S 2,T 2}
$ORI_TYPE=#CONSTANT
LIN {X 520.0,Y 0.0,Z 380.0,A 180.0,B 0.0,C 180.0}
LIN_REL {Z 40.0}
LIN {X 540.0,Y 0.0,Z 380.0,A 180.0,B 0.0,C 180.0}
LIN {X 520.0,Y 0.0,Z 380.0,A 150.0,B 0.0,C 180.0}
LIN_REL {Z 10.0,B 5.0}
PTP {A1 0,A2 -90,A3 90,A4 0,A5 10,A6 0}
LIN {X 500,Y 0,Z 400,A 150,B 0,C 180}
$ORI_TYPE=#VAR
LIN {X 500.0,Y 0.0,Z 400.0,A 150.0,B 0.0,C 180.0}
END
"""
HELD_ALONE = """DEF main( )
INTERRUPT DECL 5 WHEN $IN[1] DO HELD( )
INTERRUPT ON 5
INTERRUPT DISABLE 5
WAIT SEC 1
INTERRUPT ENABLE 5
END
DEF HELD( )
$OUT[1]=TRUE
END
"""
IN_USE = """MODULE main
  PERS tooldata t:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  PROC main()
    t:=CTool();
    SetDO do1,1;
  ENDPROC
ENDMODULE
"""
FILLED = """DEF main( )
DECL INT offset
DECL STATE_T state
DECL CHAR line[40]
offset=0
SWRITE(line[],state,offset,"part %5.1f",7.5)
SWRITE(line[],state,offset,"%03d",7)
SWRITE(line[],state,offset,"%-4s|",line[])
SWRITE(line[],state,offset,"%+d %%",7)
SWRITE(line[],state,offset,"%.2s",line[])
SWRITE(line[],state,offset,"%x",7)
END
"""
COMPARED = """MODULE main
  RECORD size
    num width;
    num height;
  ENDRECORD
  PERS size a:=[1,2];
  PERS size b:=[1,2];
  VAR robtarget p1;
  PERS robtarget p2:=[[400,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    IF a.width=b.width SetDO do1,1;
    IF a=b SetDO do2,1;
    p1:=p2;
    IF p1.trans=p2.trans SetDO do3,1;
    IF p1<>p2 SetDO do4,1;
  ENDPROC
ENDMODULE
"""
READ_BACK = """DEF main( )
DECL REAL v
$ANOUT[1]=0.5
v=$ANOUT[1]
$OUT[1]=v==0.5
END
"""
PAYLOAD = """def main():
  set_payload(1.5, [0, 0, 0.05])
  if get_target_payload() > 1:
    set_standard_digital_out(1, True)
  end
end
"""
IN_ORDER = """MODULE m
  VAR string s:="abc";
  PROC main()
    VAR bool b;
    IF StrOrder(s,"b",STR_UPPER) SetDO do1,1;
    b:=StrOrder(s,"b","cba");
    IF b SetDO do2,1;
  ENDPROC
ENDMODULE
"""
BEFORE = """.PROGRAM main()
 $a = "gear"
 IF $a < "gears" THEN
 SIGNAL 1
 END
 ok = ("axle" > $a) OR ($a == "gear")
 IF ok THEN
 SIGNAL 2
 END
.END
"""
JOINTS = """MODULE k
  CONST robtarget p:=[[500,150,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    VAR jointtarget j;
    j:=CalcJointT(p,tool0);
    MoveAbsJ j,v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""
ALL_ERRORS = """.PROGRAM main()
 REACTE trap
 t = SQRT(-4)
 REACTE
 SIGNAL 3
.END
.PROGRAM trap()
 errs = ERROR(-1)
 RETURNE
.END
"""
RAISED = """ENTRY main
MODULE m
    PROCEDURE main()
        TRAP ERRORS WITH rec
        RAISE 60
        TRAP ERRORS OFF
    END PROCEDURE
    PROCEDURE rec()
        TRY NEXT
    END PROCEDURE
END MODULE
"""
ERROR_NUMBER = """VAR last: INT = 0
work()

PROCEDURE work()
    WAIT UNTIL di[4] TIMEOUT 0.1 s ERROR timeout
ON ERROR timeout
    IF $error_number = timeout THEN SET do[1] TO ON
    last = $error_number
END PROCEDURE
"""


@pytest.mark.parametrize(
    ("program", "source", "arm", "lost", "targets"),
    [
        (RANDOM, "vplus", VIPER, [("random-numbers-lost", 3)], "rapid tp inform"),
        (FIXED_ARC, "urscript", UR, [("fixed-arc-lost", 3)], "rapid tp inform vplus"),
        (
            ONE_ORIENTATION,
            "krl",
            KUKA,
            [("constant-orientation-lost", line) for line in (8, 9, 11)],
            "rapid tp urscript vplus inform",
        ),
        (HELD_ALONE, "krl", KUKA, [("interrupt-held-alone", 4), ("interrupt-held-alone", 6)], "rapid vplus"),
        (IN_USE, "rapid", ABB, [("record-in-use-lost", 4)], "krl tp urscript vplus inform"),
        (FILLED, "krl", KUKA, [("text-format-lost", line) for line in range(7, 12)], "rapid tp urscript vplus inform"),
        (
            COMPARED,
            "rapid",
            ABB,
            [("record-comparison-lost", 12), ("record-comparison-lost", 15)],
            "krl tp urscript vplus inform",
        ),
        (READ_BACK, "krl", KUKA, [("vplus-guarded-stop", 4)], "vplus"),
        (IN_ORDER, "rapid", ABB, [("text-order-lost", 5), ("text-order-lost", 6)], "krl tp urscript vplus inform"),
        (BEFORE, "vplus", VIPER, [("text-order-lost", 3), ("text-order-lost", 6)], "krl rapid urscript inform"),
        (JOINTS, "rapid", ABB, [("kinematics-lost", 5)], "vplus"),
        (ALL_ERRORS, "vplus", VIPER, [("error-routine-lost", 2)], "krl rapid tp urscript inform"),
        (RAISED, "rpl", KUKA, [("error-routine-lost", 4)], "vplus"),
        (ERROR_NUMBER, "rpl", ABB, [("error-number-lost", 8)], "rapid"),
        (PAYLOAD, "urscript", UR, [("payload-question-lost", 3)], "krl tp vplus inform"),
    ],
)
def test_the_construct_is_named_at_its_line(
    program: str, source: str, arm: str, lost: list[tuple[str, int]], targets: str
) -> None:
    for target in targets.split():
        assert refused(program, source, target, arm) == lost, target
