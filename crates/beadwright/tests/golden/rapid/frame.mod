MODULE frame
  ! frame, cmt-steel-abb
  ! The cell must supply:
  ! RobotWare Arc watches the arc. With arc = "plain" diArc is on while current
  ! flows: programs wait for it, and stop
  ! where it goes off; doShadow is an output without a wire, and a routine of
  ! the cell ends doArc and doGas at the events
  ! STOP and QSTOP (docs/dialects/rapid.md).
  ! The emergency stop also switches the power source off.
  ! Shielding gas has pressure, and the fume extraction runs.
  TASK PERS tooldata tTorch:=[TRUE,[[85.000,0.000,320.000],[0.9238795,0.0000000,0.3826834,0.0000000]],[4.500,[30.000,0.000,120.000],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wPart:=[FALSE,TRUE,"",[[900.000,0.000,400.000],[1.0000000,0.0000000,0.0000000,0.0000000]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0.000,0.000,0.000,0.000,30.000,0.000],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST speeddata vHome:=[100.000,500.000,5000,1000];
  CONST speeddata vTravel:=[100.000,500.000,5000,1000];
  CONST zonedata zBead:=[FALSE,1.000,1.000,1.000,0.100,1.000,0.100];
  TASK PERS seamdata smBead:=[0.000,0.500,[1,7,0.000,2.710,0.000,129.000,0,0,0],0.200,0,6.000,0.000,0.000,[1,7,0.000,2.710,0.000,129.000,0,0,0],0.000,0.350,[1,7,0.000,2.710,0.000,129.000,0,0,0],0.080,0.000,[1,7,0.000,2.710,0.000,129.000,0,0,0],1.000];
  PROC main()
    ConfL \Off;
    ConfJ \Off;
    SingArea \Wrist;
    CirPathMode \ObjectFrame;
    MoveAbsJ jHome,vHome,fine,tTorch\WObj:=wPart;
    IF ModExist("frame_L001") EraseModule "frame_L001";
    Load \Dynamic,"HOME:/part/frame_L001.mod";
    %"frame_L001:Layer001"%;
    UnLoad "HOME:/part/frame_L001.mod";
    IF ModExist("frame_L002") EraseModule "frame_L002";
    Load \Dynamic,"HOME:/part/frame_L002.mod";
    %"frame_L002:Layer002"%;
    UnLoad "HOME:/part/frame_L002.mod";
    MoveAbsJ jHome,vHome,fine,tTorch\WObj:=wPart;
  ENDPROC
ENDMODULE
