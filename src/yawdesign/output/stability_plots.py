"""A picture of stability: the eigenvalues in the complex plane, with the margins."""

from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Complex
from yawdesign.output.condition_texts import condition_text
from yawdesign.output.pictures import legend_below, literal, new_axes, put_title, quantity
from yawdesign.output.root_locus import damping_ray, draw_plane
from yawdesign.output.style import BECOMES, BECOMES_DASHES, BEFORE, CHOSEN, LIMIT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.hunting.verdict import Stability

OWN = 1e-6  # relative: a decoupled eigenvalue is found among all by its value


def draw_stability(result: "Stability", ax: "Axes | None" = None, *, widest: float = 40.0) -> "Axes":
    """Draw the eigenvalues under the worst condition, the least damping ratio and what is required of it.

    Parameters
    ----------
    result : Stability
        Of `yawdesign.stability`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    widest : float
        Modes that decay faster than this [1/s] are left out.
    """
    ax = new_axes(ax)
    upper = np.array([s for s in result.eigenvalues if s.imag >= 0])
    seen = upper[upper.real > -widest]
    fixed = np.array([s for roots in result.fixed_modes.values() for s in roots if s.imag >= 0])
    apart = np.array([bool(fixed.size and np.min(abs(fixed - s)) <= OWN * max(abs(s), 1.0)) for s in seen], dtype=bool)
    beside = fixed[[not np.any(abs(upper - s) <= OWN * max(abs(s), 1.0)) for s in fixed]] if fixed.size else fixed
    own = np.concatenate([seen[apart], beside[beside.real > -widest]])
    farthest = float(np.max(upper.real, initial=0.0))
    draw_plane(ax, widest, max(0.0, farthest), 1.12 * float(np.max(seen.imag, initial=2 * pi)) / (2 * pi))
    _mark(ax, seen[~apart], "o", CHOSEN, "mode that a design variable moves")
    _mark(ax, own, "s", BEFORE, "decoupled mode")
    _margins(ax, result)
    fast = int(np.sum(upper.real <= -widest))
    if fast:
        ax.plot([], [], linestyle="none", label=f"{fast} faster ones not shown")
    legend_below(ax)
    verdict = "Stable" if result.stable else f"Unstable: {result.unstable_roots} roots with positive real part"
    worst = literal(condition_text({"speed": result.speed, **result.worst_condition}))
    put_title(ax, f"{verdict}, {quantity('C_s', result.C_s)}; worst condition: {worst}")
    return ax


def _mark(ax: "Axes", s: Complex, sign: str, colour: str, label: str) -> None:
    if s.size:
        face = "none" if sign == "s" else colour
        look: dict[str, Any] = {"color": colour, "markerfacecolor": face, "markersize": 6, "linestyle": "none"}
        ax.plot(s.real, s.imag / (2 * pi), marker=sign, label=label, zorder=3, **look)


def _margins(ax: "Axes", result: "Stability") -> None:
    """Draw the least damping ratio and what is required of it, and the least decay rate."""
    wanted = next((x.wanted for x in result.requirements if x.name == "damping_ratio"), None)
    if 0 < result.damping_ratio < 1:
        text = f"least damping ratio {100 * result.damping_ratio:.3g} %"
        damping_ray(ax, result.damping_ratio, text, color=CHOSEN, linestyle=(0, (1.5, 1.5)))
    if wanted is not None and wanted > 0:
        damping_ray(ax, wanted, f"required damping ratio {100 * wanted:g} %")
    kind = "stable" if result.decay_rate > 0 else "unstable"
    look: dict[str, Any] = {"color": BECOMES[kind], "linestyle": BECOMES_DASHES[kind], "linewidth": 1.2}
    ax.axvline(-result.decay_rate, label=f"least decay rate {result.decay_rate:.3g} 1/s", **look)
    ax.axvline(0, color=LIMIT, linewidth=1, label="_")
