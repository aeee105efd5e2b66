MODULE Process
  CONST jointtarget jHome:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p1:=[[500,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p2:=[[500,200,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST errnum ERR_NO_PART:=11;
  CONST errnum ERR_BAD_CODE:=12;
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1.5,[0,0,60],[1,0,0,0],0,0,0]];
  PERS num nAlarms:=0;
  PERS num nParts:=0;
  VAR intnum iStop;
  VAR intnum iCount;
  VAR intnum iTick;
  VAR num nEdges:=0;
  VAR num nTicks:=0;
  VAR num nTry:=0;
  VAR bool bStopped:=FALSE;
  VAR robtarget pStopped;
  VAR triggdata tdGlue;
  VAR triggdata tdOff;
  VAR clock ck;

  PROC main()
    VAR bool bTimedOut;
    VAR robtarget pFound;
    VAR num n;
    VAR num code;
    MoveAbsJ jHome,v500,fine,tGrip;
    Reset do31;
    Reset do32;
    SetGO go1,0;

    ! 1 handshake: the request is answered
    SetDO do31,1;
    WaitDI di1,1;
    SetDO do31,0;
    WaitDI di1,0;
    SetDO do1,1;

    ! 2 a wait that ends by its time
    ClkReset ck;
    ClkStart ck;
    WaitDI di9,1\MaxTime:=0.5\TimeFlag:=bTimedOut;
    ClkStop ck;
    IF bTimedOut AND ClkRead(ck)>0.45 AND ClkRead(ck)<0.7 SetDO do2,1;

    ! 3 a wait that is fulfilled in its time
    SetDO do32,1;
    WaitUntil di2=1 AND di9=0\MaxTime:=3\TimeFlag:=bTimedOut;
    IF NOT bTimedOut SetDO do3,1;
    SetDO do32,0;

    ! 4 a timeout as error, handled and left
    nAlarms:=0;
    WaitForPart;
    IF nAlarms=1 SetDO do4,1;

    ! 5 again and again until it works
    nTry:=0;
    Stubborn;
    IF nTry=3 SetDO do5,1;

    ! 6 the instruction behind the failing one goes on
    n:=Quotient(10,0);
    IF n=-1 AND Quotient(10,4)=2.5 SetDO do6,1;

    ! 7 an error of its own handed up
    code:=0;
    n:=CheckCode(7);
    IF n=0 AND CheckCode(3)=12 SetDO do7,1;

    ! 8 pulses come back as edges
    CONNECT iCount WITH tEdge;
    ISignalDI di3,1,iCount;
    FOR k FROM 1 TO 3 DO
      PulseDO\PLength:=0.2,do33;
      WaitTime 0.6;
    ENDFOR
    IF nEdges=3 SetDO do8,1;

    ! 9 not while it sleeps
    ISleep iCount;
    PulseDO\PLength:=0.2,do33;
    WaitTime 0.6;
    IWatch iCount;
    IF nEdges=3 SetDO do9,1;

    ! 10 again when it is awake, and no more when deleted
    PulseDO\PLength:=0.2,do33;
    WaitTime 0.6;
    IDelete iCount;
    PulseDO\PLength:=0.2,do33;
    WaitTime 0.6;
    IF nEdges=4 SetDO do10,1;

    ! 11 a clock that ticks
    CONNECT iTick WITH tTick;
    ITimer 0.5,iTick;
    WaitTime 1.8;
    IDelete iTick;
    IF nTicks=3 SetDO do11,1;

    ! 12 events on the path
    TriggIO tdGlue,50\Start\DOp:=do34,1;
    TriggIO tdOff,50\DOp:=do34,0;
    MoveL p1,v300,fine,tGrip;
    ClkReset ck;
    ClkStart ck;
    CONNECT iStop WITH tGlue;
    ISignalDO do34,0,iStop;
    TriggL p2,v100,tdGlue\T2:=tdOff,fine,tGrip;
    IDelete iStop;
    IF bStopped AND pStopped.trans.y>140 AND pStopped.trans.y<165 SetDO do12,1;

    ! 13 a search that finds: the world answers behind the start
    MoveL p1,v300,fine,tGrip;
    bStopped:=FALSE;
    SetDO do35,1;
    SearchL\Stop,di5,pFound,p2,v100,tGrip;
    SetDO do35,0;
    IF pFound.trans.y>40 AND pFound.trans.y<180 SetDO do13,1;

    ! 14 a search that does not find
    WaitTime 0.5;
    MoveL p1,v300,fine,tGrip;
    nAlarms:=0;
    SearchNothing;
    IF nAlarms=5 SetDO do14,1;

    ! 15 stopped and gone on by an interrupt
    MoveL p1,v300,fine,tGrip;
    bStopped:=FALSE;
    CONNECT iStop WITH tHold;
    ISignalDI\Single,di6,1,iStop;
    SetDO do36,1;
    ClkReset ck;
    ClkStart ck;
    MoveL p2,v100,fine,tGrip;
    ClkStop ck;
    SetDO do36,0;
    IDelete iStop;
    pFound:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    IF bStopped AND ClkRead(ck)>2.8 AND Abs(pFound.trans.y-200)<0.5 SetDO do15,1;

    ! 16 a group of outputs
    SetGO go1,9;
    IF GOutput(go1)=9 SetDO do16,1;
    SetGO go1,0;

    ! 17 outputs read back
    SetDO do37,1;
    InvertDO do38;
    IF DOutput(do37)=1 AND DOutput(do38)=1 AND do39=0 SetDO do17,1;

    ! 18 counters of a shift
    nParts:=0;
    WHILE nParts<5 DO
      Incr nParts;
      IF nParts=4 GOTO enough;
    ENDWHILE
  enough:
    IF nParts=4 SetDO do18,1;

    ! 19 an output with a delay
    SetDO\SDelay:=0.3,do40,1;
    IF DOutput(do40)=0 THEN
      WaitTime 0.5;
      IF DOutput(do40)=1 SetDO do19,1;
    ENDIF

    ! 20 a routine by its name
    n:=2;
    %"Job"+NumToStr(n,0)%;
    IF nAlarms=200 SetDO do20,1;

    ! 21 a switch in the middle of the corner
    MoveLDO p1,v200,z10,tGrip,do41,1;
    MoveL p2,v200,fine,tGrip;
    IF DOutput(do41)=1 SetDO do21,1;
    MoveAbsJ jHome,v500,fine,tGrip;
  ENDPROC

  PROC Job1()
    nAlarms:=100;
  ENDPROC

  PROC Job2()
    nAlarms:=200;
  ENDPROC

  PROC WaitForPart()
    WaitDI di9,1\MaxTime:=0.3;
    nAlarms:=100;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      Incr nAlarms;
      RETURN;
    ENDIF
  ENDPROC

  PROC Attempt()
    IF nTry<3 RAISE ERR_NO_PART;
  ENDPROC

  PROC Stubborn()
    Attempt;
  ERROR
    IF ERRNO=ERR_NO_PART THEN
      Incr nTry;
      RETRY;
    ENDIF
  ENDPROC

  FUNC num Quotient(num a,num b)
    VAR num q:=-1;
    q:=a/b;
    RETURN q;
  ERROR
    IF ERRNO=ERR_DIVZERO TRYNEXT;
  ENDFUNC

  FUNC num CheckCode(num c)
    Inspect c;
    RETURN 0;
  ERROR
    IF ERRNO=ERR_BAD_CODE RETURN ERR_BAD_CODE;
  ENDFUNC

  PROC Inspect(num c)
    IF c<5 RAISE ERR_BAD_CODE;
  ERROR
    RAISE;
  ENDPROC

  PROC SearchNothing()
    VAR robtarget pAny;
    SearchL\Stop,di9,pAny,Offs(p1,0,60,0),v100,tGrip;
    nAlarms:=50;
  ERROR
    IF ERRNO=ERR_WHLSEARCH THEN
      nAlarms:=nAlarms+5;
      StorePath;
      RestoPath;
      StartMove;
      RETURN;
    ENDIF
  ENDPROC

  TRAP tEdge
    Incr nEdges;
  ENDTRAP

  TRAP tTick
    Incr nTicks;
  ENDTRAP

  TRAP tGlue
    pStopped:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    bStopped:=TRUE;
  ENDTRAP

  TRAP tHold
    StopMove;
    bStopped:=TRUE;
    WaitTime 1;
    StartMove;
  ENDTRAP
ENDMODULE
