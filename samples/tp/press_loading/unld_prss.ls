/PROG  UNLD_PRSS
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "part from press";
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
   1:  !Waits in front for the part ;
   2:  UFRAME_NUM=2 ;
   3:  UTOOL_NUM=1 ;
   4:   ;
   5:  WAIT DI[4:press done]=ON ;
   6:L P[1:above die] 500mm/sec CNT50    ;
   7:L P[2:die] 200mm/sec FINE    ;
   8:  DO[1:vacuum]=ON ;
   9:  WAIT DI[2:vacuum ok]=ON ;
  10:L P[1:above die] 500mm/sec CNT50    ;
  11:L P[3:front] 500mm/sec CNT50    ;
  12:L P[4:behind column] 500mm/sec CNT50    ;
  13:L P[5:before column] 500mm/sec CNT50    ;
/POS
P[1:"above die"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =   150.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[2:"die"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =    50.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[3:"front"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =  -150.000  mm,	Y =     0.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[4:"behind column"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =  -200.000  mm,	Y =  -150.000  mm,	Z =   250.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[5:"before column"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =  -150.000  mm,	Y =  -300.000  mm,	Z =   250.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
/END
