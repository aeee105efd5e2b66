MODULE Coating
  ! Paint strokes: corners with logic between, switches by distance and time, speeds changed on the way, probing, and a
  ! guard that holds the arm. do21 gun, do22 air, do23 fan, do24 stroke lamp, do25 probe on, do26 guard armed;
  ! di1 stroke seen, di2 surface, di3 guard open, di4 surface of the second probe. doN is on when expectation N holds.
  PERS tooldata tGun:=[TRUE,[[0,0,90],[1,0,0,0]],[1.2,[0,0,40],[1,0,0,0],0,0,0]];
  PERS wobjdata wPanel:=[FALSE,TRUE,"",[[420,-120,180],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,40,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pA:=[[0,0,60],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pB:=[[0,240,60],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pC:=[[80,240,60],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pD:=[[80,0,60],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST speeddata vStroke:=[250,200,5000,1000];
  VAR intnum iGuard;
  VAR intnum iMark;
  VAR triggdata tgOpen;
  VAR triggdata tgShut;
  VAR triggdata tgAir;
  VAR triggdata tgMark;
  VAR clock ckStroke;
  VAR num tFine:=0;
  VAR num tFly:=0;
  VAR num tSlow:=0;
  VAR num nHeld:=0;
  VAR num nMarks:=0;
  VAR num yMark:=0;
  VAR num nStrokes:=0;
  VAR bool bFound:=FALSE;
  VAR robtarget pFound;
  VAR robtarget pHeld;

  PROC main()
    ConfL\Off;
    MoveAbsJ jHome,v500,fine,tGun;
    Reset do21;
    Reset do22;
    Reset do23;
    Corners;
    Switches;
    Speeds;
    Probing;
    Guard;
    Strokes;
    MoveAbsJ jHome,v1000,fine,tGun;
  ENDPROC

  FUNC bool About(num a,num b,num tolerance)
    RETURN Abs(a-b)<=tolerance;
  ENDFUNC

  FUNC num Round3(robtarget p,num axis)
    IF axis=1 RETURN p.trans.x;
    IF axis=2 RETURN p.trans.y;
    RETURN p.trans.z;
  ENDFUNC

  ! The way round the panel with the zone given; the time it takes.
  FUNC num Way(zonedata z)
    VAR clock ck;
    MoveL pA,v300,fine,tGun\WObj:=wPanel;
    ClkReset ck;
    ClkStart ck;
    MoveL pB,vStroke,z,tGun\WObj:=wPanel;
    MoveL pC,vStroke,z,tGun\WObj:=wPanel;
    MoveL pD,vStroke,fine,tGun\WObj:=wPanel;
    ClkStop ck;
    RETURN ClkRead(ck);
  ENDFUNC

  PROC Corners()
    VAR num n:=0;
    VAR robtarget pNow;
    ! 1 corners are quicker than stops, and the end is reached all the same
    tFine:=Way(fine);
    tFly:=Way(z30);
    pNow:=CRobT(\Tool:=tGun\WObj:=wPanel);
    IF tFly<tFine-0.05 AND About(pNow.trans.x,80,0.1) AND About(pNow.trans.y,0,0.1) SetDO do1,1;
    ! 2 logic between corners runs in order
    MoveL pA,v300,z20,tGun\WObj:=wPanel;
    n:=n*10+1;
    MoveL pB,v300,z20,tGun\WObj:=wPanel;
    n:=n*10+2;
    IF n=12 THEN
      MoveL pC,v300,z20,tGun\WObj:=wPanel;
    ELSE
      MoveL pD,v300,z20,tGun\WObj:=wPanel;
    ENDIF
    n:=n*10+3;
    WaitRob\InPos;
    pNow:=CRobT(\Tool:=tGun\WObj:=wPanel);
    IF n=123 AND About(pNow.trans.x,80,0.1) AND About(pNow.trans.y,240,0.1) SetDO do2,1;
    ! 3 an output behind a corner is on before the next point: what answers to it comes under way
    Reset do24;
    MoveL pB,v300,fine,tGun\WObj:=wPanel;
    MoveL pA,v100,z10,tGun\WObj:=wPanel;
    SetDO do24,1;
    MoveL pD,v20,fine,tGun\WObj:=wPanel;
    IF di1=1 SetDO do3,1;
    SetDO do24,0;
    ! 4 an arc between two corners
    MoveL pA,v200,z10,tGun\WObj:=wPanel;
    MoveL Offs(pA,0,80,0),v200,z10,tGun\WObj:=wPanel;
    MoveC Offs(pA,40,120,0),Offs(pA,80,80,0),v100,z10,tGun\WObj:=wPanel;
    MoveL pD,v200,fine,tGun\WObj:=wPanel;
    pNow:=CRobT(\Tool:=tGun\WObj:=wPanel);
    IF About(pNow.trans.x,80,0.1) AND About(pNow.trans.y,0,0.1) SetDO do4,1;
  ENDPROC

  PROC Switches()
    VAR num y;
    TriggIO tgOpen,40\Start\DOp:=do21,1;
    TriggIO tgShut,40\DOp:=do21,0;
    TriggIO tgAir,0.2\Time\DOp:=do22,1;
    CONNECT iMark WITH tMark;
    TriggInt tgMark,100,iMark;
    MoveL pA,v300,fine,tGun\WObj:=wPanel;
    ! 5 a routine 100 mm before the end
    nMarks:=0;
    TriggL pB,v100,tgMark,fine,tGun\WObj:=wPanel;
    WaitTime 0.2;
    IF nMarks=1 AND About(yMark,140,6) SetDO do5,1;
    ! 6 on 40 mm behind the start, off 40 mm before the end, the time between at the stroke's speed
    MoveL pA,v300,fine,tGun\WObj:=wPanel;
    ClkReset ckStroke;
    SetDO do23,1;
    TriggL pB,v100,tgOpen\T2:=tgShut\T3:=tgAir,fine,tGun\WObj:=wPanel;
    SetDO do23,0;
    IF DOutput(do21)=0 AND DOutput(do22)=1 SetDO do6,1;
    Reset do22;
    ! 7 two strokes in one go, each with its own switches
    MoveL pA,v300,fine,tGun\WObj:=wPanel;
    TriggL pB,v100,tgOpen\T2:=tgShut,z10,tGun\WObj:=wPanel;
    MoveL pC,v200,z10,tGun\WObj:=wPanel;
    TriggL pD,v100,tgOpen\T2:=tgShut,fine,tGun\WObj:=wPanel;
    IF DOutput(do21)=0 SetDO do7,1;
    ! 8 switched in the middle of the corner
    MoveL pA,v200,fine,tGun\WObj:=wPanel;
    MoveLDO pB,v100,z20,tGun\WObj:=wPanel,do22,1;
    MoveLDO pC,v100,z20,tGun\WObj:=wPanel,do22,0;
    MoveL pD,v200,fine,tGun\WObj:=wPanel;
    IF DOutput(do22)=0 SetDO do8,1;
    IDelete iMark;
  ENDPROC

  PROC Speeds()
    VAR num t;
    ! 9 half the speed takes about twice the time
    tFine:=Way(fine);
    VelSet 50,5000;
    tSlow:=Way(fine);
    VelSet 100,5000;
    IF tSlow>tFine*1.6 AND tSlow<tFine*2.2 SetDO do9,1;
    ! 10 a limit that the stroke does not reach changes nothing
    VelSet 100,300;
    t:=Way(fine);
    VelSet 100,5000;
    IF About(t,tFine,0.1) SetDO do10,1;
    ! 11 a limit below the stroke's speed
    VelSet 100,100;
    t:=Way(fine);
    VelSet 100,5000;
    IF t>tFine*1.6 SetDO do11,1;
    ! 12 gentle ramps take longer
    MoveL pA,v300,fine,tGun\WObj:=wPanel;
    AccSet 20,100;
    ClkReset ckStroke;
    ClkStart ckStroke;
    MoveL pB,vStroke,fine,tGun\WObj:=wPanel;
    MoveL pC,vStroke,fine,tGun\WObj:=wPanel;
    MoveL pD,vStroke,fine,tGun\WObj:=wPanel;
    ClkStop ckStroke;
    AccSet 100,100;
    IF ClkRead(ckStroke)>tFine+0.1 SetDO do12,1;
    ! 13 a time instead of a speed
    MoveL pA,v300,fine,tGun\WObj:=wPanel;
    ClkReset ckStroke;
    ClkStart ckStroke;
    MoveL pB,v300\T:=3,fine,tGun\WObj:=wPanel;
    ClkStop ckStroke;
    IF About(ClkRead(ckStroke),3,0.3) SetDO do13,1;
  ENDPROC

  PROC Probing()
    VAR robtarget pNow;
    ! 14 down until the surface: quick stop, the point found is where the arm was
    MoveL Offs(pA,40,60,60),v300,fine,tGun\WObj:=wPanel;
    SetDO do25,1;
    SearchL\Stop,di2,pFound,Offs(pA,40,60,-60),v50,tGun\WObj:=wPanel;
    pNow:=CRobT(\Tool:=tGun\WObj:=wPanel);
    SetDO do25,0;
    IF pFound.trans.z<100 AND pFound.trans.z>40 AND pNow.trans.z<=pFound.trans.z+0.01 AND pNow.trans.z>pFound.trans.z-8 SetDO do14,1;
    ! 15 on the way back, without a stop
    WaitDI di2,0;
    MoveL Offs(pA,40,60,60),v300,fine,tGun\WObj:=wPanel;
    SetDO do25,1;
    SearchL di2,pFound,Offs(pA,40,60,-40),v50,tGun\WObj:=wPanel;
    SetDO do25,0;
    pNow:=CRobT(\Tool:=tGun\WObj:=wPanel);
    IF pFound.trans.z<100 AND pFound.trans.z>40 AND About(pNow.trans.z,20,0.1) SetDO do15,1;
    ! 16 nothing there
    WaitDI di2,0;
    bFound:=TRUE;
    Nothing;
    IF NOT bFound SetDO do16,1;
  ENDPROC

  PROC Nothing()
    MoveL Offs(pA,40,60,60),v300,fine,tGun\WObj:=wPanel;
    SearchL\Stop,di9,pFound,Offs(pA,40,60,20),v100,tGun\WObj:=wPanel;
  ERROR
    IF ERRNO=ERR_WHLSEARCH THEN
      bFound:=FALSE;
      StorePath;
      RestoPath;
      StartMove;
      TRYNEXT;
    ENDIF
  ENDPROC

  PROC Guard()
    VAR robtarget pNow;
    ! 17 held between two corners and gone on
    MoveL pA,v300,fine,tGun\WObj:=wPanel;
    CONNECT iGuard WITH tHold;
    ISignalDI di3,1,iGuard;
    ClkReset ckStroke;
    ClkStart ckStroke;
    SetDO do26,1;
    MoveL pB,v100,z20,tGun\WObj:=wPanel;
    MoveL pC,v100,z20,tGun\WObj:=wPanel;
    MoveL pD,v100,fine,tGun\WObj:=wPanel;
    ClkStop ckStroke;
    SetDO do26,0;
    pNow:=CRobT(\Tool:=tGun\WObj:=wPanel);
    IF nHeld=1 AND ClkRead(ckStroke)>6.5 AND About(pNow.trans.y,0,0.1) SetDO do17,1;
    ! 18 it was held on the first leg
    IF About(pHeld.trans.x,0,0.5) AND pHeld.trans.y>60 AND pHeld.trans.y<180 SetDO do18,1;
    IDelete iGuard;
  ENDPROC

  PROC Strokes()
    VAR num y;
    ! 19 a pattern of strokes there and back
    MoveL pA,v300,fine,tGun\WObj:=wPanel;
    FOR i FROM 0 TO 3 DO
      y:=240*(i MOD 2);
      IF i>0 MoveL Offs(pA,20*i,y,0),v300,z5,tGun\WObj:=wPanel;
      y:=240-y;
      TriggL Offs(pA,20*i,y,0),v300,tgOpen\T2:=tgShut,z5,tGun\WObj:=wPanel;
      Incr nStrokes;
    ENDFOR
    WaitRob\ZeroSpeed;
    pHeld:=CRobT(\Tool:=tGun\WObj:=wPanel);
    IF nStrokes=4 AND DOutput(do21)=0 AND About(pHeld.trans.x,60,0.1) AND About(pHeld.trans.y,0,0.1) SetDO do19,1;
    ! 20 from where the arm is
    MoveL RelTool(pHeld,0,0,-30),v200,z5,tGun\WObj:=wPanel;
    MoveL Offs(pHeld,-20,0,30),v200,fine,tGun\WObj:=wPanel;
    pFound:=CRobT(\Tool:=tGun\WObj:=wPanel);
    IF About(Round3(pFound,1),40,0.1) AND About(Round3(pFound,3),90,0.1) SetDO do20,1;
  ENDPROC

  TRAP tMark
    VAR robtarget pNow;
    pNow:=CRobT(\Tool:=tGun\WObj:=wPanel);
    yMark:=pNow.trans.y;
    Incr nMarks;
  ENDTRAP

  TRAP tHold
    StopMove;
    Incr nHeld;
    WaitTime 1;
    pHeld:=CRobT(\Tool:=tGun\WObj:=wPanel);
    StartMove;
  ENDTRAP
ENDMODULE
