"""What was written: units, the table of parameters, problem files, and the problem they describe."""

from .creep import creep_coefficients
from .diagnostics import Diagnostic, ProblemError
from .paper_example import table1
from .parameters import PARAMETERS, Bogie, CarBody
from .problem import Problem
from .quantities import Written, exact, format_quantity, parse_quantity, to_unit
from .reader import load, loads, read, read_stream
from .running import Curve, SpeedRange
from .schema import SCHEMA_FILE, schema
from .starter import starter
from .table import Parameter
from .variables import Design, Variable

__all__ = [
    "PARAMETERS",
    "SCHEMA_FILE",
    "Bogie",
    "CarBody",
    "Curve",
    "Design",
    "Diagnostic",
    "Parameter",
    "Problem",
    "ProblemError",
    "SpeedRange",
    "Variable",
    "Written",
    "creep_coefficients",
    "exact",
    "format_quantity",
    "load",
    "loads",
    "parse_quantity",
    "read",
    "read_stream",
    "schema",
    "starter",
    "table1",
    "to_unit",
]
