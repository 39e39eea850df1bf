"""Common parts of the Python peers: parameters of a scene, and the loop that answers `SCENE METHOD SETTING` line by line."""

import json
import subprocess
import sys


def exported(peers, name):
    """Parameters of a scene, from the program benches/peers."""
    return json.loads(subprocess.run([peers, "export", name], check=True, capture_output=True, text=True).stdout)


def serve(solve):
    """Answers each line of standard input by `seconds steps tip.. pressure..` of solve(scene, method, setting), or by `failed` and the reason."""
    for line in sys.stdin:
        name, method, setting = line.split()
        try:
            seconds, steps, tips, pressures = solve(name, method, float(setting))
            print(f"{seconds:e} {steps} " + " ".join(f"{x:.17g}" for x in [*tips, *pressures]), flush=True)
        except Exception as error:  # a peer may fail at a setting; that is a result
            print("failed " + f"{type(error).__name__} {error}".replace("\n", " "), flush=True)
