MODULE Stations
  ! The stations of the cell: where they are and what is done there.

  CONST robtarget pLeft:=[[50,150,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pRight:=[[50,-150,0],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  LOCAL VAR num nVisits:=0;

  FUNC station StationOf(num nNumber)
    VAR station stFound;

    TEST nNumber
    CASE 1:
      stFound:=["left",pLeft,2];
    CASE 2:
      stFound:=["right",pRight,1];
    DEFAULT:
      RAISE ERR_ARGVALERR;
    ENDTEST
    RETURN stFound;
  ENDFUNC

  PROC Work1(station stHere)
    Incr nVisits;
    PulseDO\High\PLength:=0.2,doStamp;
    WaitTime 0.5;
  ENDPROC

  PROC Work2(station stHere)
    Incr nVisits;
    SetDO doScrew,1;
    WaitTime 0.5;
    SetDO doScrew,0;
  ENDPROC

  FUNC num Visits()
    RETURN nVisits;
  ENDFUNC
ENDMODULE
