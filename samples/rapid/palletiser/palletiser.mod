MODULE Palletiser
  ! Stacks boxes from an infeed onto a pallet of columns x rows x layers places, layer by layer.
  ! When the pallet is full, doFull tells the operator for one second and an empty pallet is begun.
  ! Expected: nine boxes move, the pallet is full once after the eighth, doReady is on at the end, the arm is home.

  CONST num COLUMNS:=2;
  CONST num ROWS:=2;
  CONST num LAYERS:=2;
  CONST num PARTS:=9;
  CONST pos BOX:=[80,80,40];

  PERS tooldata tVacuum:=[TRUE,[[0,0,100],[1,0,0,0]],[0.8,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wPallet:=[FALSE,TRUE,"",[[250,100,60],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pInfeed:=[[300,-200,120],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pCorner:=[[0,0,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  PROC main()
    VAR num nPlace:=0;

    Reset doGrip;
    Reset doFull;
    Reset doReady;
    MoveAbsJ jHome,v1000,fine,tVacuum;
    FOR nPart FROM 1 TO PARTS DO
      PickBox;
      PlaceBox nPlace;
      Incr nPlace;
      IF nPlace=COLUMNS*ROWS*LAYERS THEN
        ! the operator takes the full pallet away
        MoveAbsJ jHome,v1000,fine,tVacuum;
        SetDO doFull,1;
        WaitTime 1;
        SetDO doFull,0;
        nPlace:=0;
      ENDIF
    ENDFOR
    MoveAbsJ jHome,v1000,fine,tVacuum;
    Set doReady;
  ENDPROC

  ! Takes one box from the infeed with the vacuum gripper.
  PROC PickBox()
    MoveJ Offs(pInfeed,0,0,100),v800,z20,tVacuum;
    MoveL pInfeed,v200,fine,tVacuum;
    Set doGrip;
    WaitTime 0.2;
    MoveL Offs(pInfeed,0,0,100),v400,z20,tVacuum;
  ENDPROC

  ! Puts the box down at a place of the pallet, counted from 0.
  PROC PlaceBox(num nPlace)
    VAR num nLayer;
    VAR num nRest;
    VAR robtarget pSpot;

    nLayer:=nPlace DIV (COLUMNS*ROWS);
    nRest:=nPlace MOD (COLUMNS*ROWS);
    pSpot:=Offs(pCorner,(nRest MOD COLUMNS)*BOX.x,(nRest DIV COLUMNS)*BOX.y,nLayer*BOX.z);
    MoveJ Offs(pSpot,0,0,90),v800,z20,tVacuum\WObj:=wPallet;
    MoveL pSpot,v200,fine,tVacuum\WObj:=wPallet;
    Reset doGrip;
    WaitTime 0.2;
    MoveL Offs(pSpot,0,0,90),v400,z20,tVacuum\WObj:=wPallet;
  ENDPROC
ENDMODULE
