/PROG  PREPARE
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "outputs, home";
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
   1:  !Outputs off, no parts yet ;
   2:  UFRAME_NUM=1 ;
   3:  UTOOL_NUM=1 ;
   4:  PAYLOAD[1] ;
   5:  DO[1:vacuum]=OFF ;
   6:  DO[2:start press]=OFF ;
   7:  DO[3:no part]=OFF ;
   8:  DO[4:inspect]=OFF ;
   9:  R[1:level]=5 ;
  10:  R[3:goods]=0 ;
  11:  PR[11:level offset]=LPOS-LPOS ;
  12:J PR[1:home] 50% FINE    ;
/POS
/END
