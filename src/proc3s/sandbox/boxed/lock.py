"""Locks the process it runs in: resource limits, no privileges, and a short seccomp allow-list.

After `lock_down` the process computes, reads one pipe and writes two. It opens nothing, starts nothing and
signals nobody. Everything it will ever import must have been imported before. `restrain` is what is left
for a user who insists on running programs where the kernel has no lock: it hinders, it does not hold.
"""

import contextlib
import ctypes
import os
import platform
import resource
import struct
from collections.abc import Callable

REQUESTS, REPLIES, TRACES = 3, 4, 5
"""The descriptors that stay open: requests to read, replies and stack traces to write."""
NOBODY = 65534

_AUDIT_ARCH = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
_X32_CALLS = 0x40000000
_NUMBERS = {
    "x86_64": {
        "read": 0, "write": 1, "mmap": 9, "mprotect": 10, "munmap": 11, "brk": 12, "rt_sigaction": 13,
        "rt_sigprocmask": 14, "rt_sigreturn": 15, "sched_yield": 24, "mremap": 25, "madvise": 28,
        "getpid": 39, "exit": 60, "gettimeofday": 96, "sigaltstack": 131, "gettid": 186, "futex": 202,
        "restart_syscall": 219, "clock_gettime": 228, "clock_getres": 229, "exit_group": 231,
        "getrandom": 318,
    },
    "aarch64": {
        "read": 63, "write": 64, "mmap": 222, "mprotect": 226, "munmap": 215, "brk": 214, "rt_sigaction": 134,
        "rt_sigprocmask": 135, "rt_sigreturn": 139, "sched_yield": 124, "mremap": 216,
        "madvise": 233, "getpid": 172, "exit": 93, "gettimeofday": 169, "sigaltstack": 132, "gettid": 178,
        "futex": 98, "restart_syscall": 128, "clock_gettime": 113, "clock_getres": 114, "exit_group": 94,
        "getrandom": 278,
    },
}  # fmt: skip

_LOAD, _EQUAL, _AT_LEAST, _ANY_BIT, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
_KILL, _ALLOW, _REFUSE = 0x80000000, 0x7FFF0000, 0x00050001
_CALL_NUMBER, _ARCHITECTURE, _ARGUMENTS = 0, 4, 16
_PROT_EXEC = 4
_PR_SET_PDEATHSIG, _PR_SET_DUMPABLE, _PR_SET_SECCOMP, _PR_SET_NO_NEW_PRIVS = 1, 4, 22, 38
_SIGKILL = 9
_SECCOMP_MODE_FILTER = 2
_CAPABILITY_VERSION_3 = 0x20080522
_REFUSALS = (OSError, ValueError, AttributeError)
"""What a missing or forbidden system call comes as."""


class Unavailable(Exception):
    """This kernel or machine cannot lock a process in."""


def lock_down(memory: int, cpu_seconds: int) -> None:
    """Lock this process for good; `memory` is in bytes on top of what it has. Raises Unavailable."""
    machine = platform.machine()
    if machine not in _NUMBERS:
        raise Unavailable(f"no list of system calls for {machine} processors")
    try:
        for step in _steps(memory, cpu_seconds):
            step()
        install(allow_list(machine))
    except _REFUSALS as error:
        raise Unavailable(str(error)) from error


def restrain(memory: int, cpu_seconds: int) -> None:
    """All but the filter, each step as far as this system knows it."""
    for step in _steps(memory, cpu_seconds):
        with contextlib.suppress(*_REFUSALS):
            step()


def disarm() -> None:
    """Give up all privileges, each as far as this system knows it, and end with the parent."""
    for step in _renounce():
        with contextlib.suppress(*_REFUSALS):
            step()


def _steps(memory: int, cpu_seconds: int) -> list[Callable[[], None]]:
    return [lambda: _limit_resources(memory, cpu_seconds), *_renounce()]


def _renounce() -> list[Callable[[], None]]:
    return [
        _drop_privileges,
        # the parent-death signal is forgotten when the user changes, so it comes after that
        lambda: _prctl(_PR_SET_PDEATHSIG, _SIGKILL),
        lambda: _prctl(_PR_SET_NO_NEW_PRIVS, 1),
        lambda: _prctl(_PR_SET_DUMPABLE, 0),
    ]


