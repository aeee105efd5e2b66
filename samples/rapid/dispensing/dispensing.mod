MODULE Dispensing
  ! Lays a bead of glue along a line, half a circle and a line back, on a board turned in the room.
  ! Expected: the gun opens 10 mm behind the start of the first line and closes 15 mm before the end of the last;
  ! the valve for the flushing position opens in the middle of the corner there; the arm ends above the board.

  VAR triggdata tdOpen;
  VAR triggdata tdClose;
  PERS tooldata tGun:=[TRUE,[[0,0,100],[1,0,0,0]],[0.6,[0,0,40],[1,0,0,0],0,0,0]];
  PERS wobjdata wBoard:=[FALSE,TRUE,"",[[300,-80,100],[0.991444861,0,0,0.130526192]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pStart:=[[0,0,0],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBend:=[[80,0,0],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pTop:=[[120,40,0],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBack:=[[80,80,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pEnd:=[[0,80,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  PROC main()
    ConfL\Off;
    TriggIO tdOpen,10\Start\DOp:=doGun,1;
    TriggIO tdClose,15\DOp:=doGun,0;
    MoveAbsJ jHome,v500,fine,tGun;
    MoveJ Offs(pStart,0,0,60),v500,z10,tGun\WObj:=wBoard;
    MoveL pStart,v100,fine,tGun\WObj:=wBoard;
    TriggL pBend,v100,tdOpen,z5,tGun\WObj:=wBoard;
    MoveC pTop,pBack,v100,z5,tGun\WObj:=wBoard;
    TriggL pEnd,v100,tdClose,fine,tGun\WObj:=wBoard;
    MoveLDO Offs(pEnd,0,0,60),v200,z20,tGun\WObj:=wBoard,doFlush,1;
    MoveL Offs(pStart,0,0,60),v200,fine,tGun\WObj:=wBoard;
    Reset doFlush;
  ENDPROC
ENDMODULE
