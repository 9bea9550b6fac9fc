"""What an answer does not hold: said in a line beside it."""

from collections.abc import Sequence

from yawdesign.vehicle.vehicle import Vehicle

LOW_CONICITY = 0.2  # below about this a car body that moves may ask for many times the damping

STANDS_STILL = (
    "The car body stands still here: its sway and yaw, and what they do to the bogies at low conicity or reduced "
    "creep, are not in this answer. Give `car_body` to have them."
)
NOT_TO_BE_RELIED_ON = (
    "DO NOT RELY ON THIS AT CONICITY {:.3g}. The car body stands still here, and below a conicity of about 0.2, or "
    "with reduced creep, a car body that moves may ask for many times this damping (low-conicity sway). Give "
    "`car_body`."
)


def scope(vehicles: Sequence[Vehicle]) -> str:
    """Return what an answer about a vehicle does not hold; empty where a car body moves in it.

    Parameters
    ----------
    vehicles : sequence of Vehicle
        It under each of its conditions.
    """
    if any(vehicle.model.has_car_body for vehicle in vehicles):
        return ""
    conicity = min(float(vehicle.p["lambda"]) for vehicle in vehicles)
    return NOT_TO_BE_RELIED_ON.format(conicity) if conicity < LOW_CONICITY else STANDS_STILL
