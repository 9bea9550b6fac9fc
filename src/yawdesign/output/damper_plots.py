"""A picture of the yaw damper as a component."""

from math import isinf, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.output.panels import divided
from yawdesign.output.pictures import legend_below, log_axis, new_axes, put_title, quantity
from yawdesign.output.style import BEFORE, CHOSEN, LIMIT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.response.run.damper_component import DamperComponent

LOW, HIGH, POINTS = 0.1, 30.0, 300  # what is drawn [Hz]


def damper_component(result: "DamperComponent", ax: "Axes | None" = None) -> "Axes":
    """Draw dynamic stiffness and, below, phase of the pair of yaw dampers over frequency.

    Parameters
    ----------
    result : DamperComponent
        What `damper_component` returns.
    ax : Axes, optional
        Where to draw; the phase stands in axes of its own in the lower part of them.
    """
    upper, lower = divided(new_axes(ax), rows=(3, 2), shared=True)
    f = np.geomspace(LOW, HIGH, POINTS)
    Z = result.complex_stiffness(f)
    rigid = isinf(result.K_ds)
    upper.loglog(f, np.abs(Z) / 1e6, color=CHOSEN, label="damper with its joints")
    damping: dict[str, Any] = {"color": BEFORE, "linestyle": (0, (5, 2)), "linewidth": 1.2}
    joints: dict[str, Any] = {"color": BEFORE, "linestyle": (0, (1.5, 1.5)), "linewidth": 1.4}
    if not rigid:
        upper.loglog(f, 2 * pi * f * result.C_s / 1e6, label=r"damping alone, $2\pi f\,C_\mathrm{s}$", **damping)
        upper.axhline(result.K_ds / 1e6, label=r"stiffness of the joints alone, $K_\mathrm{ds}$", **joints)
        upper.set_ylim(0.7 * abs(Z[0]) / 1e6, 3 * result.K_ds / 1e6)
        lower.axhline(90.0, **damping)
        lower.axhline(0.0, **joints)
    lower.plot(f, np.degrees(np.angle(Z)), color=CHOSEN, label="_")
    lower.set(ylim=(-4, 94), yticks=[0, 30, 60, 90], ylabel="phase [°]", xlabel="frequency [Hz]", xlim=(LOW, HIGH))
    upper.set_ylabel("|Z| of the pair [MN/m]")
    log_axis(upper)
    log_axis(upper, upright=True)
    _mark_hunting(result, upper, lower)
    for panel in (upper, lower):
        panel.grid()
    bogie = {"1": ", leading bogie", "2": ", trailing bogie"}.get(result.name[-1], "")
    held = "rigid joints" if rigid else quantity("K_ds", result.K_ds)
    put_title(upper, f"Dynamic stiffness of the yaw dampers{bogie}: {quantity('C_s', result.C_s)}, {held}")
    legend_below(lower, handles=upper.get_legend_handles_labels()[0])
    return upper


def _mark_hunting(result: "DamperComponent", upper: "Axes", lower: "Axes") -> None:
    at = result.at_hunting
    if at is None:
        return
    text = f"at the hunting, {at.frequency:.3g} Hz: {at.stiffness / 1e6:.3g} MN/m, {np.degrees(at.phase):.0f}°"
    for panel, value in ((upper, at.stiffness / 1e6), (lower, np.degrees(at.phase))):
        panel.axvline(at.frequency, color=LIMIT, linewidth=0.8)
        panel.plot([at.frequency], [value], "o", color=LIMIT, markersize=6, label=text)
