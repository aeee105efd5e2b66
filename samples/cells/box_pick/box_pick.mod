MODULE box_pick
  ! Takes a box from the left half of the table to the right one. A gripper that holds nothing tries again, twice.
  PERS tooldata Gripper:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
  CONST jointtarget Home:=[[0,0,0,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget Pick:=[[450,-150,40],[0,1,0,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget Place:=[[450,150,40],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num MostTries:=3;

  PROC main()
    VAR num tries:=0;
    ConfJ\Off;
    ConfL\Off;
    Reset doGrip;
    MoveAbsJ Home,v500,fine,Gripper;
    MoveJ Offs(Pick,0,0,160),v500,z10,Gripper;
    REPEAT_GRIP:
    Incr tries;
    MoveL Pick,v200,fine,Gripper;
    Set doGrip;
    WaitTime 0.4;
    IF diHeld=0 THEN
      Reset doGrip;
      WaitTime 0.4;
      MoveL Offs(Pick,0,0,160),v500,fine,Gripper;
      IF tries<MostTries GOTO REPEAT_GRIP;
      Set doAlarm;
      MoveAbsJ Home,v500,fine,Gripper;
      Stop;
    ENDIF
    MoveL Offs(Pick,0,0,160),v500,z10,Gripper;
    MoveJ Offs(Place,0,0,160),v500,z10,Gripper;
    MoveL Place,v200,fine,Gripper;
    Reset doGrip;
    WaitTime 0.4;
    MoveL Offs(Place,0,0,160),v500,z10,Gripper;
    MoveAbsJ Home,v500,fine,Gripper;
  ENDPROC
ENDMODULE
