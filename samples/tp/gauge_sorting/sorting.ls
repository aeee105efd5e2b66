/PROG  SORTING
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "gauge and sort";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 20;
MEMORY_SIZE	= 0;
PROTECT		= READ_WRITE;
TCD:  STACK_SIZE	= 0,
      TASK_PRIORITY	= 50,
      TIME_SLICE	= 0,
      BUSY_LAMP_OFF	= 0,
      ABORT_REQUEST	= 0,
      PAUSE_REQUEST	= 0;
DEFAULT_GROUP	= 1,*,*,*,*;
CONTROL_CODE	= 00000000 00000000;
/MN
   1:  !Four parts gauged and sorted ;
   2:  CALL PREPARE ;
   3:   ;
   4:  LBL[10:next part] ;
   5:  CALL FETCH ;
   6:  CALL GAUGE ;
   7:  IF DI[3:part good]=OFF,JMP LBL[20] ;
   8:  CALL PUT_GOOD ;
   9:  JMP LBL[30] ;
  10:  LBL[20:reject] ;
  11:  CALL PUT_REJ ;
  12:  LBL[30:sorted] ;
  13:  R[3:part]=R[3:part]+1 ;
  14:  IF R[3:part]<4,JMP LBL[10] ;
  15:   ;
  16:J PR[1:home] 50% FINE    ;
  17:  !Somebody empties the bin ;
  18:  IF R[2:rejects]<2,JMP LBL[99] ;
  19:  DO[5:bin full]=ON ;
  20:  LBL[99:end] ;
/POS
/END
