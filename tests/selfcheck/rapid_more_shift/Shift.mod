MODULE Shift
  ! Two modules with names of one kind, moves with data from lists. doN is on when expectation N holds.
  RECORD job
    robtarget at;
    speeddata v;
    num id;
  ENDRECORD
  PERS tooldata aTools{2}:=[[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]],[TRUE,[[0,0,130],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]]];
  PERS tooldata tNow:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  PERS tooldata tLong:=[TRUE,[[0,0,130],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wNow:=[FALSE,TRUE,"",[[420,-100,200],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wOther:=[FALSE,TRUE,"",[[400,20,180],[0.9659258,0,0,0.2588190]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pMid:=[[40,40,80],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST speeddata SPEEDS{3}:=[[200,500,5000,1000],[100,500,5000,1000],[50,500,5000,1000]];
  VAR job aJobs{3};
  LOCAL VAR num count:=5;
  VAR num nOrder:=0;
  PERS num nKept{3}:=[1,2,3];
  VAR num nWhere:=0;

  PROC main()
    ConfL\Off;
    ConfJ\Off;
    init;
    MoveAbsJ jHome,v1000,fine,tNow;
    Data;
    Lists;
    Modules;
    Errors;
    Rest;
    MoveAbsJ jHome,v1000,fine,tNow;
  ENDPROC

  LOCAL PROC init()
    nOrder:=1;
    FOR i FROM 1 TO 3 DO
      aJobs{i}.at:=Offs(pMid,20*(i-1),0,0);
      aJobs{i}.v:=SPEEDS{4-i};
      aJobs{i}.id:=i*i;
    ENDFOR
  ENDPROC

  FUNC robtarget Here(PERS tooldata t,PERS wobjdata w)
    RETURN CRobT(\Tool:=t\WObj:=w);
  ENDFUNC

  PROC GoTo1(robtarget p,PERS tooldata t\PERS wobjdata w\switch slow)
    VAR speeddata v;
    v:=v300;
    IF Present(slow) v.v_tcp:=60;
    IF Present(w) THEN
      MoveL p,v,fine,t\WObj:=w;
    ELSE
      MoveL p,v,fine,t\WObj:=wNow;
    ENDIF
  ENDPROC

  PROC Data()
    VAR robtarget p;
    VAR clock ck;
    ! 1 tool and work object as arguments
    GoTo1 pMid,tNow;
    p:=Here(tNow,wNow);
    IF Distance(p.trans,pMid.trans)<0.1 SetDO do1,1;
    ! 2 another tool, the work object given
    GoTo1 pMid,tLong\w:=wOther;
    p:=Here(tNow,wOther);
    IF Abs(p.trans.z-110)<0.1 AND Abs(p.trans.x-40)<0.1 SetDO do2,1;
    ! 3 slowly when it is said
    GoTo1 pMid,tNow;
    ClkReset ck;
    ClkStart ck;
    GoTo1 Offs(pMid,0,60,0),tNow\slow;
    ClkStop ck;
    IF Abs(ClkRead(ck)-1)<0.15 SetDO do3,1;
    ! 4 the tool's data changed in the program, the arm goes elsewhere with the same place
    GoTo1 pMid,tNow;
    tNow.tframe.trans.z:=tNow.tframe.trans.z+25;
    GoTo1 pMid,tNow;
    p:=Here(tLong,wNow);
    tNow:=aTools{1};
    IF Abs(p.trans.z-75)<0.1 AND tNow.tframe.trans.z=100 SetDO do4,1;
    ! 5 an element of a list of tools copied
    tNow:=aTools{2};
    tNow.tframe.trans.x:=10;
    IF aTools{2}.tframe.trans.x=0 AND tNow.tframe.trans.z=130 SetDO do5,1;
    tNow:=aTools{1};
    ! 6 a load by reference of one component
    Heavier tNow.tload.mass;
    IF tNow.tload.mass=1.5 AND aTools{1}.tload.mass=1 SetDO do6,1;
  ENDPROC

  PROC Heavier(INOUT num m)
    m:=m+0.5;
  ENDPROC

  PROC Lists()
    VAR num t{3};
    VAR clock ck;
    VAR num n:=0;
    ! 7 speeds from records in a list
    FOR i FROM 1 TO 3 DO
      MoveL aJobs{i}.at,v300,fine,tNow\WObj:=wNow;
      ClkReset ck;
      ClkStart ck;
      MoveL Offs(aJobs{i}.at,0,50,0),aJobs{i}.v,fine,tNow\WObj:=wNow;
      ClkStop ck;
      t{i}:=ClkRead(ck);
    ENDFOR
    IF Abs(t{1}-1)<0.12 AND Abs(t{2}-0.5)<0.12 AND t{3}<t{2}-0.1 SetDO do7,1;
    ! 8 whole lists copied and given by value
    n:=Weighted(nKept);
    IF n=14 AND nKept{3}=3 SetDO do8,1;
    ! 9 searched from behind, the place found by reference
    IF Found(4,nWhere) AND nWhere=2 AND NOT Found(5,nWhere) AND nWhere=0 SetDO do9,1;
  ENDPROC

  FUNC num Weighted(num a{*})
    VAR num s:=0;
    FOR i FROM 1 TO Dim(a,1) DO
      a{i}:=a{i}*i;
      s:=s+a{i};
    ENDFOR
    RETURN s;
  ENDFUNC

  FUNC bool Found(num id,INOUT num at)
    FOR i FROM Dim(aJobs,1) TO 1 DO
      IF aJobs{i}.id=id THEN
        at:=i;
        RETURN TRUE;
      ENDIF
    ENDFOR
    at:=0;
    RETURN FALSE;
  ENDFUNC

  PROC Modules()
    ! 10 local names of two modules
    Prepare;
    IF nOrder=12 AND count=5 AND Counted()=71 SetDO do10,1;
    ! 11 a constant of the other module in a choice
    TEST count
    CASE LOW,LOW+1:
      SetDO do11,0;
    CASE HIGH:
      SetDO do11,1;
    ENDTEST
    ! 12 true is chosen by conditions
    TEST TRUE
    CASE count>6:
      nWhere:=1;
    CASE count>4,count<1:
      nWhere:=2;
    DEFAULT:
      nWhere:=3;
    ENDTEST
    IF nWhere=2 SetDO do12,1;
  ENDPROC

  PROC Errors()
    VAR num n;
    ! 13 the whole statement again, with the calls in it
    nOrder:=0;
    n:=Again(2);
    IF n=25 AND nOrder=3 SetDO do13,1;
    ! 14 an error in an argument; the next statement
    nOrder:=0;
    Passed;
    IF nOrder=7 SetDO do14,1;
    ! 15 a handler in a routine called by a handler, the number kept before
    nOrder:=0;
    Nested;
    IF nOrder=15 SetDO do15,1;
  ENDPROC

  FUNC num Step1()
    Incr nOrder;
    RETURN nOrder;
  ENDFUNC

  FUNC num Again(num limit)
    VAR num d:=0;
    VAR num n;
    n:=Step1()*10+10/d;
    RETURN n;
  ERROR
    IF ERRNO=ERR_DIVZERO THEN
      IF nOrder>=limit d:=-2;
      RETRY;
    ENDIF
  ENDFUNC

  PROC Passed()
    VAR num z:=0;
    Note 100/z;
    Note 7;
  ERROR
    IF ERRNO=ERR_DIVZERO TRYNEXT;
  ENDPROC

  PROC Note(num n)
    nOrder:=nOrder+n;
  ENDPROC

  PROC Nested()
    VAR num n;
    RAISE 5;
  ERROR
    IF ERRNO=5 THEN
      n:=ERRNO;
      Quiet;
      nOrder:=nOrder+n;
    ENDIF
    RETURN;
  ENDPROC

  PROC Quiet()
    RAISE 6;
  ERROR
    nOrder:=nOrder+10;
    RETURN;
  ENDPROC

  PROC Rest()
    VAR robtarget p;
    VAR pos a;
    VAR pos b;
    ! 16 nested places in a move
    MoveJ Offs(RelTool(Offs(pMid,0,0,20),0,0,-10),5,0,0),v500,fine,tNow\WObj:=wNow;
    p:=Here(tNow,wNow);
    IF Abs(p.trans.x-45)<0.1 AND Abs(p.trans.z-110)<0.1 SetDO do16,1;
    ! 17 a place written out in the move
    MoveL [[70,20,90],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v300,fine,tNow\WObj:=wNow;
    p:=Here(tNow,wNow);
    IF Distance(p.trans,[70,20,90])<0.1 SetDO do17,1;
    ! 18 products of positions
    a:=[1,0,0];
    b:=[0,2,0];
    a:=a*b+[1,1,1]-b;
    IF a=[1,-1,3] SetDO do18,1;
  ENDPROC
ENDMODULE
