"""What was written for other codes, as tables; nothing is computed here."""

from typing import TYPE_CHECKING

from rich.console import Group, RenderableType

from yawdesign.hunting.chosen_condition import condition_in_words
from yawdesign.output.tables import damping, facts, speed, titled

if TYPE_CHECKING:
    from yawdesign.exports.fmu.archive import Fmu
    from yawdesign.exports.state_space import StateSpaceModel
    from yawdesign.exports.write import Export


def export_tables(result: "Export") -> RenderableType:
    """Return the table of an `Export`."""
    rows = [("functions", ", ".join(result.functions)), ("files", ", ".join(result.files))]
    rows += [("condition", condition_in_words(result.condition)), ("what they take and give", "manifest.json")]
    return facts(f"Written to {result.folder}", rows)


def fmu_tables(result: "Fmu") -> RenderableType:
    """Return the table of an `Fmu`."""
    library = result.message if result.platform is None else f"for {result.platform}"
    return facts(f"Written to {result.path}", [("library", library), ("start", condition_in_words(result.condition))])


def state_space_tables(result: "StateSpaceModel") -> RenderableType:
    """Return the tables of a `StateSpaceModel`: the names of its signals, without the matrices."""
    at = f"{speed(result.speed)}, C_s = {damping(result.C_s)}"
    rows = [("at", at), ("condition", condition_in_words(result.condition)), ("A, B, C, D", "matrices, SI")]
    signals = titled("Signals", "", "number", "name and unit")
    signals.columns[-1].justify = "left"
    for kind in ("state", "input", "output"):
        named = list(zip(getattr(result, f"{kind}s"), getattr(result, f"{kind}_units"), strict=True))
        signals.add_row(f"{kind}s", f"{len(named)}", ", ".join(f"{name} [{unit}]" for name, unit in named))
    title = f": {result.title}" if result.title else ""
    return Group(facts(f"Linear model of the {result.name}{title}", rows), signals)
