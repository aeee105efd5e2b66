MODULE Deburr
  ! Paths at the spindle jig.
  PERS tooldata tSpin:=[TRUE,[[0,0,130],[1,0,0,0]],[1.8,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wJig:=[FALSE,TRUE,"",[[400,-100,150],[1,0,0,0]],[[20,-10,0],[1,0,0,0]]];
  PERS speeddata vDeb:=[40,100,500,100];
  CONST robtarget pEdge:=[[-40,0,10],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBore:=[[20,10,15],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  PROC DeburrEdge(INOUT num nTime)
    VAR clock ck;
    MoveJ Offs(pEdge,0,0,60),v500,z10,tSpin\WObj:=wJig;
    MoveL pEdge,v100,fine,tSpin\WObj:=wJig;
    SetDO doCoolant,1;
    ClkReset ck;
    ClkStart ck;
    MoveL Offs(pEdge,80,0,0),vDeb,fine,tSpin\WObj:=wJig;
    ClkStop ck;
    SetDO doCoolant,0;
    nTime:=ClkRead(ck);
    MoveL Offs(pEdge,80,0,60),v200,z10,tSpin\WObj:=wJig;
  ENDPROC

  PROC DeburrBore(INOUT num nTime)
    VAR clock ck;
    CONST num r:=20;
    MoveJ Offs(pBore,-r,0,60),v500,z10,tSpin\WObj:=wJig;
    MoveL Offs(pBore,-r,0,0),v100,fine,tSpin\WObj:=wJig;
    ClkReset ck;
    ClkStart ck;
    MoveC Offs(pBore,0,r,0),Offs(pBore,r,0,0),vDeb,z1,tSpin\WObj:=wJig;
    MoveC Offs(pBore,0,-r,0),Offs(pBore,-r,0,0),vDeb,fine,tSpin\WObj:=wJig;
    ClkStop ck;
    nTime:=ClkRead(ck);
    MoveL Offs(pBore,-r,0,60),v200,z10,tSpin\WObj:=wJig;
  ENDPROC
ENDMODULE
