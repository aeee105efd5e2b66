MODULE Kits
  ! Bookkeeping of an assembly line: handlers with retries, records, tables, texts, late calls. doN: expectation N holds.
  RECORD dims
    num w;
    num h;
    pos corner;
  ENDRECORD
  RECORD part
    string name;
    dims size;
    bool ok;
    num count;
  ENDRECORD
  ALIAS num level;
  CONST num FIRST:=3;
  CONST num LAST:=FIRST*2+1;
  CONST part EMPTY:=["",[0,0,[0,0,0]],FALSE,0];
  PERS part aStock{3}:=[["bolt",[10,20,[1,2,3]],TRUE,4],["nut",[5,6,[0,0,9]],FALSE,0],["cap",[7,8,[4,5,6]],TRUE,11]];
  VAR num aGrid{2,3,2};
  VAR num nTries:=0;
  VAR num nLog:=0;
  VAR string sLog:="";
  VAR errnum ERR_OWN:=-1;
  LOCAL VAR num nHidden:=5;
  PERS num nKept:=17;
  VAR level lvTank:=2;
  VAR num aFilled{6}:=[9,4,7,1,8,3];

  PROC main()
    BookErrNo ERR_OWN;
    Handlers;
    Tables;
    TextWork;
    Calls;
  ENDPROC

  PROC Handlers()
    VAR num n;
    VAR num m;
    ! 1 a retry that mends its cause
    nTries:=0;
    n:=Safe(10,0);
    IF n=5 AND nTries=1 SetDO do1,1;
    ! 2 raised through two callers, caught in a loop, the loop goes on
    nLog:=0;
    FOR i FROM 1 TO 4 DO
      Outer i;
      nLog:=nLog*10+i;
    ENDFOR
    IF nLog=19293949 OR nLog=1239 SetDO do2,0;
    IF sLog="r2 r4 " SetDO do2,1;
    ! 3 the handler calls a routine that has a handler of its own
    sLog:="";
    Chain;
    IF sLog="chain inner end" SetDO do3,1;
    ! 4 a function that gives a value out of its handler
    IF OrElse("12.5",-1)=12.5 AND OrElse("abc",-1)=-1 AND OrElse("",7)=7 SetDO do4,1;
    ! 5 division by zero is passed over, what follows is done
    m:=3;
    n:=8;
    Divide n,m-3;
    Divide n,m+1;
    IF n=2 SetDO do5,1;
    ! 6 the third try gives up
    nTries:=0;
    GiveUp 3;
    IF nTries=3 AND nLog=-3 SetDO do6,1;
  ENDPROC

  FUNC num Safe(num a,num b)
    RETURN a/b;
  ERROR
    IF ERRNO=ERR_DIVZERO THEN
      Incr nTries;
      b:=2;
      RETRY;
    ENDIF
  ENDFUNC

  PROC Outer(num i)
    Middle i;
  ERROR
    IF ERRNO=ERR_OWN THEN
      sLog:=sLog+"r"+NumToStr(i,0)+" ";
      RETURN;
    ENDIF
  ENDPROC

  PROC Middle(num i)
    Inner i;
    nLog:=nLog*10+9;
  ENDPROC

  PROC Inner(num i)
    IF i MOD 2=0 RAISE ERR_OWN;
  ERROR
    RAISE;
  ENDPROC

  PROC Chain()
    VAR num n;
    n:=1 DIV 0;
    sLog:=sLog+"end";
  ERROR
    sLog:=sLog+"chain ";
    Mender;
    TRYNEXT;
  ENDPROC

  PROC Mender()
    VAR num n;
    n:=5 MOD 0;
  ERROR
    sLog:=sLog+"inner ";
    TRYNEXT;
  ENDPROC

  FUNC num OrElse(string s,num other)
    VAR num n;
    IF s="" RAISE ERR_OWN;
    IF NOT StrToVal(s,n) RAISE ERR_OWN;
    RETURN n;
  ERROR
    RETURN other;
  ENDFUNC

  PROC Divide(INOUT num n,num by)
    n:=n/by;
  ERROR
    IF ERRNO=ERR_DIVZERO TRYNEXT;
  ENDPROC

  PROC GiveUp(num limit)
    WaitUntil FALSE\MaxTime:=0.2;
    nLog:=0;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      Incr nTries;
      IF nTries<limit THEN
        RETRY;
      ELSE
        nLog:=-nTries;
        RETURN;
      ENDIF
    ENDIF
  ENDPROC

  PROC Tables()
    VAR num k:=0;
    VAR part p;
    VAR part q;
    VAR bool ok;
    VAR num n;
    ! 7 three dimensions
    FOR i FROM 2 TO 1 DO
      FOR j FROM 1 TO 3 DO
        FOR l FROM 2 TO 1 STEP -1 DO
          Incr k;
          aGrid{i,j,l}:=k;
        ENDFOR
      ENDFOR
    ENDFOR
    IF aGrid{2,1,2}=1 AND aGrid{2,3,1}=6 AND aGrid{1,2,1}=10 AND aGrid{1,3,2}=11 AND Dim(aGrid,2)=3 SetDO do7,1;
    ! 8 records copied, changed within, compared
    p:=aStock{1};
    q:=p;
    p.size.corner.z:=30;
    p.count:=p.count+LAST;
    aStock{2}.size:=p.size;
    IF q.size.corner.z=3 AND aStock{2}.size.corner=[1,2,30] AND p.count=11 AND q<>p AND aStock{2}.name="nut" SetDO do8,1;
    ! 9 sorted by a component, whole records exchanged
    aStock{2}.count:=5;
    aStock{1}.count:=9;
    SortStock aStock;
    IF aStock{1}.name="nut" AND aStock{2}.name="bolt" AND aStock{3}.name="cap" AND aStock{2}.count=9 SetDO do9,1;
    ! 10 at least one pass, and the other way round
    n:=0;
    FOR i FROM 5 TO 1 STEP 1 DO
      n:=n+i;
    ENDFOR
    FOR i FROM 1 TO -1 DO
      n:=n*10+i;
    ENDFOR
    IF n=5099 SetDO do10,1;
    ! 11 an aggregate as argument, a component given by reference
    Grow aStock{3}.size.w,[2,3,4];
    Grow aGrid{2,2,1},aStock{2}.size.corner;
    IF aStock{3}.size.w=7+9 AND aGrid{2,2,1}=-20 SetDO do11,1;
    ! 12 a test with texts, sums and several values
    k:=0;
    FOR i FROM 1 TO 3 DO
      TEST aStock{i}.name
      CASE "cap","lid":
        k:=k+100;
      CASE "bo"+"lt":
        k:=k+10;
      DEFAULT:
        k:=k+1;
      ENDTEST
      TEST i*2
      CASE FIRST+1,LAST-1:
        k:=k+1000;
      ENDTEST
    ENDFOR
    IF k=2111 SetDO do12,1;
    ! 13 sum of a list of any length, the largest place
    IF SumOf(aFilled)=32 AND aFilled{Largest(aFilled)}=9 AND Largest(aFilled)=1 SetDO do13,1;
  ENDPROC

  PROC SortStock(PERS part a{*})
    VAR part t;
    VAR bool moved:=TRUE;
    WHILE moved DO
      moved:=FALSE;
      FOR i FROM 1 TO Dim(a,1)-1 DO
        IF a{i}.count>a{i+1}.count THEN
          t:=a{i};
          a{i}:=a{i+1};
          a{i+1}:=t;
          moved:=TRUE;
        ENDIF
      ENDFOR
    ENDWHILE
  ENDPROC

  PROC Grow(INOUT num n,pos by)
    n:=n+by.x+by.y+by.z;
    IF by.x=1 n:=n-30;
  ENDPROC

  FUNC num SumOf(num a{*})
    VAR num s:=0;
    FOR i FROM Dim(a,1) TO 1 DO
      s:=s+a{i};
      a{i}:=0;
    ENDFOR
    RETURN s;
  ENDFUNC

  FUNC num Largest(VAR num a{*})
    VAR num at:=1;
    FOR i FROM 2 TO Dim(a,1) DO
      IF a{i}>a{at} at:=i;
    ENDFOR
    RETURN at;
  ENDFUNC

  PROC TextWork()
    VAR string s;
    VAR num n;
    VAR bool ok;
    VAR pos p;
    ! 14 a record read from a text and written again
    ok:=FALSE;
    ok:=StrToVal("[1.5,-2,30]",p);
    s:=ValToStr(p*2);
    IF ok AND p.y=-2 AND s="[3,-4,60]" SetDO do14,1;
    ! 15 words of a line
    s:="pick;3;left";
    n:=StrFind(s,1,";");
    IF StrPart(s,1,n-1)="pick" AND StrMatch(s,n+1,";")=7 AND StrPart(s,StrMatch(s,n+1,";")+1,4)="left" AND StrFind(s,1,"#")=12 SetDO do15,1;
    ! 16 numbers as texts
    IF NumToStr(2.345,1)="2.3" AND NumToStr(-0.6,0)="-1" AND NumToStr(7,2)="7.00" AND ValToStr(0.25)="0.25" AND ValToStr(TRUE)="TRUE" SetDO do16,1;
    ! 17 letters turned into others, order
    IF StrMap("a1b2","ab","xy")="x1y2" AND StrOrder("FIRST","SECOND",STR_UPPER) AND NOT StrOrder("B","A",STR_UPPER) AND StrMemb("part7",5,STR_DIGIT) SetDO do17,1;
  ENDPROC

  PROC Calls()
    VAR num n:=2;
    VAR string s;
    ! 18 called by name
    sLog:="";
    FOR i FROM 3 TO 1 STEP -1 DO
      %"Step"+NumToStr(i,0)%;
    ENDFOR
    IF sLog="cba" SetDO do18,1;
    ! 19 what may be left out, and what is passed on
    IF Weight(2)=2 AND Weight(2\by:=5)=10 AND Weight(2\heavy)=102 AND Pass(3)=3 AND Pass(3\by:=4)=12 SetDO do19,1;
    ! 20 rounding, whole parts, signs
    IF Round(2.5)=3 AND Round(-2.5)=-3 AND Trunc(-2.7)=-2 AND Round(2.345\Dec:=2)=2.35 AND -7 DIV 2=-3 AND 17 MOD 5=2 AND Abs(-3) DIV 2=1 SetDO do20,1;
    ! 21 jumps out of loops and again
    n:=0;
  again:
    n:=n+1;
    FOR i FROM 1 TO 5 DO
      WHILE TRUE DO
        IF i*n>=6 GOTO outside;
        GOTO next;
      ENDWHILE
    next:
    ENDFOR
    GOTO again;
  outside:
    IF n=2 SetDO do21,1;
    ! 22 kept data, hidden data, an own type
    nKept:=nKept+1;
    lvTank:=lvTank+0.5;
    IF nKept=18 AND Shadow(4)=11 AND nHidden=5 AND lvTank=2.5 SetDO do22,1;
  ENDPROC

  PROC Step1()
    sLog:=sLog+"a";
  ENDPROC

  PROC Step2()
    sLog:=sLog+"b";
  ENDPROC

  PROC Step3()
    sLog:=sLog+"c";
  ENDPROC

  FUNC num Weight(num n\num by|switch heavy)
    IF Present(by) RETURN n*by;
    IF Present(heavy) RETURN n+100;
    RETURN n;
  ENDFUNC

  FUNC num Pass(num n\num by)
    RETURN Weight(n\by?by);
  ENDFUNC

  FUNC num Shadow(num x)
    VAR num nHidden:=7;
    nHidden:=nHidden+x;
    RETURN nHidden;
  ENDFUNC
ENDMODULE
