"""`python -m proc3s`."""

from proc3s.cli import main

main()
