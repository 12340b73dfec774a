"""Programs that mean harm, with every module of the interpreter at hand: here only the kernel refuses."""

import os
from pathlib import Path

import numpy as np
import pytest

from proc3s.sandbox import SketchCrash, SketchError, SketchTimeout
from proc3s.sandbox.boxed.wire import ERROR, PLAN, REPLY
from proc3s.sandbox.limits import Limits

from .conftest import LINE, cube

# past the friendly imports, which are no boundary
ESCAPE = """
classes = ().__class__.__base__.__subclasses__()
os = [c for c in classes if c.__name__ == "_wrap_close"][0].__init__.__globals__
sys = os["sys"]
io, signal, ctypes, resource, threading = map(sys.modules.get, "io signal ctypes resource threading".split())
"""


def attempts(box, expressions):
    """What comes of each expression in a program: what it printed, or its error."""
    choices = ", ".join(f"lambda: {expression}" for expression in expressions)
    sketch = box(f"""{ESCAPE}
def gen_plan(state, k, attempts=[{choices}]):
    print(attempts[k]())
    return [Action("repeat", [1])]

def gen_domain(state):
    return {{"k": DiscreteSampler(range({len(expressions)}))}}
""")
    batch = sketch.plans((np.arange(len(expressions))[:, None] + 0.5) / len(expressions))
    return [str(batch.errors.get(i, batch.logs.get(i))).strip() for i in range(len(expressions))]


def test_system_calls_are_refused(box):
    expressions = [
        'io.open("/etc/passwd").read()',
        'io.open("/tmp/proc3s-escape", "w")',
        'os["open"]("/proc/self/environ", 0)',
        'os["listdir"]("/")',
        'os["stat"]("/")',
        'os["unlink"]("/tmp/proc3s")',
        'os["fork"]()',
        'os["posix_spawn"]("/bin/true", ["true"], {})',
        'os["execv"]("/bin/true", ["true"])',
        'os["kill"](1, 0)',
        'os["dup"](3)',
        'os["pipe"]()',
        'os["read"](0, 1)',
        'os["write"](1, b"x")',
        'os["close"](4)',
        'os["setuid"](0)',
        'os["memfd_create"]("x")',
    ]
    for expression, outcome in zip(expressions, attempts(box, expressions), strict=True):
        assert "PermissionError: [Errno 1] Operation not permitted" in outcome, expression


def test_calls_through_the_c_library_are_refused(box):
    calls = [
        "socket(1, 1, 0)",
        "mmap(0, 4096, 7, 0x22, -1, 0)",
        "mprotect(0, 0, 5)",
        "ptrace(16, 1, 0, 0)",
        "kill(1, 0)",
        "prctl(22, 0, 0, 0, 0)",
    ]
    expressions = [f"(ctypes.CDLL(None, use_errno=True).{call}, ctypes.get_errno())" for call in calls]
    assert attempts(box, expressions) == ["(-1, 1)"] * len(calls)


def test_threads_and_higher_limits_are_refused(box):
    thread, limit = attempts(
        box,
        ["threading.Thread(target=print).start()", "resource.setrlimit(resource.RLIMIT_CPU, (9999, 9999))"],
    )
    assert "can't start new thread" in thread
    assert "Error" in limit


def test_no_secret_is_in_reach(box, monkeypatch):
    monkeypatch.setenv("SECRET_API_KEY", "hunter2")
    [seen] = attempts(box, ["(sorted(os['environ']), sys.path, 'subprocess' in sys.modules)"])
    assert "PYTHONHASHSEED" in seen
    assert "SECRET" not in seen
    assert str(Path(__file__).parents[2] / "src" / "proc3s" / "sketch'") not in seen
    assert seen.endswith("False)")


def test_a_ready_worker_is_locked(box):
    pid = box(LINE)._channel._worker.pid
    text = Path(f"/proc/{pid}/status").read_text()
    fields = dict(line.split(":\t", 1) for line in text.splitlines() if ":\t" in line)
    assert fields["Seccomp"] == "2"
    assert fields["NoNewPrivs"] == "1"
    assert fields["Threads"] == "1"
    assert all(int(fields[name], 16) == 0 for name in ("CapPrm", "CapEff", "CapInh", "CapAmb"))
    assert "0" not in fields["Uid"].split()
    if os.getuid() == 0:
        assert sorted(fd.name for fd in Path(f"/proc/{pid}/fd").iterdir()) == list("012345")


