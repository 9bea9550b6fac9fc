"""The texts of an FMU: its description, how to build it, and the header of its C code."""

from collections.abc import Mapping, Sequence
from xml.etree import ElementTree

from yawdesign import __version__
from yawdesign.exports.fmu.variables import FmuVariable
from yawdesign.problem.units import parse_unit


def model_description(table: Sequence[FmuVariable], *, name: str, token: str, title: str) -> str:
    """Return modelDescription.xml.

    Parameters
    ----------
    table : sequence of FmuVariable
        All variables, the time last.
    name : str
        Of the model and its library.
    token : str
        Instantiation token; the library knows the same.
    title : str
        What this vehicle is.
    """
    root = ElementTree.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName=name,
        instantiationToken=token,
        description=title,
        generationTool=f"yawdesign {__version__}",
        variableNamingConvention="structured",
    )
    flags = ("canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives")
    ElementTree.SubElement(root, "ModelExchange", {"modelIdentifier": name, **dict.fromkeys(flags, "true")})
    _add_units(root, table)
    categories = ElementTree.SubElement(root, "LogCategories")
    ElementTree.SubElement(categories, "Category", name="logStatusError", description="What was refused, and why")
    ElementTree.SubElement(root, "DefaultExperiment", startTime="0", stopTime="5", tolerance="1e-6", stepSize="1e-3")
    _add_variables(root, table)
    _add_structure(root, table)
    return _written(root)


def build_description(name: str) -> str:
    """Return sources/buildDescription.xml for a model of this name."""
    root = ElementTree.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=name)
    files = ElementTree.SubElement(configuration, "SourceFileSet", language="C99")
    ElementTree.SubElement(files, "SourceFile", name="fmi3.c")
    return _written(root)


def _written(root: ElementTree.Element) -> str:
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def fmi_unit(unit: str) -> str:
    """Return a unit as FMI and Modelica write it.

    Examples
    --------
    >>> fmi_unit("kN·s·m/rad"), fmi_unit("kg·m²"), fmi_unit("m/s^2"), fmi_unit("-")
    ('kN.s.m/rad', 'kg.m2', 'm/s2', '1')
    """
    return "1" if unit == "-" else unit.replace("·", ".").replace("²", "2").replace("^", "")


def _add_units(root: ElementTree.Element, table: Sequence[FmuVariable]) -> None:
    shown: dict[str, list[str]] = {}
    for variable in table:
        units = shown.setdefault(variable.unit, [])
        if variable.shown and variable.shown not in (variable.unit, *units):
            units.append(variable.shown)
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for unit, others in shown.items():
        entry = ElementTree.SubElement(definitions, "Unit", name=fmi_unit(unit))
        ElementTree.SubElement(entry, "BaseUnit", _base(unit))
        for other in others:
            factor = repr(float(1 / parse_unit(other).factor))
            ElementTree.SubElement(entry, "DisplayUnit", name=fmi_unit(other), factor=factor)


def _base(unit: str) -> dict[str, str]:
    """Return the powers of the base units; FMI counts the radian among them."""
    radian = 1 if unit.startswith("rad") else -1 if unit.endswith("/rad") else 0
    powers = dict(zip(("kg", "m", "s", "rad"), (*parse_unit(unit).dimension, radian), strict=True))
    return {name: str(power) for name, power in powers.items() if power}


def _add_variables(root: ElementTree.Element, table: Sequence[FmuVariable]) -> None:
    parent = ElementTree.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(table):
        entry = ElementTree.SubElement(parent, "Float64", _attributes(variable, reference))
        for name in variable.aliases:
            ElementTree.SubElement(entry, "Alias", name=name, description=f"another name of {variable.name}")


def _attributes(variable: FmuVariable, reference: int) -> dict[str, str]:
    given = {
        "name": variable.name,
        "valueReference": str(reference),
        "description": variable.description,
        "causality": variable.causality,
        "variability": variable.variability,
        "initial": _initial(variable),
        "unit": fmi_unit(variable.unit),
        "displayUnit": fmi_unit(variable.shown) if variable.shown not in ("", variable.unit) else "",
        "min": variable.least,
        "max": variable.greatest,
        "nominal": variable.nominal,
        "start": variable.start,
        "derivative": variable.derivative_of,
    }
    # repr of a float has as many digits as it takes to read the same float back.
    return {key: x if isinstance(x, str) else repr(x) for key, x in given.items() if x not in ("", None)}


def _initial(variable: FmuVariable) -> str:
    if variable.causality in ("independent", "input"):
        return ""
    return "calculated" if variable.start is None else "exact"


def _add_structure(root: ElementTree.Element, table: Sequence[FmuVariable]) -> None:
    parent = ElementTree.SubElement(root, "ModelStructure")
    outputs = [i for i, variable in enumerate(table) if variable.causality == "output"]
    derivatives = [i for i, variable in enumerate(table) if variable.derivative_of is not None]
    unknown = sorted({i for i in outputs if table[i].start is None} | set(derivatives))
    for tag, references in (
        ("Output", outputs),
        ("ContinuousStateDerivative", derivatives),
        ("InitialUnknown", unknown),
    ):
        for reference in references:
            ElementTree.SubElement(parent, tag, valueReference=str(reference))


def header(table: Sequence[FmuVariable], *, token: str, sizes: Mapping[str, int]) -> str:
    """Return sources/model.h.

    Parameters
    ----------
    table : sequence of FmuVariable
        All variables, the time last.
    token : str
        Instantiation token.
    sizes : mapping
        Lengths that `motion.c` asks for.
    """
    parameters = [variable for variable in table if variable.causality == "parameter"]
    states = [table[variable.derivative_of] for variable in table if variable.derivative_of is not None]
    known = [variable for variable in table if variable.start is not None]
    counts = {
        "PARAMETERS": len(parameters),
        "INPUTS": len(known) - len(parameters) - len(states),
        "STATES": len(states),
        "VARIABLES": len(table) - 1,  # without the time
        **sizes,
    }
    lines = [
        f"/* Written by yawdesign {__version__} */",
        f'#define INSTANTIATION_TOKEN "{token}"',
        *(f"#define {name} {count}" for name, count in counts.items()),
        _array("const char *const names", [f'"{variable.name}"' for variable in known]),
        _array("const double start_values", [repr(variable.start) for variable in known]),
        _array("const double least", [repr(variable.least) for variable in parameters]),
        _array("const double greatest", [repr(variable.greatest) for variable in parameters]),
        _array("const double nominal", [repr(variable.nominal) for variable in states]),
    ]
    return "\n".join(lines) + "\n"


def _array(declaration: str, entries: Sequence[str]) -> str:
    return f"static {declaration}[] = {{{', '.join(entries)}}};"
