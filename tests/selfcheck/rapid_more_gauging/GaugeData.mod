MODULE GaugeData
  ! Ring gauging cell - data and helpers of the acceptance run
  RECORD ringclass
    string name;
    num nominal;
    num lower;
    num upper;
    num counted;
    pos bin;
  ENDRECORD

  RECORD lotinfo
    string family;
    num size;
    num sheet;
    bool valid;
  ENDRECORD

  CONST num nReadings:=7;
  CONST num rAir{7}:=[42.012,41.987,42.051,41.962,42.003,42.020,41.995];
  VAR num rWork{7};
  VAR num nFailed:=0;
  VAR num nMatrix{3,4}:=[[1,2,3,4],[5,6,7,8],[9,10,11,12]];

  PERS ringclass rcTable{4}:=[["small",41.97,41.95,41.98,0,[0,0,0]],
                              ["fit",42,41.98,42.015,0,[60,0,0]],
                              ["large",42.03,42.015,42.06,0,[120,0,0]],
                              ["scrap",0,0,0,0,[180,40,0]]];

  PERS tooldata tProbe:=[TRUE,[[0,0,110],[1,0,0,0]],[0.8,[0,0,50],[1,0,0,0],0,0,0]];
  PERS tooldata tCrank:=[TRUE,[[40,0,95],[0.923879533,0,0.382683432,0]],[1.5,[10,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wFixture:=[FALSE,TRUE,"",[[480,-120,220],[0.965925826,0,0,0.258819045]],[[10,20,0],[1,0,0,0]]];
  TASK PERS wobjdata wTray:=[FALSE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];

  CONST jointtarget jHome:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jAside:=[[-35,12,8,0,70,15],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pSeat:=[[40,30,60],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pOpen:=[[460,80,420],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget cCorner1:=[[400,-150,180],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget cCorner2:=[[480,-90,180],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget cCorner3:=[[370,-110,180],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  ! shared with the background task
  PERS bool bBeatOn:=FALSE;
  PERS num nBeats:=0;

  ! ---------------------------------------------------------------
  ! an expectation that holds switches its lamp on
  PROC Expect(VAR signaldo lamp,bool met,string what)
    IF met THEN
      SetDO lamp,1;
    ELSE
      Incr nFailed;
      TPWrite "not met: "+what+" ("\Num:=nFailed;
    ENDIF
  ENDPROC

  FUNC bool Near(num a,num b\num Tol)
    VAR num limit:=0.05;
    IF Present(Tol) limit:=Tol;
    RETURN Abs(a-b)<=limit;
  ENDFUNC

  FUNC bool NearPos(pos a,pos b\num Tol)
    RETURN Distance(a,b)<=LimitOr(0.1\given?Tol);
  ENDFUNC

  LOCAL FUNC num LimitOr(num standard\num given)
    IF Present(given) RETURN given;
    RETURN standard;
  ENDFUNC

  ! "RG-0420/17B" -> family RG, size 420, sheet 17
  FUNC lotinfo ReadLot(string code)
    VAR lotinfo info:=["",0,0,FALSE];
    VAR num dash;
    VAR num slash;
    VAR num stop1;
    VAR bool ok1;
    VAR bool ok2;
    dash:=StrMatch(code,1,"-");
    slash:=StrMatch(code,1,"/");
    IF dash>StrLen(code) OR slash>StrLen(code) RETURN info;
    info.family:=StrPart(code,1,dash-1);
    ok1:=StrToVal(StrPart(code,dash+1,slash-dash-1),info.size);
    stop1:=slash+1;
    WHILE stop1<=StrLen(code) AND StrMemb(code,stop1,STR_DIGIT) DO
      stop1:=stop1+1;
    ENDWHILE
    ok2:=StrToVal(StrPart(code,slash+1,stop1-slash-1),info.sheet);
    info.valid:=ok1 AND ok2;
    RETURN info;
  ENDFUNC

  ! insertion sort, in place, of any length
  PROC SortUp(INOUT num list{*})
    VAR num held;
    VAR num k;
    FOR i FROM 2 TO Dim(list,1) DO
      held:=list{i};
      k:=i-1;
      WHILE k>=1 AND HigherAt(list,k,held) DO
        list{k+1}:=list{k};
        Decr k;
      ENDWHILE
      list{k+1}:=held;
    ENDFOR
  ENDPROC

  LOCAL FUNC bool HigherAt(INOUT num list{*},num at,num than)
    RETURN at>=1 AND list{at}>than;
  ENDFUNC

  PROC MeanAndSpread(num list{*},INOUT num mean,INOUT num sigma)
    VAR num total:=0;
    FOR i FROM 1 TO Dim(list,1) DO
      total:=total+list{i};
    ENDFOR
    mean:=total/Dim(list,1);
    total:=0;
    FOR i FROM 1 TO Dim(list,1) DO
      total:=total+Pow(list{i}-mean,2);
    ENDFOR
    sigma:=Sqrt(total/(Dim(list,1)-1));
  ENDPROC

  FUNC num ClassOf(num reading)
    FOR i FROM 1 TO 3 DO
      IF reading>=rcTable{i}.lower AND reading<rcTable{i}.upper RETURN i;
    ENDFOR
    RETURN 4;
  ENDFUNC

  ! weighted sum over the characters of a text, modulo 97, and its bits turned over
  FUNC num CheckSum(string code\switch Inverted)
    VAR num sum:=0;
    VAR byte low;
    IF StrLen(code)=0 RETURN 0;
    FOR i FROM 1 TO StrLen(code) DO
      sum:=(sum*7+StrToByte(StrPart(code,i,1)\Char)) MOD 97;
    ENDFOR
    IF Present(Inverted) THEN
      low:=sum;
      RETURN BitXOr(low,255);
    ENDIF
    RETURN sum;
  ENDFUNC
ENDMODULE
