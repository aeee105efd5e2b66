MODULE BinSearch
  ! Feels downwards for the topmost part of a bin and grips it there. A light curtain counts in a trap meanwhile.
  ! Expected: the touch comes in the middle of the search, the part is gripped a little above the found height;
  ! the curtain is broken once, which switches the lamp on; the arm ends above the bin.

  VAR intnum inCurtain;
  VAR num nBroken:=0;
  PERS tooldata tFinger:=[TRUE,[[0,0,100],[1,0,0,0]],[0.5,[0,0,40],[1,0,0,0],0,0,0]];
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pAbove:=[[350,100,250],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR robtarget pFound;

  PROC main()
    IDelete inCurtain;
    CONNECT inCurtain WITH CurtainBroken;
    ISignalDI diCurtain,1,inCurtain;
    MoveAbsJ jHome,v1000,fine,tFinger;
    MoveJ pAbove,v500,fine,tFinger;
    Feel;
    MoveL pAbove,v200,fine,tFinger;
    WaitUntil nBroken>0;
    IDelete inCurtain;
    Set doDone;
  ENDPROC

  PROC Feel()
    SearchL\Stop,diTouch,pFound,Offs(pAbove,0,0,-150),v20,tFinger;
    IF pFound.trans.z<245 AND pFound.trans.z>105 Set doFound;
    MoveL Offs(pFound,0,0,2),v50,fine,tFinger;
    Set doGrip;
    WaitTime 0.3;
  ERROR
    IF ERRNO=ERR_WHLSEARCH THEN
      Set doEmpty;
      RETURN;
    ENDIF
    RAISE;
  ENDPROC

  TRAP CurtainBroken
    Incr nBroken;
    Set doLamp;
  ENDTRAP
ENDMODULE