def forging(reply):
    """A sketch that, in its third sample, writes a reply of its own before the honest one."""
    return f"""{ESCAPE}
calls = -1
def gen_plan(state):
    global calls
    calls += 1
    if calls == 3:
        os["write"](4, {reply!r})
    return [Action("draw_line", [1, 2, 3, 4])]
"""


def frame(kind, body, sample=2, actions=0, length=None):
    return REPLY.pack(sample, kind, actions, len(body) if length is None else length) + body


FAULT = b'{"kind": "runtime", "message": "x", "line": 1}'


@pytest.mark.parametrize(
    "reply",
    [
        frame(PLAN, b"\0" + bytes(32), actions=1, sample=7),
        frame(PLAN, b"\xff" + bytes(32), actions=1),
        frame(PLAN, b"", length=2**31),
        frame(ERROR, FAULT.replace(b"1", b"NaN")),
        frame(PLAN, b"\0" + bytes(32), actions=1) * 2,
    ],
)
def test_forged_replies_end_the_batch(box, reply):
    sketch = box(forging(reply), "program")
    with pytest.raises(SketchCrash, match="tampered with its process") as caught:
        sketch.plans(np.empty((9, 0)))
    assert len(caught.value.done) in (2, 3)
    assert not caught.value.done.errors


def test_half_a_reply_is_waited_for_only_so_long(box):
    source = forging(b"\2").replace("    return", "    while calls == 3: pass\n    return")
    with pytest.raises(SketchTimeout) as caught:
        box(source, "program", limits=Limits(call=0.3, restarts=0)).plans(np.empty((9, 0)))
    assert len(caught.value.done) == 2


def test_dripping_bytes_gain_no_time(box):
    drip = f"{ESCAPE}\ncalls = 0\ndef gen_plan(state):\n    global calls; calls += 1\n    if calls == 2:\n"
    drip += "        body = b'\\0\\0\\0\\0\\4\\0\\0\\0\\0\\0\\2\\0' + b'x' * 10**5\n"
    drip += "        for byte in body:\n            os['write'](4, bytes([byte])); sum(range(200_000))\n"
    drip += "    return [Action('repeat', [1])]"
    with pytest.raises(SketchTimeout):
        box(drip, "program", limits=Limits(call=0.4, restarts=0)).plans(np.empty((1, 0)))


def test_what_is_forged_while_loading_is_noticed(box):
    for reply in (b"\0", frame(2, b"{}", sample=0), frame(5, FAULT, sample=1), os.urandom(64)):
        with pytest.raises((SketchCrash, SketchTimeout)):
            box(f"{ESCAPE}\nos['write'](4, {reply!r})\n{LINE}", limits=Limits(load=0.5))


def test_a_forged_trace_yields_no_more_than_a_line_number(box):
    trace = b'  File "<program>", line 999999 in x\n  File "<program>", line 4 in \x1b[31mevil\n'
    source = f"{ESCAPE}\nsignal.signal(10, lambda *_: os['write'](5, {trace!r}))\nwhile True: pass"
    with pytest.raises(SketchTimeout) as caught:
        box(source, limits=Limits(load=0.4))
    assert caught.value.line in (4, 8)
    assert "evil" not in str(caught.value)


def test_redefined_internals_hurt_only_the_program(box):
    source = f"{ESCAPE}\nserve = sys.modules['boxed.serve']\nserve.json = serve.REPLY = None\n{LINE}"
    with pytest.raises(SketchError):
        box(source)
    assert len(box(LINE).plans(cube(3, 2))) == 3


def test_huge_output_and_messages_are_cut(box):
    source = "def gen_plan(state):\n    print('x' * 10**8)\n    raise ValueError('y' * 10**7)"
    batch = box(source, "program").plans(np.empty((2, 0)))
    assert all(len(log) == 4096 for log in batch.logs.values())
    assert all(len(error.message) == 600 for error in batch.errors.values())
