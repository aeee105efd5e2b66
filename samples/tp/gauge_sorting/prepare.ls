/PROG  PREPARE
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "outputs, home";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 13;
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
   1:  !Outputs off, counters zero ;
   2:  UFRAME_NUM=1 ;
   3:  UTOOL_NUM=1 ;
   4:  PAYLOAD[1] ;
   5:  DO[1:close grip]=OFF ;
   6:  DO[2:gauge]=OFF ;
   7:  DO[3:good out]=OFF ;
   8:  DO[4:reject out]=OFF ;
   9:  DO[5:bin full]=OFF ;
  10:  R[1:goods]=0 ;
  11:  R[2:rejects]=0 ;
  12:  R[3:part]=0 ;
  13:J PR[1:home] 50% FINE    ;
/POS
/END
