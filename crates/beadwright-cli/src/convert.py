"""STEP or IGES to STL in mm by Open CASCADE: python3 convert.py FROM TO. Run by beadwright; needs cadquery-ocp-novtk."""
import sys

from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.IFSelect import IFSelect_RetDone
from OCP.StlAPI import StlAPI_Writer

DEFLECTION_MM, ANGLE_RAD, SEWING_MM = 0.02, 0.2, 0.01

source, target = sys.argv[1:3]
with open(source, "rb") as file:
    is_step = file.read(64).lstrip().startswith(b"ISO-10303-21")
if is_step:
    from OCP.STEPControl import STEPControl_Reader as Reader
else:
    from OCP.IGESControl import IGESControl_Reader as Reader
reader = Reader()
if reader.ReadFile(source) != IFSelect_RetDone:
    sys.exit("Open CASCADE cannot read it")
reader.TransferRoots()
shape = reader.OneShape()
if shape.IsNull():
    sys.exit("it holds no shape")
if not is_step:
    sewing = BRepBuilderAPI_Sewing(SEWING_MM)
    sewing.Add(shape)
    sewing.Perform()
    shape = sewing.SewedShape()
BRepMesh_IncrementalMesh(shape, DEFLECTION_MM, False, ANGLE_RAD, True)
writer = StlAPI_Writer()
writer.ASCIIMode = False
if not writer.Write(shape, target):
    sys.exit("it holds no faces")
