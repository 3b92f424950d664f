"""A process that behaves on the wire like real ROS 2 with rmw_cyclonedds_cpp.

It needs only `cyclonedds`.

``python -m tests.wire.ros_peer humble|jazzy NODE_NAME``. It has a publisher on ``/from_ros``, a subscription to
``/to_ros``, a server of ``/ros_flip``, and a client of ``/linkwright_flip``; it writes CDR by hand.
"""

from __future__ import annotations

import os
import struct
import sys
from typing import Any

from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication, BuiltinTopicDcpsSubscription
from cyclonedds.core import DDSException, Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct, make_idl_struct, types
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from tests.wire.programs import serve

CONFIGURATIONS = {
    "humble": "",
    "jazzy": (
        "<CycloneDDS><Domain><Discovery><ParticipantIndex>auto</ParticipantIndex>"
        "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex></Discovery></Domain></CycloneDDS>"
    ),
    "jazzy localhost": (
        "<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast></General><Discovery>"
        "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
        '<Peers><Peer address="localhost"/></Peers></Discovery></Domain></CycloneDDS>'
    ),
    "localhost": (
        '<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>'
        "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
        '<MaxAutoParticipantIndex>99</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>'
        "</Domain></CycloneDDS>"
    ),
}
HASHES = {"std_msgs/msg/String": "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"}
DISCOVERY_HASH = "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"


def make_type(type_name: str, members: dict[str, Any]) -> type[IdlStruct]:
    """Return the type with these members."""
    return make_idl_struct(type_name.rpartition(".")[2], type_name, members, dataclassify=False)


def as_bytes(base: type[IdlStruct]) -> type[IdlStruct]:
    """Return a type whose samples are CDR bytes."""

    class Raw(base):  # type: ignore[misc,valid-type]
        def __init__(self, data: bytes = b"") -> None:
            self.cdr = data

        def serialize(self, buffer: Any = None, endianness: Any = None, use_version_2: Any = None) -> bytes:
            return self.cdr

        @classmethod
        def deserialize(cls, data: bytes, has_header: bool = True, use_version_2: Any = None) -> Any:
            return cls(bytes(data))

    Raw.__idl__ = base.__idl__
    Raw.__idl_typename__ = base.__idl_typename__
    return Raw


def read_text(value: str) -> bytes:
    encoded = value.encode() + b"\0"
    return struct.pack("<I", len(encoded)) + encoded + bytes(-len(encoded) % 4)