def allow_list(machine: str) -> list[bytes]:
    """The filter as BPF instructions: what is not named fails with EPERM, foreign architectures kill."""
    numbers = dict(_NUMBERS[machine])
    program = [
        _instruction(_LOAD, _ARCHITECTURE),
        _instruction(_EQUAL, _AUDIT_ARCH[machine], then=1),
        _instruction(_RETURN, _KILL),
        _instruction(_LOAD, _CALL_NUMBER),
        _instruction(_AT_LEAST, _X32_CALLS, otherwise=1),
        _instruction(_RETURN, _KILL),
        *_with_descriptor(numbers.pop("read"), (REQUESTS,)),
        *_with_descriptor(numbers.pop("write"), (REPLIES, TRACES)),
        *_without_code_pages(numbers.pop("mmap")),
        *_without_code_pages(numbers.pop("mprotect")),
    ]
    for number in numbers.values():
        program += [_instruction(_EQUAL, number, otherwise=1), _instruction(_RETURN, _ALLOW)]
    return [*program, _instruction(_RETURN, _REFUSE)]


def install(program: list[bytes]) -> None:
    """Install a seccomp filter; needs NO_NEW_PRIVS. Raises OSError."""

    class Filter(ctypes.Structure):
        _fields_ = (("length", ctypes.c_ushort), ("instructions", ctypes.c_void_p))

    instructions = ctypes.create_string_buffer(b"".join(program))
    pointer = ctypes.cast(instructions, ctypes.c_void_p)
    _prctl(_PR_SET_SECCOMP, _SECCOMP_MODE_FILTER, ctypes.byref(Filter(len(program), pointer)))


def _instruction(code: int, operand: int, then: int = 0, otherwise: int = 0) -> bytes:
    return struct.pack("=HBBI", code, then, otherwise, operand)


def _with_descriptor(number: int, descriptors: tuple[int, ...]) -> list[bytes]:
    """Allow a call whose first argument is one of the descriptors."""
    count = len(descriptors)
    tests = [_instruction(_EQUAL, fd, then=count - i) for i, fd in enumerate(descriptors)]
    return [
        _instruction(_EQUAL, number, otherwise=count + 3),
        _instruction(_LOAD, _ARGUMENTS),
        *tests,
        _instruction(_RETURN, _REFUSE),
        _instruction(_RETURN, _ALLOW),
    ]


def _without_code_pages(number: int) -> list[bytes]:
    """Allow a memory call whose third argument, the protection, does not ask for execution."""
    return [
        _instruction(_EQUAL, number, otherwise=4),
        _instruction(_LOAD, _ARGUMENTS + 2 * 8),
        _instruction(_ANY_BIT, _PROT_EXEC, otherwise=1),
        _instruction(_RETURN, _REFUSE),
        _instruction(_RETURN, _ALLOW),
    ]


def _limit_resources(memory: int, cpu_seconds: int) -> None:
    with open("/proc/self/statm") as statm:  # noqa: PTH123 - pathlib is not worth its import here
        in_use = int(statm.read().split()[0]) * resource.getpagesize()
    for kind, value in (
        (resource.RLIMIT_AS, in_use + memory),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_NPROC, 0),
        (resource.RLIMIT_NOFILE, TRACES + 1),
    ):
        hard = resource.getrlimit(kind)[1]
        value = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(kind, (value, value))
    # the signal at the soft limit says why the process dies; it can be ignored, the hard limit cannot
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    most = cpu_seconds + 1 if hard == resource.RLIM_INFINITY else min(cpu_seconds + 1, hard)
    resource.setrlimit(resource.RLIMIT_CPU, (min(cpu_seconds, most), most))


def _drop_privileges() -> None:
    # in a user namespace that does not know this user root stays root, but without capabilities (below)
    with contextlib.suppress(OSError):
        if os.getuid() == 0:
            os.setgroups([])
            os.setresgid(NOBODY, NOBODY, NOBODY)
            os.setresuid(NOBODY, NOBODY, NOBODY)
    libc = ctypes.CDLL(None, use_errno=True)
    header = struct.pack("=Ii", _CAPABILITY_VERSION_3, 0)
    if libc.capset(header, bytes(24)):
        raise OSError(ctypes.get_errno(), "cannot drop capabilities")


def _prctl(option: int, *arguments: object) -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    padding = [0] * (4 - len(arguments))
    longs = [ctypes.c_ulong(a) if isinstance(a, int) else a for a in (*arguments, *padding)]
    if libc.prctl(option, *longs):
        code = ctypes.get_errno()
        raise OSError(code, f"prctl({option}) failed: {os.strerror(code)}")
