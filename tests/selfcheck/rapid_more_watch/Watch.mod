MODULE Watch
  ! Interrupts, waits, groups and pulses of a press cell. doN is on when expectation N holds.
  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[1.5,[0,0,60],[1,0,0,0],0,0,0]];
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pA:=[[420,-100,300],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pB:=[[420,120,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR intnum iHigh;
  VAR intnum iTick;
  VAR intnum iData;
  VAR intnum iOwn;
  VAR num nHigh:=0;
  VAR num nTick:=0;
  VAR num nData:=0;
  VAR num nOwn:=0;
  VAR num nTry:=0;
  VAR string sLog:="";
  PERS num nShared:=0;
  PERS bool bGo:=FALSE;
  VAR robtarget pHeld;
  VAR bool bLate;
  VAR num nStep:=0;

  PROC main()
    ConfL\Off;
    ConfJ\Off;
    MoveAbsJ jHome,v1000,fine,tGrip;
    Waits;
    Traps;
    Signals;
    Moves;
    Order;
  ENDPROC

  PROC Waits()
    VAR clock ck;
    VAR num t;
    ! 1 a time-out that is told, then one that is raised and mended
    SetDO do41,1;
    WaitDI di5,1\MaxTime:=0.3\TimeFlag:=bLate;
    IF bLate AND di5=0 SetDO do1,1;
    WaitDI di5,1;
    SetDO do41,0;
    ! 2 the handler switches what is waited for
    nTry:=0;
    ClkReset ck;
    ClkStart ck;
    Answer;
    ClkStop ck;
    t:=ClkRead(ck);
    IF nTry=1 AND t>1.3 AND t<1.7 SetDO do2,1;
    SetDO do42,0;
    WaitDI di6,0;
    ! 3 a wait for several things
    SetDO do41,1;
    SetDO do42,1;
    WaitUntil (di5=1 AND di6=1) OR di7=1;
    IF di5=1 AND di6=1 SetDO do3,1;
    SetDO do41,0;
    SetDO do42,0;
    WaitUntil di5=0 AND di6=0;
    ! 4 given up after two tries, the caller goes on
    nTry:=0;
    sLog:="";
    Never;
    IF nTry=2 AND sLog="gave up" SetDO do4,1;
  ENDPROC

  PROC Answer()
    WaitDI di6,1\MaxTime:=0.5;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME AND nTry=0 THEN
      nTry:=nTry+1;
      SetDO do42,1;
      WaitTime 0.5;
      RETRY;
    ENDIF
    RAISE;
  ENDPROC

  PROC Never()
    FOR i FROM 1 TO 5 DO
      WaitDI di7,1\MaxTime:=0.2;
    ENDFOR
    sLog:="done";
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      Incr nTry;
      IF nTry<2 TRYNEXT;
      sLog:="gave up";
      RETURN;
    ENDIF
  ENDPROC

  PROC Traps()
    ! 5 counted while the program waits
    CONNECT iHigh WITH tHigh;
    ISignalDI di5,1,iHigh;
    FOR i FROM 1 TO 3 DO
      SetDO do41,1;
      WaitTime 0.8;
      SetDO do41,0;
      WaitTime 0.3;
    ENDFOR
    IF nHigh=3 SetDO do5,1;
    ! 6 asleep, what comes is lost
    ISleep iHigh;
    SetDO do41,1;
    WaitTime 0.8;
    SetDO do41,0;
    WaitTime 0.3;
    IWatch iHigh;
    IF nHigh=3 SetDO do6,1;
    ! 7 held back, what comes is done later
    IDisable;
    SetDO do41,1;
    WaitTime 0.8;
    bLate:=nHigh=3;
    IEnable;
    WaitTime 0.1;
    SetDO do41,0;
    IF bLate AND nHigh=4 SetDO do7,1;
    IDelete iHigh;
    ! 8 a clock's beat, and its end in the trap
    CONNECT iTick WITH tTick;
    ITimer 0.3,iTick;
    WaitTime 2;
    IF nTick=4 SetDO do8,1;
    ! 9 a change of kept data
    nShared:=1;
    CONNECT iData WITH tData;
    IPers nShared,iData;
    nShared:=2;
    WaitTime 0.2;
    nShared:=2;
    WaitTime 0.2;
    nShared:=7;
    WaitTime 0.2;
    IDelete iData;
    nShared:=8;
    WaitTime 0.2;
    IF nData=9 SetDO do9,1;
    ! 10 an output of our own, once only
    CONNECT iOwn WITH tOwn;
    ISignalDO\Single,do43,0,iOwn;
    FOR i FROM 1 TO 3 DO
      SetDO do43,1;
      WaitTime 0.1;
      Reset do43;
      WaitTime 0.1;
    ENDFOR
    IDelete iOwn;
    IF nOwn=1 SetDO do10,1;
  ENDPROC

  TRAP tHigh
    nHigh:=nHigh+1;
  ENDTRAP

  TRAP tTick
    Incr nTick;
    IF nTick>=4 IDelete iTick;
  ENDTRAP

  TRAP tData
    nData:=nData+nShared;
  ENDTRAP

  TRAP tOwn
    nOwn:=nOwn+1;
  ENDTRAP

  PROC Signals()
    VAR num n;
    ! 11 a pulse runs on while the program does other things
    PulseDO\PLength:=0.4,do44;
    WaitTime 0.2;
    n:=DOutput(do44);
    WaitTime 0.4;
    IF n=1 AND DOutput(do44)=0 SetDO do11,1;
    ! 12 switched later, inverted, read back in a sum
    SetDO\SDelay:=0.4,do45,1;
    n:=DOutput(do45);
    WaitTime 0.6;
    InvertDO do46;
    n:=n*100+DOutput(do45)*10+DOutput(do46);
    InvertDO do45;
    IF n=11 AND do45=0 SetDO do12,1;
    ! 13 a truth on an output
    nStep:=7;
    SetDO do47,BoolNum(nStep>5);
    bLate:=DOutput(do47)=1 AND DOutput(do44)=0;
    IF bLate SetDO do13,1;
    SetDO do47,0;
  ENDPROC

  FUNC dionum BoolNum(bool b)
    IF b RETURN 1;
    RETURN 0;
  ENDFUNC

  PROC Moves()
    VAR robtarget p;
    VAR clock ck;
    VAR intnum iStop;
    ! 14 the move is held by a trap, goes on when the cause is gone
    MoveJ pA,v500,fine,tGrip;
    CONNECT iStop WITH tStop;
    ISignalDI di5,1,iStop;
    SetDO do41,1;
    ClkReset ck;
    ClkStart ck;
    MoveL pB,v200,fine,tGrip;
    ClkStop ck;
    IDelete iStop;
    SetDO do41,0;
    IF ClkRead(ck)>1.5 AND pHeld.trans.y>-20 AND pHeld.trans.y<60 SetDO do14,1;
    p:=CRobT(\Tool:=tGrip);
    ! 15 and it is where it should be
    IF Distance(p.trans,pB.trans)<0.1 SetDO do15,1;
    ! 16 the way is left in a trap that raises nothing: a flag is looked at between short moves
    WaitDI di5,0;
    nStep:=0;
    bGo:=TRUE;
    CONNECT iStop WITH tFlag;
    ISignalDI di5,1,iStop;
    SetDO do41,1;
    WHILE bGo AND nStep<20 DO
      Incr nStep;
      MoveL Offs(pB,0,-nStep*10,0),v100,z1,tGrip;
    ENDWHILE
    WaitRob\InPos;
    IDelete iStop;
    SetDO do41,0;
    IF nStep>3 AND nStep<12 SetDO do16,1;
  ENDPROC

  TRAP tStop
    StopMove;
    pHeld:=CRobT(\Tool:=tGrip);
    WaitTime 0.5;
    StartMove;
  ENDTRAP

  TRAP tFlag
    bGo:=FALSE;
  ENDTRAP

  PROC Order()
    ! 17 what is done in which order when a handler calls what raises
    sLog:="";
    First;
    IF sLog="1>2>a<2b<1" SetDO do17,1;
    ! 18 an error number of one's own, made in a loop
    sLog:="";
    FOR i FROM 1 TO 3 DO
      Picky i;
    ENDFOR
    IF sLog="12!3" SetDO do18,1;
  ENDPROC

  PROC First()
    sLog:=sLog+"1>";
    Second;
    sLog:=sLog+"b<1";
  ERROR
    sLog:=sLog+"?";
    TRYNEXT;
  ENDPROC

  PROC Second()
    VAR num n:=0;
    sLog:=sLog+"2>";
    n:=10 DIV n;
    sLog:=sLog+"<2";
  ERROR
    IF ERRNO=ERR_DIVZERO THEN
      sLog:=sLog+"a";
      TRYNEXT;
    ENDIF
  ENDPROC

  PROC Picky(num i)
    sLog:=sLog+NumToStr(i,0);
    IF i=2 RAISE 7;
  ERROR
    IF ERRNO=7 THEN
      sLog:=sLog+"!";
      RETURN;
    ENDIF
    RAISE;
  ENDPROC
ENDMODULE
