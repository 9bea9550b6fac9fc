"""Draws Figures 2 to 5 of the paper with this package, and pictures of its own, into docs/figures."""

from pathlib import Path

import numpy as np
from PIL import Image

import yawdesign as yd
from yawdesign.output.paper_pictures import drawing_of
from yawdesign.output.pictures import write_picture

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "docs" / "figures"
COLOURS = 96


def write(axes, file):
    """Write a picture with no more colours than it needs."""
    write_picture(axes, FOLDER / file, replace=True)
    Image.open(FOLDER / file).convert("RGB").quantize(COLOURS).save(FOLDER / file, optimize=True)


def save(file, result, **options):
    """Save the picture of a result."""
    write(yd.plot(result, **options), file)


def draw_runs():
    """Draw runs over a track, and what the paper shows of them."""
    for name, (title, draw) in drawing_of(yd.reproduce().drawn).items():
        write(draw(title), f"{name}.png")
    table1 = yd.table1(equations="as-printed")
    design = table1.replace(C_s="1 046 770 N s/m")
    run = yd.simulate(design, "german-low", speed="300 km/h", start="rest")
    save("long-run.png", run)
    weak = table1.replace(C_s="50 kN s/m")
    save("unstable.png", yd.simulate(weak, speed=["250 km/h", "300 km/h"], start="rest", duration="12 s"))
    save("frequency-response.png", yd.frequency_response(design, np.geomspace(200, 5, 370)))
    save("spectrum.png", yd.spectrum_check("german-low"))
    save("damper.png", run.damper)
    save("stationary.png", yd.stationary_response(design, speed="300 km/h"))


def draw_modes():
    """Draw modes of one bogie, and of a vehicle with a car body."""
    bogie, vehicle = yd.table1(), yd.load(ROOT / "problems" / "vehicle.yaml")
    speeds = np.linspace(50, 450, 120) / 3.6
    save("stability.png", yd.stability(bogie.replace(requirements={"damping_ratio": "5 %"})))
    save("mode-shape.png", yd.modes(bogie))
    save("vehicle-sway.png", yd.modes(vehicle), mode="lower sway")
    save("root-locus.png", yd.follow_modes(bogie, C_s=np.geomspace(1e4, 5e6, 200)))
    save("damping-over-speed.png", yd.follow_modes(bogie, v=speeds), of="damping_ratio", target=0.05)
    followed = yd.follow_modes(vehicle, v=speeds)
    save("vehicle-damping-over-speed.png", followed, of="damping_ratio", target=0.05)
    save("vehicle-root-locus.png", followed, target=0.05)


def main():
    """Draw everything."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    draw_runs()
    draw_modes()


if __name__ == "__main__":
    main()
