# Opens a connection in the obvious way.
# expect: SketchRuntimeError line 5: No module named 'socket'
# friendly: SketchRuntimeError line 5: ImportError: 'socket' cannot be imported here
# answer: plan
import socket
socket.create_connection(("127.0.0.1", 80))
gen_plan = [Action("repeat", [1])]
