"""A ride over a wavy track in FMPy; on the way the yaw dampers lose nearly all of their damping.

yawdesign export problems/table1.yaml --to exported --only fmu
python examples/fmpy/failing_yaw_damper.py exported/bogie.fmu
"""

import sys

import fmpy
import numpy as np

FMU = sys.argv[1]
WAVELENGTH, AMPLITUDE = 20.0, 1e-3  # of the track's centre line [m]
FAILURE, END, INTERVAL = 6.0, 9.0, 1e-3  # [s]
FAILED = 10e3  # what is left of C_s [N s/m]

start = {v.name: float(v.start) for v in fmpy.read_model_description(FMU).modelVariables if v.start is not None}
omega, delay = 2 * np.pi * start["v"] / WAVELENGTH, 2 * start["a"] / start["v"]

# FMPy holds an input until the next output: the track is given half an interval ahead, which is right to second order.
t = np.arange(0, END + INTERVAL, INTERVAL)
names = ("time", "alignment_1", "alignment_2", "cross_level_1", "cross_level_2", "C_s")
ride = np.zeros(len(t), dtype=[(name, float) for name in names])
ride["time"] = t
ride["alignment_1"] = AMPLITUDE * np.sin(omega * (t + INTERVAL / 2))
ride["alignment_2"] = AMPLITUDE * np.sin(omega * (t + INTERVAL / 2 - delay))
ride["C_s"] = np.where(t < FAILURE, start["C_s"], FAILED)  # a tunable parameter may change on the way

FORCE, DISPLACEMENT = "yaw_damper_pair_force", "yaw_damper_displacement"
outputs = ["y_b", FORCE, DISPLACEMENT]
motion = fmpy.simulate_fmu(FMU, stop_time=END, output_interval=INTERVAL, input=ride, output=outputs)
before = (motion["time"] > FAILURE - 1) & (motion["time"] < FAILURE)
after = motion["time"] > END - 1
print(f"frame, per mm of the track: {np.abs(motion['y_b'][before]).max() / AMPLITUDE:.4f} mm")
force, displacement = (np.abs(motion[name][before]).max() for name in (FORCE, DISPLACEMENT))
print(f"yaw dampers: {force:.1f} N, {displacement * 1e3:.5f} mm")
print(f"frame after the failure, per mm of the track: {np.abs(motion['y_b'][after]).max() / AMPLITUDE:.4f} mm")
