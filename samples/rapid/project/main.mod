MODULE MainModule
  ! Visits the stations of a cell in turn; each station's work is called by its number.
  ! Expected: the left station is stamped twice, the right one screwed once, station 3 does not exist and is reported;
  ! three visits are counted, so doOk comes on; the arm ends at home.

  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  PROC main()
    nDone:=0;
    MoveAbsJ jHome,v1000,fine,tGrip;
    FOR nNumber FROM 1 TO 3 DO
      Visit nNumber;
    ENDFOR
    MoveAbsJ jHome,v1000,fine,tGrip;
    IF (nDone=3) AND (Visits()=3) Set doOk;
  ENDPROC

  LOCAL PROC Visit(num nNumber)
    VAR station stHere;

    stHere:=StationOf(nNumber);
    TPWrite "at the station "+stHere.name;
    FOR nPart FROM 1 TO stHere.nParts DO
      MoveJ Offs(stHere.pWork,0,0,100),v500,z10,tGrip\WObj:=wTable;
      MoveL stHere.pWork,v200,fine,tGrip\WObj:=wTable;
      %"Work"+NumToStr(nNumber,0)% stHere;
      Incr nDone;
      MoveL Offs(stHere.pWork,0,0,100),v200,fine,tGrip\WObj:=wTable;
    ENDFOR
  ERROR
    IF ERRNO=ERR_ARGVALERR THEN
      TPWrite "no station "+NumToStr(nNumber,0);
      RETURN;
    ENDIF
    RAISE;
  ENDPROC
ENDMODULE
