MODULE BondMain
  ! Adhesive bonding and press cell. Output don is 1 at the end when expectation n holds.
  CONST string aOrder{5}:=["COVER","FRAME","DOOR","COVER","FRAME"];
  VAR intnum iGun;
  VAR intnum iLow;
  VAR num nGun:=0;
  VAR num nLow:=0;
  VAR num nUnknown:=0;
  VAR num nMade:=0;
  VAR num aVariant{5};
  VAR num aOpen{5};
  VAR num aPress{5};
  VAR num aBead{5};
  VAR num aGun{5};
  VAR bool bClosed:=TRUE;
  VAR bool bLate:=TRUE;

  PROC main()
    ConfJ\Off;
    ConfL\Off;
    MoveAbsJ jHome,v1000,fine,tGun;
    StartShift;
    FOR i FROM 1 TO Dim(aOrder,1) DO
      MakePart aOrder{i};
    ENDFOR
    MoveAbsJ jHome,v1000,fine,tGun;
    EndShift;
    CheckProcess;
  ENDPROC

  PROC StartShift()
    VAR robtarget pNow;
    VAR clock ckFault;
    CONNECT iGun WITH GunSwitched;
    ISignalDO do21,edge,iGun;
    CONNECT iLow WITH AdhesiveLow;
    ISignalDI di2,1,iLow;
    ! the press reports that it is open
    SetDO do25,1;
    wFixture.uframe:=DefFrame(measOrigin,measX,measY);
    MoveJ RelTool(pFixture,0,0,-40),v1000,fine,tGun\WObj:=wFixture;
    ! 1: the measured frame: origin of the first point, x axis turned by 10 degrees; back along the tool is up
    pNow:=CRobT(\Tool:=tGun\WObj:=wobj0);
    IF Distance(pNow.trans,[460,-70,240])<1 AND Close(EulerZYX(\Z,wFixture.uframe.rot),10,0.5) SetDO do1,1;
    ! 2: two timeouts of 1 s, the purge, then pressure after half a second
    ClkStart ckFault;
    WaitPressure;
    ClkStop ckFault;
    IF nRetries=2 AND Close(ClkRead(ckFault),2.5,0.2) SetDO do2,1;
  ENDPROC

  PROC MakePart(string name)
    VAR num nVar;
    VAR pos pEnd;
    nVar:=FindVariant(name);
    Incr nMade;
    aVariant{nMade}:=nVar;
    Bead aVar{nVar};
    aBead{nMade}:=ClkRead(ckBead);
    aGun{nMade}:=ClkRead(ckGun);
    pEnd:=CPos(\Tool:=tGun\WObj:=wFixture);
    IF Distance(pEnd,[aVar{nVar}.radius,0,0])>1 bClosed:=FALSE;
    aTotal{nVar}.glue:=aTotal{nVar}.glue+BeadLength(aVar{nVar});
    MoveL Offs(pFixture,aVar{nVar}.radius,0,50),v500,z20,tGun\WObj:=wFixture;
    FetchLid;
    PressPart aVar{nVar},aOpen{nMade},aPress{nMade};
    IF aOpen{nMade}>aVar{nVar}.openTime THEN
      TPWrite "Open time over: "+name;
      Incr aTotal{nVar}.reject;
      RejectPart bLate;
    ELSE
      Incr aTotal{nVar}.good;
    ENDIF
  ERROR
    IF ERRNO=ERR_NOTKNOWN THEN
      Incr nUnknown;
      TPWrite "No recipe for "+name;
      RETURN;
    ENDIF
  ENDPROC

  PROC EndShift()
    VAR jointtarget jNow;
    VAR pos pGun;
    VAR pos pGrip;
    VAR num nGood:=0;
    VAR string stReport;
    SetDO do25,0;
    SetDO do26,0;
    SetDO do27,0;
    IDelete iGun;
    IDelete iLow;
    FOR i FROM 1 TO Dim(aTotal,1) DO
      nGood:=nGood+aTotal{i}.good;
    ENDFOR
    ! 3: totals of each variant
    IF nGood=3 AND aTotal{1}.good=2 AND aTotal{1}.reject=0 AND aTotal{2}.reject=1 AND aTotal{3}.good=0 SetDO do3,1;
    ! 4: the report for the shift book: 2 x 254.2 mm and 2 x 365.7 mm
    stReport:="Good "+NumToStr(nGood,0)+" of "+NumToStr(nMade,0)+", glue "+NumToStr((aTotal{1}.glue+aTotal{2}.glue)/1000,2)+" m";
    TPWrite stReport;
    IF stReport="Good 3 of 4, glue 1.24 m" SetDO do4,1;
    ! 5: everything off, the arm at home
    jNow:=CJointT();
    IF Close(jNow.robax.rax_1,0,0.5) AND Close(jNow.robax.rax_3,0,0.5) AND Close(jNow.robax.rax_5,90,0.5)
      AND DOutput(do21)=0 AND DOutput(do22)=0 AND DOutput(do23)=0 AND DOutput(do24)=0 SetDO do5,1;
    ! 6: two tools on one flange
    pGun:=CPos(\Tool:=tGun\WObj:=wobj0);
    pGrip:=CPos(\Tool:=tGrip\WObj:=wobj0);
    IF Close(Distance(pGun,pGrip),Sqrt(60*60+30*30),0.5) AND Close(pGrip.z-pGun.z,30,0.5) SetDO do6,1;
  ENDPROC

  PROC CheckProcess()
    VAR bool bTimes:=TRUE;
    ! 7: recipes found by their name
    IF aVariant{1}=1 AND aVariant{2}=2 AND aVariant{4}=2 AND FindVariant("PLATE")=3 SetDO do7,1;
    ! 8: the unknown order was left out, the others were made
    IF nUnknown=1 AND nMade=4 SetDO do8,1;
    ! 9: each bead ends where it began
    IF bClosed SetDO do9,1;
    ! 10, 11: the bead and the gun by the clock; the gun closes 10 mm before the end
    IF Close(aBead{1},BeadLength(aVar{1})/80,0.3) AND Close(aBead{2},BeadLength(aVar{2})/60,0.3) SetDO do10,1;
    IF Close(aBead{1}-aGun{1},10/80,0.06) AND Close(aBead{2}-aGun{2},10/60,0.06) SetDO do11,1;
    ! 12: on and off once for each bead
    IF nGun=8 SetDO do12,1;
    ! 13: the first frame waits 10 s for the platen, the second finds it hot
    IF aOpen{2}>10 AND aOpen{4}<8 AND aOpen{1}<14 SetDO do13,1;
    ! 14: pressed as long as the recipe says
    FOR i FROM 1 TO nMade DO
      IF NOT Close(aPress{i},aVar{aVariant{i}}.pressTime,0.1) bTimes:=FALSE;
    ENDFOR
    IF bTimes SetDO do14,1;
    ! 15: the reject was dropped at the chute
    IF Distance(pDropped.trans,[300,380,350])<1 SetDO do15,1;
    ! 16: it was seen by the chute's sensor
    IF NOT bLate SetDO do16,1;
    ! 17: the fourth lid, second column, second row: gripper at 400, -325, 190, the gun 60 mm beside and 30 mm below it
    IF nLid=4 AND Distance(pLastLid.trans,[460,-325,160])<1 SetDO do17,1;
    ! 18: the adhesive was low twice; that it was filled up again does not count
    IF nLow=2 SetDO do18,1;
  ENDPROC

  TRAP GunSwitched
    Incr nGun;
    IF DOutput(do21)=1 THEN
      ClkStart ckGun;
    ELSE
      ClkStop ckGun;
    ENDIF
  ENDTRAP

  TRAP AdhesiveLow
    Incr nLow;
    TPWrite "Adhesive low, warning "\Num:=nLow;
  ENDTRAP
ENDMODULE
