"""Write invalid messages to DDS topics: ``python -m tests.reliability.garbage DOMAIN``.

The bytes go to a topic of strings, to the requests of a service, to ``ros_discovery_info``, and to the UDP ports.
Cyclone rejects many of them by itself. The others are texts with invalid UTF-8, and impossible names of nodes. A valid
message follows, so that a test sees whether a receiver still works.
"""

from __future__ import annotations

import random
import socket
import struct
import sys
import time
from contextlib import suppress
from pathlib import Path

from cyclonedds.core import DDSException
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import types
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from linkwright.wire.dds.settings import read_settings
from tests.wire.ros_peer import as_bytes, make_type, read_text

ROUND_COUNT = 40
HEADER = b"\0\1\0\0"
RELIABLE = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))
TRANSIENT_LOCAL = RELIABLE + Qos(Policy.Durability.TransientLocal)


def make_writer(participant: DomainParticipant, topic: str, kind: type, qos: Qos) -> DataWriter:
    return DataWriter(participant, Topic(participant, topic, kind), qos)


def make_random_bodies(lottery: random.Random) -> list[bytes]:
    """Return bytes that are rarely a valid message.

    Each has an encapsulation header that Cyclone accepts.
    """
    packets = [HEADER + lottery.randbytes(4 * lottery.randrange(1, 40)) for _ in range(ROUND_COUNT)]
    packets += [HEADER + struct.pack("<I", length) + bytes(4) for length in (2**32 - 1, 2**31, 10_000_000, 0)]
    packets += [HEADER + struct.pack("<I", 3) + bytes([0xFF, byte, 0, 0]) for byte in range(1, 60)]
    packets += [HEADER + b"\2\0\0\0\xff\0\0\0", HEADER]
    return packets


def make_announcements(participant: bytes) -> list[bytes]:
    """Return possible announcements of a participant in the layout of Humble.

    The node names are impossible.
    """

    def name(value: bytes) -> bytes:
        return struct.pack("<I", len(value) + 1) + value + bytes(4 - len(value) % 4)

    nodes = [(b"/", b"\xff\xfe"), (b"", b""), (b"/", b"\x1b[2Jred"), (b"no slash", b"a b"), (b"//", b"x" * 200)] * 20
    messages = []
    for count in (1, 2, 3, len(nodes)):
        data = b"".join(name(space) + name(node) + bytes(8) for space, node in nodes[:count])
        messages.append(HEADER + participant + bytes(8) + struct.pack("<I", count) + data)
    return messages


def send_datagrams(lottery: random.Random, first_port: int) -> None:
    """Send datagrams to the ports of the first participants of the domain."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for port in range(first_port, first_port + 20):
            for _ in range(20):
                junk = lottery.randbytes(lottery.randrange(1, 400))
                for datagram in (junk, b"RTPS" + junk, b"RTPS\2\1\1\x10" + junk, b"RTPS\2\5" + bytes(14) + junk):
                    sender.sendto(datagram, ("127.0.0.1", port))


def main() -> None:
    number = int(sys.argv[1])
    domain = Domain(number, read_settings(domain_id=number).configurations[0])
    participant = DomainParticipant(number)
    header = {"client_guid": types.uint64, "sequence_number": types.int64}
    string = as_bytes(make_type("std_msgs.msg.dds_.String_", {"data": str}))
    request = as_bytes(make_type("std_srvs.srv.dds_.SetBool_Request_", {**header, "data": bool}))
    prefix = "rmw_dds_common.msg.dds_."
    gid = make_type(prefix + "Gid_", {"data": types.array[types.uint8, 24]})
    names = {"node_namespace": types.bounded_str[256], "node_name": types.bounded_str[256]}
    gids = {"reader_gid_seq": types.sequence[gid], "writer_gid_seq": types.sequence[gid]}
    node = make_type(prefix + "NodeEntitiesInfo_", {**names, **gids})
    members = {"gid": gid, "node_entities_info_seq": types.sequence[node]}
    info = as_bytes(make_type(prefix + "ParticipantEntitiesInfo_", members))
    lottery = random.Random(7)
    writers = {
        "rt/words": make_writer(participant, "rt/words", string, RELIABLE),
        "rq/flipRequest": make_writer(participant, "rq/flipRequest", request, RELIABLE),
        "ros_discovery_info": make_writer(participant, "ros_discovery_info", info, TRANSIENT_LOCAL),
    }
    limit = time.monotonic() + 60
    while time.monotonic() < limit and not all(writer.get_matched_subscriptions() for writer in writers.values()):
        time.sleep(0.02)
    print("matched", *(name for name, writer in writers.items() if writer.get_matched_subscriptions()), flush=True)
    send_datagrams(lottery, 7400 + 250 * number + 10)
    for name, data_writer in writers.items():
        written = 0
        for body in make_random_bodies(lottery) + make_announcements(participant.guid.bytes):
            with suppress(DDSException):  # Cyclone rejects some by itself
                data_writer.write(data_writer.data_type(body))
                written += 1
        print("written", name, written, flush=True)
    time.sleep(0.5)
    writers["rt/words"].write(string(HEADER + read_text("fine")))
    print("last", flush=True)
    while not Path("leave").exists():  # gives receivers the time to read the last message
        time.sleep(0.01)
    print("done", flush=True)
    del domain


if __name__ == "__main__":
    main()
