MODULE MachineTending
  ! Loads a machine through its door. The door is asked for again when it does not answer in time.
  ! Expected: the door opens at the third asking (two time-outs), the part is put in, the clamp never answers,
  ! so the alarm comes on and the message is written; the arm ends outside.

  CONST num MOST_TRIES:=4;
  VAR num nTries:=0;

  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  CONST jointtarget jOutside:=[[-30,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pDoor:=[[300,50,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pChuck:=[[400,100,200],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  PROC main()
    nTries:=0;
    OpenDoor;
    MoveAbsJ jOutside,v500,fine,tGrip;
    Load;
    MoveAbsJ jOutside,v500,fine,tGrip;
    Set doCycleEnd;
  ENDPROC

  PROC OpenDoor()
    SetDO doOpenDoor,1;
    WaitDI diDoorOpen,1\MaxTime:=2;
    SetDO doOpenDoor,0;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      Incr nTries;
      IF nTries<MOST_TRIES THEN
        PulseDO\High\PLength:=0.5,doCall;
        RETRY;
      ENDIF
    ENDIF
    RAISE;
  ENDPROC

  PROC Load()
    VAR bool bLate:=FALSE;

    MoveJ pDoor,v500,z10,tGrip;
    MoveL pChuck,v200,fine,tGrip;
    Set doClamp;
    WaitDI diClamped,1\MaxTime:=3\TimeFlag:=bLate;
    IF bLate THEN
      Set doAlarm;
      TPWrite "no answer of the clamp after "+NumToStr(nTries,0)+" door calls";
    ENDIF
    MoveL Offs(pChuck,0,0,100),v200,z10,tGrip;
    MoveJ pDoor,v500,z10,tGrip;
  ENDPROC
ENDMODULE
