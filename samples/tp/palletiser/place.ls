/PROG  PLACE
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "puts it down";
PROG_SIZE	= 0;
CREATE		= DATE 24-03-04  TIME 08:00:00;
MODIFIED	= DATE 24-03-04  TIME 08:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 18;
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
   1:  !place R[2]: column, row, layer ;
   2:  R[3:layer]=R[2:place] DIV 4 ;
   3:  R[4:rest]=R[2]-R[3]*4 ;
   4:  R[5:row]=R[4] DIV 2 ;
   5:  R[6:column]=R[4] MOD 2 ;
   6:  PR[1:shift]=P[3]-P[3] ;
   7:  PR[1,1]=R[6]*110 ;
   8:  PR[1,2]=R[5]*90 ;
   9:  PR[1,3]=R[3]*60 ;
  10:J P[1:above pallet] 80% CNT50 ;
  11:  UFRAME_NUM=1 ;
  12:L P[2:approach] 500mm/sec CNT30 Offset,PR[1:shift] ;
  13:L P[3:first place] 200mm/sec FINE Offset,PR[1] ;
  14:  DO[1]=OFF ;
  15:  WAIT    .20(sec) ;
  16:L P[2] 500mm/sec CNT30 Offset,PR[1] ;
  17:  UFRAME_NUM=0 ;
  18:J P[1] 80% CNT50 ;
/POS
P[1:"above pallet"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   400.000  mm,	Y =  -195.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[2:"approach"]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =   130.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[3:"first place"]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =    20.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
