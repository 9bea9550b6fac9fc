"""The catalogue of vehicles: which elements each is made of, with the words for its parts (eqs (1) to (6))."""

from collections.abc import Callable, Mapping
from typing import Any

from yawdesign.vehicle.elements import Dashpot, Element, Link, Mass, Maxwell, Pair, Spring, WheelRailContact

Parameters = Mapping[str, Any]  # of Number


def power_bogie(p: Parameters, equations: str = "reciprocal") -> list[Element]:
    """Return the elements of a bogie with two traction motors hung in its frame, under a car body that stands still.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units (``lambda`` for the conicity), ``v`` [m/s] and, for a state matrix, ``C_s``;
        numbers of any type.
    equations : {"reciprocal", "as-printed"}
        With the motors' yaw reaction on the frame, or without it as eqs (1) and (7) are printed.
    """
    # Misprint 1: the row of phi_b in (1) and (7) lacks what the motors' yaw suspension does to the frame.
    acts_on = frozenset({"phi_m"}) if equations == "as-printed" else None
    lateral = (Spring(p["K_m"]), Maxwell(p["K_dm"] / 2, p["C_m"]))
    motor = (
        Mass("y_m", p["M_m"], body="motor", name="motor lateral"),
        Mass("phi_m", p["J_m"], unit="rad", body="motor", name="motor yaw", alone="motors yawing"),
        Link(lateral, {"y_b": 1, "y_m": -1}, lever={"phi_b": p["a_0"]}, name="motor damper"),
        Link((Spring(p["K_mphi"]), Dashpot(p["C_mphi"])), {"phi_b": 1, "phi_m": -1}, acts_on=acts_on),
    )
    return [*trailer_bogie(p, equations), Pair(motor, own=frozenset({"y_m", "phi_m"}))]


def trailer_bogie(p: Parameters, equations: str = "reciprocal") -> list[Element]:
    """Return the elements of a bogie without motors. Parameters as in `power_bogie`."""
    arm_2, arm_1 = p["b_2"] * p["b_2"], p["b_1"] * p["b_1"]
    wheelset = (
        Mass("y_w", p["M_w"], body="wheelset", name="wheelset hunting", creeping="wheelset creep"),
        Mass("phi_w", p["J_w"], unit="rad", body="wheelset", name="wheelset hunting", creeping="wheelset creep"),
        WheelRailContact("y_w", "phi_w", p["W"], p["lambda"], p["b"], p["r"], p["f_11"], p["f_22"], p["v"]),
        Link((Spring(p["K_1y"]),), {"y_b": 1, "y_w": -1}, lever={"phi_b": p["a"]}),
        Link((Spring(p["K_1x"] * arm_1),), {"phi_b": 1, "phi_w": -1}),
    )
    lateral_law = Maxwell(p["K_dt"] / 2, p["C_t"] / 2)
    lateral_damper = Link((lateral_law,), {"y_b": 1}, lever={"phi_b": p["b_0"]}, name="lateral damper")
    yaw_law = Maxwell(p["K_ds"], p.get("C_s", 0))
    return [
        Mass("y_b", p["M_b"], body="bogie frame", name="frame lateral"),
        Mass("phi_b", p["J_b"], unit="rad", body="bogie frame", name="frame yaw"),
        Link((Spring(p["K_2y"]),), {"y_b": 1}),
        Link((Spring(p["K_2x"] * arm_2),), {"phi_b": 1}),
        Link((yaw_law,), {"phi_b": p["b_3"]}, name="yaw damper", pieces=2, varied=True),
        Pair((lateral_damper,)),
        Pair(wheelset, own=frozenset({"y_w", "phi_w"})),
    ]


CATALOGUE: Mapping[str, Callable[[Parameters, str], list[Element]]] = {
    "power": power_bogie,
    "trailer": trailer_bogie,
}
