"""Reads exports with VTK and pyarrow; prints what they hold as JSON. Arguments: VTP, Parquet and CSV of one plan."""

import csv
import json
import sys

import pyarrow.parquet
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
sizes = vtkCellSizeFilter()
sizes.SetInputConnection(reader.GetOutputPort())
sizes.Update()
cells = sizes.GetOutput().GetCellData()


def column(name):
    array = cells.GetArray(name)
    return [array.GetValue(k) for k in range(array.GetNumberOfTuples())]


table = pyarrow.parquet.read_table(sys.argv[2]).to_pydict()
with open(sys.argv[3], newline="", encoding="utf-8") as file:
    rows = list(csv.DictReader(file))


def apart(name, values):
    """Greatest difference of a column in both tables; texts are equal or infinitely far apart."""
    texts = [row[name] for row in rows]
    if isinstance(values[0], str):
        return 0.0 if texts == values else float("inf")
    return max(abs(float(text) - value) for text, value in zip(texts, values, strict=True))


print(
    json.dumps(
        {
            "lines": sizes.GetOutput().GetNumberOfLines(),
            "length": sum(column("Length")),
            "time": sum(column("time")),
            "layers": len(set(column("layer"))),
            "passes": len(set(zip(column("layer"), column("pass")))),
            "rows": len(rows),
            "names": list(rows[0]) == list(table),
            "apart": {name: apart(name, values) for name, values in table.items()},
        }
    )
)
