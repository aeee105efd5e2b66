%%%
VERSION:1
LANGUAGE:ENGLISH
%%%
MODULE Frames
  CONST jointtarget jHome:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p1:=[[500,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p2:=[[500,150,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pIn:=[[40,30,20],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1.5,[0,0,60],[1,0,0,0],0,0,0]];
  PERS tooldata tLong:=[TRUE,[[0,0,180],[1,0,0,0]],[2,[0,0,80],[1,0,0,0],0,0,0]];
  PERS wobjdata wTray:=[FALSE,TRUE,"",[[450,-100,300],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wTurned:=[FALSE,TRUE,"",[[400,100,300],[0.70710678,0,0,0.70710678]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wMoving:=[FALSE,TRUE,"",[[450,-100,300],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST speeddata vMine:=[350,300,5000,1000];
  VAR clock ck;

  PROC main()
    VAR robtarget here;
    VAR jointtarget jt;
    VAR pose a;
    VAR pose b;
    VAR pos v;
    VAR num n;
    VAR num tSlow;
    VAR num tFast;
    VAR robtarget corner;
    ConfJ\On;
    ConfL\Off;
    AccSet 80,80;
    VelSet 100,1000;
    MoveAbsJ jHome\NoEOffs,v500,fine,tGrip;

    ! 1 joints read back
    jt:=CJointT();
    IF Near(jt.robax.rax_5,30) AND Near(jt.robax.rax_2,0) SetDO do1,1;

    ! 2 poses in a chain
    a:=[[450,-100,300],[1,0,0,0]];
    b:=PoseMult(a,[[10,20,30],[1,0,0,0]]);
    IF Near(b.trans.x,460) AND Near(b.trans.y,-80) AND Near(b.trans.z,330) SetDO do2,1;

    ! 3 a pose and its inverse
    a:=[[400,50,350],OrientZYX(90,0,0)];
    b:=PoseInv(a);
    v:=PoseVect(a,[10,20,30]);
    IF Near(b.trans.x,-50) AND Near(b.trans.y,400) AND Near(v.x,380) AND Near(v.y,60) SetDO do3,1;

    ! 4 a straight move ends where it should
    MoveJ p1,v500,z10,tGrip;
    MoveL p2,vMine,fine,tGrip;
    here:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    IF NearPos(here.trans,[500,150,400]) SetDO do4,1;

    ! 5 the same place in a work object
    here:=CRobT(\Tool:=tGrip\WObj:=wTray);
    IF NearPos(here.trans,[50,250,100]) SetDO do5,1;

    ! 6 a move in the work object
    MoveJ p1,v500,z10,tGrip;
    MoveL pIn,v300,fine,tGrip\WObj:=wTray;
    here:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    IF NearPos(here.trans,[490,-70,320]) SetDO do6,1;

    ! 7 another tool at the same place
    here:=CRobT(\Tool:=tLong\WObj:=wobj0);
    IF NearPos(here.trans,[490,-70,260]) SetDO do7,1;

    ! 8 the longer tool at the same point
    MoveL p1,v300,fine,tLong;
    here:=CRobT(\Tool:=tool0\WObj:=wobj0);
    IF NearPos(here.trans,[500,0,580]) SetDO do8,1;

    ! 9 offsets
    MoveL Offs(p1,-30,20,50),v300,fine,tGrip;
    here:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    IF NearPos(here.trans,[470,20,450]) SetDO do9,1;

    ! 10 in the direction of the tool, which looks down
    MoveL RelTool(p1,0,0,40),v300,fine,tGrip;
    here:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    IF NearPos(here.trans,[500,0,360]) SetDO do10,1;

    ! 11 turned about the tool
    MoveL RelTool(p1,0,0,0\Rz:=30),v300,fine,tGrip;
    jt:=CJointT();
    IF Near(Abs(jt.robax.rax_6),30) AND Near(jt.robax.rax_1,0) SetDO do11,1;

    ! 12 an axis more
    MoveAbsJ jHome,v500,fine,tGrip;
    jt:=CJointT();
    jt.robax.rax_1:=jt.robax.rax_1+15;
    jt.robax.rax_6:=-10;
    MoveAbsJ jt,v500,fine,tGrip;
    jt:=CJointT();
    IF Near(jt.robax.rax_1,15) AND Near(jt.robax.rax_6,-10) SetDO do12,1;

    ! 13 half a circle
    MoveJ p1,v500,fine,tGrip;
    MoveC Offs(p1,50,50,0),Offs(p1,0,100,0),v200,fine,tGrip;
    here:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    IF NearPos(here.trans,[500,100,400]) SetDO do13,1;

    ! 14 slow and fast
    MoveL p1,v300,fine,tGrip;
    tSlow:=Timed(p2,50);
    tFast:=Timed(p1,500);
    IF tSlow>2.9 AND tSlow<3.6 AND tFast<1.5 AND tFast>0.2 SetDO do14,1;

    ! 15 corners with a zone take less time
    tSlow:=Square(fine);
    tFast:=Square(z10);
    IF tFast<tSlow-0.05 SetDO do15,1;

    ! 16 rows and columns
    n:=0;
    FOR i FROM 0 TO 1 DO
      FOR j FROM 0 TO 2 DO
        corner:=Offs(pIn,i*30,j*25,0);
        MoveL corner,v300,z5,tGrip\WObj:=wTray;
        Incr n;
      ENDFOR
    ENDFOR
    MoveL corner,v300,fine,tGrip\WObj:=wTray;
    here:=CRobT(\Tool:=tGrip\WObj:=wTray);
    IF NearPos(here.trans,[70,80,20]) AND n=6 SetDO do16,1;

    ! 17 a turned work object
    MoveJ p1,v500,z20,tGrip;
    corner:=[[30,-80,60],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    corner.rot:=OrientZYX(90,0,180);
    ConfJ\Off;
    MoveL corner,v300,fine,tGrip\WObj:=wTurned;
    here:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    IF NearPos(here.trans,[480,130,360]) SetDO do17,1;

    ! 18 a work object that is moved by the program
    wMoving.oframe.trans:=[0,50,20];
    MoveL pIn,v300,fine,tGrip\WObj:=wMoving;
    here:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    IF NearPos(here.trans,[490,-20,340]) SetDO do18,1;

    ! 19 angles of an orientation
    IF Near(EulerZYX(\Z,OrientZYX(25,10,-5)),25) AND Near(EulerZYX(\Y,OrientZYX(25,10,-5)),10) AND Near(EulerZYX(\X,OrientZYX(25,10,-5)),-5) SetDO do19,1;

    ! 20 a place with its own offset
    corner:=p1;
    corner.trans:=corner.trans+[0,40,30];
    MoveL corner,v300,fine,tGrip;
    here:=CRobT(\Tool:=tGrip\WObj:=wobj0);
    IF NearPos(here.trans,[500,40,430]) SetDO do20,1;

    ! 21 distance between two places
    IF Near(Distance(p1.trans,p2.trans),150) AND Near(VectMagn(here.trans-p1.trans),50) SetDO do21,1;

    ! 22 joints of a place and back
    jt:=CalcJointT(p2,tGrip);
    here:=CalcRobT(jt,tGrip);
    IF NearPos(here.trans,[500,150,400]) SetDO do22,1;

    ! 23 a frame from three points
    a:=DefFrame(Offs(p1,0,0,0),Offs(p1,0,100,0),Offs(p1,-50,0,0));
    IF NearPos(a.trans,[500,0,400]) AND Near(EulerZYX(\Z,a.rot),90) SetDO do23,1;
    MoveAbsJ jHome,v500,fine,tGrip;
  ENDPROC

  FUNC bool Near(num x,num y)
    RETURN Abs(x-y)<0.5;
  ENDFUNC

  FUNC bool NearPos(pos x,pos y)
    RETURN Near(x.x,y.x) AND Near(x.y,y.y) AND Near(x.z,y.z);
  ENDFUNC

  FUNC num Timed(robtarget target,num speed)
    ClkReset ck;
    ClkStart ck;
    MoveL target,v100\V:=speed,fine,tGrip;
    ClkStop ck;
    RETURN ClkRead(ck);
  ENDFUNC

  FUNC num Square(zonedata zone)
    MoveL p1,v300,fine,tGrip;
    ClkReset ck;
    ClkStart ck;
    FOR k FROM 1 TO 2 DO
      MoveL Offs(p1,60,0,0),v300,zone,tGrip;
      MoveL Offs(p1,60,60,0),v300,zone,tGrip;
      MoveL Offs(p1,0,60,0),v300,zone,tGrip;
      MoveL p1,v300,zone,tGrip;
    ENDFOR
    MoveL p1,v300,fine,tGrip;
    ClkStop ck;
    RETURN ClkRead(ck);
  ENDFUNC
ENDMODULE
