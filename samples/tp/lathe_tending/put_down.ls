/PROG  PUT_DOWN
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "part onto tray";
PROG_SIZE	= 0;
CREATE		= DATE 26-02-10  TIME 09:00:00;
MODIFIED	= DATE 26-02-10  TIME 09:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 8;
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
   1:  !Turned part onto the tray ;
   2:  UFRAME_NUM=1 ;
   3:  UTOOL_NUM=1 ;
   4:   ;
   5:J P[1:above finished] 50% CNT50    ;
   6:L P[2:finished] 200mm/sec FINE    ;
   7:  CALL FING_OPN ;
   8:L P[1:above finished] 500mm/sec CNT50    ;
/POS
P[1:"above finished"]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =   180.000  mm,	Z =   140.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
P[2:"finished"]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =   180.000  mm,	Z =    40.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    90.000 deg
};
/END
