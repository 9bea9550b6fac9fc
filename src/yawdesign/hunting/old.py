# ruff: noqa: D103
"""What other rooms still ask for by its former name; it goes as soon as they ask a vehicle."""

from collections.abc import Collection
from typing import Any

import numpy as np

from yawdesign.hunting import boundary as graphs
from yawdesign.hunting import critical_damping as single
from yawdesign.hunting import verdict
from yawdesign.hunting.eigenvalues import motion_eigenvalues, motion_matrix
from yawdesign.hunting.routh import count_unstable
from yawdesign.vehicle.vehicle import Model


def core_matrix(p: Any, C_s: Any, *, kind: str = "power", equations: str = "reciprocal") -> Any:
    vehicle = Model(kind, equations).at(p, C_s=C_s)
    return motion_matrix(vehicle, vehicle.coupled)


def core_eigenvalues(p: Any, C_s: Any, *, kind: str = "power", equations: str = "reciprocal") -> Any:
    vehicle = Model(kind, equations).at(p, C_s=C_s)
    return motion_eigenvalues(vehicle, vehicle.coupled)


def undamped_roots(p: Any) -> int:
    return count_unstable(p)


def fixed_factors(p: Any, variables: Collection[str], *, kind: str, equations: str) -> tuple[str, ...]:
    model = Model(kind, equations)
    return tuple(name for name in model.sources if name not in model.movable(variables))


def stability_at(p: Any, C_s: float, variables: Collection[str] = (), *, kind: str, equations: str) -> Any:
    return verdict.stability_at(Model(kind, equations).at(p, C_s=C_s), variables)


def critical_damping(p: Any, *, kind: str = "power", equations: str = "reciprocal") -> Any:
    return single.critical_damping(Model(kind, equations).at(p))


def exact_critical_values(p: Any, *, kind: str, equations: str) -> Any:
    from yawdesign.hunting import exact

    return exact.exact_critical_values(Model(kind, equations).at(p))


def state_matrix(p: Any, C_s: Any, *, kind: str = "power", equations: str = "reciprocal") -> Any:
    from yawdesign.hunting import eigenvalues

    return eigenvalues.state_matrix(Model(kind, equations).at(p, C_s=C_s))


def certify(p: Any, *, kind: str = "power", equations: str = "reciprocal") -> Any:
    from yawdesign.hunting import certificate

    return certificate.certify(Model(kind, equations).at(p))


def critical_values(p: Any, *, kind: str = "power", equations: str = "reciprocal") -> Any:
    from yawdesign.hunting import certificate

    return certificate.critical_values(Model(kind, equations).at(p))


def unstable_roots(p: Any, C_s: Any, *, kind: str = "power", equations: str = "reciprocal") -> Any:
    from yawdesign.hunting import certificate

    return certificate.unstable_roots(Model(kind, equations).at(p), C_s)


def hurwitz_polynomial(p: Any, *, kind: str = "power", equations: str = "reciprocal") -> Any:
    from yawdesign.hunting import certificate

    return certificate.hurwitz_polynomial(Model(kind, equations).at(p))


class boundary:  # noqa: N801, D101
    pass


def _graph(name: str) -> Any:
    def call(names: Any, kind: str = "power", equations: str = "reciprocal", **more: Any) -> Any:
        return getattr(graphs, name)(Model(kind, equations), names, **more)

    return staticmethod(call)


for _name in ("routh_column", "hurwitz_minors", "boundary", "boundary_slope", "rootfinder", "critical_damping"):
    setattr(boundary, _name, _graph(_name))
boundary.parameter_names = staticmethod(graphs.parameter_names)  # type: ignore[attr-defined]
boundary.polish = staticmethod(  # type: ignore[attr-defined]
    lambda p, guesses, *, kind="power", equations="reciprocal": graphs.polish(Model(kind, equations).at(p), guesses)
)
assert np
