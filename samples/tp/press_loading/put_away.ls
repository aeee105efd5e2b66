/PROG  PUT_AWAY
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "crate or table";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 9;
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
   1:  !Every third part is inspected ;
   2:  R[3:goods]=R[3:goods]+1 ;
   3:  IF R[3:goods]=3,JMP LBL[10] ;
   4:  CALL TO_CRATE ;
   5:  END ;
   6:   ;
   7:  LBL[10:third part] ;
   8:  R[3:goods]=0 ;
   9:  CALL TO_TABLE ;
/POS
/END
