"""A process that is on the wire what one of Fast DDS is, with a service and a client of our own making.

``python -m tests.wire.fast_peer``. It answers ``/fast_echo``, first to somebody else, and asks ``/our_echo``; both say
again what they are told.
"""

from __future__ import annotations

import os
import socket
import threading
from typing import Any

from linkwright.messages import deserialize, get_service, serialize
from linkwright.wire.dds.local_sockets import multicast_port
from linkwright.wire.dds.names import Role, dds_topic
from linkwright.wire.dds.rtps import values

# It is the other side: what it says of itself is what Fast DDS says, and it speaks with us alone.
values.VENDOR, values.FAST_DDS = values.FAST_DDS, values.VENDOR

from linkwright.wire.dds.rtps.messages import Data  # noqa: E402 - after the two have changed places
from linkwright.wire.dds.rtps.network import Network  # noqa: E402 - see above
from linkwright.wire.dds.rtps.participant import RtpsParticipant  # noqa: E402 - see above
from linkwright.wire.dds.settings import read_settings  # noqa: E402 - see above
from tests.wire.programs import serve  # noqa: E402 - see above

SetCameraInfo = get_service("sensor_msgs/srv/SetCameraInfo")
TYPES = ("sensor_msgs::srv::dds_::SetCameraInfo_Request_", "sensor_msgs::srv::dds_::SetCameraInfo_Response_")


class KnownPort(socket.socket):
    """Listens where discovery listens by the specification, as Fast DDS does and we do not."""

    def bind(self, address: Any) -> None:
        super().bind((address[0], multicast_port(read_settings().domain_id) + 10 + 2 * 60))


class FastPeer:
    def __init__(self) -> None:
        Network.SOCKET = KnownPort
        self.participant = RtpsParticipant(read_settings(), "fast", lambda: None)
        self.came = threading.Event()
        self.answers: dict[int, str] = {}
        add_reader, add_writer = self.participant.add_reader, self.participant.add_writer
        self.requests = add_reader(dds_topic(Role.REQUEST, "/fast_echo"), TYPES[0], b"", self._asked)
        self.replies = add_writer(dds_topic(Role.REPLY, "/fast_echo"), TYPES[1], b"")
        self.asking = add_writer(dds_topic(Role.REQUEST, "/our_echo"), TYPES[0], b"")
        self.answered = add_reader(dds_topic(Role.REPLY, "/our_echo"), TYPES[1], b"", self._answer)
        self.participant.expect({b"whoever there is"})

    def is_matched(self) -> bool:
        return bool(self.participant.matched_readers(self.asking) and self.participant.matched_writers(self.answered))

    def ask(self, text: str) -> str:
        """What our service answers."""
        request = SetCameraInfo.Request()
        request.camera_info.distortion_model = text
        identity = values.related_identity(self.answered.reader.guid, values.NO_NUMBER)
        self.came.clear()
        number = self.participant.write(self.asking, serialize(request), inline=identity)
        assert self.came.wait(60)
        return self.answers[number]

    def _asked(self, sample: Data) -> None:
        text = deserialize(sample.payload, SetCameraInfo.Request).camera_info.distortion_model
        client, _ = values.read_related_identity(sample.inline, sample.order)
        for guid, answer in ((os.urandom(16), "for somebody else"), (client, text)):
            reply = serialize(SetCameraInfo.Response(success=True, status_message=answer))
            self.participant.write(self.replies, reply, inline=values.related_identity(guid, sample.number))

    def _answer(self, sample: Data) -> None:
        guid, number = values.read_related_identity(sample.inline, sample.order)
        assert guid == self.answered.reader.guid
        self.answers[number] = deserialize(sample.payload, SetCameraInfo.Response).status_message
        self.came.set()


if __name__ == "__main__":
    peer = FastPeer()
    serve({"is_matched": peer.is_matched, "ask": peer.ask})
    peer.participant.close()
