MODULE Beat
  PERS bool bBeatOn:=FALSE;
  PERS num nBeats:=0;

  PROC main()
    WHILE TRUE DO
      WaitUntil bBeatOn;
      WaitTime 0.2;
      IF nBeats<5 nBeats:=nBeats+1;
      WaitTime 0.1;
    ENDWHILE
  ENDPROC
ENDMODULE
