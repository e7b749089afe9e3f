MODULE frame_L001
  ! frame, cmt-steel-abb
  LOCAL CONST speeddata vd1:=[8.000,500.000,5000,1000];
  LOCAL CONST speeddata vd2:=[7.600,500.000,5000,1000];
  LOCAL CONST speeddata vd3:=[7.200,500.000,5000,1000];
  LOCAL CONST speeddata vd4:=[6.200,500.000,5000,1000];
  PROC Layer001()
    ! layer 1, z 1.419 mm
    MoveJ [[0.000,0.000,21.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vHome,fine,tTorch\WObj:=wPart;
    MoveL [[0.000,0.000,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    ! pass 1 contour
    WaitTime \InPos,0;
    WaitDI diArc,0;
    SetDO doGas,1;
    WaitTime \InPos,0.5;
    SetDO doArc,1;
    WaitTime \InPos,0.2;
    WatchArc;
    ArcBurns;
    MoveL [[30.000,0.000,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveL [[30.000,20.000,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveL [[0.000,20.000,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveL [[0.000,0.000,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,fine,tTorch\WObj:=wPart;
    WaitTime \InPos,0;
    IDelete iArc;
    WaitTime \InPos,0;
    SetDO doArc,0;
    WaitTime \InPos,0.5;
    WaitTime \InPos,1;
    SetDO doGas,0;
    MoveL [[0.000,0.000,21.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    MoveL [[5.000,10.000,21.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    MoveL [[5.000,10.000,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
    ! pass 2 infill
    WaitTime \InPos,0;
    WaitDI diArc,0;
    SetDO doGas,1;
    WaitTime \InPos,0.5;
    SetDO doArc,1;
    WaitTime \InPos,0.2;
    WatchArc;
    ArcBurns;
    MoveL [[10.000,10.000,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd1,zBead,tTorch\WObj:=wPart;
    MoveL [[15.000,10.000,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd2,zBead,tTorch\WObj:=wPart;
    MoveL [[20.000,10.500,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd3,zBead,tTorch\WObj:=wPart;
    MoveL [[25.000,10.000,1.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vd4,fine,tTorch\WObj:=wPart;
    WaitTime \InPos,0;
    IDelete iArc;
    WaitTime \InPos,0;
    SetDO doArc,0;
    WaitTime \InPos,0.5;
    WaitTime \InPos,1;
    SetDO doGas,0;
    MoveL [[25.000,10.000,21.419],[0.0000000,1.0000000,0.0000000,0.0000000],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,fine,tTorch\WObj:=wPart;
  ENDPROC
ENDMODULE
