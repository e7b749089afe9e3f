MODULE demo_L002
  ! demo, cmt-steel-robots
  LOCAL CONST speeddata vd1:=[6.400,500.000,5000,1000];
  LOCAL CONST speeddata vd2:=[8.000,500.000,5000,1000];
  LOCAL CONST speeddata vd3:=[10.000,500.000,5000,1000];
  LOCAL CONST speeddata vd4:=[6.000,500.000,5000,1000];
  LOCAL CONST speeddata vd5:=[7.400,500.000,5000,1000];
  PROC Layer002()
    ! layer 2, z 2.837 mm
    MoveL [[90.000,0.000,36.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    WaitTime \InPos,672.000;
    MoveL [[0.000,0.000,36.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    SetAO aoWire,1.0000;
    MoveL [[0.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    ! pass 1 contour
    WaitTime \InPos,0;
    WaitDI diArc,0;
    SetDO doGas,1;
    WaitTime \InPos,0.5;
    SetDO doArc,1;
    WaitTime \InPos,0.2;
    WatchArc;
    ArcBurns;
    MoveL [[5.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveL [[30.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd2,zBead,tTorch\WObj:=wPart;
    MoveL [[30.000,30.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd2,zBead,tTorch\WObj:=wPart;
    MoveL [[0.000,30.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd2,zBead,tTorch\WObj:=wPart;
    MoveL [[0.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd2,zBead,tTorch\WObj:=wPart;
    MoveL [[2.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd2,zBead,tTorch\WObj:=wPart;
    MoveL [[6.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd3,fine,tTorch\WObj:=wPart;
    WaitTime \InPos,0;
    SetAO aoWire,0.5000;
    WaitTime \InPos,0.400;
    WaitTime \InPos,0;
    IDelete iArc;
    WaitTime \InPos,0;
    SetDO doArc,0;
    WaitTime \InPos,0.5;
    WaitTime \InPos,1;
    SetDO doGas,0;
    WaitTime \InPos,0.05;
    MoveL [[6.000,0.000,22.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    MoveL [[50.000,0.000,22.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    SetAO aoWire,1.0000;
    MoveL [[50.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    ! pass 2 infill
    WaitTime \InPos,0;
    WaitDI diArc,0;
    SetDO doGas,1;
    WaitTime \InPos,0.5;
    SetDO doArc,1;
    WaitTime \InPos,0.2;
    WatchArc;
    ArcBurns;
    MoveL [[55.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveL [[70.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd2,zBead,tTorch\WObj:=wPart;
    MoveL [[86.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd4,zBead,tTorch\WObj:=wPart;
    MoveL [[90.000,0.000,2.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd5,fine,tTorch\WObj:=wPart;
    WaitTime \InPos,0;
    SetAO aoWire,0.5000;
    WaitTime \InPos,0.400;
    WaitTime \InPos,0;
    IDelete iArc;
    WaitTime \InPos,0;
    SetDO doArc,0;
    WaitTime \InPos,0.5;
    WaitTime \InPos,1;
    SetDO doGas,0;
    WaitTime \InPos,0.05;
    MoveL [[90.000,0.000,22.837],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
  ENDPROC
ENDMODULE
