/PROG  DEMO_L002
/ATTR
OWNER = MNEDITOR;
COMMENT = "LAYER 2";
LINE_COUNT = 46;
PROTECT = READ_WRITE;
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  UFRAME_NUM=1 ;
   2:  UTOOL_NUM=1 ;
   3:  !layer 2, z 2.837 mm ;
   4:L P[1] 100.0mm/sec FINE ;
   5:  WAIT 300.00(sec) ;
   6:  WAIT 300.00(sec) ;
   7:  WAIT 72.00(sec) ;
   8:L P[2] 100.0mm/sec FINE ;
   9:  AO[1]=1.0000 ;
  10:L P[3] 100.0mm/sec FINE ;
  11:  !pass 1 contour ;
  12:  WAIT 0.5(sec) ;
  13:  Weld Start[1,1] ;
  14:  WAIT 0.2(sec) ;
  15:L P[4] 6.4mm/sec CNT100 ;
  16:L P[5] 8.0mm/sec CNT100 ;
  17:L P[6] 8.0mm/sec CNT100 ;
  18:L P[7] 8.0mm/sec CNT100 ;
  19:L P[8] 8.0mm/sec CNT100 ;
  20:L P[9] 8.0mm/sec CNT100 ;
  21:L P[10] 10.0mm/sec FINE ;
  22:  AO[1]=0.5000 ;
  23:  WAIT 0.40(sec) ;
  24:  Weld End[1,1] ;
  25:  WAIT 0.5(sec) ;
  26:  WAIT 1(sec) ;
  27:  WAIT 0.05(sec) ;
  28:L P[11] 100.0mm/sec FINE ;
  29:L P[12] 100.0mm/sec FINE ;
  30:  AO[1]=1.0000 ;
  31:L P[13] 100.0mm/sec FINE ;
  32:  !pass 2 infill ;
  33:  WAIT 0.5(sec) ;
  34:  Weld Start[1,1] ;
  35:  WAIT 0.2(sec) ;
  36:L P[14] 6.4mm/sec CNT100 ;
  37:L P[15] 8.0mm/sec CNT100 ;
  38:L P[16] 6.0mm/sec CNT100 ;
  39:L P[17] 7.5mm/sec FINE ;
  40:  AO[1]=0.5000 ;
  41:  WAIT 0.40(sec) ;
  42:  Weld End[1,1] ;
  43:  WAIT 0.5(sec) ;
  44:  WAIT 1(sec) ;
  45:  WAIT 0.05(sec) ;
  46:L P[18] 100.0mm/sec FINE ;
/POS
P[1]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    90.000 mm, Y =     0.000 mm, Z =    36.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[2]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     0.000 mm, Y =     0.000 mm, Z =    36.419 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[3]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     0.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[4]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     5.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[5]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    30.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[6]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    30.000 mm, Y =    30.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[7]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     0.000 mm, Y =    30.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[8]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     0.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[9]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     2.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[10]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     6.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[11]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =     6.000 mm, Y =     0.000 mm, Z =    22.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[12]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    50.000 mm, Y =     0.000 mm, Z =    22.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[13]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    50.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[14]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    55.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[15]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    70.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[16]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    86.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[17]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    90.000 mm, Y =     0.000 mm, Z =     2.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
P[18]{
   GP1:
    UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X =    90.000 mm, Y =     0.000 mm, Z =    22.837 mm,
    W =  180.0000 deg, P =    0.0000 deg, R =    0.0000 deg
};
/END
