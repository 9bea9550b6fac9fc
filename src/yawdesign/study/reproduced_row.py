"""One number of the paper beside what was computed."""

from dataclasses import dataclass
from typing import Any, Literal

PRINTED: Literal["as-printed"] = "as-printed"
RECIPROCAL: Literal["reciprocal"] = "reciprocal"
OTHER_EQUATIONS = "the printed number belongs to the equations as printed; with the motors' reaction it is another one"


@dataclass(frozen=True)
class ReproducedRow:
    """One number of the paper beside what was computed.

    Parameters
    ----------
    where : str
        Table, figure or equation of the paper.
    what : str
        What is compared.
    equations : str
        "as-printed" or "reciprocal"; empty where both give the same.
    printed, computed : float, str or None
        In SI units, see `unit`; None where the paper prints no number, or where there is no answer.
    unit : str
        SI unit.
    deviation : float or None
        Of what was computed from what is printed [%].
    tolerance : float or None
        The largest deviation that counts as agreement [%]; None where numbers are not compared.
    reason : str
        Where the tolerance comes from, or why there is no comparison.
    agrees : bool or None
        Whether they agree; None where they are not compared.
    misprint : int or None
        Number in docs/errata.md of the misprint or slip behind the difference.
    check : str
        The second route to the computed value.
    checked : bool
        Whether both routes agree.
    """

    where: str
    what: str
    equations: str
    printed: float | str | None
    computed: float | str | None
    unit: str
    deviation: float | None
    tolerance: float | None
    reason: str
    agrees: bool | None
    misprint: int | None
    check: str
    checked: bool


def row(
    where: str,
    what: str,
    *,
    printed: float | str | None = None,
    computed: float | str | None = None,
    unit: str = "",
    equations: str = "",
    tolerance: float | None = None,
    reason: str = "",
    agrees: bool | None = None,
    misprint: int | None = None,
    check: str = "",
    checked: bool = True,
) -> ReproducedRow:
    """Return a row with its deviation; with a tolerance that says whether the numbers agree."""
    deviation = _deviation(printed, computed)
    if tolerance is not None:
        agrees = deviation is not None and abs(deviation) <= tolerance
    return ReproducedRow(
        where=where,
        what=what,
        equations=equations,
        printed=printed,
        computed=computed,
        unit=unit,
        deviation=deviation,
        tolerance=tolerance,
        reason=reason,
        agrees=agrees,
        misprint=misprint,
        check=check,
        checked=checked,
    )


def _deviation(printed: float | str | None, computed: float | str | None) -> float | None:
    if isinstance(printed, (str, type(None))) or isinstance(computed, (str, type(None))) or not printed:
        return None
    return 100 * (computed / printed - 1)


def judged(equations: str, tolerance: float, reason: str, misprint: int | None) -> dict[str, Any]:
    """Return how a number is compared that only the equations as printed can meet."""
    if equations == PRINTED:
        return {"equations": equations, "tolerance": tolerance, "reason": reason, "misprint": misprint}
    return {"equations": equations, "reason": OTHER_EQUATIONS, "misprint": 1}
