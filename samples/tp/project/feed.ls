/PROG  FEED
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "one station";
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
   1:  !AR 1 station, AR 2 depth ;
   2:  PR[2:way]=P[1]-P[1] ;
   3:  PR[2,2]=AR[1]*80-160 ;
   4:  PR[3:down]=P[1]-P[1] ;
   5:  PR[3,3]=AR[2] ;
   6:L P[1:above] 400mm/sec CNT50 Offset,PR[2:way] ;
   7:  CALL GREIF(1) ;
   8:L P[1] 200mm/sec FINE Offset,PR[2] Tool_Offset,PR[3:down] ;
   9:  CALL GREIF(0) ;
  10:L P[1] 400mm/sec CNT50 Offset,PR[2] ;
/POS
P[1:"above"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   400.000  mm,	Y =     0.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
