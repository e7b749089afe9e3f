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
  TASK PERS seamdata smBead:=[0.000,0.500,[1,7,0.000,2.400,0.000,129.000,0,0,0],0.200,0,6.000,0.000,0.000,[1,7,0.000,2.400,0.000,129.000,0,0,0],0.000,0.300,[1,7,0.000,1.680,0.000,129.000,0,0,0],0.080,0.000,[1,7,0.000,2.400,0.000,129.000,0,0,0],1.000];
  PROC main()
    ConfL \Off;
    ConfJ \Off;
    SingArea \Wrist;
    CirPathMode \ObjectFrame;
    MoveAbsJ jHome,vHome,fine,tTorch\WObj:=wPart;
    IF ModExist("demo_L001") EraseModule "demo_L001";
    Load \Dynamic,"HOME:/part/demo_L001.mod";
    %"demo_L001:Layer001"%;
    UnLoad "HOME:/part/demo_L001.mod";
    IF ModExist("demo_L002") EraseModule "demo_L002";
    Load \Dynamic,"HOME:/part/demo_L002.mod";
    %"demo_L002:Layer002"%;
    UnLoad "HOME:/part/demo_L002.mod";
    MoveAbsJ jHome,vHome,fine,tTorch\WObj:=wPart;
  ENDPROC
ENDMODULE
