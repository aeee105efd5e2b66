/PROG  LOADING
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "blanks to press";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 15;
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
   1:  !Five blanks through the press ;
   2:  CALL PREPARE ;
   3:   ;
   4:  !From the top of the rack down ;
   5:  LBL[10:next level] ;
   6:  CALL PICK_BLNK(R[1:level]) ;
   7:  IF DI[2:vacuum ok]=OFF,JMP LBL[20] ;
   8:  CALL LOAD_PRSS ;
   9:  CALL UNLD_PRSS ;
  10:  CALL PUT_AWAY ;
  11:  LBL[20:no blank] ;
  12:  R[1:level]=R[1:level]-1 ;
  13:  IF R[1:level]>0,JMP LBL[10] ;
  14:   ;
  15:J PR[1:home] 50% FINE    ;
/POS
/END
