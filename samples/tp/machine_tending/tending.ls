/PROG  TENDING
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "door and clamp";
PROG_SIZE	= 0;
CREATE		= DATE 24-03-04  TIME 08:00:00;
MODIFIED	= DATE 24-03-04  TIME 08:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 34;
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
   1:  !loads a machine, with limits ;
   2:  !DI 1 open 2 idle 3 clamped 4 end ;
   3:  !DO 1 door 3 grip 4 clamp 5 start ;
   4:  UFRAME_NUM=0 ;
   5:  UTOOL_NUM=1 ;
   6:  DO[10:alarm]=OFF ;
   7:  $WAITTMOUT=800 ;
   8:J P[1:home] 80% FINE ;
   9:  WAIT DI[2:idle]=ON ;
  10:  DO[3:gripper]=ON ;
  11:  WAIT    .30(sec) ;
  12:J P[2:before] 80% CNT50 ;
  13:  DO[1:open door]=ON ;
  14:  R[10:step]=1 ;
  15:  WAIT DI[1:door open]=ON TIMEOUT,LBL[9] ;
  16:L P[3:load] 300mm/sec FINE ;
  17:  DO[4:clamp]=ON ;
  18:  R[10]=2 ;
  19:  WAIT DI[3:clamped]=ON AND DI[1]=ON TIMEOUT,LBL[9] ;
  20:  DO[3]=OFF ;
  21:  WAIT    .30(sec) ;
  22:L P[2] 400mm/sec FINE ;
  23:  DO[1]=OFF ;
  24:  DO[2:may close]=ON ;
  25:  DO[5:start]=PULSE,0.5sec ;
  26:  R[10]=3 ;
  27:  $WAITTMOUT=300 ;
  28:  WAIT (DI[4:finished]) TIMEOUT,LBL[9] ;
  29:  JMP LBL[10] ;
  30:  LBL[9:no answer] ;
  31:  DO[10]=ON ;
  32:  MESSAGE[MACHINE DOES NOT ANSWER] ;
  33:  LBL[10:end] ;
  34:J P[1] 80% FINE ;
/POS
P[1:"home"]{
   GP1:
	UF : 0, UT : 1,	
	J1=     0.000 deg,	J2=     0.000 deg,	J3=     0.000 deg,
	J4=     0.000 deg,	J5=   -90.000 deg,	J6=     0.000 deg
};
P[2:"before"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   380.000  mm,	Y =   200.000  mm,	Z =   250.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[3:"load"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   420.000  mm,	Y =   200.000  mm,	Z =   120.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
