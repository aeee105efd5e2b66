MODULE RackPick
  ! The rack: two columns, two rows. Search from above, clamp with retry.
  RECORD castinfo
    num kind;
    num height;
    num time;
    bool ok;
  ENDRECORD
  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[1.5,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wRack:=[FALSE,TRUE,"",[[350,0,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wBox:=[FALSE,TRUE,"",[[390,40,190],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pSlot1:=[[90,80,10],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBox1:=[[0,0,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS speeddata vSearch:=[20,50,100,100];
  VAR num nEmpty:=0;
  VAR num nRetry:=0;
  VAR num tClamp:=0;

  FUNC robtarget SlotPos(num nSlot)
    RETURN Offs(pSlot1,60*((nSlot-1) MOD 2),50*((nSlot-1) DIV 2),0);
  ENDFUNC

  PROC GetCasting(num nSlot,INOUT castinfo c)
    VAR robtarget pSlot;
    VAR robtarget pFound;
    pSlot:=SlotPos(nSlot);
    MoveJ Offs(pSlot,0,0,100),v500,z10,tGrip\WObj:=wRack;
    MoveL Offs(pSlot,0,0,50),v200,fine,tGrip\WObj:=wRack;
    Light nSlot\On;
    SearchL\Stop,diTouch,pFound,pSlot,vSearch,tGrip\WObj:=wRack;
    Light nSlot\Off;
    c.height:=pFound.trans.z-pSlot.trans.z;
    c.ok:=TRUE;
    MoveL pFound,v50,fine,tGrip\WObj:=wRack;
    IF c.kind=1 THEN
      Clamp doClamp1,diClamped1;
    ELSE
      Clamp doClamp2,diClamped2;
    ENDIF
    MoveL Offs(pFound,0,0,60),v200,z5,tGrip\WObj:=wRack;
  ERROR
    IF ERRNO=ERR_WHLSEARCH THEN
      nEmpty:=nEmpty+1;
      c.ok:=FALSE;
      Light nSlot\Off;
      MoveL Offs(pSlot,0,0,100),v200,fine,tGrip\WObj:=wRack;
      RETURN;
    ENDIF
  ENDPROC

  PROC Clamp(VAR signaldo doValve,VAR signaldi diClosed)
    VAR clock ckClamp;
    ClkReset ckClamp;
    ClkStart ckClamp;
    SetDO doValve,1;
    WaitDI diClosed,1\MaxTime:=0.8;
    ClkStop ckClamp;
    IF ClkRead(ckClamp)>tClamp tClamp:=ClkRead(ckClamp);
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME AND nRetry<3 THEN
      Incr nRetry;
      RETRY;
    ENDIF
  ENDPROC

  PROC Light(num nSlot\switch On|switch Off)
    VAR dionum nVal:=0;
    IF Present(On) nVal:=1;
    TEST nSlot
    CASE 1:
      SetDO doLight1,nVal;
    CASE 2:
      SetDO doLight2,nVal;
    CASE 3:
      SetDO doLight3,nVal;
    CASE 4:
      SetDO doLight4,nVal;
    ENDTEST
    IF nVal=0 WaitDI diTouch,0;
  ENDPROC

  PROC PutAway(num nKind,INOUT num nCount)
    VAR robtarget p;
    p:=Offs(pBox1,nCount*40,(nKind-1)*70,0);
    MoveJ Offs(p,0,0,80),v500,z10,tGrip\WObj:=wBox;
    MoveL p,v200,fine,tGrip\WObj:=wBox;
    Reset doClamp1;
    Reset doClamp2;
    WaitTime 0.2;
    MoveL Offs(p,0,0,80),v500,fine,tGrip\WObj:=wBox;
    Incr nCount;
  ENDPROC

  PROC ResetAll()
    Reset doClamp1;
    Reset doClamp2;
    Reset doCoolant;
    Reset doReady;
    FOR i FROM 1 TO 4 DO
      Light i\Off;
    ENDFOR
  ENDPROC
ENDMODULE
