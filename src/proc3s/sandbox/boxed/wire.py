"""The frames between the two sides.

A request is an operation, a length and a body; a reply is a sample number, a kind, a number of actions, a
length and a body. LOAD and PROBE carry JSON or one row; RUN carries rows of float64. Every row is answered
by exactly one PLAN (skill numbers, one byte each, then float64 values) or ERROR (JSON), written at once so
that it survives whatever the next row does; a LOG (JSON) may precede it.

The template of the boxes takes orders: an operation, the number of a box and three values. BOX (memory in
bytes, CPU seconds, locked or not) comes with the PIPES of the box and has no answer; SIGNAL (its number, or
0) is answered with process id, exit code or RUNNING, and the CPU seconds of the template and ended boxes.
"""

import struct

REQUEST = struct.Struct("<cI")
LOAD, PROBE, RUN = b"L", b"P", b"R"
FIRST_SAMPLE = struct.Struct("<I")

REPLY = struct.Struct("<IHHI")
READY, UNAVAILABLE, LOADED, PROBED, PLAN, ERROR, LOG = range(7)

ORDER = struct.Struct("<cIQQQ")
BOX, SIGNAL = b"B", b"S"
PIPES = 3
BOX_STATE = struct.Struct("<iid")
RUNNING = 1 << 16
"""No process ends with this code."""

FILENAME = "<program>"
"""What tracebacks call the program."""
MOST_PARAMETERS = 256
MOST_VALUES = 1000
"""Values of a list that is an argument of a sampler."""
LONGEST_NAME = 100
"""Characters of the name of a parameter."""
MOST_PROBLEMS = 20
"""No more breaches of the contract than these are reported at once, to keep the reply small."""
WIDTH = {"float": 1, "int": 1, "str": 1, "object": 1, "point": 3, "pose": 6, "grasp": 6}
"""How many float64 values a parameter of each type takes."""
