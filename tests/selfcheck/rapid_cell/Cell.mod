MODULE CellCheck
  ! Frames, moves, signals and interrupts. Output don becomes 1 when expectation n holds.
  PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[0.8,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wTable:=[FALSE,TRUE,"",[[350,0,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pPlace:=[[100,50,50],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pCorner:=[[100,-50,50],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR intnum iPart;
  VAR intnum iBeat;
  VAR num nSeen:=0;
  VAR num nBeats:=0;

  PROC main()
    VAR robtarget pNow;
    VAR robtarget pOld;
    VAR robtarget pFound;
    VAR jointtarget jNow;
    VAR pose peA;
    VAR pose peB;
    VAR pose peC;
    VAR pos v;
    VAR clock ck;
    VAR triggdata gun;
    VAR bool bLate;
    VAR num n;
    ConfL\Off;
    ! 1: PoseMult(a,b) is b seen from a
    peA:=[[100,50,0],OrientZYX(90,0,0)];
    peB:=[[10,0,5],[1,0,0,0]];
    peC:=PoseMult(peA,peB);
    IF Near(peC.trans,[100,60,5]) AND Abs(EulerZYX(\Z,peC.rot)-90)<0.001 SetDO do1,1;
    ! 2: the inverse; a vector through a frame
    peC:=PoseMult(PoseInv(peA),peC);
    v:=PoseVect(peA,[0,10,0]);
    IF Near(peC.trans,peB.trans) AND Near(v,[90,50,0]) SetDO do2,1;
    ! 3: axes
    MoveAbsJ jHome,v1000,fine,tPen;
    jNow:=CJointT();
    IF Abs(jNow.robax.rax_5-60)<0.01 AND Abs(jNow.robax.rax_1)<0.01 SetDO do3,1;
    ! 4: a point in the work object
    MoveJ Offs(pPlace,0,0,100),v500,fine,tPen\WObj:=wTable;
    pNow:=CRobT(\Tool:=tPen\WObj:=wTable);
    IF Near(pNow.trans,[100,50,150]) SetDO do4,1;
    ! 5: the configuration as programmed
    IF pNow.robconf.cfx=0 AND pNow.robconf.cf1=0 SetDO do5,1;
    ! 6: on behind a stop point
    MoveL pPlace,v200,fine,tPen\WObj:=wTable;
    Set do6;
    ! 7: RelTool in the tool's axes, x turned by the tool
    MoveL RelTool(pPlace,15,0,-40),v200,fine,tPen\WObj:=wTable;
    pNow:=CRobT(\Tool:=tPen\WObj:=wTable);
    IF Near(pNow.trans,[85,50,90]) SetDO do7,1;
    ! 8: one axis of the present joints
    jNow:=CJointT();
    n:=jNow.robax.rax_1;
    jNow.robax.rax_1:=n+8;
    MoveAbsJ jNow,v500,fine,tPen;
    jNow:=CJointT();
    IF Abs(jNow.robax.rax_1-n-8)<0.01 SetDO do8,1;
    ! 9: forward and inverse kinematics
    pNow:=CalcRobT(jHome,tPen\WObj:=wTable);
    jNow:=CalcJointT(pNow,tPen\WObj:=wTable);
    IF Abs(jNow.robax.rax_3)<0.01 AND Abs(jNow.robax.rax_5-60)<0.01 SetDO do9,1;
    ! 10: corners, then an arc
    MoveL pPlace,v300,z10,tPen\WObj:=wTable;
    MoveL pCorner,v300,z10,tPen\WObj:=wTable;
    MoveL Offs(pCorner,-40,-30,0),v300,fine,tPen\WObj:=wTable;
    MoveC Offs(pCorner,0,-70,0),Offs(pCorner,40,-30,0),v200,fine,tPen\WObj:=wTable;
    pNow:=CRobT(\Tool:=tPen\WObj:=wTable);
    IF Near(pNow.trans,[140,-80,50]) SetDO do10,1;
    ! 11: relative to where the robot is
    pOld:=CRobT(\Tool:=tPen\WObj:=wTable);
    MoveL Offs(pOld,0,20,30),v200,fine,tPen\WObj:=wTable;
    pNow:=CRobT(\Tool:=tPen\WObj:=wTable);
    IF Near(pNow.trans-pOld.trans,[0,20,30]) SetDO do11,1;
    ! 12: switched on the path, 30 mm before the end
    MoveL pCorner,v200,fine,tPen\WObj:=wTable;
    Reset do12;
    TriggIO gun,30\DOp:=do12,1;
    TriggL pPlace,v100,gun,fine,tPen\WObj:=wTable;
    ! 13: an output in the middle of a corner
    MoveLDO pCorner,v100,z10,tPen\WObj:=wTable,do13,1;
    MoveL Offs(pCorner,0,-30,0),v100,fine,tPen\WObj:=wTable;
    ! 14: an input that comes at 30 s
    WaitDI di1,1;
    SetDO do14,1;
    ! 15: one that never comes, with a limit
    ClkReset ck;
    ClkStart ck;
    WaitDI di2,1\MaxTime:=1.5\TimeFlag:=bLate;
    ClkStop ck;
    IF bLate AND ClkRead(ck)>1.45 AND ClkRead(ck)<1.75 SetDO do15,1;
    ! 16: the same as an error
    IF WaitFailed() SetDO do16,1;
    ! 17: a pulse ends by itself
    PulseDO\PLength:=0.4,do40;
    WaitTime 0.1;
    n:=DOutput(do40);
    WaitTime 0.5;
    IF n=1 AND DOutput(do40)=0 SetDO do17,1;
    ! 18: a trap counts (di3 comes at 40 s) while the move goes on to its end
    CONNECT iPart WITH tPart;
    ISignalDI di3,1,iPart;
    WaitDI di5,1;
    MoveL pPlace,v20,fine,tPen\WObj:=wTable;
    IDelete iPart;
    pNow:=CRobT(\Tool:=tPen\WObj:=wTable);
    IF nSeen=1 AND Near(pNow.trans,[100,50,50]) SetDO do18,1;
    ! 19: search; di4 comes at 45 s
    SearchL\Stop,di4,pFound,Offs(pPlace,0,-140,0),v20,tPen\WObj:=wTable;
    pNow:=CRobT(\Tool:=tPen\WObj:=wTable);
    IF pFound.trans.y<45 AND pFound.trans.y>-85 AND Abs(pNow.trans.y-pFound.trans.y)<1 AND Abs(pFound.trans.x-100)<0.1 SetDO do19,1;
    ! 20: an interrupt by time
    CONNECT iBeat WITH tBeat;
    ITimer 0.2,iBeat;
    WaitTime 1.1;
    IDelete iBeat;
    WaitTime 0.5;
    IF nBeats=5 SetDO do20,1;
    ! 21: a message with a value
    TPWrite "parts seen: "\Num:=nSeen;
    MoveAbsJ jHome,v1000,fine,tPen;
    SetDO do21,1;
  ENDPROC

  FUNC bool Near(pos a,pos b)
    RETURN Distance(a,b)<0.1;
  ENDFUNC

  FUNC bool WaitFailed()
    WaitUntil di2=1\MaxTime:=0.5;
    RETURN FALSE;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME RETURN TRUE;
    RAISE;
  ENDFUNC

  TRAP tPart
    Incr nSeen;
  ENDTRAP

  TRAP tBeat
    nBeats:=nBeats+1;
  ENDTRAP
ENDMODULE