class RosPeer:
    def __init__(self, distribution: str, name: str, network: str) -> None:
        self.old = distribution == "humble"
        self.gid_size = 24 if self.old else 16
        number = int(os.environ["ROS_DOMAIN_ID"])
        self.domain = Domain(number, CONFIGURATIONS[network])
        self.participant = DomainParticipant(number, Qos(Policy.Userdata(b"enclave=/;")))
        self.name = name
        string = as_bytes(make_type("std_msgs.msg.dds_.String_", {"data": str}))
        header = {"client_guid": types.uint64, "sequence_number": types.int64}
        request = as_bytes(make_type("std_srvs.srv.dds_.SetBool_Request_", {**header, "data": bool}))
        response = as_bytes(
            make_type("std_srvs.srv.dds_.SetBool_Response_", {**header, "success": bool, "message": str})
        )
        info = self._discovery_type()
        facts = "" if self.old else f"typehash={HASHES['std_msgs/msg/String']};"
        self.info_writer = self._writer(
            "ros_discovery_info", info, "" if self.old else f"typehash={DISCOVERY_HASH};", latched=True
        )
        self.info_reader = self._reader("ros_discovery_info", info, "", latched=True)
        self.publisher = self._writer("rt/from_ros", string, facts)
        self.subscription = self._reader("rt/to_ros", string, facts)
        self.requests = self._reader("rq/ros_flipRequest", request, "serviceid=1.2.3;")
        self.replies = self._writer("rr/ros_flipReply", response, "serviceid=1.2.3;")
        self.client_requests = self._writer("rq/linkwright_flipRequest", request, "clientid=4.5.6;")
        self.client_replies = self._reader("rr/linkwright_flipReply", response, "clientid=4.5.6;")
        self.publications = BuiltinDataReader(self.participant, BuiltinTopicDcpsPublication)
        self.subscriptions = BuiltinDataReader(self.participant, BuiltinTopicDcpsSubscription)
        self.nodes_by_participant: dict[str, Any] = {}
        self.endpoints: dict[str, Any] = {}
        self._announce()

    def publish(self, value: str) -> None:
        self.publisher.write(self.publisher.data_type(b"\0\1\0\0" + read_text(value)))

    def publish_bytes(self, data: str) -> str:
        """Publish bytes unchanged, and return Cyclone's error, or "written"."""
        try:
            self.publisher.write(self.publisher.data_type(bytes.fromhex(data)))
        except DDSException as error:
            return str(error)
        return "written"

    def received(self) -> list[str]:
        samples = [sample for sample in self.subscription.take(100) if hasattr(sample, "cdr")]
        return [sample.cdr[8:].split(b"\0")[0].decode() for sample in samples]

    def answer_requests(self) -> int:
        """Answer the requests so far, and return their number."""
        requests = [sample for sample in self.requests.take(100) if hasattr(sample, "cdr")]
        for request in requests:
            head, value = request.cdr[4:20], request.cdr[20]
            self.replies.write(
                self.replies.data_type(b"\0\1\0\0" + head + bytes([not value, 0, 0, 0]) + read_text("by ROS"))
            )
        return len(requests)

    def call(self, value: bool, number: int) -> None:
        head = struct.pack("<Qq", 0x0123456789ABCDEF, number)
        self.client_requests.write(self.client_requests.data_type(b"\0\1\0\0" + head + bytes([value, 0, 0, 0])))

    def replies_to_calls(self) -> list[list[Any]]:
        samples = [sample for sample in self.client_replies.take(100) if hasattr(sample, "cdr")]
        return [
            [*struct.unpack_from("<Qq", sample.cdr, 4), bool(sample.cdr[20]), sample.cdr[28:].split(b"\0")[0].decode()]
            for sample in samples
        ]

    def nodes(self) -> list[Any]:
        """Return the nodes in ``ros_discovery_info``, with gids of the distribution's size."""
        for sample in self.info_reader.take(100):
            if hasattr(sample, "cdr"):
                self.nodes_by_participant[sample.cdr[4:20].hex()] = self._decode(sample.cdr[4:])
        return [node for nodes in self.nodes_by_participant.values() for node in nodes]

    def remote_endpoints(self) -> dict[str, Any]:
        """Return the remote endpoints by key.

        Each has the topic, type and USER_DATA in DDS, and whether it is a writer.
        """
        for reader, writes in ((self.publications, True), (self.subscriptions, False)):
            for sample in reader.take(500):
                if sample.sample_info.instance_state != 16:
                    self.endpoints.pop(sample.key.bytes.hex(), None)
                elif sample.participant_key != self.participant.guid:
                    data = sample.qos[Policy.Userdata].data.decode() if Policy.Userdata in sample.qos else ""
                    self.endpoints[sample.key.bytes.hex()] = [sample.topic_name, sample.type_name, data, writes]
        return self.endpoints

    def _qos(self, facts: str, latched: bool) -> Qos:
        durability = Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile
        return Qos(
            Policy.Reliability.Reliable(1_000_000_000),
            durability,
            Policy.History.KeepAll,
            Policy.DataRepresentation(use_cdrv0_representation=True),
            Policy.WriterDataLifecycle(autodispose=False),
            Policy.Userdata(facts.encode()),
        )

    def _writer(self, topic: str, make_type: Any, facts: str, *, latched: bool = False) -> Any:
        return DataWriter(self.participant, Topic(self.participant, topic, make_type), self._qos(facts, latched))

    def _reader(self, topic: str, make_type: Any, facts: str, *, latched: bool = False) -> Any:
        return DataReader(self.participant, Topic(self.participant, topic, make_type), self._qos(facts, latched))

    def _announce(self) -> None:
        def gids(*entities: Any) -> bytes:
            data = b"".join(entity.guid.bytes.ljust(self.gid_size, b"\0") for entity in entities)
            return struct.pack("<I", len(entities)) + data

        body = self.participant.guid.bytes.ljust(self.gid_size, b"\0") + struct.pack("<I", 1)
        body += read_text("/") + read_text(self.name)
        body += gids(self.subscription, self.requests, self.client_replies)
        body += gids(self.publisher, self.replies, self.client_requests)
        self.info_writer.write(self.info_writer.data_type(b"\0\1\0\0" + body))

    def _decode(self, data: bytes) -> list[Any]:
        offset = self.gid_size

        def number() -> int:
            nonlocal offset
            offset += -offset % 4
            (value,) = struct.unpack_from("<I", data, offset)
            offset += 4
            return int(value)

        def string() -> str:
            nonlocal offset
            size = number()
            offset += size
            return data[offset - size : offset - 1].decode()

        def gids() -> list[str]:
            nonlocal offset
            gid_list = []
            for _ in range(number()):
                gid_list.append(data[offset : offset + self.gid_size].hex())
                offset += self.gid_size
            return gid_list

        return [[string(), string(), gids(), gids()] for _ in range(number())]

    def _discovery_type(self) -> Any:
        prefix = "rmw_dds_common.msg.dds_."
        gid = make_type(prefix + "Gid_", {"data": types.array[types.uint8, self.gid_size]})
        node = make_type(
            prefix + "NodeEntitiesInfo_",
            {
                "node_namespace": types.bounded_str[256],
                "node_name": types.bounded_str[256],
                "reader_gid_seq": types.sequence[gid],
                "writer_gid_seq": types.sequence[gid],
            },
        )
        members = {"gid": gid, "node_entities_info_seq": types.sequence[node]}
        return as_bytes(make_type(prefix + "ParticipantEntitiesInfo_", members))


if __name__ == "__main__":
    peer = RosPeer(*sys.argv[1:4])
    serve(
        {
            "publish": peer.publish,
            "publish_bytes": peer.publish_bytes,
            "received": peer.received,
            "answer_requests": peer.answer_requests,
            "call": peer.call,
            "replies": peer.replies_to_calls,
            "nodes": peer.nodes,
            "remote_endpoints": peer.remote_endpoints,
        }
    )
