"""`python -m proc3s`."""

import sys

if not sys.flags.safe_path:
    # the working directory, whose files must not hide a package; the script `proc3s` does not have it either
    del sys.path[0]

from proc3s.cli import main

main()
