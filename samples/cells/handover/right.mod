MODULE Right
  ! Takes boxes out of the nest and sets them down in a row.
  PERS tooldata Gripper:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
  CONST jointtarget Home:=[[40,0,0,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget Nest:=[[600,0,90],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget Row:=[[400,250,40],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  PROC main()
    ConfJ\Off;
    ConfL\Off;
    Reset doGrip;
    MoveAbsJ Home,v500,fine,Gripper;
    Set doAway;
    FOR i FROM 0 TO 2 DO
      WaitDI diThere,1;
      Reset doAway;
      MoveJ Offs(Nest,0,0,110),v500,z10,Gripper;
      MoveL Nest,v200,fine,Gripper;
      Set doGrip;
      WaitDI diHeld,1;
      MoveL Offs(Nest,0,0,110),v100,z10,Gripper;
      MoveJ Offs(Row,0,i*100,160),v500,fine,Gripper;
      WaitDI diThere,0;
      Set doAway;
      MoveL Offs(Row,0,i*100,0),v200,fine,Gripper;
      Reset doGrip;
      WaitDI diHeld,0;
      MoveL Offs(Row,0,i*100,160),v500,z10,Gripper;
    ENDFOR
    MoveAbsJ Home,v500,fine,Gripper;
  ENDPROC
ENDMODULE
