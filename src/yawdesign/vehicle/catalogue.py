"""The bogie of the paper: a frame, two wheelsets, and two traction motors hung in the frame (eqs (1) to (6))."""

from collections.abc import Mapping

from yawdesign.vehicle.elements import Dashpot, Element, Link, Mass, Maxwell, Pair, Spring, WheelRailContact
from yawdesign.vehicle.polynomials import Number

Parameters = Mapping[str, Number]

YAW_DAMPER = "yaw damper"  # the pair of them
LATERAL_DAMPER = "lateral damper "
MOTOR_DAMPER = "motor damper "


def bogie(p: Parameters, *, kind: str = "power", equations: str = "reciprocal") -> list[Element]:
    """Return the elements of a bogie under a car body that stands still.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units (``lambda`` for the conicity), ``v`` [m/s] and, for a state matrix, ``C_s``;
        numbers of any type.
    kind : {"power", "trailer"}
        With or without traction motors.
    equations : {"reciprocal", "as-printed"}
        With the motors' yaw reaction on the frame, or without it as eqs (1) and (7) are printed.
    """
    frame = _frame(p)
    return frame if kind == "trailer" else [*frame, _motors(p, equations)]


def _frame(p: Parameters) -> list[Element]:
    arm_2, arm_1 = p["b_2"] * p["b_2"], p["b_1"] * p["b_1"]
    wheelset = (
        Mass("y_w", p["M_w"]),
        Mass("phi_w", p["J_w"]),
        WheelRailContact("y_w", "phi_w", p["W"], p["lambda"], p["b"], p["r"], p["f_11"], p["f_22"], p["v"]),
        Link((Spring(p["K_1y"]),), {"y_b": 1, "y_w": -1}, lever={"phi_b": p["a"]}),
        Link((Spring(p["K_1x"] * arm_1),), {"phi_b": 1, "phi_w": -1}),
    )
    lateral_law = Maxwell(p["K_dt"] / 2, p["C_t"] / 2)
    lateral_damper = Link((lateral_law,), {"y_b": 1}, lever={"phi_b": p["b_0"]}, name=LATERAL_DAMPER)
    return [
        Mass("y_b", p["M_b"]),
        Mass("phi_b", p["J_b"]),
        Link((Spring(p["K_2y"]),), {"y_b": 1}),
        Link((Spring(p["K_2x"] * arm_2),), {"phi_b": 1}),
        Link((Maxwell(p["K_ds"], p.get("C_s", 0)),), {"phi_b": p["b_3"]}, name=YAW_DAMPER),
        Pair((lateral_damper,)),
        Pair(wheelset, own=frozenset({"y_w", "phi_w"})),
    ]


def _motors(p: Parameters, equations: str) -> Pair:
    # Misprint 1: the row of phi_b in (1) and (7) lacks what the motors' yaw suspension does to the frame.
    acts_on = frozenset({"phi_m"}) if equations == "as-printed" else None
    lateral = (Spring(p["K_m"]), Maxwell(p["K_dm"] / 2, p["C_m"]))
    motor = (
        Mass("y_m", p["M_m"]),
        Mass("phi_m", p["J_m"]),
        Link(lateral, {"y_b": 1, "y_m": -1}, lever={"phi_b": p["a_0"]}, name=MOTOR_DAMPER),
        Link((Spring(p["K_mphi"]), Dashpot(p["C_mphi"])), {"phi_b": 1, "phi_m": -1}, acts_on=acts_on),
    )
    return Pair(motor, own=frozenset({"y_m", "phi_m"}))
