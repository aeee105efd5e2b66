MODULE checks
  ! Arithmetic, loops, selection, parameters, records, texts and error handlers as the RAPID manuals state them.
  ! Output don becomes 1 when expectation n holds.
  RECORD part
    num id;
    string name;
    pos where;
  ENDRECORD
  CONST num ERR_MINE:=77;
  VAR num tries:=0;
  VAR num list{4}:=[4,3,2,1];
  VAR num grid{2,3}:=[[1,2,3],[4,5,6]];
  PERS num kept:=5;

  PROC main()
    VAR num n;
    VAR num m;
    VAR bool b;
    VAR string s;
    VAR part p;
    VAR part q;
    VAR num sum:=0;
    ! division
    hold1 7 / 2 = 3.5;
    IF 7 DIV 2 = 3 AND 7 MOD 2 = 1 SetDO do2,1;
    ! precedence: NOT binds a whole logical term
    b:=FALSE;
    IF (NOT b AND FALSE) = TRUE SetDO do3,1;
    IF 2 + 3 * 4 = 14 AND (2 + 3) * 4 = 20 SetDO do4,1;
    ! at least one pass, default step by direction
    FOR i FROM 1 TO 0 DO
      sum:=sum * 10 + i + 1;
    ENDFOR
    IF sum = 21 SetDO do5,1;
    sum:=0;
    FOR i FROM 5 TO 1 STEP 1 DO
      sum:=sum + i;
    ENDFOR
    IF sum = 5 SetDO do6,1;
    n:=3;
    sum:=0;
    FOR i FROM 1 TO n DO
      n:=10;
      sum:=sum + i;
    ENDFOR
    IF sum = 6 SetDO do7,1;
    WHILE n > 4 DO
      n:=n - 2.5;
    ENDWHILE
    IF n = 2.5 SetDO do8,1;
    ! TEST
    TEST n * 2
    CASE 1,2,3:
      m:=1;
    CASE 5:
      m:=2;
    CASE 5:
      m:=3;
    DEFAULT:
      m:=4;
    ENDTEST
    IF m = 2 SetDO do9,1;
    s:="abc";
    TEST s
    CASE "x","abc": SetDO do10,1;
    DEFAULT: Stop;
    ENDTEST
    ! arrays and records
    list{2}:=list{1} + grid{2,3};
    IF list{2} = 10 AND Dim(list,1) = 4 SetDO do11,1;
    p:=[1,"left",[10,20,30]];
    q:=p;
    q.where.y:=q.where.y + 5;
    q.name:=q.name + "/" + NumToStr(2.456,1);
    IF p.where.y = 20 AND q.where.y = 25 AND q.name = "left/2.5" SetDO do12,1;
    IF StrLen(q.name) = 8 AND StrPart(q.name,1,4) = "left" SetDO do13,1;
    b:=StrToVal("12.5",n);
    IF b AND n = 12.5 SetDO do14,1;
    ! parameters
    n:=1;
    change n,5;
    IF n = 6 SetDO do15,1;
    IF area(3,4) = 12 AND area(3,4\scale:=2) = 24 SetDO do16,1;
    choose\left;
    n:=2;
    copy n;
    IF n = 2 SetDO do18,1;
    ! error handlers
    retried;
    IF tries = 3 SetDO do19,1;
    IF skipped() = 4 SetDO do20,1;
    caught;
    kept:=kept + 1;
    IF kept = 6 SetDO do22,1;
    ! short circuit
    tries:=0;
    IF FALSE AND counted() SetDO do31,1;
    IF TRUE OR counted() THEN
      IF tries = 0 SetDO do23,1;
    ENDIF
    geo;
    %"late"%;
    n:=0;
  again:
    n:=n + 1;
    IF n < 3 GOTO again;
    IF n = 3 SetDO do28,1;
    IF Abs(Sin(30) - 0.5) < 0.00001 AND Abs(ATan2(1,1) - 45) < 0.0001 AND Sqrt(81) = 9 SetDO do29,1;
    IF Round(2.5) = 3 AND Trunc(-2.7) = -2 AND Round(3.14159\Dec:=2) = 3.14 SetDO do30,1;
  ENDPROC

  PROC hold1(bool good)
    IF good SetDO do1,1;
  ENDPROC
  PROC change(INOUT num x,num by)
    x:=x + by;
    by:=0;
  ENDPROC
  PROC copy(num x)
    x:=x + 1;
  ENDPROC
  FUNC num area(num w,num h\num scale)
    VAR num f:=1;
    IF Present(scale) f:=scale;
    RETURN w * h * f;
  ENDFUNC
  PROC choose(\switch left | switch right)
    IF Present(left) AND NOT Present(right) SetDO do17,1;
  ENDPROC
  PROC fails()
    tries:=tries + 1;
    IF tries < 3 RAISE ERR_MINE;
  ENDPROC
  PROC retried()
    tries:=0;
    fails;
  ERROR
    IF ERRNO = ERR_MINE RETRY;
  ENDPROC
  FUNC num skipped()
    VAR num x:=1;
    tries:=0;
    fails;
    x:=x + 3;
    RETURN x;
  ERROR
    TRYNEXT;
  ENDFUNC
  PROC caught()
    RAISE 5;
  ERROR
    IF ERRNO = 5 SetDO do21,1;
    RETURN;
  ENDPROC
  FUNC bool counted()
    tries:=tries + 1;
    RETURN TRUE;
  ENDFUNC
  PROC geo()
    VAR pose a:=[[100,0,50],[0.70710678,0,0,0.70710678]];
    VAR pose c;
    VAR robtarget t:=[[300,10,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    c:=PoseMult(a,[[10,20,0],[1,0,0,0]]);
    IF Abs(c.trans.x - 80) < 0.001 AND Abs(c.trans.y - 10) < 0.001 AND Abs(c.trans.z - 50) < 0.001 SetDO do24,1;
    c:=PoseMult(PoseInv(a),a);
    IF Abs(c.trans.x) < 0.001 AND Abs(c.rot.q1 - 1) < 0.0001 SetDO do25,1;
    t:=Offs(t,1,2,3);
    IF t.trans.x = 301 AND t.trans.y = 12 AND t.trans.z = 403 SetDO do26,1;
    c.rot:=OrientZYX(30,20,10);
    IF Abs(EulerZYX(\Z,c.rot) - 30) < 0.001 AND Abs(EulerZYX(\Y,c.rot) - 20) < 0.001 SetDO do27,1;
  ENDPROC
  PROC late()
    SetDO do32,1;
  ENDPROC
ENDMODULE
