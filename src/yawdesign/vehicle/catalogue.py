"""The catalogue of vehicles: which elements each is made of, with the words for its parts (eqs (1) to (6)).

Which parts a vehicle has is said by its numbers: a car body by its mass ``M_c``, roll of the bogie frame by its inertia
``I_b``, primary dampers by ``C_1x`` and ``C_1y``, the wheelset's gyroscopic moment by ``J_wy``; a damper whose joint
has no stiffness among them is mounted rigidly.
"""

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any

from yawdesign.problem.cases import BOGIES, SHARE
from yawdesign.vehicle.elements import (
    Dashpot,
    Element,
    Law,
    Link,
    Mass,
    Maxwell,
    Pair,
    Point,
    Spring,
    WheelRailContact,
)
from yawdesign.vehicle.polynomials import times

Parameters = Mapping[str, Any]  # of Number

OVERTURNING = "overturning"  # the weight of the rolled car body acts
NO_GRAVITATIONAL_STIFFNESS = "no gravitational stiffness"


def elements(kind: str, equations: str, flags: Collection[str], p: Parameters) -> list[Element]:
    """Return the elements of a vehicle.

    Parameters
    ----------
    kind : {"power", "trailer"}
        With or without traction motors.
    equations : {"reciprocal", "as-printed"}
        With the motors' yaw reaction on the frame, or without it as eqs (1) and (7) are printed.
    flags : collection of str
        `OVERTURNING`, `NO_GRAVITATIONAL_STIFFNESS`.
    p : mapping
        Symbols of Table I and of the car body in SI units (``lambda`` for the conicity), ``v`` [m/s] and, for a state
        matrix, ``C_s``; numbers of any type.
    """

    def bogie(own: Parameters) -> list[Element]:
        return CATALOGUE[kind](own, equations, flags)

    return with_car_body(p, flags, bogie) if "M_c" in p else bogie(p)


def with_car_body(p: Parameters, flags: Collection[str], bogie: Callable[[Parameters], list[Element]]) -> list[Element]:
    """Return the elements of two bogies under a car body that moves. Parameters as in `elements`."""
    leading, trailing = (bogie(own_values(p, end)) for end in BOGIES) if _differ(p) else (bogie(p), [])
    tilting = -980665 * p["M_c"] / 100000 * p["h_s"]  # the standard acceleration of free fall, exactly
    weight = [Link((Spring(tilting),), {"th_c": 1})] if OVERTURNING in flags else []
    return [
        Mass("y_c", p["M_c"], body="car body", name="sway", creeping="overdamped sway"),
        Mass(*("psi_c", p["J_c"], "rad", "car body"), name="car body yaw", creeping="overdamped car body yaw"),
        Mass("th_c", p["I_c"], unit="rad", body="car body", name="sway", creeping="overdamped sway"),
        Pair(tuple(leading), own=coordinates(leading), rear=tuple(trailing), half=p["l_c"]),
        Pair((Point("y_c", {"y_c": 1}, lever={"psi_c": p["l_c"]}),)),  # above each bogie, as high as the centre of mass
        *weight,
    ]


def own_values(p: Parameters, bogie: str) -> Parameters:
    """Return the parameters of one bogie of a vehicle: its own values in the place of those of both."""
    own = {name.removeprefix(f"{bogie}."): value for name, value in p.items() if name.startswith(f"{bogie}.")}
    return {**p, **own}


def _differ(p: Parameters) -> bool:
    return any(name.startswith(tuple(f"{bogie}." for bogie in BOGIES)) for name in p)


def coordinates(parts: Iterable[Element]) -> frozenset[str]:
    """Return the coordinates of all masses in some elements, as they are called at one end."""
    found: set[str] = set()
    for part in parts:
        found |= coordinates(part.elements) if isinstance(part, Pair) else set()
        found |= {part.coordinate} if isinstance(part, Mass) else set()
    return frozenset(found)


def power_bogie(p: Parameters, equations: str = "reciprocal", flags: Collection[str] = ()) -> list[Element]:
    """Return the elements of a bogie with two traction motors hung in its frame. Parameters as in `elements`."""
    # Misprint 1: the row of phi_b in (1) and (7) lacks what the motors' yaw suspension does to the frame.
    acts_on = frozenset({"phi_m"}) if equations == "as-printed" else None
    lateral = (Spring(p["K_m"]), _damper(p, "K_dm", p["C_m"], both=2))
    motor = (
        Mass("y_m", p["M_m"], body="motor", name="motor lateral"),
        Mass("phi_m", p["J_m"], unit="rad", body="motor", name="motor yaw", alone="motors yawing"),
        Link(lateral, {"y_b": 1, "y_m": -1}, lever={"phi_b": p["a_0"]}, name="motor damper"),
        Link((Spring(p["K_mphi"]), Dashpot(p["C_mphi"])), {"phi_b": 1, "phi_m": -1}, acts_on=acts_on),
    )
    return [*trailer_bogie(p, equations, flags), Pair(motor, own=frozenset({"y_m", "phi_m"}))]


