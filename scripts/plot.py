#!/usr/bin/python3
"""Draws a result folder: scripts/plot.py DIR [OUT.png]. Deflection, pressure and tip, from fields.npz and history.csv."""
import csv, json, pathlib, sys

try:
    import matplotlib
    import numpy as np
except ModuleNotFoundError as missing:
    sys.exit(f"{missing.name} is missing: scripts/install python3-numpy python3-matplotlib, then run /usr/bin/python3 {sys.argv[0]}")
matplotlib.use("Agg")
from matplotlib import cm, pyplot as plt

if len(sys.argv) < 2:
    sys.exit(__doc__)
result = pathlib.Path(sys.argv[1])
if not (result / "fields.npz").exists():
    sys.exit(f"{result} has no fields.npz: is it the folder of a finished run?")
out = sys.argv[2] if len(sys.argv) > 2 else result / "plot.png"
fields, case = np.load(result / "fields.npz"), json.loads((result / "case.json").read_text())
columns = dict(zip(*[(rows := list(csv.reader(open(result / "history.csv"))))[0], np.array(rows[1:], float).T]))
t, theta, wet = fields["t_fields_s"], fields["theta_node_m"], "pressure_pa" in fields
if len(t) < 2:
    sys.exit(f"{result} holds one instant only")

figure, axes = plt.subplots(2 + wet, figsize=(8, 5.2 + 2.6 * wet), layout="constrained")
figure.suptitle(case["name"])
last = np.flatnonzero(t >= t[-1] - min(0.05, t[-1] / 2))  # the end of the run; a cycle of the shaken cases
unit, scale = ("mm", 1e3) if abs(fields["u1_m"]).max() > 1e-4 else ("µm", 1e6)
for k in last[:: max(1, len(last) // 24)]:
    axes[0].plot(1e3 * theta, scale * fields["u1_m"][k], color=cm.turbo((t[k] - t[last[0]]) / (t[-1] - t[last[0]])), lw=1)
axes[0].set(xlabel="θ [mm]", ylabel=f"$u_1$ [{unit}]", title=f"deflection from {t[last[0]]:.3f} s (blue) to {t[-1]:.3f} s (red)")
axes[1].plot(columns["t [s]"], scale * columns["tip_u1 [m]"], lw=0.9)
axes[1].set(xlabel="t [s]", ylabel=f"tip $u_1$ [{unit}]", xlim=(0, t[-1]))
if wet:
    most = np.percentile(abs(fields["pressure_pa"]), 99) / 1e3
    image = axes[2].pcolormesh(t, np.arange(len(fields["x_f"])), fields["pressure_pa"].T / 1e3, cmap="RdBu_r", vmin=-most, vmax=most)
    starts = np.flatnonzero(np.diff(fields["bladder"], prepend=0))[::2]
    axes[2].set(xlabel="t [s]", ylabel="bladder", title="pressure [kPa]", yticks=starts, yticklabels=fields["bladder"][starts].astype(int))
    figure.colorbar(image, ax=axes[2])
figure.savefig(out, dpi=110)
print(out)
