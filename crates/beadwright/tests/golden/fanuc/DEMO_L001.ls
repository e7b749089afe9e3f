/PROG  DEMO_L001
/ATTR
OWNER = MNEDITOR;
COMMENT = "LAYER 1";
LINE_COUNT = 25;
PROTECT = READ_WRITE;
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  UFRAME_NUM=1 ;
   2:  UTOOL_NUM=1 ;
   3:  !layer 1, z 1.419 mm ;
   4:J P[1] 20% FINE ;
   5:L P[2] 100.0mm/sec FINE ;
   6:  !pass 1 contour ;
   7:  Weld Start[1,1] ;
   8:  WAIT 0.2(sec) ;
   9:C P[3]
    :  P[4] 8.0mm/sec CNT100 ;
  10:C P[5]
    :  P[6] 8.0mm/sec CNT100 ;
  11:C P[7]
    :  P[8] 8.0mm/sec FINE ;
  12:  Weld End[1,1] ;
  13:  WAIT 0.5(sec) ;
  14:L P[9] 100.0mm/sec FINE ;
  15:L P[10] 100.0mm/sec FINE ;
  16:L P[11] 100.0mm/sec FINE ;
  17:  !pass 2 infill ;
  18:  Weld Start[1,1] ;
  19:  WAIT 0.2(sec) ;
  20:L P[12] 8.0mm/sec CNT100 ;
  21:C P[13]
    :  P[14] 8.0mm/sec CNT100 ;
  22:L P[15] 6.0mm/sec FINE ;
  23:  Weld End[1,1] ;
  24:  WAIT 0.5(sec) ;
  25:L P[16] 100.0mm/sec FINE ;
/POS
P[1]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    35.000 mm, Y =    20.000 mm, Z =    21.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[2]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    35.000 mm, Y =    20.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[3]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    21.568 mm, Y =    34.912 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[4]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     5.328 mm, Y =    23.119 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[5]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    15.366 mm, Y =     5.739 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[6]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    33.703 mm, Y =    13.899 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[7]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    34.667 mm, Y =    16.882 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[8]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    35.000 mm, Y =    20.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[9]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    35.000 mm, Y =    20.000 mm, Z =    21.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[10]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    50.000 mm, Y =     5.000 mm, Z =    21.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[11]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    50.000 mm, Y =     5.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[12]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    60.872 mm, Y =     5.038 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[13]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    67.366 mm, Y =     8.251 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[14]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    70.000 mm, Y =    15.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[15]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    70.000 mm, Y =    30.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[16]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    70.000 mm, Y =    30.000 mm, Z =    21.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
/END
