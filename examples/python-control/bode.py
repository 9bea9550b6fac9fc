"""Bode plot and poles of a bogie with python-control.

    python examples/python-control/bode.py problems/table1.yaml bode.png

Left: from the track's alignment under the front wheelset to the frame's lateral motion. Right: the poles for many yaw
dampings, a root locus of the hunting motion.
"""

import sys

import control
import numpy as np
from matplotlib.figure import Figure

import yawdesign as yd

problem = yd.load(sys.argv[1])
system = yd.state_space(problem).to_control()
print(f"largest real part {system.poles().real.max():.8g} 1/s")

figure = Figure(figsize=(8, 4.5), layout="constrained")
bode, locus = figure.subplots(1, 2)

f = np.geomspace(0.3, 40, 400)
response = control.frequency_response(system["y_b", "alignment_1"], 2 * np.pi * f)
gain = np.squeeze(response.magnitude)
print(f"largest amplification {gain.max():.6g} at {f[gain.argmax()]:.4g} Hz")
bode.loglog(f, gain)
bode.set(xlabel="frequency [Hz]", ylabel="frame / front alignment, lateral [m/m]", title="Amplification")
bode.grid(which="both", alpha=0.3)

damping = np.geomspace(20e3, 5e6, 120)
poles = [yd.state_space(problem.replace(C_s=C_s)).to_control().poles() for C_s in damping]
places = np.concatenate(poles)
near = (places.imag > 0) & (np.abs(places) < 80)
marks = locus.scatter(
    places[near].real, places[near].imag / (2 * np.pi), s=6, c=np.repeat(np.log10(damping / 1e3), len(poles[0]))[near]
)
locus.axvspan(0, 2, color="tab:red", alpha=0.1)
locus.set(xlim=(-25, 2), xlabel="real part [1/s]", ylabel="frequency [Hz]", title="Poles, right of 0 unstable")
locus.grid(alpha=0.3)
bar = figure.colorbar(marks, ax=locus, label="yaw damping C_s [kN s/m]")
bar.set_ticks([2, 3], labels=["100", "1000"])
figure.savefig(sys.argv[2])
