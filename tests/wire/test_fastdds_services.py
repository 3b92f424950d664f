"""Services with Fast DDS, imitated by a process that sends the same packets.

`test_real_services` has the real one.
"""

from __future__ import annotations

import threading
from dataclasses import replace
from types import SimpleNamespace

import pytest

from linkwright.messages import get_service, serialize
from linkwright.wire.dds.fastdds_services import EarlyRequest, FastClient, FastServer
from linkwright.wire.dds.rtps.messages import Data
from linkwright.wire.dds.rtps.values import encode_related_identity, read_parameters
from tests.wire.test_failures import FailsOnce, warnings_of

SetCameraInfo = get_service("sensor_msgs/srv/SetCameraInfo")
LARGE_TEXT = "x" * 300_000
CLIENT = SimpleNamespace(
    name="/echo", srv_type=SetCameraInfo, type_name="sensor_msgs/srv/SetCameraInfo", type_hash="", raw=False
)
ANSWER = serialize(SetCameraInfo.Response(success=True, status_message="hej"))


def echo(request, response):
    response.success, response.status_message = True, request.camera_info.distortion_model
    return response


def camera_request(text):
    request = SetCameraInfo.Request()
    request.camera_info.distortion_model = text
    return request


@pytest.mark.parametrize("text", ["hej", LARGE_TEXT])
def test_client_takes_response_with_its_identity(processes, programs, text):
    process = processes("ours")
    client = process.node.create_client(SetCameraInfo, "/fast_echo")
    peer = programs("fast_peer")
    process.spin_until(client.service_is_ready)
    future = client.call_async(camera_request(text))
    process.spin_until(future.done)
    assert future.result().status_message == text
    assert not process.warnings()
    peer.end()
    process.spin_until(lambda: not client.service_is_ready(), 5.0)  # the lease is 10 s


@pytest.mark.parametrize("text", ["hej", LARGE_TEXT])
def test_service_responds_with_identity_of_request(processes, programs, text):
    process = processes("ours")
    process.node.create_service(SetCameraInfo, "/linkwright_echo", echo)
    peer = programs("fast_peer")
    process.spin_until(lambda: peer.ask("is_matched"))
    responses = []
    thread = threading.Thread(target=lambda: responses.append(peer.ask("call", text)))
    thread.start()
    process.spin_until(lambda: responses)
    thread.join()
    assert responses == [text]
    assert not process.warnings()


def test_no_rtps_participant_is_created_with_cyclone_peers_only(processes):
    a, b = processes("a"), processes("b")
    a.node.create_service(SetCameraInfo, "/linkwright_echo", echo)
    client = b.node.create_client(SetCameraInfo, "/linkwright_echo")
    assert client.wait_for_service(60)
    assert not [thread.name for thread in threading.enumerate() if thread.name == "linkwright-rtps"]


def test_missing_socket_is_reported_once_and_other_services_work(processes, programs, monkeypatch):
    def refuse(*_):
        raise OSError("no sockets today")

    monkeypatch.setattr("linkwright.wire.dds.rtps.participant.Network", refuse)
    process = processes("ours")
    process.node.create_service(SetCameraInfo, "/linkwright_echo", echo)
    programs("fast_peer")
    process.spin_until(process.warnings)
    assert process.warnings() == ["Services and clients of nodes on Fast DDS are out of reach: no sockets today"]


class _Participant:
    """A participant that knows one client's writer."""

    def __init__(self, discovered_at, last_number):
        self.discovered_at, self.last = discovered_at, last_number

    def add_writer(self, *_):
        return "writer"

    def add_reader(self, _topic, _type_name, _facts, on_data):
        self.deliver = on_data
        return "reader"

    def find_matched_writers(self, _):
        return {b"w" * 16: self.discovered_at}

    def get_last_number(self, *_):
        return self.last


class _Service:
    name = "/linkwright_echo"
    srv_type = SetCameraInfo
    type_name, type_hash, raw = SetCameraInfo.TYPE_NAME, "", False
    destroyed = False

    def __init__(self):
        self.requests = []

    def receive(self, request, _reply, request_id):
        self.requests.append((request.camera_info.distortion_model, request_id.sequence_number))


