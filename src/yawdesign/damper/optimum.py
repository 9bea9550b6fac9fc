"""The answer of an optimisation, as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from yawdesign.damper.forward import ForwardDesign
from yawdesign.damper.relaxations import Relaxation
from yawdesign.hunting.verdict import CaseVerdict, Mode, RequirementVerdict
from yawdesign.problem.result import Result


@dataclass(frozen=True)
class Bound:
    """Where a variable of the optimum lies.

    Parameters
    ----------
    value, min, max : float
        In SI units; the bounds as written.
    position : float
        Between its bounds, 0 ... 1 [-], on the scale of the search: linear below the parameter's least usual value,
        geometric above.
    """

    value: float
    min: float
    max: float
    position: float


@dataclass(frozen=True)
class SingleOptimum:
    """What optimising one bogie under a car body that stands still would have answered for a vehicle.

    Parameters
    ----------
    optimum : mapping
        Values of the design variables, in SI units (None without motors).
    margin : float or None
        Its worst margin under the car body that stands still: [1/s] for a decay rate, [-] for a damping ratio.
    margin_with_car_body : float or None
        The worst margin of that design under the car body that moves [1/s], [-].
    stable : bool
        Whether it is stable there.
    """

    optimum: Mapping[str, float | None]
    margin: float | None
    margin_with_car_body: float | None
    stable: bool


@dataclass(frozen=True, repr=False)
class Optimum(Result):
    """Answer of the optimisation.

    Parameters
    ----------
    optimum : mapping
        Value of C_s, K_m, C_m and of every other design variable, in SI units (None without motors).
    objective : {"decay_rate", "damping_ratio"}
        What was maximised.
    C_s : float or None
        Damping of the pair of yaw dampers at the optimum [N s/m]; that of the golden section is ``forward.C_s``.
    margin, margin_before : float or None
        Worst margin under all conditions, of the optimum and of the problem as written (None without a value of C_s):
        [1/s] for a decay rate, [-] for a damping ratio.
    worst_condition : mapping
        The condition under which the optimum has that margin, by the names of the problem file: ``speed`` [m/s], SI
        values, a load by its name, of a tolerance the share of deviation.
    active : tuple of str
        Limits at which the optimum lies: ``"K_m max"``, ``"rotational_resistance"``.
    status : Status
        What kind of answer this is.
    message : str
        The same in a sentence, and what to do.
    stable : bool
        Whether the optimum is stable under every condition.
    C_su : float or None
        What the curve allows with the optimum's bogie, eq. (14) [N s/m].
    rotational_resistance : float or None
        T / (4 Q a) of the optimum [-].
    bounds : mapping name -> Bound
        Where in its bounds each variable lies.
    before : mapping
        Values of the design variables as written, in SI units (None where not given).
    fixed_modes : mapping name -> tuple of complex
        Roots that no design variable moves [1/s].
    modes : tuple of Mode
        All modes of the optimum under its worst condition.
    next_margin : float or None
        Where modes cap the margin that the variables hardly move (less than a fifth over their bounds): the worst
        margin of all others, which is then the largest with at most 2 % of the largest margin given away [1/s], [-].
    capped_by : str or None
        Names of those modes, such as ``"lower sway"``, as `modes` calls them.
    capping_sensitivity : mapping
        d ln margin / d ln p [-] of the first of them for every parameter p and the speed v, the largest first.
    cases, cases_before : tuple of CaseVerdict
        Stability with each fault of the problem under all conditions: of the optimum, and of the problem as written
        (none without a value of C_s).
    worsened : tuple of str
        Faults that the optimum survives worse than the problem as written.
    requirements : tuple of RequirementVerdict
        What was required, and what the optimum reaches.
    conflict : tuple of str
        Where there is no answer: what excludes each other, by keys of a problem file, and ``"stability"``.
    relaxations : tuple of Relaxation
        Where there is no answer: the least change of each single number with which there is one, the smallest first.
    searched : str
        Under which conditions this holds, and whether a search found the worst of them.
    damper : str or None
        Name of the damper, where it is chosen from a catalogue.
    hurwitz_positive : bool
        Whether all Hurwitz minors of eq. (10) are positive at the optimum, under every condition.
    margin_polynomial : float or None
        The margin by Routh's array of the polynomial, found by bisection: the second route [1/s], [-].
    checked : bool
        Whether both routes agree.
    load : str or None
        The load that stands for Q in eq. (13): axle or wheel.
    forward : ForwardDesign
        The forward design with the optimum's bogie: critical values, stable intervals, golden section.
    single_bogie : SingleOptimum or None
        For a vehicle with a car body whose variables a bogie has: what one bogie alone would have answered.
    """

    optimum: Mapping[str, float | None]
    objective: str
    C_s: float | None
    margin: float | None
    margin_before: float | None
    worst_condition: Mapping[str, float]
    active: tuple[str, ...]
    status: str
    message: str
    stable: bool
    C_su: float | None
    rotational_resistance: float | None
    bounds: Mapping[str, Bound]
    before: Mapping[str, float | None]
    fixed_modes: Mapping[str, tuple[complex, ...]]
    modes: tuple[Mode, ...]
    hurwitz_positive: bool
    margin_polynomial: float | None
    checked: bool
    load: str | None
    forward: ForwardDesign
    next_margin: float | None = None
    capped_by: str | None = None
    capping_sensitivity: Mapping[str, float] = field(default_factory=dict)
    requirements: tuple[RequirementVerdict, ...] = ()
    cases: tuple[CaseVerdict, ...] = ()
    cases_before: tuple[CaseVerdict, ...] = ()
    worsened: tuple[str, ...] = ()
    conflict: tuple[str, ...] = ()
    relaxations: tuple[Relaxation, ...] = ()
    searched: str = ""
    damper: str | None = None
    single_bogie: SingleOptimum | None = None
