"""Starts the template of the untrusted side, without proc3s: `python -s -B worker.py`."""

import sys
from importlib import import_module

if __name__ == "__main__":
    import_module("boxed")
    # this folder was only needed to find the package: its other modules must not shadow anything
    del sys.path[0]
    import_module("boxed.template").main()
