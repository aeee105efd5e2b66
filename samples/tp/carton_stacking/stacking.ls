/PROG  STACKING
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "cartons to stack";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 19;
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
   1:  !Eight cartons, belt to stack ;
   2:  !2 columns, 2 rows, 2 layers ;
   3:  CALL PREPARE ;
   4:   ;
   5:  LBL[10:next carton] ;
   6:  CALL FETCH ;
   7:  CALL STACK ;
   8:  R[1:cartons]=R[1:cartons]+1 ;
   9:  R[11:column]=R[11:column]+1 ;
  10:  IF R[11:column]<2,JMP LBL[10] ;
  11:  R[11:column]=0 ;
  12:  R[12:row]=R[12:row]+1 ;
  13:  IF R[12:row]<2,JMP LBL[10] ;
  14:  R[12:row]=0 ;
  15:  R[13:layer]=R[13:layer]+1 ;
  16:  IF R[13:layer]<2,JMP LBL[10] ;
  17:   ;
  18:J PR[1:home] 50% FINE    ;
  19:  DO[3:stack full]=ON ;
/POS
/END
