"""A system call filter (seccomp) that blocks operations which the other protections allow.

System V shared memory outlives its processes and is not included in their memory usage. io_uring bypasses such
filters. A run that shares the root folder and the user with the grader could request forbidden operations from a
server of that user, such as systemd over D-Bus, because Landlock does not restrict Unix sockets. A pair of
connected sockets (socketpair) is allowed. The filter is a classic BPF program.
"""

from __future__ import annotations

import ctypes
import errno
import os
import socket
import struct
import sys

from linkwright.learning.sandbox.linux import call_libc

_IO_URING_SETUP = 425
_ARCHITECTURES = {
    "x86_64": (0xC000003E, 41, (29, 64, 68, _IO_URING_SETUP)),
    "aarch64": (0xC00000B7, 198, (194, 190, 186, _IO_URING_SETUP)),
}
"""An architecture's number in audit(8), and the numbers of `socket`, and of `shmget`, `semget`, `msgget`, io_uring."""
_FIRST_NUMBER_OF_X32 = 0x40000000

_LOAD = 0x20
_JUMP_IF_EQUAL = 0x15
_JUMP_IF_GREATER_OR_EQUAL = 0x35
_RETURN = 0x06
_ALLOW = 0x7FFF0000
_FAIL = 0x00050000
_KILL_PROCESS = 0x80000000
_OFFSET_OF_NUMBER, _OFFSET_OF_ARCHITECTURE, _OFFSET_OF_FIRST_ARGUMENT = 0, 4, 16

_PR_SET_SECCOMP = 22
_SECCOMP_MODE_FILTER = 2


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_ushort), ("instructions", ctypes.c_void_p))


def filter_system_calls(*, forbid_local_servers: bool) -> bool:
    """Filter the system calls of this process and its descendants.

    Returns whether the system supports filters. The process must have called `forbid_new_privileges` before.

    Args:
        forbid_local_servers: whether to forbid sockets for servers on this machine, except network sockets.
    """
    known = _ARCHITECTURES.get(os.uname().machine)
    if known is None or sys.maxsize < 2**32:
        return False
    architecture, socket_number, forbidden = known
    instructions = [
        (_LOAD, 0, 0, _OFFSET_OF_ARCHITECTURE),
        (_JUMP_IF_EQUAL, 1, 0, architecture),
        (_RETURN, 0, 0, _KILL_PROCESS),
        (_LOAD, 0, 0, _OFFSET_OF_NUMBER),
        (_JUMP_IF_GREATER_OR_EQUAL, 0, 1, _FIRST_NUMBER_OF_X32),
        (_RETURN, 0, 0, _KILL_PROCESS),
    ]
    for number in forbidden:
        instructions += [(_JUMP_IF_EQUAL, 0, 1, number), (_RETURN, 0, 0, _FAIL | errno.ENOSYS)]
    if forbid_local_servers:
        instructions += [
            (_JUMP_IF_EQUAL, 0, 3, socket_number),
            (_LOAD, 0, 0, _OFFSET_OF_FIRST_ARGUMENT),
            (_JUMP_IF_EQUAL, 0, 1, int(socket.AF_UNIX)),
            (_RETURN, 0, 0, _FAIL | errno.EACCES),
        ]
    instructions.append((_RETURN, 0, 0, _ALLOW))
    code = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *instruction) for instruction in instructions))
    program = _Program(len(instructions), ctypes.addressof(code))
    try:
        call_libc("prctl", _PR_SET_SECCOMP, ctypes.c_ulong(_SECCOMP_MODE_FILTER), ctypes.byref(program))
    except OSError:
        return False
    return True
