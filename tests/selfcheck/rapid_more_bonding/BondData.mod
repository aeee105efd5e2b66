MODULE BondData
  ! Recipes, shift totals, tools, frames and taught points of the bonding and press cell.
  RECORD variant
    string name;
    num length;
    num width;
    num radius;
    num speed;
    num openTime;
    num pressTime;
    bool heated;
  ENDRECORD
  RECORD shiftTotal
    num good;
    num reject;
    num glue;
  ENDRECORD
  ! name, contour length, width, corner radius, bead speed, open time, press time, heated platen
  PERS variant aVar{3}:=[["COVER",80,60,15,80,14,1.5,FALSE],["FRAME",120,80,20,60,8,2.0,TRUE],["PLATE",60,60,10,50,10,1.0,FALSE]];
  VAR shiftTotal aTotal{3};
  PERS tooldata tGun:=[TRUE,[[0,0,150],[1,0,0,0]],[1.6,[0,0,60],[1,0,0,0],0,0,0]];
  PERS tooldata tGrip:=[TRUE,[[0,60,120],[0.70710678,0,0,0.70710678]],[2.1,[0,20,50],[1,0,0,0],0,0,0]];
  ! The fixture is measured with three points at the start of the shift.
  PERS wobjdata wFixture:=[FALSE,TRUE,"",[[460,-70,200],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wLids:=[FALSE,TRUE,"",[[330,-380,180],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget measOrigin:=[[460,-70,200],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget measX:=[[558.4808,-52.6352,200],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget measY:=[[450,60,200],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jHome:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pFixture:=[[0,0,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pLid:=[[0,0,10],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pChute:=[[300,380,350],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num ERR_NOTKNOWN:=1;

  ! Index of a variant by its name; an unknown name is an error of the caller.
  FUNC num FindVariant(string name)
    FOR i FROM 1 TO Dim(aVar,1) DO
      IF aVar{i}.name=name RETURN i;
    ENDFOR
    RAISE ERR_NOTKNOWN;
  ENDFUNC

  ! Length of the closed bead: four straight pieces and four quarter circles.
  FUNC num BeadLength(variant v)
    RETURN 2*(v.length-2*v.radius)+2*(v.width-2*v.radius)+2*3.14159265*v.radius;
  ENDFUNC

  FUNC bool Close(num a,num b,num tolerance)
    RETURN Abs(a-b)<=tolerance;
  ENDFUNC
ENDMODULE
