/PROG  DEMO
/ATTR
OWNER = MNEDITOR;
COMMENT = "demo";
LINE_COUNT = 6;
PROTECT = READ_WRITE;
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  UFRAME_NUM=1 ;
   2:  UTOOL_NUM=1 ;
   3:J P[1] 20% FINE ;
   4:  CALL DEMO_L001 ;
   5:  CALL DEMO_L002 ;
   6:J P[2] 20% FINE ;
/POS
P[1]{
   GP1:
    UF : 1, UT : 1,
    J1 =     0.000 deg, J2 =     0.000 deg, J3 =     0.000 deg,
    J4 =     0.000 deg, J5 =   -90.000 deg, J6 =     0.000 deg
};
P[2]{
   GP1:
    UF : 1, UT : 1,
    J1 =     0.000 deg, J2 =     0.000 deg, J3 =     0.000 deg,
    J4 =     0.000 deg, J5 =   -90.000 deg, J6 =     0.000 deg
};
/END
