MODULE GaugeSorting
  ! Four parts gauged, good ones and rejects apart
  PERS tooldata tGrip:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wobjBelt:=[FALSE,TRUE,"",[[450,-350,100],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wobjTable:=[FALSE,TRUE,"",[[350,150,20],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBelt:=[[0,0,60],[0,0.707107,0.707107,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pGauge:=[[50,0,120],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pChute:=[[0,150,60],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBin:=[[150,150,60],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num nParts:=4;
  CONST num nBinSize:=2;
  CONST num nAbove:=100;
  PERS num nGoods:=0;
  PERS num nRejects:=0;

  PROC main()
    rPrepare;
    FOR part FROM 1 TO nParts DO
      rFetch;
      rGauge;
      IF diPartGood=1 THEN
        rPutGood;
      ELSE
        rPutReject;
      ENDIF
    ENDFOR
    MoveAbsJ jHome,v1000,fine,tGrip;
    ! Somebody empties the bin
    IF nRejects>=nBinSize Set doBinFull;
  ENDPROC

  ! Outputs off, both counters zero
  PROC rPrepare()
    Reset doCloseGrip;
    Reset doGauge;
    Reset doGoodOut;
    Reset doRejectOut;
    Reset doBinFull;
    nGoods:=0;
    nRejects:=0;
    MoveAbsJ jHome,v1000,fine,tGrip;
  ENDPROC

  ! Part from the end of the belt
  PROC rFetch()
    MoveJ Offs(pBelt,0,0,nAbove),v1000,fine,tGrip\WObj:=wobjBelt;
    WaitDI diPartHere,1;
    MoveL pBelt,v200,fine,tGrip\WObj:=wobjBelt;
    Set doCloseGrip;
    WaitTime 0.3;
    MoveL Offs(pBelt,0,0,nAbove),v500,z50,tGrip\WObj:=wobjBelt;
  ENDPROC

  ! Held in the gauge until it has measured
  PROC rGauge()
    MoveJ Offs(pGauge,0,0,nAbove),v1000,z50,tGrip\WObj:=wobjTable;
    MoveL pGauge,v200,fine,tGrip\WObj:=wobjTable;
    Set doGauge;
    WaitDI diGaugeDone,1;
    Reset doGauge;
    MoveL Offs(pGauge,0,0,nAbove),v500,fine,tGrip\WObj:=wobjTable;
  ENDPROC

  ! Onto the chute
  PROC rPutGood()
    MoveJ Offs(pChute,0,0,nAbove),v1000,z50,tGrip\WObj:=wobjTable;
    MoveL pChute,v200,fine,tGrip\WObj:=wobjTable;
    Reset doCloseGrip;
    WaitTime 0.3;
    MoveL Offs(pChute,0,0,nAbove),v500,fine,tGrip\WObj:=wobjTable;
    Set doGoodOut;
    WaitTime 0.2;
    Reset doGoodOut;
    Incr nGoods;
  ENDPROC

  ! Into the bin
  PROC rPutReject()
    MoveJ Offs(pBin,0,0,nAbove),v1000,z50,tGrip\WObj:=wobjTable;
    MoveL pBin,v200,fine,tGrip\WObj:=wobjTable;
    Reset doCloseGrip;
    WaitTime 0.3;
    MoveL Offs(pBin,0,0,nAbove),v500,fine,tGrip\WObj:=wobjTable;
    Set doRejectOut;
    WaitTime 0.2;
    Reset doRejectOut;
    Incr nRejects;
  ENDPROC
ENDMODULE
