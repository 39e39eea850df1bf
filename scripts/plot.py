#!/usr/bin/python3
"""Draws a result folder: scripts/plot.py DIR [OUT.png]. Needs numpy and matplotlib: scripts/install python3-numpy python3-matplotlib"""
import sys

import matplotlib.pyplot as plt
import numpy as np

folder, out = sys.argv[1], (sys.argv + ["plot.png"])[2]
fields = np.load(f"{folder}/fields.npz")
history = np.genfromtxt(f"{folder}/history.csv", delimiter=",", names=True, deletechars="")
t, theta, wet = fields["t_fields_s"], fields["theta_node_m"], "pressure_pa" in fields
figure, axes = plt.subplots(2 + wet, figsize=(8, 5 + 3 * wet), layout="constrained")
last = np.flatnonzero(t >= 0.9 * t[-1])
for k in last[:: max(1, len(last) // 24)]:
    axes[0].plot(1e3 * theta, 1e3 * fields["u1_m"][k], color=plt.cm.turbo((t[k] - t[last[0]]) / np.ptp(t[last])))
axes[0].set(xlabel="θ [mm]", ylabel="$u_1$ [mm]", title=f"deflection, {t[last[0]]:.3f} s (blue) to {t[-1]:.3f} s (red)")
axes[1].plot(history["t_[s]"], 1e3 * history["tip_u1_[m]"])
axes[1].set(xlabel="t [s]", ylabel="tip $u_1$ [mm]", xlim=(t[0], t[-1]))
if wet:
    most = np.percentile(abs(fields["pressure_pa"]), 99) / 1e3
    image = axes[2].pcolormesh(t, fields["x_f"], fields["pressure_pa"].T / 1e3, cmap="RdBu_r", vmin=-most, vmax=most)
    figure.colorbar(image, label="pressure [kPa]")
    axes[2].set(xlabel="t [s]", ylabel="along the networks, $X_f$")
figure.savefig(out, dpi=110)
