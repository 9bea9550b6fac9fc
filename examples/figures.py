"""Draws Figures 2, 4 and 5 of the paper with this package, and pictures of its own, into docs/figures."""

from pathlib import Path

from matplotlib.figure import Figure

import yawdesign as yd

FOLDER = Path(__file__).parents[1] / "docs" / "figures"
SHOWN_TIME = 10.0  # [s]


def two_panels(result, names, title, file, start=0.0):
    """Draw two responses of the frame below each other, as the paper does."""
    figure = Figure(figsize=(7.0, 5.2), layout="constrained")
    for ax, name, letter in zip(figure.subplots(2, 1, sharex=True), names, "ab", strict=True):
        yd.plot(result, ax, response=name, until=start + SHOWN_TIME)
        ax.get_legend().remove()
        ax.set_ylabel(ax.get_ylabel().replace(" of the frame", ""))
        ax.set_title(f"({letter})", loc="left", fontsize="medium")
        ax.grid(alpha=0.25)
    figure.axes[0].set_xlabel("")
    figure.suptitle(title, fontsize="medium")
    figure.savefig(FOLDER / file, dpi=110)


def save(file, result):
    """Save the picture of a result."""
    yd.plot(result).figure.savefig(FOLDER / file, dpi=110)


def main():
    """Draw everything."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    table1 = yd.table1(equations="as-printed")
    accelerations = ("y_b_acceleration", "phi_b_acceleration")
    sinusoid = yd.simulate(table1, yd.Sinusoid("1 m"), speed="250 km/h", start="rest", duration="10 s")
    title = "Fig. 2: y_a = sin 6t m under the front wheelset, 250 km/h, C_s = 1 000 kN·s/m"
    two_panels(sinusoid, accelerations, title, "fig2.png")
    design = table1.replace(C_s="1 046 770 N s/m")
    for number, kmh in ((4, 250), (5, 300)):
        run = yd.simulate(design, "german-low", speed=f"{kmh} km/h", start="rest")
        title = f"Fig. {number}: {kmh} km/h, C_s = 1 046.77 kN·s/m, German low disturbance (0.3 to 40 Hz)"
        two_panels(run, ("y_b", "phi_b"), title, f"fig{number}.png")
    wavelengths = [200 / 1.01**k for k in range(370)]
    save("frequency-response.png", yd.frequency_response(design, wavelengths))
    save("spectrum.png", yd.spectrum_check("german-low"))
    save("damper.png", yd.damper_component(design))
    weak = table1.replace(C_s="50 kN s/m")
    save("unstable.png", yd.simulate(weak, speed=["250 km/h", "300 km/h"], start="rest", duration="12 s"))


if __name__ == "__main__":
    main()
