MODULE GaugeMain
  ! Acceptance of the ring gauging cell: each lamp do1..do20 is one point of the protocol
  VAR clock ckRun;
  VAR intnum irTouch;
  VAR intnum irTick;
  VAR intnum irEdge;
  VAR num nTouches:=0;
  VAR num nTicks:=0;
  VAR pos pEdge:=[0,0,0];
  VAR bool bEdge:=FALSE;
  VAR triggdata tgGlue;
  VAR triggdata tgEdge;

  PROC main()
    ConfJ\Off;
    ConfL\Off;
    AccSet 100,100;
    VelSet 100,1500;
    Calculations;
    MoveAbsJ jHome,v1000,fine,tProbe;
    Geometry;
    Process;
    MoveAbsJ jHome,v1000,fine,tProbe;
    TPWrite "points not met: "\Num:=nFailed;
  ENDPROC

  PROC Calculations()
    VAR lotinfo lot;
    VAR lotinfo bad;
    VAR num mean;
    VAR num sigma;
    VAR num n;
    VAR num total:=0;
    VAR num column{4};
    VAR string line:="";
    VAR bool found:=FALSE;

    ! 1: lot code
    lot:=ReadLot("RG-0420/17B");
    bad:=ReadLot("RG0420");
    Expect do1,lot.valid AND lot.family="RG" AND lot.size=420 AND lot.sheet=17 AND NOT bad.valid,"lot code";

    ! 2: sorted readings, median, the source unharmed
    rWork:=rAir;
    SortUp rWork;
    Expect do2,rWork{1}=41.962 AND rWork{4}=42.003 AND rWork{7}=42.051 AND rAir{1}=42.012,"sorting";

    ! 3: statistics with rounding and text
    MeanAndSpread rAir,mean,sigma;
    line:="x="+NumToStr(mean,3)+" s="+NumToStr(sigma,4);
    Expect do3,Near(mean,42.0043\Tol:=0.0005) AND Round(sigma\Dec:=3)=0.028 AND StrPart(line,1,8)="x=42.004","statistics";

    ! 4: classes in an array of records
    FOR i FROM 1 TO nReadings DO
      n:=ClassOf(rAir{i});
      rcTable{n}.counted:=rcTable{n}.counted+1;
    ENDFOR
    Expect do4,rcTable{1}.counted=1 AND rcTable{2}.counted=4 AND rcTable{3}.counted=2 AND rcTable{4}.counted=0,"classes";

    ! 5: check sums
    Expect do5,CheckSum("RG17")=90 AND CheckSum("RG17"\Inverted)=165 AND CheckSum("")=0,"check sum";

    ! 6: matrix: column sums, diagonal against the grain, -7 DIV 2
    FOR c FROM 1 TO 4 DO
      column{c}:=0;
      FOR r FROM 3 TO 1 STEP -1 DO
        column{c}:=column{c}+nMatrix{r,c};
      ENDFOR
    ENDFOR
    FOR r FROM 1 TO 3 DO
      total:=total+nMatrix{r,4-r};
    ENDFOR
    Expect do6,column{1}=15 AND column{4}=24 AND total=18 AND 17 DIV 5=3 AND 17 MOD 5=2,"matrix";

    ! 7: leaving a search through a table by GOTO, TEST over text
    FOR r FROM 1 TO 3 DO
      FOR c FROM 1 TO 4 DO
        IF nMatrix{r,c}*nMatrix{r,c}>50 THEN
          n:=10*r+c;
          GOTO out_of_table;
        ENDIF
      ENDFOR
    ENDFOR
    n:=0;
  out_of_table:
    TEST rcTable{n MOD 4+1}.name
    CASE "small","fit":
      found:=FALSE;
    CASE "scrap":
      found:=TRUE;
    DEFAULT:
      found:=FALSE;
    ENDTEST
    Expect do7,n=24 OR n=23 AND found,"table";
  ENDPROC

  PROC Geometry()
    VAR pose frTray;
    VAR pose one;
    VAR robtarget here;
    VAR robtarget aside;
    VAR jointtarget joints;
    VAR pos atTip;
    VAR pos along{3};
    VAR num slow;
    VAR num fast;

    ! 8: a frame from three corners and its inverse
    frTray:=DefFrame(cCorner1,cCorner2,cCorner3\Origin:=3);
    one:=PoseMult(frTray,PoseInv(frTray));
    wTray.uframe:=frTray;
    Expect do8,NearPos(one.trans,[0,0,0]) AND Near(EulerZYX(\Z,frTray.rot),36.87) AND Near(EulerZYX(\X,one.rot),0),"tray frame";

    ! 9: seat in the fixture, read back there
    MoveJ Offs(pSeat,0,0,50),v800,z20,tProbe\WObj:=wFixture;
    MoveL pSeat,v200,fine,tProbe\WObj:=wFixture;
    here:=CRobT(\Tool:=tProbe\WObj:=wFixture);
    Expect do9,NearPos(here.trans,pSeat.trans) AND Near(Abs(here.rot.q3),1\Tol:=0.001),"seat";

    ! 10: the same place seen from the base, by calculation
    atTip:=PoseVect(PoseMult(wFixture.uframe,wFixture.oframe),pSeat.trans);
    Expect do10,NearPos(CPos(\Tool:=tProbe\WObj:=wobj0),atTip) AND Near(atTip.z,280),"seat in base";

    ! 11: turned in the tool, then the cranked tool at the same place
    MoveL RelTool(pSeat,0,0,-30\Rz:=25),v300,fine,tProbe\WObj:=wFixture;
    here:=CRobT(\Tool:=tProbe\WObj:=wFixture);
    Expect do11,NearPos(here.trans,[40,30,90]) AND Near(Abs(EulerZYX(\Z,pSeat.rot)-EulerZYX(\Z,here.rot)),25\Tol:=0.1),"turned";

    ! 12: half circle above the tray
    along{1}:=[20,10,120];
    along{2}:=[50,40,120];
    along{3}:=[80,10,120];
    aside:=[along{1},OrientZYX(180,0,180),[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    MoveJ aside,v500,fine,tProbe\WObj:=wTray;
    here:=aside;
    here.trans:=along{2};
    aside.trans:=along{3};
    MoveC here,aside,v200,fine,tProbe\WObj:=wTray;
    atTip:=CPos(\Tool:=tProbe\WObj:=wTray);
    Expect do12,NearPos(atTip,along{3}) AND Near(Distance(atTip,[50,10,120]),30),"half circle";

    ! 13: blended corners are quicker than exact stops, and end at the same place
    MoveJ pOpen,v1000,fine,tProbe;
    ClkReset ckRun;
    ClkStart ckRun;
    Square fine;
    ClkStop ckRun;
    slow:=ClkRead(ckRun);
    ClkReset ckRun;
    ClkStart ckRun;
    Square z30;
    ClkStop ckRun;
    fast:=ClkRead(ckRun);
    Expect do13,fast<slow AND fast>0.3 AND NearPos(CPos(\Tool:=tProbe),pOpen.trans),"blending";

    ! 14: joints and places agree
    MoveAbsJ jAside\NoEOffs,v1000,fine,tCrank;
    joints:=CJointT();
    here:=CalcRobT(joints,tCrank);
    aside:=CRobT(\Tool:=tCrank\WObj:=wobj0);
    Expect do14,Near(joints.robax.rax_1,-35) AND Near(joints.robax.rax_5,70) AND NearPos(here.trans,aside.trans\Tol:=0.2),"joints";
  ENDPROC

  PROC Square(zonedata z)
    MoveL Offs(pOpen,80,0,0),v400,z,tProbe;
    MoveL Offs(pOpen,80,80,0),v400,z,tProbe;
    MoveL Offs(pOpen,0,80,0),v400,z,tProbe;
    MoveL pOpen,v400,fine,tProbe;
  ENDPROC

  PROC Process()
    VAR bool late:=FALSE;
    VAR bool late2:=FALSE;
    VAR num tries;
    VAR num wait1;
    VAR robtarget touched;
    VAR bool hit;

    ! 15: clamp answers in time, the missing door does not
    SetDO do21,1;
    WaitDI di1,1\MaxTime:=3\TimeFlag:=late;
    ClkReset ckRun;
    ClkStart ckRun;
    WaitUntil di9=1 AND nTouches=0\MaxTime:=0.6\TimeFlag:=late2;
    wait1:=ClkRead(ckRun);
    ClkStop ckRun;
    Expect do15,NOT late AND late2 AND Near(wait1,0.6\Tol:=0.15),"clamp";
    Reset do21;

    ! 16: a feeder that needs three tries, in an error handler
    tries:=Feed(3);
    Expect do16,tries=3,"feeder";

    ! 17: touches counted by a trap; asleep they do not count
    CONNECT irTouch WITH tpTouch;
    ISignalDI di2,1,irTouch;
    PulseTouch;
    PulseTouch;
    ISleep irTouch;
    PulseTouch;
    IWatch irTouch;
    PulseTouch;
    IDelete irTouch;
    CONNECT irTick WITH tpTick;
    ITimer 0.25,irTick;
    WaitTime 1.1;
    IDelete irTick;
    WaitTime 0.5;
    Expect do17,nTouches=3 AND nTicks=4,"traps";

    ! 18: probing the ring: touched within the path; a second probing finds nothing
    MoveJ pOpen,v1000,fine,tProbe;
    SetDO do23,1;
    hit:=Probe(Offs(pOpen,0,0,-100),touched);
    SetDO do23,0;
    WaitDI di3,0;
    Expect do18,hit AND touched.trans.z<pOpen.trans.z-1 AND touched.trans.z>pOpen.trans.z-99 AND Near(touched.trans.x,460),"probing";

    ! 19: glue gun at a distance before the end, the edge caught by a trap
    MoveL pOpen,v500,fine,tProbe;
    CONNECT irEdge WITH tpEdge;
    TriggIO tgGlue,60\DOp:=do24,1;
    TriggInt tgEdge,30\Start,irEdge;
    TriggL Offs(pOpen,0,150,0),v100,tgGlue\T2:=tgEdge,fine,tProbe;
    IDelete irEdge;
    Expect do19,bEdge AND DOutput(do24)=1 AND pEdge.y>pOpen.trans.y+20 AND pEdge.y<pOpen.trans.y+60,"events";
    Reset do24;

    ! 20: the background task counts, the group shows it, the pulse ends by itself
    nBeats:=0;
    bBeatOn:=TRUE;
    WaitUntil nBeats>=5\MaxTime:=10\TimeFlag:=late;
    bBeatOn:=FALSE;
    SetGO go25_28,nBeats;
    PulseDO\PLength:=0.4,do29;
    WaitTime 0.2;
    hit:=DOutput(do29)=1;
    WaitTime 0.5;
    Expect do20,NOT late AND hit AND DOutput(do29)=0 AND GOutput(go25_28)=5,"beats";
  ENDPROC

  FUNC num Feed(num most)
    VAR num tries:=1;
    SetDO do22,1;
    IF tries=most SetDO do30,1;
    WaitDI di4,1\MaxTime:=0.5;
    Reset do22;
    Reset do30;
    RETURN tries;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      Incr tries;
      IF tries<most RETRY;
      SetDO do30,1;
      RETRY;
    ENDIF
  ENDFUNC

  FUNC bool Probe(robtarget goal,INOUT robtarget found)
    SearchL\Stop,di3,found,goal,v50,tProbe;
    RETURN TRUE;
  ERROR
    IF ERRNO=ERR_WHLSEARCH THEN
      MoveL pOpen,v200,fine,tProbe;
      RETURN FALSE;
    ENDIF
  ENDFUNC

  PROC PulseTouch()
    Set do31;
    WaitDI di2,1;
    Reset do31;
    WaitDI di2,0;
    WaitTime 0.1;
  ENDPROC

  TRAP tpTouch
    nTouches:=nTouches+1;
  ENDTRAP

  TRAP tpTick
    Incr nTicks;
  ENDTRAP

  TRAP tpEdge
    pEdge:=CPos(\Tool:=tProbe\WObj:=wobj0);
    bEdge:=TRUE;
  ENDTRAP
ENDMODULE
