/PROG  PALLETISER
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "stacks boxes";
PROG_SIZE	= 0;
CREATE		= DATE 24-03-04  TIME 08:00:00;
MODIFIED	= DATE 24-03-04  TIME 08:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 24;
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
   1:  !nine boxes, 2 x 2 in two layers ;
   2:  !output 8: the pallet is full ;
   3:  UFRAME_NUM=0 ;
   4:  UTOOL_NUM=1 ;
   5:  DO[1:vacuum]=OFF ;
   6:  R[1:done]=0 ;
   7:  R[2:place]=0 ;
   8:J P[1:home] 80% FINE ;
   9:  LBL[1:next box] ;
  10:  CALL PICK ;
  11:  CALL PLACE ;
  12:  R[1]=R[1]+1 ;
  13:  R[2]=R[2]+1 ;
  14:  IF (R[2]=8) THEN ;
  15:  !the pallet is taken away ;
  16:J P[1] 80% FINE ;
  17:  DO[8:full]=ON ;
  18:  WAIT   1.00(sec) ;
  19:  DO[8]=OFF ;
  20:  R[2]=0 ;
  21:  ENDIF ;
  22:  IF R[1]<9,JMP LBL[1] ;
  23:J P[1] 80% FINE ;
  24:  DO[2:ready]=ON ;
/POS
P[1:"home"]{
   GP1:
	UF : 0, UT : 1,	
	J1=     0.000 deg,	J2=     0.000 deg,	J3=     0.000 deg,
	J4=     0.000 deg,	J5=   -90.000 deg,	J6=     0.000 deg
};
/END
