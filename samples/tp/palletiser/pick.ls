/PROG  PICK
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "takes a box";
PROG_SIZE	= 0;
CREATE		= DATE 24-03-04  TIME 08:00:00;
MODIFIED	= DATE 24-03-04  TIME 08:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 7;
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
   1:  !One box from the infeed ;
   2:  UFRAME_NUM=0 ;
   3:J P[1:above] 80% CNT50 ;
   4:L P[2:box] 300mm/sec FINE ;
   5:  DO[1:vacuum]=ON ;
   6:  WAIT    .20(sec) ;
   7:L P[1] 300mm/sec CNT50 ;
/POS
P[1:"above"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   420.000  mm,	Y =   220.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[2:"box"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   420.000  mm,	Y =   220.000  mm,	Z =    60.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
