MODULE Logic
  ! Arithmetic, loops, records, texts and errors. Output don becomes 1 when expectation n holds.
  RECORD tray
    num rows;
    num pitch;
  ENDRECORD
  RECORD station
    num id;
    pos place;
    tray box;
  ENDRECORD
  CONST num nMax:=5;
  CONST string stNames{3}:=["LEFT","MIDDLE","RIGHT"];
  PERS num nTotal:=99;
  VAR num nCalls:=0;
  VAR num nGrid{3,4};

  PROC main()
    VAR num n;
    VAR num k;
    VAR num nHit:=0;
    VAR bool bOk;
    VAR string st1;
    VAR station s1;
    VAR station s2;
    VAR num nList{5}:=[9,8,7,6,5];
    VAR byte byMask:=170;
    ! 1: / is real, DIV and MOD whole
    IF 7/2=3.5 AND 17 DIV 5=3 AND 17 MOD 5=2 AND -17 DIV 5=-3 SetDO do1,1;
    ! 2: Round away from zero at the half, Trunc towards zero
    IF Round(2.5)=3 AND Round(-2.5)=-3 AND Trunc(-2.7)=-2 AND Round(3.14159\Dec:=2)=3.14 SetDO do2,1;
    ! 3: products before sums, relations before AND, AND before OR
    IF 2+3*4-8/2=10 AND (FALSE OR TRUE AND 3>2) SetDO do3,1;
    ! 4: NOT holds for the whole AND term behind it
    bOk:=FALSE;
    IF NOT bOk AND bOk SetDO do4,1;
    ! 5: the right side is not looked at when the left decides
    k:=0;
    IF k=0 OR 10/k>1 SetDO do5,1;
    ! 6: FOR counts both ways, the counter is the loop's own
    n:=0;
    FOR i FROM 1 TO nMax DO
      n:=n+i*i;
    ENDFOR
    FOR i FROM 9 TO 2 STEP -2 DO
      n:=n-i;
    ENDFOR
    FOR i FROM 3 TO 1 DO
      n:=n*10+i;
    ENDFOR
    IF n=31321 SetDO do6,1;
    ! 7: out of the inner loop by GOTO
    FOR i FROM 1 TO 4 DO
      FOR j FROM 1 TO 4 DO
        IF i*j=6 THEN
          nHit:=nHit*100+10*i+j;
          GOTO nextrow;
        ENDIF
      ENDFOR
      nextrow:
    ENDFOR
    IF nHit=2332 SetDO do7,1;
    ! 8: WHILE looks first
    n:=10;
    WHILE n>100 DO
      n:=0;
    ENDWHILE
    WHILE n<25 DO
      n:=n+12;
    ENDWHILE
    IF n=34 SetDO do8,1;
    ! 9: TEST by numbers and texts
    n:=0;
    FOR i FROM 1 TO 5 DO
      TEST i
      CASE 1:
        n:=n+1;
      CASE 2,3:
        n:=n+10;
      DEFAULT:
        n:=n+100;
      ENDTEST
    ENDFOR
    TEST stNames{2}
    CASE "LEFT","RIGHT":
      n:=0;
    CASE "MIDDLE":
      n:=n+1000;
    ENDTEST
    IF n=1221 SetDO do9,1;
    ! 10: arrays, whole and as parameter
    FOR i FROM 1 TO 3 DO
      FOR j FROM 1 TO Dim(nGrid,2) DO
        nGrid{i,j}:=10*i+j;
      ENDFOR
    ENDFOR
    IF nGrid{3,2}-nGrid{1,4}=18 AND nLeast(nList)=5 AND nList{1}=0 SetDO do10,1;
    ! 11: records are copied as a whole
    s1:=[7,[10,20,30],[3,12.5]];
    s2:=s1;
    s2.place.x:=s2.place.x+s2.box.pitch*s2.box.rows;
    s2.box.rows:=4;
    IF s1.place.x=10 AND s2.place.x=47.5 AND s1.box.rows=3 AND s2.id=7 SetDO do11,1;
    ! 12: a parameter is a copy, INOUT the variable itself
    n:=12;
    k:=30;
    Swap n,k;
    IF n=30 AND k=12 AND nHalf(k)=6 AND k=12 SetDO do12,1;
    ! 13: recursion and RETURN at once
    IF nFak(6)=720 AND nGrade(3)=0 AND nGrade(40)=1 AND nGrade(70)=2 SetDO do13,1;
    ! 14: optional arguments and switches
    IF nArea(4)=16 AND nArea(4\nWidth:=3)=12 AND nArea(4\Half)=8 SetDO do14,1;
    ! 15: data of the module
    nTotal:=0;
    Tally 5;
    Tally 6;
    IF nTotal=11 AND nCalls=2 SetDO do15,1;
    ! 16: texts
    st1:="PART "+"A7";
    IF StrLen(st1)=7 AND StrPart(st1,6,2)="A7" AND StrFind(st1,1,"T")=4 AND st1<>"part a7" SetDO do16,1;
    ! 17: numbers as texts and back
    st1:="N"+NumToStr(42,0)+"="+NumToStr(2.5,2);
    bOk:=StrToVal("128",n);
    IF st1="N42=2.50" AND bOk AND n=128 AND ValToStr(TRUE)="TRUE" SetDO do17,1;
    bOk:=StrToVal("12a",n);
    IF NOT bOk SetDO do18,1;
    ! 19: degrees
    IF Abs(Sin(30)-0.5)<0.0001 AND Abs(ATan2(1,-1)-135)<0.001 AND Abs(Sqrt(2.25)-1.5)<0.0001 AND Pow(2,10)=1024 SetDO do19,1;
    ! 20: bits of a byte
    IF BitAnd(byMask,240)=160 AND BitOr(byMask,5)=175 AND BitXOr(byMask,255)=85 AND BitCheck(byMask,2) SetDO do20,1;
    ! 21: own errors go to the caller
    n:=0;
    Risky n;
    IF n=3 SetDO do21,1;
    ! 22: late binding
    %"Tally"% 100;
    IF nTotal=111 SetDO do22,1;
  ENDPROC

  FUNC num nLeast(INOUT num nField{*})
    VAR num nBest;
    nBest:=nField{1};
    FOR i FROM 2 TO Dim(nField,1) DO
      IF nField{i}<nBest nBest:=nField{i};
    ENDFOR
    nField{1}:=0;
    RETURN nBest;
  ENDFUNC

  PROC Swap(INOUT num a,INOUT num b)
    VAR num nKeep;
    nKeep:=a;
    a:=b;
    b:=nKeep;
  ENDPROC

  FUNC num nHalf(num x)
    x:=x/2;
    RETURN x;
  ENDFUNC

  FUNC num nFak(num x)
    IF x<=1 RETURN 1;
    RETURN x*nFak(x-1);
  ENDFUNC

  FUNC num nGrade(num nPoints)
    IF nPoints<20 THEN
      RETURN 0;
    ELSEIF nPoints<50 THEN
      RETURN 1;
    ENDIF
    RETURN 2;
  ENDFUNC

  FUNC num nArea(num nLength\num nWidth\switch Half)
    VAR num nResult;
    IF Present(nWidth) THEN
      nResult:=nLength*nWidth;
    ELSE
      nResult:=nLength*nLength;
    ENDIF
    IF Present(Half) nResult:=nResult/2;
    RETURN nResult;
  ENDFUNC

  PROC Tally(num x)
    nTotal:=nTotal+x;
    Incr nCalls;
  ENDPROC

  PROC Risky(INOUT num nTries)
    Deeper nTries;
  ERROR
    IF ERRNO=77 THEN
      IF nTries<3 RETRY;
      TRYNEXT;
    ENDIF
  ENDPROC

  PROC Deeper(INOUT num nTries)
    Incr nTries;
    RAISE 77;
  ERROR
    RAISE;
  ENDPROC
ENDMODULE
