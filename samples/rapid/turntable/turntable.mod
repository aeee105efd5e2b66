MODULE turntable
  ! A seam on a part that a turn-table turns under the tool: the work object stands on the mechanical unit.
  ! Expected: do1 to do3 come on, each when the tool is where it must be.
  TASK PERS tooldata pin:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata plate:=[FALSE,FALSE,"EASYS",[[0,0,0],[1,0,0,0]],[[0,0,50],[1,0,0,0]]];
  CONST robtarget first:=[[60,0,400],[0,0,1,0],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget turned:=[[60,0,400],[0,0,1,0],[0,0,0,0],[30,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget via:=[[0,60,400],[0,0,1,0],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget last:=[[-60,0,400],[0,0,1,0],[0,0,0,0],[-30,9E9,9E9,9E9,9E9,9E9]];
  VAR robtarget here;

  PROC main()
    ConfL\Off;
    MoveAbsJ [[0,0,0,0,90,0],[0,9E9,9E9,9E9,9E9,9E9]],v200,fine,pin;
    MoveL first,v200,fine,pin\WObj:=plate;
    ! the table turns by 30 degrees, the tool stays on its point of the part
    MoveL turned,v200,fine,pin\WObj:=plate;
    here:=CRobT(\Tool:=pin\WObj:=plate);
    IF Abs(here.trans.x-60)<0.01 SetDO do1,1;
    ! half a circle on the part while the table turns back
    MoveC via,last,v200,fine,pin\WObj:=plate;
    here:=CRobT(\Tool:=pin\WObj:=plate);
    IF Abs(here.trans.x+60)<0.01 SetDO do2,1;
    ! seen from the room: 700-60*cos(-30), -60*sin(-30)
    here:=CRobT(\Tool:=pin\WObj:=wobj0);
    IF Abs(here.trans.x-648.038)<0.01 AND Abs(here.trans.y-30)<0.01 SetDO do3,1;
  ENDPROC
ENDMODULE
