"""A model with parameters that stay free and parameters that have the values of a problem."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property

from yawdesign.hunting.critical_damping import CriticalValue, critical_damping
from yawdesign.problem import PARAMETERS, Problem, ProblemError
from yawdesign.problem.diagnostics import Mistakes, unknown_key
from yawdesign.problem.running import CURVE
from yawdesign.problem.table import key_of
from yawdesign.vehicle.vehicle import Model, Vehicle

LEAST_DAMPING = 1.0  # N s/m: as good as none, where a free damping cannot be 0


@dataclass(frozen=True)
class ParametricModel:
    """A model, the values that a problem gives its parameters, and which of these stay free.

    Parameters
    ----------
    model : Model
        Which equations.
    values : mapping name -> float or None
        Vehicle, speed ``v`` and curve in SI; None where the problem has no single value.
    free : tuple of str
        Names that stay inputs, in the order of `values`.
    load : str or None
        The load Q of the curve; None if the problem has no curve.
    top_speed : float
        The largest speed of the problem [m/s].
    """

    model: Model
    values: Mapping[str, float | None]
    free: tuple[str, ...]
    load: str | None
    top_speed: float

    @classmethod
    def of(cls, problem: Problem, free: Collection[str] | None) -> "ParametricModel":
        """Return the model of a problem with some free parameters, or, if none are named, with all of them free."""
        p, speeds = problem.parameters(), problem.speeds
        values: dict[str, float | None] = {key: p.get(key) for key in problem.keys}
        values["v"] = speeds[0] if len(speeds) == 1 else None
        values |= {key: getattr(problem.curve, key) for key in CURVE if problem.curve is not None}
        values = {key: None if value is None else float(value) for key, value in values.items()}
        wanted = set(values) if free is None else _known(free, values)
        load = None if problem.curve is None else problem.curve.load
        return cls(
            model=Model.of(problem),
            values=values,
            free=tuple(key for key in values if key in wanted),
            load=load,
            top_speed=float(speeds[-1]),
        )

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters on which the characteristic polynomial depends, beside C_s."""
        return tuple(key for key in self.values if key not in CURVE and key != "C_s")

    @property
    def as_in_the_paper(self) -> bool:
        """Whether it is the paper's bogie, whose polynomial is eq. (9): no car body, nothing added, nothing rigid."""
        return self.model == Model(self.model.kind, self.model.equations)

    @property
    def resists(self) -> bool:
        """Whether there is a rotational resistance: a curve, and an axle load that is not fixed at 0."""
        return self.load is not None and ("W" in self.free or self.values["W"] != 0)

    @property
    def examples(self) -> dict[str, float]:
        """Values of all parameters; where the problem has none those of the paper, and its largest speed."""
        usual = {"C_s": float(PARAMETERS["C_s"].check(PARAMETERS["C_s"].example)), "v": self.top_speed}
        values = {key: usual[key] if value is None else value for key, value in self.values.items()}
        dampers = (key for key in self.model.joints if key in self.free)
        return values | {key: LEAST_DAMPING for key in dampers if values[key] == 0}

    @cached_property
    def example(self) -> Vehicle:
        """The vehicle of these values."""
        values = self.examples
        return self.model.at({name: values[name] for name in (*self.names, "C_s")})

    @cached_property
    def critical(self) -> tuple[CriticalValue, ...]:
        """Its critical values of the yaw damping."""
        return critical_damping(self.example).critical


def _known(names: Collection[str], allowed: Collection[str]) -> set[str]:
    keys = ["v" if name == "speed" else key_of(name) for name in names]
    mistakes = Mistakes()
    for key in keys:
        with mistakes.under(f"inputs: {key}"):
            if key not in allowed:
                raise ProblemError(unknown_key(key, allowed))
    mistakes.report()
    return set(keys)
