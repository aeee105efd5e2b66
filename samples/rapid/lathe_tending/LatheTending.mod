MODULE LatheTending
  ! Three blanks through one lathe
  PERS tooldata tFingers:=[TRUE,[[0,0,130],[1,0,0,0]],[2.5,[0,0,65],[1,0,0,0],0,0,0]];
  PERS wobjdata wobjTray:=[FALSE,TRUE,"",[[450,-300,50],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wobjLathe:=[FALSE,TRUE,"",[[700,250,100],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBlank:=[[0,0,40],[0,0.707107,0.707107,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pFinished:=[[0,180,40],[0,0.707107,0.707107,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pGate:=[[-150,0,300],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pChuck:=[[0,0,50],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num nBlanks:=3;
  CONST num nAbove:=100;
  PERS num nTurned:=0;

  PROC main()
    rGetReady;
    FOR blank FROM 1 TO nBlanks DO
      rTakeBlank;
      rFillChuck;
      rEmptyChuck;
      rPutDown;
      Incr nTurned;
    ENDFOR
    MoveAbsJ jHome,v1000,fine,tFingers;
  ENDPROC

  ! Fingers and chuck open, arm home
  PROC rGetReady()
    Reset doCloseFingers;
    Reset doCloseChuck;
    nTurned:=0;
    MoveAbsJ jHome,v1000,fine,tFingers;
  ENDPROC

  ! Blank from the tray
  PROC rTakeBlank()
    MoveJ Offs(pBlank,0,0,nAbove),v1000,fine,tFingers\WObj:=wobjTray;
    WaitDI diBlankHere,1;
    MoveL pBlank,v200,fine,tFingers\WObj:=wobjTray;
    rFingersClose;
    MoveL Offs(pBlank,0,0,nAbove),v500,z50,tFingers\WObj:=wobjTray;
  ENDPROC

  ! Blank into the chuck, lathe started
  PROC rFillChuck()
    MoveJ pGate,v1000,fine,tFingers\WObj:=wobjLathe;
    WaitDI diLatheReady,1;
    WaitDI diGateOpen,1;
    MoveL Offs(pChuck,0,0,nAbove),v500,z50,tFingers\WObj:=wobjLathe;
    MoveL pChuck,v200,fine,tFingers\WObj:=wobjLathe;
    Set doCloseChuck;
    WaitTime 0.4;
    rFingersOpen;
    MoveL Offs(pChuck,0,0,nAbove),v500,z50,tFingers\WObj:=wobjLathe;
    MoveL pGate,v500,fine,tFingers\WObj:=wobjLathe;
    PulseDO\PLength:=0.5,doStartLathe;
    WaitDI diLatheReady,0;
  ENDPROC

  ! Waits at the gate for the turned part
  PROC rEmptyChuck()
    WaitDI diLatheReady,1;
    WaitDI diGateOpen,1;
    MoveL Offs(pChuck,0,0,nAbove),v500,z50,tFingers\WObj:=wobjLathe;
    MoveL pChuck,v200,fine,tFingers\WObj:=wobjLathe;
    rFingersClose;
    Reset doCloseChuck;
    WaitTime 0.4;
    MoveL Offs(pChuck,0,0,nAbove),v500,z50,tFingers\WObj:=wobjLathe;
    MoveL pGate,v500,z50,tFingers\WObj:=wobjLathe;
  ENDPROC

  ! Turned part onto the tray
  PROC rPutDown()
    MoveJ Offs(pFinished,0,0,nAbove),v1000,z50,tFingers\WObj:=wobjTray;
    MoveL pFinished,v200,fine,tFingers\WObj:=wobjTray;
    rFingersOpen;
    MoveL Offs(pFinished,0,0,nAbove),v500,z50,tFingers\WObj:=wobjTray;
  ENDPROC

  PROC rFingersOpen()
    Reset doCloseFingers;
    WaitTime 0.3;
  ENDPROC

  ! 1.5 s for the part between the fingers
  PROC rFingersClose()
    Set doCloseFingers;
    WaitDI diPartHeld,1\MaxTime:=1.5;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      TPWrite "Nothing between the fingers";
      Stop;
      RETRY;
    ENDIF
  ENDPROC
ENDMODULE
