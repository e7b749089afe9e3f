/PROG  DEMO_L001
/ATTR
OWNER = MNEDITOR;
COMMENT = "LAYER 1";
LINE_COUNT = 33;
PROTECT = READ_WRITE;
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  UFRAME_NUM=1 ;
   2:  UTOOL_NUM=1 ;
   3:  !layer 1, z 1.419 mm ;
   4:J P[1] 20% FINE ;
   5:L P[2] 100.0mm/sec FINE ;
   6:  !pass 1 contour ;
   7:  DO[1]=ON ;
   8:  WAIT 0.5(sec) ;
   9:  Weld Start[1,1] ;
  10:  WAIT 0.2(sec) ;
  11:C P[3]
    :  P[4] 8.0mm/sec CNT100 ;
  12:C P[5]
    :  P[6] 8.0mm/sec CNT100 ;
  13:C P[7]
    :  P[8] 8.0mm/sec FINE ;
  14:  Weld End[1,1] ;
  15:  WAIT 0.5(sec) ;
  16:  WAIT 1(sec) ;
  17:  DO[1]=OFF ;
  18:L P[9] 100.0mm/sec FINE ;
  19:L P[10] 100.0mm/sec FINE ;
  20:L P[11] 100.0mm/sec FINE ;
  21:  !pass 2 infill ;
  22:  DO[1]=ON ;
  23:  WAIT 0.5(sec) ;
  24:  Weld Start[1,1] ;
  25:  WAIT 0.2(sec) ;
  26:L P[12] 8.0mm/sec CNT100 ;
  27:C P[13]
    :  P[14] 8.0mm/sec CNT100 ;
  28:L P[15] 6.0mm/sec FINE ;
  29:  Weld End[1,1] ;
  30:  WAIT 0.5(sec) ;
  31:  WAIT 1(sec) ;
  32:  DO[1]=OFF ;
  33:L P[16] 100.0mm/sec FINE ;
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
