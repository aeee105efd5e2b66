/PROG  DISPENSING
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "bead of glue";
PROG_SIZE	= 0;
CREATE		= DATE 24-03-04  TIME 08:00:00;
MODIFIED	= DATE 24-03-04  TIME 08:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 19;
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
   1:  !glue: DO 1 gun 2 corner 3 done ;
   2:  UFRAME_NUM=2 ;
   3:  UTOOL_NUM=2 ;
   4:J P[1:home] 60% FINE ;
   5:L P[2:above] 250mm/sec CNT20 ;
   6:L P[3:start] 250mm/sec FINE ;
   7:  DO[1:gun]=ON ;
   8:L P[4] 120mm/sec CNT100 ;
   9:C P[5]    
    :  P[6] 120mm/sec CNT100     ;
  10:L P[7] 120mm/sec CNT100 DB   10.0mm,DO[2:corner]=ON ;
  11:L P[8] 120mm/sec CNT100 TB    .10sec,DO[2]=OFF ;
  12:L P[3] 120mm/sec FINE DB    5.0mm,DO[1]=OFF ;
  13:L P[2] 250mm/sec CNT20 ;
  14:  !a ring around the hole ;
  15:C P[10]    
    :  P[11] 100mm/sec FINE Tool_Offset,PR[2:gap]     ;
  16:J P[1] 60% FINE ;
  17:  DO[3:done]=ON ;
/POS
P[1:"home"]{
   GP1:
	UF : 2, UT : 2,	
	J1=     0.000 deg,	J2=     0.000 deg,	J3=     0.000 deg,
	J4=     0.000 deg,	J5=   -90.000 deg,	J6=     0.000 deg
};
P[2]{
   GP1:
	UF : 2, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =    20.000  mm,	Y =     0.000  mm,	Z =    60.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[3]{
   GP1:
	UF : 2, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =    20.000  mm,	Y =     0.000  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[4]{
   GP1:
	UF : 2, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =   120.000  mm,	Y =     0.000  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[5]{
   GP1:
	UF : 2, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =   134.142  mm,	Y =     5.858  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[6]{
   GP1:
	UF : 2, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =   140.000  mm,	Y =    20.000  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[7]{
   GP1:
	UF : 2, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =   140.000  mm,	Y =   100.000  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[8]{
   GP1:
	UF : 2, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =   100.000  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[10]{
   GP1:
	UF : 2, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =    55.000  mm,	Y =    30.000  mm,	Z =    30.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[11]{
   GP1:
	UF : 2, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =    90.000  mm,	Y =     0.000  mm,	Z =    60.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