def test_early_requests_get_numbers_before_first_received(monkeypatch):
    now = 100.0
    monkeypatch.setattr("linkwright.wire.dds.fastdds_services.time.monotonic", lambda: now)
    service, participant = _Service(), _Participant(discovered_at=None, last_number=7)
    server = FastServer(service, participant)
    for number, text in enumerate(["six", "seven"]):
        server.on_early_request(EarlyRequest(b"w" * 16, serialize(camera_request(text)), 1_000_000 * number, now))
    server.write_pending_replies()
    assert service.requests == []
    participant.discovered_at = now
    server.write_pending_replies()
    assert server.has_pending_work
    now += 0.2
    server.write_pending_replies()
    assert service.requests == [("six", 6), ("seven", 7)]
    assert not server.has_pending_work
    server.on_early_request(EarlyRequest(b"w" * 16, serialize(camera_request("eight")), 9_000_000, now))
    assert not server.has_pending_work  # requests are numbered from now on


def test_early_request_repeated_with_number_is_executed_once(monkeypatch):
    now = 100.0
    monkeypatch.setattr("linkwright.wire.dds.fastdds_services.time.monotonic", lambda: now)
    service, participant = _Service(), _Participant(discovered_at=now, last_number=1)
    server = FastServer(service, participant)
    server.on_early_request(EarlyRequest(b"w" * 16, serialize(camera_request("first")), 5_000_000, now))
    now += 0.2
    server.write_pending_replies()
    for number, text in enumerate(["first", "second"], 1):
        request = serialize(camera_request(text))
        participant.deliver(Data(b"w" * 12, b"r" * 4, b"w" * 16, number, "<", {}, request, 5_000_000 * number + 1))
    assert service.requests == [("first", 1), ("second", 2)]


def test_replies_to_others_during_client_creation_are_ignored():
    """A server may know the new reader before the client has it."""
    inline, _ = read_parameters(encode_related_identity(b"o" * 16, 1), 0, "<")
    reply = Data(b"s" * 12, b"r" * 4, b"s" * 16, 1, "<", inline, b"")

    class EarlyReplyParticipant:
        def add_reader(self, _topic, _type_name, _facts, on_data):
            on_data(reply)
            return SimpleNamespace(reader=SimpleNamespace(guid=b"r" * 16))

        def add_writer(self, *_):
            return SimpleNamespace(writer=SimpleNamespace(guid=b"w" * 16))

        def write(self, *_, **__):
            return 1

    client = FastClient(CLIENT, EarlyReplyParticipant(), lambda _: False)
    responses = []
    client.send(camera_request("hej"), responses.append)
    client._on_data(
        replace(reply, inline=read_parameters(encode_related_identity(b"r" * 16, 1), 0, "<")[0], payload=ANSWER)
    )
    assert [response.status_message for response in responses] == ["hej"]


def test_error_in_participant_thread_is_reported_and_next_call_answered(processes, programs, monkeypatch):
    process = processes("ours")
    client = process.node.create_client(SetCameraInfo, "/fast_echo")
    peer = programs("fast_peer")
    process.spin_until(client.service_is_ready)
    client.announce = FailsOnce(client.announce)
    futures = [client.call_async(camera_request(text)) for text in ("one", "two")]
    process.spin_until(lambda: all(call.done() for call in futures))
    assert warnings_of(process, "client of service '/fast_echo' failed:")
    errors = []
    monkeypatch.setattr(threading, "excepthook", lambda hook: errors.append((hook.thread.name, str(hook.exc_value))))
    participant = process.transport._engine._fast
    participant.changed = FailsOnce(participant.changed)
    peer.end()
    process.spin_until(lambda: errors)
    assert errors == [("linkwright-rtps", "the user's own mistake")]
    programs("fast_peer")
    process.spin_until(lambda: participant.changed.calls > 2)
    process.spin_until(client.service_is_ready)
    call = client.call_async(camera_request("again"))
    process.spin_until(call.done)
    assert call.result().status_message == "again"
