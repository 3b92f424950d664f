"""A filter of system calls (seccomp) against what the other layers leave open.

Shared memory of System V outlives its processes, and no count of theirs includes it. Requests by io_uring pass by such
filters. Where a run shares the root folder and the user with the grader, it could ask a server of that user, such as
systemd over D-Bus, to do what the run must not, because Landlock does not restrict sockets of servers; a pair of
connected sockets (socketpair) is allowed. The filter is a program of classic BPF.
"""

from __future__ import annotations

import ctypes
import errno
import os
import socket
import struct
import sys

from linkwright.learning.sandbox.linux import call

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
    """Filter the system calls of this process and its descendants. False: not on this system.

    The process must have given up new privileges before.

    Args:
        forbid_local_servers: Whether to forbid sockets to servers of this machine other than those of the network.
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
        call("prctl", _PR_SET_SECCOMP, ctypes.c_ulong(_SECCOMP_MODE_FILTER), ctypes.byref(program))
    except OSError:
        return False
    return True
