/PROG  DEMO
/ATTR
OWNER = MNEDITOR;
COMMENT = "demo";
LINE_COUNT = 15;
PROTECT = READ_WRITE;
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  !The cell must supply: ;
   2:  !The signal that current flows: ;
   3:  !arc detect (FANUC), arc ;
   4:  !confirmation (Yaskawa), input 0 ;
   5:  !(UR), on while it does. ;
   6:  !The emergency stop also switches ;
   7:  !the power source off. ;
   8:  !Shielding gas has pressure, and ;
   9:  !the fume extraction runs. ;
  10:  UFRAME_NUM=1 ;
  11:  UTOOL_NUM=1 ;
  12:J P[1] 20% FINE ;
  13:  CALL DEMO_L001 ;
  14:  CALL DEMO_L002 ;
  15:J P[2] 20% FINE ;
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
