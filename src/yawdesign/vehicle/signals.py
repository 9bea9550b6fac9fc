"""What the motions, forces and strokes of a vehicle are called: one vocabulary for state space, runs, exports and FMU.

Coordinates are ``y_b``, ``phi_b``, ``y_w1``, ..., their rates ``y_b_velocity`` and ``y_b_acceleration``. A damper in
series with its joints is displaced by ``yaw_damper_displacement``, its piston by ``yaw_damper_stroke``;
``yaw_damper_force`` is the force of *each* of the two yaw dampers, ``yaw_damper_pair_force`` that of both. A rigidly
mounted damper has no stroke of its own: it is the displacement.

Under a car body ``y_c``, ``psi_c``, ``th_c`` the number of the bogie comes first: ``y_b1`` is the frame of the leading
bogie, ``y_w12`` its rear wheelset, ``yaw_damper_force_2`` belongs to the trailing one. ``y_c1`` and ``y_c2`` are the
car body's lateral motion above the centre of each bogie, as high as its centre of mass.
"""

from collections.abc import Iterable
from typing import Any

DIRECTIONS = {"y": "lateral", "phi": "yaw", "psi": "yaw", "th": "roll"}  # by what the name of a coordinate begins with
ENDS = {"1": "front", "2": "rear"}  # by what the name of what belongs to one end of a pair ends with
BOGIES = {"1": "leading", "2": "trailing"}  # the same of what belongs to one of two bogies
FIRST_LOOKED_AT = ("y_c1_acceleration", "y_c2_acceleration", "y_b", "phi_b", "y_b1", "phi_b1", "y_b2", "phi_b2")
OLD_OUTPUTS = {"F_s": "yaw_damper_pair_force", "u_s": "yaw_damper_displacement"}


def first_looked_at(names: Iterable[str]) -> tuple[str, ...]:
    """Return which responses are shown first: the car body above both bogies, and the frames.

    Examples
    --------
    >>> first_looked_at(["phi_b", "y_w1", "y_b"])
    ('y_b', 'phi_b')
    """
    there = set(names)
    return tuple(name for name in FIRST_LOOKED_AT if name in there)


def velocity(coordinate: str) -> str:
    """Return the name of the velocity of a coordinate."""
    return f"{coordinate}_velocity"


def acceleration(coordinate: str) -> str:
    """Return the name of the acceleration of a coordinate."""
    return f"{coordinate}_acceleration"


def rate_unit(unit: str, order: int = 1) -> str:
    """Return the SI unit of a velocity, or of an acceleration (order 2)."""
    return f"{unit}/s" if order == 1 else f"{unit}/s^{order}"


def of_damper(link: str, what: str) -> str:
    """Return the name of what belongs to a damper.

    Examples
    --------
    >>> of_damper("yaw damper", "pair force"), of_damper("lateral damper 1", "stroke")
    ('yaw_damper_pair_force', 'lateral_damper_stroke_1')
    """
    words = link.split()
    end = [words.pop()] if not words[-1].strip("12+-") else []
    return "_".join([*words, *what.split(), *end])


class SignalNames(tuple[str, ...]):
    """Names in their order, which are also found by what version 0.1 called them: ``v_y_b``, ``z_1``, ``F_s``, ``u_s``.

    Examples
    --------
    >>> names = SignalNames(("y_b", "y_b_velocity", "yaw_damper_stroke"))
    >>> names.index("v_y_b"), names.index("z_1"), "F_s" in names
    (1, 2, False)
    """

    __slots__ = ()

    @property
    def aliases(self) -> dict[str, str]:
        """Names by their old ones."""
        strokes = [name for name in self if "_stroke" in name]
        old = {f"v_{name.removesuffix('_velocity')}": name for name in self if name.endswith("_velocity")}
        old |= {f"z_{k}": name for k, name in enumerate(strokes, 1)}
        return old | {key: name for key, name in OLD_OUTPUTS.items() if tuple.__contains__(self, name)}

    def index(self, value: Any, *between: Any) -> int:
        """Return the place of a name, or of an old one."""
        return super().index(self.aliases.get(value, value), *between)

    def __contains__(self, value: object) -> bool:
        return super().__contains__(value) or value in self.aliases
