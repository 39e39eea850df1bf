"""The program, as ``slcbeam`` or ``python -m slcbeam``: ``slcbeam run case.json``."""

import signal
import sys

from . import _slcbeam


def main() -> None:
    # what the program makes of Ctrl-C, not Python
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_slcbeam.program(sys.argv[1:]))


if __name__ == "__main__":
    main()
