"""A process that behaves on the wire like Fast DDS, with a service and a client.

``python -m tests.wire.fast_peer``. It serves ``/fast_echo`` and calls ``/linkwright_echo``; both return the text of the
request. Each reply of ``/fast_echo`` comes after a reply to another client.
"""

from __future__ import annotations

import os
import socket
import threading
from typing import Any

from linkwright.messages import deserialize, get_service, serialize
from linkwright.wire.dds.local_sockets import compute_multicast_port
from linkwright.wire.dds.names import Role, to_dds_topic
from linkwright.wire.dds.rtps import values

# This is the other side: it announces itself as Fast DDS does, and talks only to Linkwright.
values.OWN_VENDOR, values.FAST_DDS_VENDOR = values.FAST_DDS_VENDOR, values.OWN_VENDOR

from linkwright.wire.dds.rtps.messages import Data  # noqa: E402 - the constants must be swapped first
from linkwright.wire.dds.rtps.network import Network  # noqa: E402 - see above
from linkwright.wire.dds.rtps.participant import RtpsParticipant  # noqa: E402 - see above
from linkwright.wire.dds.settings import read_settings  # noqa: E402 - see above
from tests.wire.programs import serve  # noqa: E402 - see above

SetCameraInfo = get_service("sensor_msgs/srv/SetCameraInfo")
TYPES = ("sensor_msgs::srv::dds_::SetCameraInfo_Request_", "sensor_msgs::srv::dds_::SetCameraInfo_Response_")


class KnownPort(socket.socket):
    """A socket on the port of the specification's discovery.

    Fast DDS listens there, and Linkwright does not.
    """

    def bind(self, address: Any) -> None:
        super().bind((address[0], compute_multicast_port(read_settings().domain_id) + 10 + 2 * 60))


class FastPeer:
    def __init__(self) -> None:
        Network.SOCKET = KnownPort
        self.participant = RtpsParticipant(read_settings(), "fast", lambda: None)
        self.reply_received = threading.Event()
        self.answers: dict[int, str] = {}
        add_reader, add_writer = self.participant.add_reader, self.participant.add_writer
        self.requests = add_reader(to_dds_topic(Role.REQUEST, "/fast_echo"), TYPES[0], b"", self._on_request)
        self.replies = add_writer(to_dds_topic(Role.REPLY, "/fast_echo"), TYPES[1], b"")
        self.client_requests = add_writer(to_dds_topic(Role.REQUEST, "/linkwright_echo"), TYPES[0], b"")
        self.client_replies = add_reader(to_dds_topic(Role.REPLY, "/linkwright_echo"), TYPES[1], b"", self._on_reply)
        self.participant.expect({b"whoever there is"})

    def is_matched(self) -> bool:
        return bool(
            self.participant.find_matched_readers(self.client_requests)
            and self.participant.find_matched_writers(self.client_replies)
        )

    def call(self, text: str) -> str:
        """Call ``/linkwright_echo``, and return its answer."""
        request = SetCameraInfo.Request()
        request.camera_info.distortion_model = text
        identity = values.encode_related_identity(self.client_replies.reader.guid, values.NO_NUMBER)
        self.reply_received.clear()
        number = self.participant.write(self.client_requests, serialize(request), inline=identity)
        assert self.reply_received.wait(60)
        return self.answers[number]

    def _on_request(self, sample: Data) -> None:
        text = deserialize(sample.payload, SetCameraInfo.Request).camera_info.distortion_model
        client, _ = values.read_related_identity(sample.inline, sample.order)
        for guid, answer in ((os.urandom(16), "for another client"), (client, text)):
            reply = serialize(SetCameraInfo.Response(success=True, status_message=answer))
            self.participant.write(
                self.replies, reply, inline=values.encode_related_identity(guid, sample.sequence_number)
            )

    def _on_reply(self, sample: Data) -> None:
        guid, number = values.read_related_identity(sample.inline, sample.order)
        assert guid == self.client_replies.reader.guid
        self.answers[number] = deserialize(sample.payload, SetCameraInfo.Response).status_message
        self.reply_received.set()


if __name__ == "__main__":
    peer = FastPeer()
    serve({"is_matched": peer.is_matched, "call": peer.call})
    peer.participant.close()
