"""The address and the port of the page's server."""

from __future__ import annotations

import socket

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.page import page_server
from linkwright.page.page_server import listen
from linkwright.page.server import make_url


@pytest.fixture
def occupied_port():
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        yield other.getsockname()[1]


def test_port_in_use_is_reported_with_hint(occupied_port):
    with pytest.raises(LinkwrightError) as caught:
        listen("127.0.0.1", occupied_port)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "VIEW101"
    assert str(occupied_port) in diagnostic.message
    assert "--port" in diagnostic.hint


def test_next_free_port_is_used_by_default(occupied_port, monkeypatch):
    monkeypatch.setattr(page_server, "DEFAULT_PORT", occupied_port)
    with listen("127.0.0.1", None) as listener:
        assert listener.getsockname()[1] > occupied_port


def test_servers_do_not_share_a_port():
    with listen("127.0.0.1", 0) as first, pytest.raises(LinkwrightError):
        listen("127.0.0.1", first.getsockname()[1])


@pytest.mark.parametrize(
    ("host", "port", "code"), [("no.such.host.invalid", 0, "VIEW103"), ("127.0.0.1", 99999, "VIEW102")]
)
def test_invalid_host_or_port_is_rejected(host, port, code):
    with pytest.raises(LinkwrightError) as caught:
        listen(host, port)
    assert caught.value.diagnostics[0].code == code


def test_address_of_another_machine_is_rejected():
    with pytest.raises(LinkwrightError) as caught:
        listen("203.0.113.7", 0)
    assert caught.value.diagnostics[0].code == "VIEW102"


def test_url_of_wildcard_address_is_loopback():
    with listen("0.0.0.0", 0) as listener:
        assert make_url(listener) == f"http://127.0.0.1:{listener.getsockname()[1]}/"


@pytest.mark.skipif(not socket.has_ipv6, reason="this machine has no IPv6")
def test_ipv6_url_has_brackets():
    try:
        listener = listen("::1", 0)
    except LinkwrightError:
        pytest.skip("IPv6 is disabled on this machine")
    with listener:
        assert make_url(listener).startswith("http://[::1]:")
