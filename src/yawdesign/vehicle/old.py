# ruff: noqa: D101, D102, D103
"""What other rooms still ask for by its former name; it goes as soon as they ask a vehicle."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from yawdesign.vehicle.catalogue import CATALOGUE, Parameters
from yawdesign.vehicle.elements import folded as folded
from yawdesign.vehicle.elements import physical as physical
from yawdesign.vehicle.polynomials import Polynomial, add, product, scale
from yawdesign.vehicle.state_space import StateSpace as NewStateSpace
from yawdesign.vehicle.state_space import fill
from yawdesign.vehicle.vehicle import Model

YAW_DAMPER, LATERAL_DAMPER, MOTOR_DAMPER = "yaw damper", "lateral damper ", "motor damper "
DAMPERS = {YAW_DAMPER: 2}
YAW_FORCE, PAIR_FORCE, YAW_DISPLACEMENT = "yaw_damper_force", "yaw_damper_pair_force", "yaw_damper_displacement"
OLD_OUTPUTS = {"F_s": PAIR_FORCE, "u_s": YAW_DISPLACEMENT}
DAMPER_FACTOR = "yaw dampers against each other"


def bogie(p: Parameters, *, kind: str = "power", equations: str = "reciprocal") -> Any:
    return CATALOGUE[kind](p, equations)


def unit_of(name: str) -> str:
    if "force" in name:
        return "N"
    base = "rad" if name.startswith(("phi", "cross_level")) else "m"
    return base + ("/s" if name.endswith("_velocity") else "/s^2" if name.endswith("_acceleration") else "")


class StateSpace(NewStateSpace):
    def __init__(self, elements: Any) -> None:
        super().__init__(elements)
        self.entries = self.A
        self.input_names = tuple(self.inputs)
        self.inputs: Any = self.B

    def fill(self, matrix: Any, convert: Any = lambda x: x) -> Any:
        return fill(self.A, matrix, convert)


@dataclass(frozen=True)
class Characteristic:
    A: Polynomial
    B: Polynomial
    factors: Mapping[str, Polynomial]

    def core(self, C_s: Any) -> Polynomial:
        return add(self.A, scale(self.B, C_s))

    def full(self, C_s: Any) -> Polynomial:
        return product([self.core(C_s), *self.factors.values()])


def characteristic(p: Parameters, *, kind: str = "power", equations: str = "reciprocal") -> Characteristic:
    others: Any = []
    first, *others = Model(kind, equations).at({**p, "C_s": 0}).motions
    return Characteristic(first.coefficients[0], first.coefficients[1], {m.name: m.polynomial(0) for m in others})


def paper_coefficients(
    p: Parameters, C_s: Any, *, kind: str = "power", equations: str = "reciprocal", unit: Any = 1
) -> tuple[Any, ...]:
    return Model(kind, equations).at({**p, "C_s": C_s}).paper_coefficients(unit)
