MODULE demo_L002
  ! demo, cmt-steel-robots
  LOCAL CONST speeddata vd1:=[8.000,500.000,5000,1000];
  LOCAL CONST speeddata vd2:=[6.000,500.000,5000,1000];
  PROC Layer002()
    ! layer 2, z 2.837 mm
    MoveL [[70.000,30.000,22.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    MoveL [[35.000,20.000,22.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    MoveL [[35.000,20.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    ! pass 1 contour
    WaitTime \InPos,0;
    WaitDI diArc,0;
    SetDO doGas,1;
    WaitTime \InPos,0.5;
    SetDO doArc,1;
    WaitTime \InPos,0.2;
    WatchArc;
    ArcBurns;
    MoveC [[21.568,34.912,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],[[5.328,23.119,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveC [[15.366,5.739,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],[[33.703,13.899,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveC [[34.667,16.882,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],[[35.000,20.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,fine,tTorch\WObj:=wPart;
    WaitTime \InPos,0;
    IDelete iArc;
    WaitTime \InPos,0;
    SetDO doArc,0;
    WaitTime \InPos,0.5;
    WaitTime \InPos,1;
    SetDO doGas,0;
    MoveL [[35.000,20.000,22.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    MoveL [[50.000,5.000,22.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    MoveL [[50.000,5.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    ! pass 2 infill
    WaitTime \InPos,0;
    WaitDI diArc,0;
    SetDO doGas,1;
    WaitTime \InPos,0.5;
    SetDO doArc,1;
    WaitTime \InPos,0.2;
    WatchArc;
    ArcBurns;
    MoveL [[60.872,5.038,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveC [[67.366,8.251,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],[[70.000,15.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveL [[70.000,30.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd2,fine,tTorch\WObj:=wPart;
    WaitTime \InPos,0;
    IDelete iArc;
    WaitTime \InPos,0;
    SetDO doArc,0;
    WaitTime \InPos,0.5;
    WaitTime \InPos,1;
    SetDO doGas,0;
    MoveL [[70.000,30.000,22.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
  ENDPROC
ENDMODULE
