MODULE MainCast
  ! Castings from a rack, found by a search, deburred and put into boxes. do1..do16: expectation holds.
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num KIND{4}:=[1,2,1,1];
  VAR castinfo aCast{4};
  VAR num aDone{2}:=[0,0];
  VAR string stOrder:="";
  VAR errnum ERR_SPINDLE:=-1;
  VAR bool bSpindleBad:=FALSE;
  VAR intnum iChip;
  VAR num nChip:=0;

  PROC main()
    VAR robtarget pNow;
    VAR robtarget pSlot4;
    VAR robtarget pLast;
    VAR pose peBoxSeen;
    VAR string stText;
    VAR num nMean:=0;
    VAR num nGood:=0;
    VAR bool bLate;
    VAR clock ck;
    VAR num nPulse;
    ConfL\Off;
    ConfJ\Off;
    BookErrNo ERR_SPINDLE;
    ResetAll;
    CONNECT iChip WITH tChip;
    ISignalDI\Single,diChip,1,iChip;
    MoveAbsJ jHome,v1000,fine,tGrip;
    ! 1: the last slot of the rack, computed
    pSlot4:=SlotPos(4);
    IF Distance(pSlot4.trans,[150,130,10])<0.01 SetDO do1,1;
    FOR i FROM 1 TO 4 DO
      aCast{i}.kind:=KIND{i};
      GetCasting i,aCast{i};
      IF aCast{i}.ok THEN
        TEST KIND{i}
        CASE 1:
          DeburrEdge aCast{i}.time;
          stOrder:=stOrder+NumToStr(i,0)+"A";
        CASE 2:
          DeburrBore aCast{i}.time;
          stOrder:=stOrder+NumToStr(i,0)+"B";
        DEFAULT:
          Stop;
        ENDTEST
        PutAway KIND{i},aDone{KIND{i}};
        nGood:=nGood+1;
        nMean:=nMean+aCast{i}.height;
      ELSE
        stOrder:=stOrder+NumToStr(i,0)+"-";
      ENDIF
    ENDFOR
    pLast:=CRobT(\Tool:=tGrip\WObj:=wBox);
    MoveAbsJ jHome,v1000,fine,tGrip;
    ! 2, 3: heights found, at 20 mm/s from 50 mm above the slot
    IF Abs(aCast{1}.height-30)<2.5 SetDO do2,1;
    IF Abs(aCast{2}.height-20)<2.5 AND Abs(aCast{4}.height-40)<2.5 SetDO do3,1;
    ! 4: one slot empty
    IF nEmpty=1 AND NOT aCast{3}.ok AND aCast{4}.ok SetDO do4,1;
    ! 5: the slow clamp answered in the second try
    IF nRetry=1 AND tClamp>1.0 AND tClamp<1.25 SetDO do5,1;
    ! 6: 80 mm at 40 mm/s with a stop of 0.5 s for chips
    IF nChip=1 AND Abs(aCast{1}.time-2.5)<0.17 SetDO do6,1;
    ! 7: without a stop
    IF Abs(aCast{4}.time-2)<0.15 SetDO do7,1;
    ! 8: around the bore, radius 20, at 40 mm/s
    IF Abs(aCast{2}.time-2*pi*20/40)<0.2 SetDO do8,1;
    ! 9: counters
    IF aDone{1}=2 AND aDone{2}=1 AND nGood=3 SetDO do9,1;
    ! 10: order
    IF stOrder="1A2B3-4A" AND StrLen(stOrder)=8 SetDO do10,1;
    ! 11: the last casting went to the second place of box 1
    IF Distance(pLast.trans,[40,0,80])<1 SetDO do11,1;
    ! 12: a fault of the spindle is raised to the caller
    StartSpindle;
    IF bSpindleBad AND DOutput(doSpindle)=0 SetDO do12,1;
    ! 13: text of the report
    nMean:=nMean/nGood;
    stText:="castings "+NumToStr(nGood,0)+" of "+NumToStr(Dim(aCast,1),0);
    TPWrite stText;
    IF stText="castings 3 of 4" AND StrPart(stText,10,1)="3" AND Abs(nMean-30)<2.5 SetDO do13,1;
    ! 14: nobody clears the box; the wait ends by itself
    ClkReset ck;
    ClkStart ck;
    WaitUntil diBoxClear=1\MaxTime:=1.2\TimeFlag:=bLate;
    ClkStop ck;
    IF bLate AND Abs(ClkRead(ck)-1.2)<0.15 SetDO do14,1;
    ! 15: the box seen from the jig, and a point in tool axes
    peBoxSeen:=PoseMult(PoseInv(PoseMult(wJig.uframe,wJig.oframe)),PoseMult(wBox.uframe,wBox.oframe));
    MoveJ pEdge,v500,fine,tSpin\WObj:=wJig;
    MoveL RelTool(pEdge,10,0,-30\Rz:=20),v200,fine,tSpin\WObj:=wJig;
    pNow:=CRobT(\Tool:=tSpin\WObj:=wJig);
    IF Distance(peBoxSeen.trans,[-30,150,40])<0.1 AND Distance(pNow.trans,[-50,0,40])<0.5 SetDO do15,1;
    ! 16: end signal, and everything off at home
    PulseDO\PLength:=0.5,doReady;
    WaitTime 0.2;
    nPulse:=DOutput(doReady);
    MoveAbsJ jHome,v1000,fine,tGrip;
    WaitTime 0.5;
    IDelete iChip;
    IF nPulse=1 AND DOutput(doReady)=0 AND DOutput(doClamp1)=0 AND DOutput(doCoolant)=0 SetDO do16,1;
  ENDPROC

  PROC StartSpindle()
    SpindleOn 0.5;
  ERROR
    IF ERRNO=ERR_SPINDLE THEN
      bSpindleBad:=TRUE;
      SetDO doSpindle,0;
      TRYNEXT;
    ENDIF
  ENDPROC

  PROC SpindleOn(num nLimit)
    SetDO doSpindle,1;
    WaitDI diSpindle,1\MaxTime:=nLimit;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      ErrWrite\W,"Spindle","no speed in time";
      RAISE ERR_SPINDLE;
    ENDIF
  ENDPROC

  TRAP tChip
    StopMove;
    nChip:=nChip+1;
    WaitTime 0.5;
    StartMove;
  ENDTRAP
ENDMODULE
