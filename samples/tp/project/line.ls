/PROG  LINE
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "three stations";
PROG_SIZE	= 0;
CREATE		= DATE 24-03-04  TIME 08:00:00;
MODIFIED	= DATE 24-03-04  TIME 08:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 11;
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
   1:  !feeds three stations in turn ;
   2:  UFRAME_NUM=0 ;
   3:  UTOOL_NUM=1 ;
   4:J PR[1:home] 80% FINE ;
   5:  FOR R[1:station]=1 TO 3 ;
   6:  CALL FEED(R[1],R[2:depth]) ;
   7:  ENDFOR ;
   8:  CALL PROBE ;
   9:  Open gripper ;
  10:J PR[1] 80% FINE ;
  11:  IF R[20:found]=1,DO[4:all done]=ON ;
/POS
/END
