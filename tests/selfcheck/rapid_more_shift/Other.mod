MODULE Other
  CONST num LOW:=1;
  CONST num HIGH:=LOW+4;
  LOCAL VAR num count:=70;

  PROC Prepare()
    init;
  ENDPROC

  LOCAL PROC init()
    nOrder:=nOrder*10+2;
    Incr count;
  ENDPROC

  FUNC num Counted()
    RETURN count;
  ENDFUNC
ENDMODULE
