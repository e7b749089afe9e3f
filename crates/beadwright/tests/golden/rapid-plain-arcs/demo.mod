MODULE demo
  ! demo, cmt-steel-robots
  ! The cell must supply:
  ! The signal that current flows: arc detect (FANUC), arc confirmation
  ! (Yaskawa), input 0 (UR), on while it does.
  ! The emergency stop also switches the power source off.
  ! Shielding gas has pressure, and the fume extraction runs.
  TASK PERS tooldata tTorch:=[TRUE,[[85.000,0.000,320.000],[0.9238795,0.0000000,0.3826834,0.0000000]],[4.500,[30.000,0.000,120.000],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wPart:=[FALSE,TRUE,"",[[0.000,0.000,400.000],[1.0000000,0.0000000,0.0000000,0.0000000]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0.000,0.000,0.000,0.000,30.000,0.000],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST speeddata vHome:=[100.000,500.000,5000,1000];
  CONST speeddata vTravel:=[100.000,500.000,5000,1000];
  CONST zonedata zBead:=[FALSE,1.000,1.000,1.000,0.100,1.000,0.100];
  VAR intnum iArc;
  PERS restartdata rdArc:=[FALSE,FALSE,0,0,0,0,0,0,0,0,0,0,0,0,0];
  PROC main()
    ConfL \Off;
    ConfJ \Off;
    SingArea \Wrist;
    CirPathMode \ObjectFrame;
    MoveAbsJ jHome,vHome,fine,tTorch\WObj:=wPart;
    IDelete iArc;
    TriggStopProc rdArc\DO1:=doArc,doShadow;
    IF ModExist("demo_L001") EraseModule "demo_L001";
    Load \Dynamic,"HOME:/part/demo_L001.mod";
    %"demo_L001:Layer001"%;
    UnLoad "HOME:/part/demo_L001.mod";
    IF ModExist("demo_L002") EraseModule "demo_L002";
    Load \Dynamic,"HOME:/part/demo_L002.mod";
    %"demo_L002:Layer002"%;
    UnLoad "HOME:/part/demo_L002.mod";
    SetDO doArc,0;
    SetDO doGas,0;
    MoveAbsJ jHome,vHome,fine,tTorch\WObj:=wPart;
  ENDPROC
  PROC WatchArc()
    IDelete iArc;
    CONNECT iArc WITH tArcLost;
    ISignalDI \SingleSafe,diArc,0,iArc;
  ENDPROC
  PROC ArcBurns()
    VAR num tried:=1;
    VAR bool late:=FALSE;
    WaitDI diArc,1\MaxTime:=3\TimeFlag:=late;
    WHILE late OR DOutput(doGas)=0 DO
      SetDO doArc,0;
      IF tried>=3 THEN
        WaitTime 5;
        SetDO doGas,0;
        TPWrite "The arc does not burn. Start strikes it again.";
        Stop;
        tried:=0;
      ENDIF
      tried:=tried+1;
      SetDO doGas,1;
      WaitTime 0.5;
      SetDO doArc,1;
      WaitTime 0.2;
      WaitDI diArc,1\MaxTime:=3\TimeFlag:=late;
    ENDWHILE
  ENDPROC
  TRAP tArcLost
    StopMove;
    SetDO doArc,0;
    WaitTime 5;
    SetDO doGas,0;
    TPWrite "The arc is out. Start strikes it again on the spot.";
    Stop;
    SetDO doGas,1;
    WaitTime 0.5;
    SetDO doArc,1;
    WaitTime 0.2;
    WatchArc;
    ArcBurns;
    StartMove;
  ENDTRAP
ENDMODULE
