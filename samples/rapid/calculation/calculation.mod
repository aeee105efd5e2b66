MODULE Calculation
  ! Checks the language by itself: primes, sorting, texts, records, matrices, recursion, geometry.
  ! Expected: each check switches its output on, in order; doFailed stays off; doAll comes on at the end.

  RECORD entry
    string key;
    num value;
    pos place;
  ENDRECORD

  CONST num COUNT:=8;
  VAR num nList{COUNT}:=[5,3,8,1,9,2,7,4];
  VAR num nMatrix{2,3}:=[[1,2,3],[4,5,6]];
  VAR num nCube{2,2,2};
  VAR entry enBook{2}:=[["one",1,[1,1,1]],["two",2,[2,2,2]]];
  VAR num nCalls:=0;

  PROC main()
    VAR bool bGood:=TRUE;

    Arithmetic bGood;
    Set doArithmetic;
    Sorting bGood;
    Set doSorting;
    Texts bGood;
    Set doTexts;
    Structures bGood;
    Set doStructures;
    Routines bGood;
    Set doRoutines;
    Geometry bGood;
    Set doGeometry;
    IF bGood THEN
      Set doAll;
    ELSE
      Set doFailed;
    ENDIF
  ENDPROC

  PROC Expect(INOUT bool bGood,bool bHolds)
    IF NOT bHolds bGood:=FALSE;
  ENDPROC

  PROC Arithmetic(INOUT bool bGood)
    VAR num nPrimes:=0;
    VAR num nSum:=0;

    Expect bGood,7/2=3.5;
    Expect bGood,(7 DIV 2=3) AND (7 MOD 2=1);
    Expect bGood,2+3*4-1=13;
    Expect bGood,NOT (1>2) AND TRUE;
    Expect bGood,Abs(Sin(30)-0.5)<0.0001;
    Expect bGood,(Round(2.5)=3) AND (Trunc(-2.7)=-2);
    FOR n FROM 2 TO 30 DO
      IF IsPrime(n) Incr nPrimes;
    ENDFOR
    Expect bGood,nPrimes=10;
    FOR n FROM 3 TO 1 DO
      nSum:=nSum*10+n;
    ENDFOR
    Expect bGood,nSum=321;
  ENDPROC

  FUNC bool IsPrime(num n)
    VAR num d:=2;

    WHILE d*d<=n DO
      IF n MOD d=0 RETURN FALSE;
      d:=d+1;
    ENDWHILE
    RETURN TRUE;
  ENDFUNC

  ! Sorts by exchanging neighbours until nothing changes.
  PROC Sorting(INOUT bool bGood)
    VAR num nKept;
    VAR bool bChanged;

  again:
    bChanged:=FALSE;
    FOR i FROM 1 TO COUNT-1 DO
      IF nList{i}>nList{i+1} THEN
        nKept:=nList{i};
        nList{i}:=nList{i+1};
        nList{i+1}:=nKept;
        bChanged:=TRUE;
      ENDIF
    ENDFOR
    IF bChanged GOTO again;
    Expect bGood,(nList{1}=1) AND (nList{4}=4) AND (nList{8}=9);
    Expect bGood,Total(nList)=39;
  ENDPROC

  FUNC num Total(num nNumbers{*})
    VAR num nSum:=0;

    FOR i FROM 1 TO Dim(nNumbers,1) DO
      nSum:=nSum+nNumbers{i};
    ENDFOR
    RETURN nSum;
  ENDFUNC

  PROC Texts(INOUT bool bGood)
    VAR string stText:="pallet";
    VAR num nRead;

    stText:=stText+"-"+NumToStr(12.345,1);
    Expect bGood,stText="pallet-12.3";
    Expect bGood,StrLen(stText)=11;
    Expect bGood,StrPart(stText,8,2)="12";
    Expect bGood,StrFind(stText,1,STR_DIGIT)=8;
    Expect bGood,StrMatch(stText,1,"let")=4;
    Expect bGood,StrMap("abc",STR_LOWER,STR_UPPER)="ABC";
    Expect bGood,StrToVal("42.5",nRead);
    Expect bGood,nRead=42.5;
    TEST stText
    CASE "pallet":
      bGood:=FALSE;
    CASE "box","pallet-12.3":
      Expect bGood,TRUE;
    DEFAULT:
      bGood:=FALSE;
    ENDTEST
  ENDPROC

  PROC Structures(INOUT bool bGood)
    VAR entry enCopy;

    enCopy:=enBook{2};
    enCopy.place.z:=enCopy.place.z+8;
    enCopy.key:="copy";
    Expect bGood,(enBook{2}.place.z=2) AND (enCopy.place.z=10);
    Expect bGood,(enBook{2}.key="two") AND (enCopy.key="copy");
    FOR i FROM 1 TO 2 DO
      FOR j FROM 1 TO 2 DO
        FOR k FROM 1 TO 2 DO
          nCube{i,j,k}:=nMatrix{i,j}*k;
        ENDFOR
      ENDFOR
    ENDFOR
    Expect bGood,nCube{2,2,2}+nCube{1,1,1}=11;
  ENDPROC

  PROC Routines(INOUT bool bGood)
    VAR num nValue:=1;

    Expect bGood,Factorial(6)=720;
    Change nValue,5;
    Expect bGood,nValue=6;
    Expect bGood,(Area(3,4)=12) AND (Area(3,4\scale:=2)=24);
    nCalls:=0;
    Expect bGood,(FALSE AND Counted())=FALSE;
    Expect bGood,(TRUE OR Counted()) AND (nCalls=0);
    Expect bGood,Counted();
    Expect bGood,nCalls=1;
  ENDPROC

  FUNC num Factorial(num n)
    IF n<=1 RETURN 1;
    RETURN n*Factorial(n-1);
  ENDFUNC

  PROC Change(INOUT num nValue,num nBy)
    nValue:=nValue+nBy;
    nBy:=0;
  ENDPROC

  FUNC num Area(num nWidth,num nHeight\num scale)
    IF Present(scale) RETURN nWidth*nHeight*scale;
    RETURN nWidth*nHeight;
  ENDFUNC

  FUNC bool Counted()
    Incr nCalls;
    RETURN TRUE;
  ENDFUNC

  PROC Geometry(INOUT bool bGood)
    VAR pose peA:=[[100,0,50],[0.707106781,0,0,0.707106781]];
    VAR pose peB;
    VAR robtarget p:=[[300,10,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

    peB:=PoseMult(peA,[[10,20,0],[1,0,0,0]]);
    Expect bGood,Distance(peB.trans,[80,10,50])<0.001;
    peB:=PoseMult(PoseInv(peA),peA);
    Expect bGood,VectMagn(peB.trans)<0.001;
    p:=Offs(p,1,2,3);
    Expect bGood,(p.trans.x=301) AND (p.trans.y=12) AND (p.trans.z=403);
    p:=RelTool(p,0,0,10);
    Expect bGood,Abs(p.trans.z-393)<0.001;
    peB.rot:=OrientZYX(30,20,10);
    Expect bGood,Abs(EulerZYX(\Z,peB.rot)-30)<0.001;
  ENDPROC
ENDMODULE
