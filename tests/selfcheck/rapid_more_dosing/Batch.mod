MODULE Batch
  ! Dosing and sealing line - site acceptance: mixing a batch, sealing its lids, packing layers
  RECORD dose
    string what;
    num grams;
    num flow;
    bool heated;
  ENDRECORD
  RECORD batch
    num number;
    num total;
    dose parts{3};
  ENDRECORD

  CONST num ERR_SCALE:=20;
  CONST string sUnits{3}:=["g","kg","t"];
  VAR batch bNow;
  VAR num aHistory{10};
  VAR num nHistory:=0;
  PERS num nBatchNo:=41;
  VAR bool aLamp{8};
  VAR intnum irLow;
  VAR intnum irBeat;
  VAR intnum irDone;
  VAR num nLow:=0;
  VAR num nBeat:=0;
  VAR num nSealed:=0;
  VAR num zSealed:=0;
  VAR clock ckSeal;
  VAR triggdata tgOpen;
  VAR triggdata tgShut;
  VAR triggdata tgSeen;
  PERS tooldata tNozzle:=[TRUE,[[0,0,140],[1,0,0,0]],[1.1,[0,0,70],[1,0,0,0],0,0,0]];
  PERS tooldata tGrip:=[TRUE,[[30,0,100],[0.707106781,0,0,0.707106781]],[2,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wLine:=[FALSE,TRUE,"",[[420,60,160],[0.923879533,0,0,-0.382683432]],[[0,0,15],[1,0,0,0]]];
  PERS loaddata ldLid:=[0.6,[0,0,40],[1,0,0,0],0,0,0];
  PERS robtarget pLast:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pWait:=[[440,0,420],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget aLid{3}:=[[[40,0,80],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
                            [[40,70,80],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
                            [[40,140,80],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];
  CONST speeddata vSeal:=[120,200,1000,1000];
  CONST zonedata zSoft:=[FALSE,15,22,22,2.2,22,2.2];

  PROC main()
    VAR num stage:=0;
    ConfJ\Off;
    ConfL\Off;
    SingArea\Off;
    WHILE stage<4 DO
      Incr stage;
      %"Stage"+ValToStr(stage)%;
    ENDWHILE
  ENDPROC

  ! --- the recipe
  PROC Stage1()
    VAR string line;
    VAR num found;
    VAR num q;
    VAR num sum:=0;
    VAR bool known;
    VAR dose one;

    ! 1 a record with an array of records
    bNow.number:=nBatchNo+1;
    bNow.parts{1}:=["sand",1200,15.5,FALSE];
    bNow.parts{2}:=["resin",350.25,4,TRUE];
    bNow.parts{3}:=["dye",12.5,0.5,FALSE];
    FOR i FROM 1 TO 3 DO
      bNow.total:=bNow.total+bNow.parts{i}.grams;
    ENDFOR
    one:=bNow.parts{2};
    one.grams:=0;
    IF bNow.total=1562.75 AND bNow.parts{2}.grams=350.25 AND one.heated SetDO do1,1;

    ! 2 text of an amount in the right unit
    line:=Amount(1562.75)+";"+Amount(12.5)+";"+Amount(2500000);
    IF line="1.56 kg;12.50 g;2.50 t" SetDO do2,1;

    ! 3 splitting a line of a file into fields
    line:="resin;350.25;T;x";
    IF Field(line,1)="resin" AND Field(line,3)="T" AND Field(line,5)="" THEN
      known:=StrToVal(Field(line,2),q);
      IF known AND q=350.25 AND NOT StrToVal(Field(line,1),found) SetDO do3,1;
    ENDIF

    ! 4 error raised in a function, repaired by the caller
    q:=Weigh(-3);
    found:=Weigh(8);
    IF q=0 AND found=16 SetDO do4,1;

    ! 5 a ring store of the last values
    FOR i FROM 1 TO 13 DO
      Remember i*i;
    ENDFOR
    FOR i FROM 1 TO Dim(aHistory,1) DO
      sum:=sum+aHistory{i};
    ENDFOR
    IF nHistory=13 AND aHistory{3}=169 AND aHistory{4}=16 AND sum=805 SetDO do5,1;

    ! 6 integer arithmetic and rounding
    q:=0;
    found:=Gcd(462,1071);
    WHILE found*q<100 DO
      q:=q+1;
    ENDWHILE
    IF found=21 AND q=5 AND Round(2.5)=3 AND Round(-2.5)=-3 AND Trunc(-7.9)=-7 AND Round(3.14159\Dec:=3)=3.142 SetDO do6,1;

    ! 7 lamps packed into a byte and shown on a group
    FOR i FROM 1 TO 8 DO
      aLamp{i}:=(i MOD 3=0) OR i=1;
    ENDFOR
    SetGO goLamps,Packed(aLamp);
    IF Packed(aLamp)=37 AND BitCheck(37,3) AND BitAnd(37,12)=4 AND goLamps=37 SetDO do7,1;
  ENDPROC

  ! --- places
  PROC Stage2()
    VAR robtarget p;
    VAR robtarget q;
    VAR jointtarget j;
    VAR pos c;
    VAR num a;
    VAR num long;
    VAR pose way;

    ! 8 a grid in the line's frame, from an array of places
    MoveAbsJ [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tNozzle;
    long:=0;
    FOR i FROM 1 TO 3 DO
      MoveJ Offs(aLid{i},0,0,40),v1000,zSoft,tNozzle\WObj:=wLine;
      MoveL aLid{i},v300,fine,tNozzle\WObj:=wLine;
      pLast:=CRobT(\Tool:=tNozzle\WObj:=wLine);
      long:=long+Distance(pLast.trans,[40,0,80]);
      MoveL Offs(aLid{i},0,0,40),v300,z10,tNozzle\WObj:=wLine;
    ENDFOR
    IF Abs(long-210)<0.2 SetDO do8,1;

    ! 9 the last lid in the base
    way:=PoseMult(wLine.uframe,wLine.oframe);
    c:=PoseVect(way,pLast.trans);
    MoveL aLid{3},v300,fine,tNozzle\WObj:=wLine;
    p:=CRobT(\Tool:=tNozzle\WObj:=wobj0);
    IF Distance(p.trans,c)<0.1 AND Abs(c.z-255)<0.1 SetDO do9,1;

    ! 10 tilted by its own axes and back
    MoveL RelTool(aLid{3},0,0,-20\Ry:=12),v200,fine,tNozzle\WObj:=wLine;
    q:=CRobT(\Tool:=tNozzle\WObj:=wLine);
    a:=EulerZYX(\Y,q.rot);
    MoveL aLid{3},v200,fine,tNozzle\WObj:=wLine;
    IF Abs(Abs(a)-12)<0.05 AND Abs(q.trans.z-100)<0.1 SetDO do10,1;

    ! 11 displaced program
    PDispSet [[25,-15,30],[1,0,0,0]];
    MoveL aLid{1},v300,fine,tNozzle\WObj:=wLine;
    PDispOff;
    c:=CPos(\Tool:=tNozzle\WObj:=wLine);
    IF Distance(c,[65,-15,110])<0.1 SetDO do11,1;

    ! 12 two quarter circles about a lid
    MoveL Offs(aLid{2},-40,0,0),v200,fine,tNozzle\WObj:=wLine;
    MoveC Offs(aLid{2},-28.284,28.284,0),Offs(aLid{2},0,40,0),vSeal,z1,tNozzle\WObj:=wLine;
    MoveC Offs(aLid{2},28.284,28.284,0),Offs(aLid{2},40,0,0),vSeal,fine,tNozzle\WObj:=wLine;
    p:=CRobT(\Tool:=tNozzle\WObj:=wLine);
    IF Distance(p.trans,[80,70,80])<0.1 SetDO do12,1;

    ! 13 one joint turned on, the place of the joints
    MoveJ pWait,v1000,fine,tGrip;
    j:=CJointT();
    j.robax.rax_6:=j.robax.rax_6+25;
    MoveAbsJ j,v500,fine,tGrip;
    p:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    q:=CalcRobT(j,tGrip\WObj:=wobj0);
    IF Distance(p.trans,q.trans)<0.2 AND Distance(p.trans,pWait.trans)>5 SetDO do13,1;

    ! 14 load and speed changed, still at the right place
    GripLoad ldLid;
    VelSet 50,500;
    ClkReset ckSeal;
    ClkStart ckSeal;
    MoveL Offs(pWait,0,0,-100),v1000,fine,tGrip;
    ClkStop ckSeal;
    VelSet 100,5000;
    GripLoad load0;
    IF ClkRead(ckSeal)>0.2 AND Distance(CPos(\Tool:=tGrip\WObj:=wobj0),[440,0,320])<0.1 SetDO do14,1;
  ENDPROC

  ! --- the process
  PROC Stage3()
    VAR bool late;
    VAR num t;
    VAR robtarget p;
    VAR num answer;

    ! 15 level falls: interrupt once, then the pump answers
    CONNECT irLow WITH trLow;
    ISignalDI\Single,diLevel,0,irLow;
    SetDO doDrain,1;
    WaitUntil nLow>0\MaxTime:=5\TimeFlag:=late;
    SetDO doDrain,0;
    WaitDI diLevel,1;
    SetDO doDrain,1;
    WaitTime 1;
    SetDO doDrain,0;
    IDelete irLow;
    IF nLow=1 AND NOT late SetDO do15,1;

    ! 16 the time an answer takes, and an answer that never comes
    t:=Ask(2);
    IF Abs(t-0.7)<0.15 AND Ask(0.4)=-1 SetDO do16,1;

    ! 17 a bead: valve opened and shut on the way, times and counts by a trap
    MoveJ Offs(pWait,0,-80,-60),v1000,fine,tNozzle;
    CONNECT irDone WITH trSealed;
    ISignalDO doBead,0,irDone;
    TriggIO tgOpen,25\Start\DOp:=doBead,1;
    TriggIO tgShut,25\DOp:=doBead,0;
    TriggL Offs(pWait,0,80,-60),vSeal,tgOpen\T2:=tgShut,fine,tNozzle;
    WaitTime 0.2;
    IDelete irDone;
    IF nSealed=1 AND zSealed>40 AND zSealed<70 SetDO do17,1;

    ! 18 feeling for the lid; from the place found on
    SetDO doFeel,1;
    SearchL\Stop,diFeel,p,Offs(pWait,0,80,-160),v20,tNozzle;
    SetDO doFeel,0;
    MoveL Offs(p,0,0,50),v200,fine,tNozzle;
    IF p.trans.z<359 AND p.trans.z>261 AND Distance(CPos(\Tool:=tNozzle\WObj:=wobj0),Above(p.trans))<1 SetDO do18,1;

    ! 19 beats of a timer interrupt while the arm works, stopped by IDisable for a while
    CONNECT irBeat WITH trBeat;
    ITimer 0.2,irBeat;
    WaitTime 0.7;
    IDelete irBeat;
    PulseDO\PLength:=0.3,doHorn;
    WaitTime 0.15;
    late:=doHorn=1;
    WaitTime 0.4;
    IF nBeat=3 AND late AND doHorn=0 SetDO do19,1;

    ! 20 the operator chooses
    TPReadFK answer,"Lids good?","Yes","No",stEmpty,stEmpty,stEmpty;
    TEST answer
    CASE 1:
      SetDO do20,1;
    CASE 2:
      TPWrite "refused";
    ENDTEST
  ENDPROC

  PROC Stage4()
    MoveAbsJ [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tNozzle;
    TPWrite "batch "\Num:=bNow.number;
  ENDPROC

  ! --- helpers
  FUNC string Amount(num grams)
    VAR num unit:=1;
    WHILE grams>=1000 AND unit<Dim(sUnits,1) DO
      grams:=grams/1000;
      unit:=unit+1;
    ENDWHILE
    RETURN NumToStr(grams,2)+" "+sUnits{unit};
  ENDFUNC

  FUNC string Field(string line,num which)
    VAR num first:=1;
    VAR num upto;
    FOR i FROM 1 TO 20 DO
      upto:=StrFind(line,first,";");
      IF i=which RETURN StrPart(line,first,upto-first);
      IF upto>StrLen(line) RETURN "";
      first:=upto+1;
    ENDFOR
    RETURN "";
  ENDFUNC

  FUNC num Weigh(num raw)
    IF raw<0 RAISE ERR_SCALE;
    RETURN raw*2;
  ERROR
    IF ERRNO=ERR_SCALE RETURN 0;
  ENDFUNC

  PROC Remember(num value)
    VAR num at;
    at:=nHistory MOD Dim(aHistory,1);
    aHistory{at+1}:=value;
    Incr nHistory;
  ENDPROC

  FUNC pos Above(pos p)
    p.z:=p.z+50;
    RETURN p;
  ENDFUNC

  FUNC num Gcd(num a,num b)
    VAR num rest;
    WHILE b<>0 DO
      rest:=a MOD b;
      a:=b;
      b:=rest;
    ENDWHILE
    RETURN a;
  ENDFUNC

  FUNC num Packed(bool lamps{*})
    VAR num result:=0;
    FOR i FROM Dim(lamps,1) TO 1 STEP -1 DO
      result:=result*2;
      IF lamps{i} Incr result;
    ENDFOR
    RETURN result;
  ENDFUNC

  FUNC num Ask(num patience)
    VAR num took;
    VAR bool never;
    ClkReset ckSeal;
    SetDO doAsk,1;
    ClkStart ckSeal;
    WaitDI diAnswer,1\MaxTime:=patience\TimeFlag:=never;
    ClkStop ckSeal;
    took:=ClkRead(ckSeal);
    Reset doAsk;
    WaitDI diAnswer,0;
    IF never RETURN -1;
    RETURN took;
  ENDFUNC

  TRAP trLow
    Incr nLow;
  ENDTRAP

  TRAP trBeat
    nBeat:=nBeat+1;
  ENDTRAP

  TRAP trSealed
    VAR pos here;
    here:=CPos(\Tool:=tNozzle\WObj:=wobj0);
    zSealed:=here.y;
    Incr nSealed;
  ENDTRAP
ENDMODULE
