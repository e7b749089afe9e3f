/PROG  DEMO_L001
/ATTR
OWNER = MNEDITOR;
COMMENT = "LAYER 1";
LINE_COUNT = 42;
PROTECT = READ_WRITE;
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  UFRAME_NUM=1 ;
   2:  UTOOL_NUM=1 ;
   3:  !layer 1, z 1.419 mm ;
   4:J P[1] 20% FINE ;
   5:  AO[1]=1.0000 ;
   6:L P[2] 100.0mm/sec FINE ;
   7:  !pass 1 contour ;
   8:  WAIT 0.5(sec) ;
   9:  Weld Start[1,1] ;
  10:  WAIT 0.2(sec) ;
  11:L P[3] 6.4mm/sec CNT100 ;
  12:L P[4] 8.0mm/sec CNT100 ;
  13:L P[5] 8.0mm/sec CNT100 ;
  14:L P[6] 8.0mm/sec CNT100 ;
  15:L P[7] 8.0mm/sec CNT100 ;
  16:L P[8] 8.0mm/sec CNT100 ;
  17:L P[9] 10.0mm/sec FINE ;
  18:  AO[1]=0.5000 ;
  19:  WAIT 0.40(sec) ;
  20:  Weld End[1,1] ;
  21:  WAIT 0.5(sec) ;
  22:  WAIT 1(sec) ;
  23:  WAIT 0.05(sec) ;
  24:L P[10] 100.0mm/sec FINE ;
  25:L P[11] 100.0mm/sec FINE ;
  26:  AO[1]=1.0000 ;
  27:L P[12] 100.0mm/sec FINE ;
  28:  !pass 2 infill ;
  29:  WAIT 0.5(sec) ;
  30:  Weld Start[1,1] ;
  31:  WAIT 0.2(sec) ;
  32:L P[13] 6.4mm/sec CNT100 ;
  33:L P[14] 8.0mm/sec CNT100 ;
  34:L P[15] 6.0mm/sec CNT100 ;
  35:L P[16] 7.5mm/sec FINE ;
  36:  AO[1]=0.5000 ;
  37:  WAIT 0.40(sec) ;
  38:  Weld End[1,1] ;
  39:  WAIT 0.5(sec) ;
  40:  WAIT 1(sec) ;
  41:  WAIT 0.05(sec) ;
  42:L P[17] 100.0mm/sec FINE ;
/POS
P[1]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     0.000 mm, Y =     0.000 mm, Z =    21.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[2]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     0.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[3]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     5.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[4]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    30.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[5]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    30.000 mm, Y =    30.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[6]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     0.000 mm, Y =    30.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[7]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     0.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[8]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     2.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[9]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     6.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[10]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     6.000 mm, Y =     0.000 mm, Z =    21.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[11]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    50.000 mm, Y =     0.000 mm, Z =    21.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[12]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    50.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[13]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    55.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[14]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    70.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[15]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    86.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[16]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    90.000 mm, Y =     0.000 mm, Z =     1.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[17]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    90.000 mm, Y =     0.000 mm, Z =    21.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
/END
