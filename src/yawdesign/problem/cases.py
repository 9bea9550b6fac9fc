"""The cases: faults that must be survived, as changes to the values as designed, of both bogies or of one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

BOGIES = ("leading", "trailing")
SHARE = "C_s share"  # of a bogie's own yaw dampers, what C_s is multiplied by


@dataclass(frozen=True)
class Change:
    """One value in a fault.

    Parameters
    ----------
    key : str
        A parameter, ``leading.`` or ``trailing.`` before it if it is that of one bogie.
    value : float
        In SI units; or, if it is a `share`, of the value as designed [-].
    share : bool
        Whether the value is a share.
    """

    key: str
    value: float
    share: bool = False


@dataclass(frozen=True)
class Case:
    """A fault.

    Parameters
    ----------
    name : str
        What it is called.
    changes : tuple of Change
        What differs from the design.
    """

    name: str
    changes: tuple[Change, ...]

    def applied(self, p: Mapping[str, Any]) -> dict[str, Any]:
        """Return parameters with this fault in them; numbers of any type.

        The yaw dampers of one bogie become a share of C_s, in whose powers the motions are written.
        """
        out = dict(p)
        for change in self.changes:
            bogie, _, key = change.key.rpartition(".")
            name = f"{bogie}.{SHARE if key == 'C_s' else key}" if bogie else key
            if bogie and key == "C_s":
                out[name] = change.value if change.share else change.value / p[key]
            else:
                out[name] = p[key] * change.value if change.share else change.value
        return out
