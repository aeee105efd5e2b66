/PROG  PUT_GOOD
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "good to chute";
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
   1:  !Onto the chute ;
   2:  UFRAME_NUM=2 ;
   3:  UTOOL_NUM=1 ;
   4:   ;
   5:J P[1:above chute] 50% CNT50    ;
   6:L P[2:chute] 200mm/sec FINE    ;
   7:  DO[1:close grip]=OFF ;
   8:  WAIT    .30(sec) ;
   9:L P[1:above chute] 500mm/sec FINE    ;
  10:  DO[3:good out]=ON ;
  11:  WAIT    .20(sec) ;
  12:  DO[3:good out]=OFF ;
  13:  R[1:goods]=R[1:goods]+1 ;
/POS
P[1:"above chute"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =   150.000  mm,	Z =   160.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[2:"chute"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =   150.000  mm,	Z =    60.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
/END
