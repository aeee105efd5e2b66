MODULE BondMove
  ! Bead, lids, press and chute. do21 gun, do22 gripper, do23 press, do24 chute, do25 cell on, do26 platen heating,
  ! do27 purge; di1 press open, di2 adhesive low, di3 platen hot, di4 press closed, di6 pressure, di7 part in the chute.
  VAR clock ckBead;
  VAR clock ckGun;
  VAR clock ckOpen;
  VAR speeddata vBead:=[50,500,5000,1000];
  VAR robtarget pLastLid;
  VAR robtarget pDropped;
  VAR num nLid:=0;
  VAR num nRetries:=0;

  FUNC robtarget OnArc(num x,num y,num r,num angle)
    RETURN Offs(pFixture,x+r*Cos(angle),y+r*Sin(angle),0);
  ENDFUNC

  ! One quarter circle from the angle given, to the left.
  PROC Corner(num x,num y,num r,num angle)
    MoveC OnArc(x,y,r,angle+45),OnArc(x,y,r,angle+90),vBead,z1,tGun\WObj:=wFixture;
  ENDPROC

  ! The gun opens at the start of the contour and closes 10 mm before its end.
  PROC Bead(variant v)
    VAR triggdata tgOn;
    VAR triggdata tgOff;
    VAR robtarget pStart;
    VAR num r;
    r:=v.radius;
    vBead.v_tcp:=v.speed;
    TriggIO tgOn,0\Start\DOp:=do21,1;
    TriggIO tgOff,10\DOp:=do21,0;
    pStart:=Offs(pFixture,r,0,0);
    MoveJ RelTool(pStart,0,0,-50),v1000,z20,tGun\WObj:=wFixture;
    MoveL pStart,v200,fine,tGun\WObj:=wFixture;
    ClkReset ckGun;
    ClkReset ckBead;
    ClkStart ckBead;
    TriggL Offs(pFixture,v.length-r,0,0),vBead,tgOn,z1,tGun\WObj:=wFixture;
    Corner v.length-r,r,r,-90;
    MoveL Offs(pFixture,v.length,v.width-r,0),vBead,z1,tGun\WObj:=wFixture;
    Corner v.length-r,v.width-r,r,0;
    MoveL Offs(pFixture,r,v.width,0),vBead,z1,tGun\WObj:=wFixture;
    Corner r,v.width-r,r,90;
    MoveL Offs(pFixture,0,r,0),vBead,z1,tGun\WObj:=wFixture;
    TriggC OnArc(r,r,r,225),OnArc(r,r,r,270),vBead,tgOff,fine,tGun\WObj:=wFixture;
    ClkStop ckBead;
    ! from here the adhesive begins to dry
    ClkReset ckOpen;
    ClkStart ckOpen;
  ENDPROC

  ! Lids lie in two columns, 70 mm apart, the rows 55 mm.
  PROC FetchLid()
    VAR robtarget pNest;
    Incr nLid;
    pNest:=Offs(pLid,70*((nLid-1) MOD 2),55*((nLid-1) DIV 2),0);
    MoveJ Offs(pNest,0,0,80),v1000,z50,tGrip\WObj:=wLids;
    MoveL pNest,v300,fine,tGrip\WObj:=wLids;
    SetDO do22,1;
    WaitTime 0.2;
    pLastLid:=CRobT(\Tool:=tGun\WObj:=wobj0);
    MoveL Offs(pNest,0,0,80),v500,z20,tGrip\WObj:=wLids;
  ENDPROC

  ! Joins the lid and presses; the time since the bead and the time under the press come back.
  PROC PressPart(variant v,INOUT num tOpen,INOUT num tPress)
    VAR clock ckPress;
    VAR robtarget pJoin;
    pJoin:=Offs(pFixture,v.length/2,v.width/2,5);
    MoveJ Offs(pJoin,0,0,100),v1000,z50,tGrip\WObj:=wFixture;
    MoveL pJoin,v200,fine,tGrip\WObj:=wFixture;
    IF v.heated SetDO do26,1;
    WaitUntil di1=1 AND (NOT v.heated OR di3=1);
    ClkStop ckOpen;
    tOpen:=ClkRead(ckOpen);
    SetDO do22,0;
    MoveL RelTool(pJoin,0,0,-120),v500,fine,tGrip\WObj:=wFixture;
    SetDO do23,1;
    WaitDI di4,1\MaxTime:=2;
    ClkStart ckPress;
    WaitTime v.pressTime;
    ClkStop ckPress;
    tPress:=ClkRead(ckPress);
    SetDO do23,0;
    WaitDI di4,0\MaxTime:=2;
  ENDPROC

  PROC RejectPart(INOUT bool bLate)
    MoveJ Offs(pChute,0,0,60),v1000,z50,tGrip;
    MoveL pChute,v300,fine,tGrip;
    PulseDO\PLength:=0.3,do24;
    WaitDI di7,1\MaxTime:=2\TimeFlag:=bLate;
    pDropped:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    MoveL Offs(pChute,0,0,60),v500,z20,tGrip;
  ENDPROC

  ! Waits for adhesive pressure; after the second failure the line is purged.
  PROC WaitPressure()
    WaitDI di6,1\MaxTime:=1;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME AND nRetries<4 THEN
      Incr nRetries;
      IF nRetries=2 SetDO do27,1;
      RETRY;
    ENDIF
  ENDPROC
ENDMODULE
