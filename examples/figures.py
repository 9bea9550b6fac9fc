"""Draws Figures 2 to 5 of the paper with this package, and pictures of its own, into docs/figures."""

from pathlib import Path

import yawdesign as yd
from yawdesign.output.paper_pictures import drawing_of

FOLDER = Path(__file__).parents[1] / "docs" / "figures"


def save(file, result):
    """Save the picture of a result."""
    yd.plot(result).figure.savefig(FOLDER / file, dpi=110)


def main():
    """Draw everything."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    table1 = yd.table1(equations="as-printed")
    for name, (title, draw) in drawing_of(yd.reproduce().drawn).items():
        draw(title).figure.savefig(FOLDER / f"{name}.png", dpi=110)
    design = table1.replace(C_s="1 046 770 N s/m")
    wavelengths = [200 / 1.01**k for k in range(370)]
    save("frequency-response.png", yd.frequency_response(design, wavelengths))
    save("spectrum.png", yd.spectrum_check("german-low"))
    save("damper.png", yd.damper_component(design))
    weak = table1.replace(C_s="50 kN s/m")
    save("unstable.png", yd.simulate(weak, speed=["250 km/h", "300 km/h"], start="rest", duration="12 s"))


if __name__ == "__main__":
    main()
