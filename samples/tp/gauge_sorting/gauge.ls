/PROG  GAUGE
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "part in gauge";
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
DEFAULT_GROUP	= 1,*,*,*,*;
CONTROL_CODE	= 00000000 00000000;
/MN
   1:  !Held until it has measured ;
   2:  UFRAME_NUM=2 ;
   3:  UTOOL_NUM=1 ;
   4:   ;
   5:J P[1:above gauge] 50% CNT50    ;
   6:L P[2:gauge] 200mm/sec FINE    ;
   7:  DO[2:gauge]=ON ;
   8:  WAIT DI[2:gauge done]=ON ;
   9:  DO[2:gauge]=OFF ;
  10:L P[1:above gauge] 500mm/sec FINE    ;
/POS
P[1:"above gauge"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =    50.000  mm,	Y =     0.000  mm,	Z =   220.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[2:"gauge"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =    50.000  mm,	Y =     0.000  mm,	Z =   120.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
/END
