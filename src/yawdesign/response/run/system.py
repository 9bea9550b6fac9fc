"""The vehicle at one speed as x' = A x + B u, y = C x + D u: the track as input, all that is of interest as output."""

from collections.abc import Mapping
from functools import cached_property
from typing import Any

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.eigenvalues import count_undamped, dense, eigenvalues, state_matrix
from yawdesign.hunting.verdict import given_damping
from yawdesign.problem import Problem
from yawdesign.response.track.lines import Wheelsets
from yawdesign.vehicle.elements import WheelRailContact
from yawdesign.vehicle.state_space import StateSpace
from yawdesign.vehicle.vehicle import Model, Vehicle


class System:
    """The state space of a vehicle as arrays, and what its track inputs and its eigenvalues are.

    Parameters
    ----------
    vehicle : Vehicle
        All its numbers are floats.

    Attributes
    ----------
    vehicle : Vehicle
        The same.
    space : StateSpace
        Its state space by names, with the units of inputs and outputs.
    v, C_s : float
        Speed [m/s] and damping of the pair of yaw dampers [N s/m].
    """

    def __init__(self, vehicle: Vehicle) -> None:
        self.vehicle = vehicle
        self.v, self.C_s = float(vehicle.v), float(vehicle.C_s)

    @property
    def space(self) -> StateSpace:
        """The state space in the coordinates of each end."""
        return self.vehicle.state_space

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The displacements, in the order of the first states."""
        return self.space.coordinates

    @cached_property
    def A(self) -> Float:
        """State matrix."""
        return state_matrix(self.vehicle)

    @cached_property
    def B(self) -> Float:
        """Input matrix."""
        return dense(self.space.B, self.space.size, len(self.space.inputs))

    @cached_property
    def C(self) -> Float:
        """Output matrix."""
        return dense(self.space.C, len(self.outputs), self.space.size)

    @cached_property
    def D(self) -> Float:
        """Feed-through matrix."""
        return dense(self.space.D, len(self.outputs), len(self.space.inputs))

    @cached_property
    def outputs(self) -> Mapping[str, int]:
        """Rows of C and D by the name of the output."""
        return {name: k for k, name in enumerate(self.space.outputs)}

    def named(self, values: Float) -> dict[str, float]:
        """Return values of all outputs by name."""
        return {name: float(values[k]) for name, k in self.outputs.items()}

    @cached_property
    def eigenvalues(self) -> Complex:
        """Eigenvalues [1/s], found motion by motion: what is exactly undamped stays so."""
        return eigenvalues(self.vehicle)

    @property
    def abscissa(self) -> float:
        """Largest real part of the eigenvalues [1/s]."""
        return float(self.eigenvalues.real.max())

    @property
    def stable(self) -> bool:
        """Whether all free motions die out."""
        return not count_undamped(self.eigenvalues)

    @property
    def wheelsets(self) -> Wheelsets:
        """When its wheelsets, in the order of the inputs, pass a place of the track: as they stand behind the first."""
        contacts: list[Any] = [e for e in self.space.elements if isinstance(e, WheelRailContact)]
        first = contacts[0]
        lags = tuple(float(first.ahead - contact.ahead) / self.v for contact in contacts)
        return Wheelsets(self.v, lags, 2 * float(first.b))


def system_at(problem: Problem, v: float) -> System:
    """Return the vehicle of a problem at a speed [m/s]; an error if it has no C_s."""
    given_damping(problem)
    return System(Model.of(problem).at(problem.parameters(), v=v))
