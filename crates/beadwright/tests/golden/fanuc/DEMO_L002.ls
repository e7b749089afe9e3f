/PROG  DEMO_L002
/ATTR
OWNER = MNEDITOR;
COMMENT = "LAYER 2";
LINE_COUNT = 26;
PROTECT = READ_WRITE;
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  UFRAME_NUM=1 ;
   2:  UTOOL_NUM=1 ;
   3:  !layer 2, z 2.837 mm ;
   4:L P[1] 100.0mm/sec FINE ;
   5:L P[2] 100.0mm/sec FINE ;
   6:L P[3] 100.0mm/sec FINE ;
   7:  !pass 1 contour ;
   8:  Weld Start[1,1] ;
   9:  WAIT 0.2(sec) ;
  10:C P[4]
    :  P[5] 8.0mm/sec CNT100 ;
  11:C P[6]
    :  P[7] 8.0mm/sec CNT100 ;
  12:C P[8]
    :  P[9] 8.0mm/sec FINE ;
  13:  Weld End[1,1] ;
  14:  WAIT 0.5(sec) ;
  15:L P[10] 100.0mm/sec FINE ;
  16:L P[11] 100.0mm/sec FINE ;
  17:L P[12] 100.0mm/sec FINE ;
  18:  !pass 2 infill ;
  19:  Weld Start[1,1] ;
  20:  WAIT 0.2(sec) ;
  21:L P[13] 8.0mm/sec CNT100 ;
  22:C P[14]
    :  P[15] 8.0mm/sec CNT100 ;
  23:L P[16] 6.0mm/sec FINE ;
  24:  Weld End[1,1] ;
  25:  WAIT 0.5(sec) ;
  26:L P[17] 100.0mm/sec FINE ;
/POS
P[1]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    70.000 mm, Y =    30.000 mm, Z =    22.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[2]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    35.000 mm, Y =    20.000 mm, Z =    22.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[3]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    35.000 mm, Y =    20.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[4]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    21.568 mm, Y =    34.912 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[5]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     5.328 mm, Y =    23.119 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[6]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    15.366 mm, Y =     5.739 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[7]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    33.703 mm, Y =    13.899 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[8]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    34.667 mm, Y =    16.882 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[9]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    35.000 mm, Y =    20.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[10]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    35.000 mm, Y =    20.000 mm, Z =    22.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[11]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    50.000 mm, Y =     5.000 mm, Z =    22.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[12]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    50.000 mm, Y =     5.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[13]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    60.872 mm, Y =     5.038 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[14]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    67.366 mm, Y =     8.251 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[15]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    70.000 mm, Y =    15.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[16]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    70.000 mm, Y =    30.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[17]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    70.000 mm, Y =    30.000 mm, Z =    22.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
/END
