"""Programs of other languages in TP: messages, texts, routines that call themselves."""

from __future__ import annotations

from tp_translating_helpers import same_in_tp

MESSAGES = """MODULE m
  PERS num count:=0;
  PROC main()
    VAR string part:="lid";
    count:=7;
    TPWrite "count: "+NumToStr(count,0)+" pieces";
    TPWrite "half "\\Num:=count/2;
    TPWrite part+" of "+ValToStr(count)+"mm is longer than the line of a screen";
    show 3;
  ENDPROC
  PROC show(num v)
    TPWrite "v"+NumToStr(v,1);
    TPWrite NumToStr(v,0);
  ENDPROC
ENDMODULE
"""


def test_messages_name_the_registers_of_their_values() -> None:
    files, codes = same_in_tp("rapid", MESSAGES)
    main = files["MAIN.LS"]
    assert "MESSAGE[count: R1 pieces]" in main and "MESSAGE[SR1 of R1 mm is]" in main
    assert "R[2:shown]=R[1:count]/2 ;" in main and "MESSAGE[half R2]" in main
    assert "MESSAGE[v R3]" in files["SHOW.LS"]
    assert set(codes) == {"message-values-named", "message-split", "persistent-set-at-start"}


RECURSION = """MODULE m
  PROC main()
    IF fact(5)=120 Set do1;
    IF fib(7)=13 Set do2;
    IF spell(3)="x123" Set do3;
  ENDPROC
  FUNC num fact(num n)
    IF n<2 RETURN 1;
    RETURN n*fact(n-1);
  ENDFUNC
  FUNC num fib(num n)
    VAR bool small; VAR num first;
    small:=n<2;
    IF small RETURN n;
    first:=fib(n-1);
    RETURN first+fib(n-2);
  ENDFUNC
  FUNC string spell(num n)
    VAR string end; VAR bool last;
    end:="?";
    last:=n=3;
    IF n=1 end:="1";
    IF n=2 end:="2";
    IF last end:="3";
    IF n=0 RETURN "x";
    RETURN spell(n-1)+end+checked(last,n=3);
  ENDFUNC
  FUNC string checked(bool a,bool b)
    IF a=b RETURN "";
    RETURN "wrong";
  ENDFUNC
ENDMODULE
"""


def test_routines_that_call_themselves() -> None:
    files, codes = same_in_tp("rapid", RECURSION)
    assert "recursion-limited" in codes
    assert "R[R[" not in files["FACT.LS"]  # its argument is kept by the controller
    assert "]=R[R[" in files["FIB.LS"] and "SR[R[" in files["SPELL.LS"]
