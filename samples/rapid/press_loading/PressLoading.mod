MODULE PressLoading
  ! Five blanks from the rack through the press
  PERS tooldata tGripper:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wobjRack:=[FALSE,TRUE,"",[[500,-250,50],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wobjPress:=[FALSE,TRUE,"",[[650,200,100],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wobjOutfeed:=[FALSE,TRUE,"",[[100,-450,20],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pRackFloor:=[[0,0,40],[0,0.707107,0.707107,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBeforeColumn:=[[-150,-300,250],[0,0.707107,0.707107,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBehindColumn:=[[-200,-150,250],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pFront:=[[-150,0,200],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pDie:=[[0,0,50],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pCrate:=[[0,0,60],[0,0.707107,0.707107,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pTable:=[[150,0,60],[0,0.707107,0.707107,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num nLevels:=5;
  CONST num nMaxTries:=3;
  CONST num nEvery:=3;
  CONST num nPitch:=30;
  CONST num nBack:=50;
  CONST num nClear:=100;
  PERS num nGoods:=0;

  PROC main()
    rPrepare;
    ! From the top of the rack down
    FOR level FROM nLevels TO 1 STEP -1 DO
      rPickBlank level;
      IF diVacuumOk=1 THEN
        rLoadPress;
        rUnloadPress;
        rPutAway;
      ENDIF
    ENDFOR
    MoveAbsJ jHome,v1000,fine,tGripper;
  ENDPROC

  ! Outputs off, no parts yet
  PROC rPrepare()
    Reset doVacuum;
    Reset doStartPress;
    Reset doNoPart;
    Reset doInspect;
    nGoods:=0;
    MoveAbsJ jHome,v1000,fine,tGripper;
  ENDPROC

  ! Blank of one level, three tries
  PROC rPickBlank(num level)
    VAR robtarget pBlank;
    VAR num nTries:=0;
    pBlank:=Offs(pRackFloor,0,0,level*nPitch);
    MoveJ Offs(pBlank,0,0,nClear),v1000,fine,tGripper\WObj:=wobjRack;
    WaitDI diRackThere,1;
    WHILE diVacuumOk=0 AND nTries<nMaxTries DO
      MoveL pBlank,v200,fine,tGripper\WObj:=wobjRack;
      Set doVacuum;
      WaitTime 0.3;
      Incr nTries;
      IF diVacuumOk=0 THEN
        Reset doVacuum;
        MoveL RelTool(pBlank,0,0,-nBack),v200,fine,tGripper\WObj:=wobjRack;
        WaitTime 0.3;
      ENDIF
    ENDWHILE
    IF diVacuumOk=0 PulseDO\PLength:=0.5,doNoPart;
    MoveL Offs(pBlank,0,0,nClear),v500,fine,tGripper\WObj:=wobjRack;
  ENDPROC

  ! Round the column into the die, press started
  PROC rLoadPress()
    MoveL pBeforeColumn,v500,z50,tGripper\WObj:=wobjPress;
    MoveL pBehindColumn,v500,z50,tGripper\WObj:=wobjPress;
    MoveL pFront,v500,fine,tGripper\WObj:=wobjPress;
    WaitDI diPressOpen,1;
    MoveL Offs(pDie,0,0,nClear),v500,z50,tGripper\WObj:=wobjPress;
    MoveL pDie,v200,fine,tGripper\WObj:=wobjPress;
    Reset doVacuum;
    WaitTime 0.3;
    MoveL Offs(pDie,0,0,nClear),v500,z50,tGripper\WObj:=wobjPress;
    MoveL pFront,v500,fine,tGripper\WObj:=wobjPress;
    PulseDO\PLength:=0.5,doStartPress;
    WaitDI diPressOpen,0;
  ENDPROC

  ! Waits in front for the pressed part
  PROC rUnloadPress()
    WaitDI diPressDone,1;
    MoveL Offs(pDie,0,0,nClear),v500,z50,tGripper\WObj:=wobjPress;
    MoveL pDie,v200,fine,tGripper\WObj:=wobjPress;
    Set doVacuum;
    WaitDI diVacuumOk,1;
    MoveL Offs(pDie,0,0,nClear),v500,z50,tGripper\WObj:=wobjPress;
    MoveL pFront,v500,z50,tGripper\WObj:=wobjPress;
    MoveL pBehindColumn,v500,z50,tGripper\WObj:=wobjPress;
    MoveL pBeforeColumn,v500,z50,tGripper\WObj:=wobjPress;
  ENDPROC

  ! Every third part is inspected
  PROC rPutAway()
    Incr nGoods;
    IF nGoods MOD nEvery=0 THEN
      rToTable;
    ELSE
      rToCrate;
    ENDIF
  ENDPROC

  ! Into the crate
  PROC rToCrate()
    MoveJ Offs(pCrate,0,0,nClear),v1000,z50,tGripper\WObj:=wobjOutfeed;
    MoveL pCrate,v200,fine,tGripper\WObj:=wobjOutfeed;
    Reset doVacuum;
    WaitTime 0.3;
    MoveL Offs(pCrate,0,0,nClear),v500,z50,tGripper\WObj:=wobjOutfeed;
  ENDPROC

  ! Onto the inspection table
  PROC rToTable()
    MoveJ Offs(pTable,0,0,nClear),v1000,z50,tGripper\WObj:=wobjOutfeed;
    MoveL pTable,v200,fine,tGripper\WObj:=wobjOutfeed;
    Reset doVacuum;
    WaitTime 0.3;
    PulseDO\PLength:=0.5,doInspect;
    MoveL Offs(pTable,0,0,nClear),v500,z50,tGripper\WObj:=wobjOutfeed;
  ENDPROC
ENDMODULE
