/PROG  LOAD_PRSS
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "blank into press";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 16;
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
   1:  !Round the column into the die ;
   2:  UFRAME_NUM=2 ;
   3:  UTOOL_NUM=1 ;
   4:   ;
   5:L P[1:before column] 500mm/sec CNT50    ;
   6:L P[2:behind column] 500mm/sec CNT50    ;
   7:L P[3:front] 500mm/sec FINE    ;
   8:  WAIT DI[3:press open]=ON ;
   9:L P[4:above die] 500mm/sec CNT50    ;
  10:L P[5:die] 200mm/sec FINE    ;
  11:  DO[1:vacuum]=OFF ;
  12:  WAIT    .30(sec) ;
  13:L P[4:above die] 500mm/sec CNT50    ;
  14:L P[3:front] 500mm/sec FINE    ;
  15:  DO[2:start press]=PULSE,0.5sec ;
  16:  WAIT DI[3:press open]=OFF ;
/POS
P[1:"before column"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =  -150.000  mm,	Y =  -300.000  mm,	Z =   250.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[2:"behind column"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =  -200.000  mm,	Y =  -150.000  mm,	Z =   250.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[3:"front"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =  -150.000  mm,	Y =     0.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[4:"above die"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =   150.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[5:"die"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =    50.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
/END
