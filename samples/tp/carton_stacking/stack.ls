/PROG  STACK
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "carton on stack";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 14;
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
   1:  !Place from column, row, layer ;
   2:  UFRAME_NUM=2 ;
   3:  UTOOL_NUM=1 ;
   4:   ;
   5:  PR[11,1:place offset]=R[11:column]*140 ;
   6:  PR[11,2:place offset]=R[12:row]*120 ;
   7:  PR[11,3:place offset]=R[13:layer]*70 ;
   8:   ;
   9:J P[1:over corner] 50% CNT50 Offset,PR[11:place offset]    ;
  10:L P[2:corner] 200mm/sec FINE Offset,PR[11:place offset]    ;
  11:  DO[1:suction]=OFF ;
  12:  DO[2:blow off]=PULSE,0.2sec ;
  13:  WAIT    .40(sec) ;
  14:L P[1:over corner] 500mm/sec CNT50 Offset,PR[11:place offset]    ;
/POS
P[1:"over corner"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =    70.000  mm,	Y =    60.000  mm,	Z =   160.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[2:"corner"]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =    70.000  mm,	Y =    60.000  mm,	Z =    70.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
/END
