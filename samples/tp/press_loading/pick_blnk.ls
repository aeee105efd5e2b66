/PROG  PICK_BLNK
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "blank from rack";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 21;
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
   1:  !Blank of level AR[1], 3 tries ;
   2:  UFRAME_NUM=1 ;
   3:  UTOOL_NUM=1 ;
   4:   ;
   5:  PR[11,3:level offset]=AR[1]*30 ;
   6:  R[2:tries]=0 ;
   7:J P[1:above floor] 50% FINE Offset,PR[11:level offset]    ;
   8:  WAIT DI[1:rack there]=ON ;
   9:  LBL[1:try] ;
  10:L P[2:rack floor] 200mm/sec FINE Offset,PR[11:level offset]    ;
  11:  DO[1:vacuum]=ON ;
  12:  WAIT    .30(sec) ;
  13:  IF DI[2:vacuum ok]=ON,JMP LBL[2] ;
  14:  DO[1:vacuum]=OFF ;
  15:L P[2:rack floor] 200mm/sec FINE Offset,PR[11:level offset] Tool_Offset,PR[12:back up]    ;
  16:  WAIT    .30(sec) ;
  17:  R[2:tries]=R[2:tries]+1 ;
  18:  IF R[2:tries]<3,JMP LBL[1] ;
  19:  DO[3:no part]=PULSE,0.5sec ;
  20:  LBL[2:up] ;
  21:L P[1:above floor] 500mm/sec FINE Offset,PR[11:level offset]    ;
/POS
P[1:"above floor"]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =   140.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[2:"rack floor"]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =    40.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
/END
