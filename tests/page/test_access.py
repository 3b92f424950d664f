"""Who may connect to the page's server: tokens, hosts and origins."""

from __future__ import annotations

import hmac

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.page.access import Gate, create_token, make_security_headers


@pytest.fixture
def gate():
    return Gate("127.0.0.1", create_token())


def is_admitted(gate, *, host="127.0.0.1:7447", origin=None):
    return gate.find_refusal_reason({"Host": host} | ({"Origin": origin} if origin is not None else {})) is None


def test_token_in_query_is_accepted(gate):
    assert gate.has_token({"token": gate.token})


@pytest.mark.parametrize("token", ["", "x", "\udcff", "é" * 32])
def test_wrong_or_missing_token_is_rejected(gate, token):
    assert not gate.has_token({"token": token})
    assert not gate.has_token({"token": gate.token[:-1]})
    assert not gate.has_token({})
    assert not gate.has_token({"other": gate.token})


def test_servers_have_different_tokens(gate):
    other = Gate("127.0.0.1", create_token())
    assert gate.token != other.token


@pytest.mark.parametrize(
    "host", ["127.0.0.1", "127.0.0.1:80", "localhost:9000", "LOCALHOST", "[::1]:7447", "192.168.1.5:7447", "localhost."]
)
def test_host_names_of_this_machine_are_accepted(gate, host):
    assert is_admitted(gate, host=host)


@pytest.mark.parametrize(
    "host",
    [
        "",
        "evil.example",
        "evil.example:7447",
        "127.0.0.1.evil.example",
        "localhost.evil.example",
        "user@127.0.0.1",
        "127.0.0.1/..",
        "127.0.0.1;x",
        "127.0.0.1 ",
        "127.0.0.1:80;script-src *",
        "[::1",
    ],
)
def test_other_host_names_are_rejected(gate, host):
    assert not is_admitted(gate, host=host)


def test_bound_host_name_is_accepted():
    assert is_admitted(Gate("robot.lan", create_token()), host="robot.lan")


@pytest.mark.parametrize(
    ("origin", "may"),
    [
        (None, True),
        ("http://127.0.0.1:7447", True),
        ("https://127.0.0.1:7447", True),
        ("http://127.0.0.1:7448", False),
        ("http://localhost:7447", False),
        ("http://evil.example", False),
        ("null", False),
        ("", False),
        ("file://", False),
        ("http://[", False),
    ],
)
def test_only_pages_of_same_origin_are_accepted(gate, origin, may):
    assert is_admitted(gate, origin=origin) == may


@given(st.text(), st.text())
def test_malformed_headers_are_rejected(host, origin):
    assert Gate("127.0.0.1", create_token()).find_refusal_reason({"Host": host, "Origin": origin})


def test_security_policy_allows_scripts_of_server_only():
    policy = dict(
        part.split(" ", 1) for part in make_security_headers("127.0.0.1:1")["Content-Security-Policy"].split("; ")
    )
    assert policy["script-src"] == "'self' 'unsafe-eval'"
    assert policy["default-src"] == "'none'"
    assert "ws://127.0.0.1:1" in policy["connect-src"]


def test_proof_is_hmac_of_nonce_and_token(gate):
    nonce = "0123456789abcdef" * 2
    assert gate.proof(nonce) == hmac.new(gate.token.encode(), nonce.encode(), "sha256").hexdigest()
    assert gate.proof(nonce) != Gate("127.0.0.1", create_token()).proof(nonce)


@pytest.mark.parametrize("nonce", ["", "0" * 31, "0" * 33, "x" * 32, "0" * 31 + "\n", "é" * 32])
def test_malformed_nonce_has_no_proof(gate, nonce):
    assert gate.proof(nonce) is None
