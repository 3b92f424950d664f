"""Services between processes over Zenoh."""

from __future__ import annotations

import threading

import zenoh

from linkwright.graph.endpoints.base import EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.messages import get_service, type_hash
from linkwright.wire.zenoh import attachment
from linkwright.wire.zenoh.services import IncomingService
from linkwright.wire.zenoh.session import build_config, open_session
from linkwright.wire.zenoh.settings import read_settings
from linkwright.wire.zenoh.tokens import Token
from tests.wire.test_services import flip

AddTwoInts = get_service("example_interfaces/srv/AddTwoInts")
SetBool = get_service("std_srvs/srv/SetBool")
CALL_COUNT = 1000
MAX_PENDING_CALLS = 3
"""The simultaneous requests of each client; their total is below the queue size of a service."""


def test_thousand_calls_of_three_clients_get_their_own_responses(processes):
    server, clients = processes("server"), [processes(f"client_{number}") for number in range(3)]

    def add(request, response):
        response.sum = request.a + request.b
        return response

    server.node.create_service(AddTwoInts, "add", add)
    stop = threading.Event()

    def serve():
        while not stop.is_set():
            server.executor.spin_once(timeout_sec=0.02)

    thread = threading.Thread(target=serve)
    thread.start()
    callers = [process.node.create_client(AddTwoInts, "add") for process in clients]
    assert all(caller.wait_for_service(60) for caller in callers)
    wrong_responses = []

    def call(process, caller, offset):
        for first in range(0, CALL_COUNT, MAX_PENDING_CALLS):
            numbers = range(first, min(first + MAX_PENDING_CALLS, CALL_COUNT))
            futures = [caller.call_async(AddTwoInts.Request(a=offset, b=number)) for number in numbers]
            process.spin_until(lambda futures=futures: all(future.done() for future in futures))
            sums = [future.result().sum for future in futures]
            if sums != [offset + number for number in numbers]:
                wrong_responses.append((offset, sums))

    threads = [
        threading.Thread(target=call, args=(process, caller, 10_000 * number))
        for number, (process, caller) in enumerate(zip(clients, callers, strict=True), 1)
    ]
    try:
        for caller_thread in threads:
            caller_thread.start()
        for caller_thread in threads:
            caller_thread.join(300)
            assert not caller_thread.is_alive()
    finally:
        stop.set()
        thread.join()
    assert wrong_responses == []


def test_failed_request_is_reported_once(processes):
    a, b = processes("a"), processes("b")
    service = b.node.create_service(SetBool, "flip", flip)
    client = a.node.create_client(SetBool, "flip")
    assert client.wait_for_service(60)
    future = client.call_async(SetBool.Request())
    b.node.destroy_service(service)
    a.spin_until(a.warnings)
    (text,) = a.warnings()
    assert "A request to service '/flip' was not answered" in text
    assert not future.done()
    a.spin_until(lambda: not client.service_is_ready())  # Zenoh reports the departure separately


class LateQuery:
    """A request that Zenoh delivers after the service was closed.

    It has the attributes that are read.
    """

    payload = zenoh.ZBytes(b"\0\1\0\0\1")
    attachment = zenoh.ZBytes(attachment.write(1, 2, bytes(16)))
    dropped = False

    def drop(self):
        self.dropped = True


class DeclaredSession:
    """A session that keeps the handler of its requests."""

    def declare_queryable(self, key, handler, **options):
        self.on_request = handler.callback
        return self

    def undeclare(self):
        pass


def test_request_in_transit_ends_when_service_closes(processes):
    """A request in transit ends when its service closes.

    Undeclaring a service does not wait for such a request, and its client waited for ten minutes.
    """
    node = processes("ours", join_now=False).node
    service = node.create_service(SetBool, "flip", flip)
    names = (EndpointKind.SERVICE, "/flip", "std_srvs::srv::dds_::SetBool_", "RIHS01_00")
    session, query = DeclaredSession(), LateQuery()
    incoming = IncomingService(service, Token(0, "0", "0", "1", NodeIdentity("ours", "/"), *names), session)
    incoming.close()
    session.on_request(query)
    assert query.dropped


def test_request_without_attachment_is_rejected(processes):
    process = processes("ours")
    requests = []
    process.node.create_service(SetBool, "flip", lambda request, response: requests.append(request) or response)
    with open_session(build_config(read_settings())) as session:
        key = f"{read_settings().domain_id}/flip/std_srvs::srv::dds_::SetBool_/{type_hash(SetBool)}"
        querier = session.declare_querier(key)
        process.spin_until(lambda: querier.matching_status.matching)
        body = b"\0\1\0\0\1"
        assert list(querier.get(payload=body)) == []
        assert list(querier.get(payload=body, attachment=b"nonsense")) == []
        assert list(querier.get(attachment=attachment.write(1, 2, bytes(16)))) == []
        assert not requests
