/PROG  TURNTAB
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "seam on a table";
PROG_SIZE	= 0;
CREATE		= DATE 24-05-06  TIME 08:00:00;
MODIFIED	= DATE 24-05-06  TIME 08:00:00;
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
DEFAULT_GROUP	= 1,1,*,*,*;
CONTROL_CODE	= 00000000 00000000;
/MN
   1:  !A seam on a plate that group 2 ;
   2:  !turns: DO 1 torch, 2 half way, ;
   3:  !DO 3 end of the seam, 4 home ;
   4:  UFRAME_NUM=0 ;
   5:  UTOOL_NUM=1 ;
   6:J P[1:home] 40% FINE ;
   7:  !arm and table together ;
   8:J P[2:above] 40% CNT30 ;
   9:L P[3:start] 200mm/sec FINE ;
  10:  DO[1:torch]=ON ;
  11:  !straight on the turning plate ;
  12:L P[4:end] 50mm/sec FINE COORD DB   70.0mm,DO[2:half]=ON ;
  13:  DO[1:torch]=OFF ;
  14:  PR[1:here]=LPOS ;
  15:  R[1]=PR[1,1]-900 ;
  16:  IF (R[1]<.01 AND R[1]>(-.01)),DO[3:in place]=ON ;
  17:  !back to the start of the seam ;
  18:C P[5]    
    :  P[3] 100mm/sec FINE COORD    ;
  19:L P[2] 200mm/sec CNT50 ;
  20:J P[1] 40% FINE ;
  21:  DO[4:home]=ON ;
/POS
P[1:"home"]{
   GP1:
	UF : 0, UT : 1,	
	J1=     0.000 deg,	J2=     0.000 deg,	J3=     0.000 deg,
	J4=     0.000 deg,	J5=   -90.000 deg,	J6=     0.000 deg
   GP2:
	UF : 0, UT : 1,	
	J1=     0.000 deg
};
P[2:"above"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   900.000  mm,	Y =     0.000  mm,	Z =   300.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
   GP2:
	UF : 0, UT : 1,	
	J1=     0.000 deg
};
P[3:"start"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   900.000  mm,	Y =     0.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
   GP2:
	UF : 0, UT : 1,	
	J1=     0.000 deg
};
P[4:"end"]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   900.000  mm,	Y =     0.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
   GP2:
	UF : 0, UT : 1,	
	J1=    90.000 deg
};
P[5]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   900.000  mm,	Y =     0.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
   GP2:
	UF : 0, UT : 1,	
	J1=    45.000 deg
};
/END
