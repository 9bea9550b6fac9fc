"""The model: which equations; and the vehicle: a model at given numbers, which assembles itself once."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, Self

from yawdesign.problem import Problem
from yawdesign.problem.cases import Case
from yawdesign.problem.condition import Condition
from yawdesign.problem.conditions import conditions
from yawdesign.problem.parameters import CAR_BODY, bogie_keys, parameter_keys
from yawdesign.problem.table import key_of
from yawdesign.vehicle.catalogue import CATALOGUE, OVERTURNING, Parameters, elements
from yawdesign.vehicle.elements import Element, Link, Mass, Single, folded, physical
from yawdesign.vehicle.motions import Motion, motions, numbers_in, outlines, polynomials
from yawdesign.vehicle.polynomials import Number, Polynomial, product, scale_variable
from yawdesign.vehicle.state_space import StateSpace


@dataclass(frozen=True)
class Model:
    """Which equations: hashable, the key of every cache, and sent to workers with plain numbers.

    Parameters
    ----------
    kind : {"power", "trailer"}
        With or without traction motors.
    equations : {"reciprocal", "as-printed"}
        With the motors' yaw reaction on the frame, or without it as eqs (1) and (7) are printed.
    parameters : tuple of str, optional
        Names of the numbers that its vehicles have, C_s and v among them; they say which parts there are, see
        `yawdesign.vehicle.catalogue`. Without them those of the paper's bogie, under a car body that stands still.
    flags : tuple of str, optional
        What numbers do not say: ``"overturning"``, ``"no gravitational stiffness"``.
    """

    kind: str = "power"
    equations: str = "reciprocal"
    parameters: tuple[str, ...] = ()
    flags: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not self.parameters:
            object.__setattr__(self, "parameters", (*parameter_keys(self.kind), "v"))

    @classmethod
    def of(cls, problem: Problem) -> Self:
        """Return the model of a problem."""
        return cls(problem.bogie.kind, problem.equations, (*problem.keys, "v"), problem.flags)

    def at(self, p: Parameters, **more: Number) -> "Vehicle":
        """Return the vehicle with given numbers: symbols of Table I in SI units, ``v`` [m/s] and maybe ``C_s``."""
        return Vehicle(self, {**p, **more})

    @property
    def has_car_body(self) -> bool:
        """Whether a car body on two bogies moves; otherwise it stands still on one."""
        return "M_c" in self.parameters

    @property
    def bogie(self) -> "Model":
        """The model of one bogie under a car body that stands still, with the parameters that it shares with this."""
        own = frozenset(CAR_BODY) - (frozenset(("K_2z", "C_2z")) if "I_b" in self.parameters else frozenset())
        names = tuple(name for name in self.parameters if name not in own and "." not in name)
        flags = tuple(flag for flag in self.flags if flag != OVERTURNING)
        return Model(self.kind, self.equations, names, flags)

    @property
    def motions(self) -> tuple[Motion, ...]:
        """The motions of its vehicles: their names and coordinates, and which parameters they are made of."""
        return _outlines(self)

    @property
    def states(self) -> StateSpace:
        """The state space of its vehicles in half sums and half differences, which says where which state stands."""
        return _states(self)

    @property
    def sources(self) -> Mapping[str, frozenset[str]]:
        """By the name of each motion, on which parameters it depends; C_s is not one of them."""
        return _sources(self)

    @property
    def joints(self) -> Mapping[str, str]:
        """By the damping of each damper in series with joints, the stiffness of these; by parameters' names."""
        return _joints(self)

    @property
    def coordinates(self) -> Mapping[str, str]:
        """SI units of the coordinates at each end, by name, in the order of the states."""
        return _coordinates(self)

    def with_fault(self, case: Case) -> "Model":
        """Return the model of its vehicles with a fault, maybe of one of their bogies."""
        own = [name for name in case.names if name not in self.parameters]
        return replace(self, parameters=(*self.parameters, *own)) if own else self

    def movable(self, variables: Iterable[str]) -> tuple[str, ...]:
        """Return the names of the motions that some design variable moves; what a yaw damper reaches is among them."""
        chosen = frozenset(variables)
        first, *others = self.sources
        return (first, *(name for name in others if self.sources[name] & chosen))


class Sources(frozenset[str]):
    """A number of which nothing is known but which parameters it is made of."""

    def _joined(self, other: Any) -> "Sources":
        return Sources(self | other) if isinstance(other, Sources) else self

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = _joined

    def __neg__(self) -> "Sources":
        return self


@lru_cache
def _traced(model: Model) -> "Vehicle":
    return model.at({name: Sources({name}) for name in model.parameters})


@lru_cache
def _states(model: Model) -> StateSpace:
    return _traced(model).folded_state_space


@lru_cache
def _outlines(model: Model) -> tuple[Motion, ...]:
    return outlines(_traced(model).folded)


@lru_cache
def _sources(model: Model) -> dict[str, frozenset[str]]:
    numbers = numbers_in(_traced(model).folded)
    return {name: frozenset().union(*(a for a in every if isinstance(a, Sources))) for name, every in numbers.items()}


@lru_cache
def _joints(model: Model) -> dict[str, str]:
    laws: list[Any] = [law for link in _traced(model).physical if isinstance(link, Link) for law in link.maxwell]
    return {damping: stiffness for law in laws for damping in law.c for stiffness in law.K}


@lru_cache
def _coordinates(model: Model) -> dict[str, str]:
    return {mass.coordinate: mass.unit for mass in _traced(model).physical if isinstance(mass, Mass)}


