/PROG  FING_CLS
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "close and check";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 10;
MEMORY_SIZE	= 0;
PROTECT		= READ_WRITE;
TCD:  STACK_SIZE	= 0,
      TASK_PRIORITY	= 50,
      TIME_SLICE	= 0,
      BUSY_LAMP_OFF	= 0,
      ABORT_REQUEST	= 0,
      PAUSE_REQUEST	= 0;
DEFAULT_GROUP	= *,*,*,*,*;
CONTROL_CODE	= 00000000 00000000;
/MN
   1:  !1.5 s for the part ;
   2:  LBL[1:retry] ;
   3:  DO[1:close fingers]=ON ;
   4:  $WAITTMOUT=150 ;
   5:  WAIT DI[4:part held]=ON TIMEOUT,LBL[900] ;
   6:  END ;
   7:   ;
   8:  LBL[900:nothing held] ;
   9:  UALM[1] ;
  10:  JMP LBL[1] ;
/POS
/END
