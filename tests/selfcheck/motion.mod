MODULE motion
  ! End poses of moves with tool and work object; output don becomes 1 when expectation n holds.
  PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[0.5,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wBoard:=[FALSE,TRUE,"",[[350,0,100],[0.70710678,0,0,0.70710678]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jStart:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pCorner:=[[0,0,200],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    VAR robtarget now;
    VAR jointtarget j;
    ConfJ\Off;
    ConfL\Off;
    MoveAbsJ jStart,v1000,fine,tPen;
    j:=CJointT();
    IF Abs(j.robax.rax_5 - 30) < 0.01 SetDO do1,1;
    MoveJ pCorner,v500,fine,tPen\WObj:=wBoard;
    now:=CRobT(\Tool:=tPen\WObj:=wBoard);
    IF Abs(now.trans.x) < 0.05 AND Abs(now.trans.z - 200) < 0.05 SetDO do2,1;
    MoveL Offs(pCorner,80,0,0),v200,z10,tPen\WObj:=wBoard;
    MoveL Offs(pCorner,80,-60,0),v200,fine,tPen\WObj:=wBoard;
    now:=CRobT(\Tool:=tPen\WObj:=wBoard);
    IF Abs(now.trans.x - 80) < 0.05 AND Abs(now.trans.y + 60) < 0.05 SetDO do3,1;
    MoveC Offs(pCorner,40,-100,0),Offs(pCorner,0,-60,0),v100,fine,tPen\WObj:=wBoard;
    now:=CRobT(\Tool:=tPen\WObj:=wBoard);
    IF Abs(now.trans.x) < 0.05 AND Abs(now.trans.y + 60) < 0.05 SetDO do4,1;
    MoveL RelTool(pCorner,0,0,-30),v100,fine,tPen\WObj:=wBoard;
    now:=CRobT(\Tool:=tPen\WObj:=wBoard);
    IF Abs(now.trans.z - 230) < 0.05 SetDO do5,1;
    WaitTime 0.5;
    MoveAbsJ jStart,v1000,fine,tPen;
    SetDO do6,1;
  ENDPROC
ENDMODULE
