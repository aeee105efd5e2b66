/PROG  FILL_CHCK
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "blank into chuck";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 15;
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
   1:  !Blank in chuck, lathe started ;
   2:  UFRAME_NUM=2 ;
   3:  UTOOL_NUM=1 ;
   4:   ;
   5:J P[1:gate] 50% FINE    ;
   6:  WAIT DI[2:lathe ready]=ON AND DI[3:gate open]=ON ;
   7:L P[2:above chuck] 500mm/sec CNT50    ;
   8:L P[3:chuck] 200mm/sec FINE    ;
   9:  DO[2:close chuck]=ON ;
  10:  WAIT    .40(sec) ;
  11:  CALL FING_OPN ;
  12:L P[2:above chuck] 500mm/sec CNT50    ;
  13:L P[1:gate] 500mm/sec FINE    ;
  14:  DO[3:start lathe]=PULSE,0.5sec ;
  15:  WAIT DI[2:lathe ready]=OFF ;
/POS
P[1:"gate"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =  -150.000  mm,	Y =     0.000  mm,	Z =   300.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[2:"above chuck"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =   150.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[3:"chuck"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =    50.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
/END