@lru_cache
def families() -> tuple[tuple[str, ...], ...]:
    """Return the coordinates that a bogie of the catalogue may have, and those of a car body on two of them."""
    bodies: tuple[tuple[str, ...], ...] = (), tuple(CAR_BODY)
    models = [[Model(kind, parameters=(*bogie_keys(kind), *body, "v")) for kind in CATALOGUE] for body in bodies]
    return tuple(tuple(dict.fromkeys(x for model in family for x in model.coordinates)) for family in models)


def known_coordinates() -> tuple[str, ...]:
    """Return the coordinates at each end of all vehicles in the catalogue."""
    return tuple(dict.fromkeys(name for family in families() for name in family))


class Vehicle:
    """A model at given numbers of any type: floats, arrays, SX, rationals.

    Parameters
    ----------
    model : Model
        Which equations.
    p : mapping
        Symbols of Table I in SI units (``lambda`` for the conicity), ``v`` [m/s] and, where it is known, ``C_s``.

    Examples
    --------
    >>> from yawdesign import table1
    >>> problem = table1()
    >>> first, second = Vehicle.of(problem)[0].motions
    >>> [len(part) for part in first.coefficients], second.name
    ([23, 24], 'motors yawing against each other')
    """

    def __init__(self, model: Model, p: Parameters) -> None:
        self.model = model
        self.p = p

    @classmethod
    def of(cls, problem: Problem) -> tuple["Vehicle", ...]:
        """Return the vehicle of a problem under each of its conditions."""
        model, p = Model.of(problem), problem.parameters()
        return tuple(model.at(condition.applied(p)) for condition in conditions(problem))

    def under(self, condition: Condition) -> "Vehicle":
        """Return the vehicle under a condition."""
        return Vehicle(self.model, condition.applied(self.p))

    def with_fault(self, case: Case) -> "Vehicle":
        """Return the vehicle with a fault, maybe of one of its bogies, which then have numbers of their own."""
        return self.model.with_fault(case).at(case.applied(self.p))

    @property
    def bogie(self) -> "Vehicle":
        """One bogie of it under a car body that stands still."""
        model = self.model.bogie
        return model.at({name: x for name, x in self.p.items() if name in model.parameters})

    def replace(self, **changes: Number) -> "Vehicle":
        """Return the vehicle with other numbers."""
        names = {key_of(name): value for name, value in changes.items()}
        other = Vehicle(self.model, {**self.p, **names})
        if names.keys() == {"C_s"}:  # in whose powers the motions are written: they are the same
            other.__dict__["motions"] = self.motions
        return other

    @property
    def C_s(self) -> Any:
        """Damping of the pair of yaw dampers [N s/m]; 0 if it is not given."""
        return self.p.get("C_s", 0)

    @property
    def v(self) -> Any:
        """Speed [m/s]."""
        return self.p["v"]

    @cached_property
    def elements(self) -> tuple[Element, ...]:
        """What it is made of."""
        return tuple(elements(self.model.kind, self.model.equations, self.model.flags, self.p))

    @property
    def physical(self) -> list[Single]:
        """Its elements in the coordinates of each end."""
        return physical(self.elements)

    @cached_property
    def folded(self) -> list[Single]:
        """Its elements in half sums and half differences of both ends."""
        return folded(self.elements)

    @cached_property
    def motions(self) -> tuple[Motion, ...]:
        """Its independent motions, the coupled one, which the yaw dampers reach, first."""
        return motions(self.folded)

    @cached_property
    def polynomials(self) -> Mapping[str, Polynomial]:
        """Characteristic polynomial of each motion at the vehicle's own C_s, by its name, lowest power of s first.

        At one C_s this is half the work of `motions` for a vehicle with car body.
        """
        if "motions" in self.__dict__:
            return {motion.name: motion.polynomial(self.C_s) for motion in self.motions}
        return polynomials(self.folded)

    @property
    def coupled(self) -> Motion:
        """The motion that the yaw dampers reach."""
        return self.motions[0]

    @property
    def polynomial(self) -> Polynomial:
        """Its characteristic polynomial, lowest power of s first: the product of those of its motions.

        Degree 25 with motors, 15 without; with a car body 56 and 36.
        """
        return product(motion.polynomial(self.C_s) for motion in self.motions)

    @cached_property
    def state_space(self) -> StateSpace:
        """Its state space in the coordinates of each end."""
        return StateSpace(self.physical)

    @cached_property
    def folded_state_space(self) -> StateSpace:
        """The same in half sums and half differences of both ends, in which the motions are apart."""
        return StateSpace(self.folded)

    def paper_coefficients(self, unit: Number = 1) -> tuple[Any, ...]:
        """Return chi_0 ... chi_26 of eq. (9), the determinant of the 22 x 22 matrix (7), highest power of s first.

        Parameters
        ----------
        unit : number, optional
            Time scale [rad/s]: the coefficients are those of the polynomial in s / unit.

        Returns
        -------
        tuple
            27 coefficients (17 without motors); with the model as printed those of (7) to the last factor.
        """
        # Each joint stands in a row of its own in (7), and each yaw damper separately.
        joints = [self.p[K] for K in self.model.joints.values()]
        fourth = product([(K,) for K in joints for _ in range(4)])
        whole = product([self.polynomial, (1, self.C_s / self.p["K_ds"]), fourth])
        return tuple(reversed(scale_variable(whole, unit)))