def trailer_bogie(p: Parameters, equations: str = "reciprocal", flags: Collection[str] = ()) -> list[Element]:
    """Return the elements of a bogie without motors. Parameters as in `elements`."""
    arm_2, arm_1 = p["b_2"] * p["b_2"], p["b_1"] * p["b_1"]
    body = "M_c" in p  # what stands between frame and ground otherwise stands between frame and car body
    rolling, yawing = ({"th_c": -1} if body else {}), ({"psi_c": -1} if body else {})
    contact = WheelRailContact(
        *("y_w", "phi_w"),
        W=p["W"],
        conicity=p["lambda"],
        b=p["b"],
        r=p["r"],
        f_11=p["f_11"],
        f_22=p["f_22"],
        v=p["v"],
        gravitates=NO_GRAVITATIONAL_STIFFNESS not in flags,
        spinning=p.get("J_wy", 0),
    )
    wheelset = (
        Mass("y_w", p["M_w"], body="wheelset", name="wheelset hunting", creeping="wheelset creep"),
        Mass("phi_w", p["J_w"], unit="rad", body="wheelset", name="wheelset hunting", creeping="wheelset creep"),
        contact,
        *_primary(p, "y", {"y_b": 1, "y_w": -1, **_height(p, 1, "h_1")}, {"phi_b": p["a"]}, 1),
        *_primary(p, "x", {"phi_b": 1, "phi_w": -1}, {}, p["b_1"]),
    )
    lateral_law = _damper(p, "K_dt", p["C_t"] / 2, both=2)
    lateral_damper = Link(
        (lateral_law,),
        {"y_b": 1, **_height(p, -1, "h_2t"), **_above(p, "h_t")},
        lever={"phi_b": p["b_0"], **({"psi_c": times(-1, p["b_0"])} if body else {})},
        outer={"psi_c": times(-1, p["l_c"])} if body else {},
        name="lateral damper",
    )
    secondary = Link(
        (Spring(p["K_2y"]),),
        {"y_b": 1, **_height(p, -1, "h_2"), **_above(p, "h_s")},
        lever={"psi_c": times(-1, p["l_c"])} if body else {},
    )
    return [
        Mass("y_b", p["M_b"], body="bogie frame", name="frame lateral"),
        Mass("phi_b", p["J_b"], unit="rad", body="bogie frame", name="frame yaw"),
        secondary,
        Link((Spring(p["K_2x"] * arm_2),), {"phi_b": 1, **yawing}),
        _yaw_dampers(p, yawing),
        *_roll(p, arm_1, arm_2, rolling),
        Pair((lateral_damper,)),
        Pair(wheelset, own=frozenset({"y_w", "phi_w"}), half=p["a"]),
    ]


def _damper(p: Parameters, joint: str, damping: Any, both: int = 1) -> Law:
    """Return a damper in series with its joints, or rigidly mounted where these have no stiffness among the numbers.

    `both` is 2 where the number of the joint belongs to a pair of which this is one.
    """
    return Maxwell(p[joint] / both, damping) if joint in p else Dashpot(damping)


def _yaw_dampers(p: Parameters, yawing: Mapping[str, int]) -> Link:
    share = p.get(SHARE, 1)
    law = _damper(p, "K_ds", times(share, p.get("C_s", 0)))
    gap = {x: times(sign, p["b_3"]) for x, sign in {"phi_b": 1, **yawing}.items()}
    return Link((law,), gap, name="yaw damper", pieces=2, varied=True, share=share)


def _primary(p: Parameters, axis: str, gap: Mapping[str, Any], lever: Mapping[str, Any], arm: Any) -> list[Element]:
    """Return the primary suspension of a wheelset along one axis: its spring and, if there are any, its dampers.

    What is displaced by an angle times `arm` has the force [N] and the stroke [m] of a damper, not those of an angle.
    """
    spring = Link((Spring(times(p[f"K_1{axis}"], arm * arm)),), gap, lever=lever)
    if f"C_1{axis}" not in p:
        return [spring]
    law = _damper(p, f"K_d1{axis}", p[f"C_1{axis}"])
    pulled, turned = ({x: times(arm, g) for x, g in part.items()} for part in (gap, lever))
    name = {"x": "primary longitudinal damper", "y": "primary lateral damper"}[axis]
    return [spring, Link((law,), pulled, lever=turned, name=name, pieces=2)]


def _roll(p: Parameters, arm_1: Any, arm_2: Any, rolling: Mapping[str, int]) -> list[Element]:
    """Return roll of the frame and of the car body on the vertical springs of both sides."""
    frame = {"th_b": 1} if "I_b" in p else {}
    if not frame and not rolling:
        return []
    secondary = Link((Spring(2 * p["K_2z"] * arm_2), Dashpot(2 * p["C_2z"] * arm_2)), {**frame, **rolling})
    if not frame:
        return [secondary]
    primary = Link((Spring(4 * p["K_1z"] * arm_1), Dashpot(4 * p["C_1z"] * arm_1)), frame)
    return [Mass("th_b", p["I_b"], unit="rad", body="bogie frame", name="frame roll"), primary, secondary]


def _height(p: Parameters, sign: int, height: str) -> dict[str, Any]:
    """Return what the frame's roll moves at a height above (sign -1) or below its centre of mass."""
    return {"th_b": times(sign, p[height])} if "I_b" in p else {}


def _above(p: Parameters, height: str) -> dict[str, Any]:
    """Return what the car body moves at so much below its centre of mass, but for its yaw."""
    return {"y_c": -1, "th_c": times(-1, p[height])} if "M_c" in p else {}


CATALOGUE: Mapping[str, Callable[[Parameters, str, Collection[str]], list[Element]]] = {
    "power": power_bogie,
    "trailer": trailer_bogie,
}
