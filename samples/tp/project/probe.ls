/PROG  PROBE
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "looks for a part";
PROG_SIZE	= 0;
CREATE		= DATE 24-03-04  TIME 08:00:00;
MODIFIED	= DATE 24-03-04  TIME 08:00:00;
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
   1:  !down until the sensor sees it ;
   2:  R[20:found]=0 ;
   3:L P[1:above] 400mm/sec FINE ;
   4:  SKIP CONDITION DI[5:sensor]=ON ;
   5:L P[2:lowest] 50mm/sec FINE Skip,LBL[1],PR[4:there]=LPOS ;
   6:  R[20]=1 ;
   7:  IF PR[4,3]<150,JMP LBL[1] ;
   8:  DO[5:high enough]=ON ;
   9:  LBL[1] ;
  10:L P[1] 400mm/sec FINE ;
/POS
P[1:"above"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   400.000  mm,	Y =     0.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[2:"lowest"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   400.000  mm,	Y =     0.000  mm,	Z =   100.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
