/PROG  CALCULATION
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "self checking";
PROG_SIZE	= 0;
CREATE		= DATE 24-03-04  TIME 08:00:00;
MODIFIED	= DATE 24-03-04  TIME 08:00:00;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 108;
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
   1:  !calculations check themselves ;
   2:  !output on: its line is right ;
   3:  R[1:one]=7 ;
   4:  R[2:two]=2 ;
   5:  R[3:result]=R[1]/R[2] ;
   6:  IF (R[3]=3.5),DO[1]=(ON) ;
   7:  R[3]=R[1] DIV R[2] ;
   8:  IF (R[3]=3),DO[2]=(ON) ;
   9:  R[3]=R[1] MOD R[2] ;
  10:  IF (R[3]=1),DO[3]=(ON) ;
  11:  R[3]=(R[1]+R[2]*(3+5)) ;
  12:  IF (R[3]=23),DO[4]=(ON) ;
  13:  R[3]=R[2]-R[1] ;
  14:  IF (R[3]=(-5)),DO[5]=(ON) ;
  15:  R[3]=SIN[30] ;
  16:  IF (R[3]>.499 AND R[3]<.501),DO[6]=(ON) ;
  17:  R[3]=ATAN2[R[1],R[1]] ;
  18:  IF (R[3]>44.999 AND R[3]<45.001),DO[7]=(ON) ;
  19:  R[3]=TRUNC[3.7] ;
  20:  IF (R[3]=3),DO[8]=(ON) ;
  21:  R[3]=ROUND[3.7] ;
  22:  IF (R[3]=4),DO[9]=(ON) ;
  23:  R[3]=SQRT[9] ;
  24:  IF (R[3]=3),DO[10]=(ON) ;
  25:  R[3]=0 ;
  26:  FOR R[4:count]=1 TO 3 ;
  27:  R[3]=R[3]+R[4] ;
  28:  ENDFOR ;
  29:  IF (R[3]=6 AND R[4]=3),DO[11]=(ON) ;
  30:  R[3]=0 ;
  31:  FOR R[4]=5 TO 1 ;
  32:  R[3]=R[3]+1 ;
  33:  ENDFOR ;
  34:  IF (R[3]=0 AND R[4]=5),DO[12]=(ON) ;
  35:  R[3]=0 ;
  36:  FOR R[4]=3 DOWNTO 1 ;
  37:  R[3]=R[3]*10+R[4] ;
  38:  ENDFOR ;
  39:  IF (R[3]=321 AND R[4]=1),DO[13]=(ON) ;
  40:  F[1]=(R[1]>R[2] AND !(R[1]=R[2])) ;
  41:  F[2]=(R[1]<R[2] OR F[3]) ;
  42:  IF (!F[2] AND F[1]),DO[14]=(ON) ;
  43:  R[3]=0 ;
  44:  FOR R[5]=1 TO 3 ;
  45:  SELECT R[5]=1,JMP LBL[1] ;
  46:         =2,JMP LBL[2] ;
  47:         ELSE,JMP LBL[3] ;
  48:  LBL[1] ;
  49:  LBL[3] ;
  50:  R[3]=R[3]*10+1 ;
  51:  JMP LBL[4] ;
  52:  LBL[2] ;
  53:  R[3]=R[3]*10+2 ;
  54:  LBL[4] ;
  55:  ENDFOR ;
  56:  IF (R[3]=121),DO[15]=(ON) ;
  57:  R[6:pointer]=1 ;
  58:  R[3]=R[R[6]] ;
  59:  IF (R[3]=7),DO[16]=(ON) ;
  60:  R[6]=8 ;
  61:  R[R[6]]=99 ;
  62:  IF (R[8]=99),DO[17]=(ON) ;
  63:  SR[1]='robot' ;
  64:  R[3]=STRLEN SR[1] ;
  65:  IF (R[3]=5),DO[18]=(ON) ;
  66:  SR[2]='b' ;
  67:  R[3]=FINDSTR SR[1],SR[2] ;
  68:  IF (R[3]=3),DO[19]=(ON) ;
  69:  SR[3]=SUBSTR SR[1],1,3 ;
  70:  SR[5]='7' ;
  71:  SR[4]=SR[1]+SR[5] ;
  72:  IF (SR[3]='rob' AND SR[4]='robot7'),DO[20]=(ON) ;
  73:  CALL ADD(10,21) ;
  74:  IF (R[3]=31),DO[21]=(ON) ;
  75:  PR[1:here]=P[1] ;
  76:  R[3]=PR[1,1] ;
  77:  PR[1,2]=PR[1,2]+50 ;
  78:  R[7]=PR[1,2] ;
  79:  IF (R[3]=400 AND R[7]=150),DO[22]=(ON) ;
  80:  PR[2]=PR[1]+P[1] ;
  81:  R[3]=PR[2,1] ;
  82:  PR[2]=PR[2]-PR[1] ;
  83:  R[7]=PR[2,2] ;
  84:  IF (R[3]=800 AND R[7]=100),DO[23]=(ON) ;
  85:  PR[3]=P[2] ;
  86:  R[3]=PR[3,5] ;
  87:  PR[3,1]=5 ;
  88:  R[7]=PR[3,1] ;
  89:  IF (R[3]=(-90) AND R[7]=5),DO[24]=(ON) ;
  90:  R[3]=0 ;
  91:  IF R[1]=7 AND R[2]=2,JMP LBL[5] ;
  92:  JMP LBL[6] ;
  93:  LBL[5] ;
  94:  R[3]=R[3]+2 ;
  95:  LBL[6] ;
  96:  IF (R[3]=2),DO[25]=(ON) ;
  97:  R[6]=7 ;
  98:  JMP LBL[R[6]] ;
  99:  LBL[8] ;
 100:  R[3]=R[3]*10+2 ;
 101:  JMP LBL[9] ;
 102:  LBL[7] ;
 103:  R[3]=1 ;
 104:  R[6]=8 ;
 105:  JMP LBL[R[6]] ;
 106:  LBL[9] ;
 107:  IF (R[3]=12),DO[26]=(ON) ;
 108:  DO[40]=ON ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   400.000  mm,	Y =   100.000  mm,	Z =   200.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[2]{
   GP1:
	UF : 0, UT : 1,	
	J1=     0.000 deg,	J2=     0.000 deg,	J3=     0.000 deg,
	J4=     0.000 deg,	J5=   -90.000 deg,	J6=     0.000 deg
};
/END
