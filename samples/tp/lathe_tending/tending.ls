/PROG  TENDING
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "blanks to lathe";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 12;
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
   1:  !Three blanks through one lathe ;
   2:  CALL GET_READY ;
   3:   ;
   4:  LBL[10:next blank] ;
   5:  CALL TAKE_BLNK ;
   6:  CALL FILL_CHCK ;
   7:  CALL EMPT_CHCK ;
   8:  CALL PUT_DOWN ;
   9:  R[1:turned]=R[1:turned]+1 ;
  10:  IF R[1:turned]<3,JMP LBL[10] ;
  11:   ;
  12:J PR[1:home] 50% FINE    ;
/POS
/END
