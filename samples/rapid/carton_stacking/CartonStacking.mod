MODULE CartonStacking
  ! Eight cartons from the belt onto a stack
  ! 2 columns, 2 rows, 2 layers
  PERS tooldata tSucker:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wobjBelt:=[FALSE,TRUE,"",[[450,-350,100],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wobjStack:=[FALSE,TRUE,"",[[350,150,20],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBelt:=[[10,0,70],[0,0.707107,0.707107,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pCorner:=[[70,60,70],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num nColumns:=2;
  CONST num nRows:=2;
  CONST num nLayers:=2;
  CONST num nPitchX:=140;
  CONST num nPitchY:=120;
  CONST num nPitchZ:=70;
  CONST num nClear:=90;
  PERS num nCartons:=0;

  PROC main()
    rPrepare;
    FOR layer FROM 1 TO nLayers DO
      FOR row FROM 1 TO nRows DO
        FOR column FROM 1 TO nColumns DO
          rFetch;
          rStack column,row,layer;
          Incr nCartons;
        ENDFOR
      ENDFOR
    ENDFOR
    MoveAbsJ jHome,v1000,fine,tSucker;
    Set doStackFull;
  ENDPROC

  ! Outputs off, nothing counted yet
  PROC rPrepare()
    Reset doSuction;
    Reset doBlowOff;
    Reset doStackFull;
    nCartons:=0;
    MoveAbsJ jHome,v1000,fine,tSucker;
  ENDPROC

  ! Carton at the end of the belt
  PROC rFetch()
    MoveJ Offs(pBelt,0,0,nClear),v1000,fine,tSucker\WObj:=wobjBelt;
    WaitDI diCartonHere,1;
    MoveL pBelt,v200,fine,tSucker\WObj:=wobjBelt;
    Set doSuction;
    WaitDI diSuctionOk,1\MaxTime:=1.5;
    MoveL Offs(pBelt,0,0,nClear),v500,z50,tSucker\WObj:=wobjBelt;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      TPWrite "Carton not held";
      Stop;
      RETRY;
    ENDIF
  ENDPROC

  ! Place counted from the corner of the stack
  PROC rStack(num column,num row,num layer)
    VAR robtarget pPlace;
    pPlace:=Offs(pCorner,(column-1)*nPitchX,(row-1)*nPitchY,(layer-1)*nPitchZ);
    MoveJ Offs(pPlace,0,0,nClear),v1000,z50,tSucker\WObj:=wobjStack;
    MoveL pPlace,v200,fine,tSucker\WObj:=wobjStack;
    Reset doSuction;
    PulseDO\PLength:=0.2,doBlowOff;
    WaitTime 0.4;
    MoveL Offs(pPlace,0,0,nClear),v500,z50,tSucker\WObj:=wobjStack;
  ENDPROC
ENDMODULE
