"""Entry point of ``slcbeam`` and ``python -m slcbeam``: ``slcbeam run case.json``."""

import signal
import sys

from . import _slcbeam


def main() -> None:
    # Ctrl-C ends the program; Python does not raise KeyboardInterrupt
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_slcbeam.program(sys.argv[1:]))


if __name__ == "__main__":
    main()
