from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.viewer.web.access import Gate, security_headers


@pytest.fixture
def gate():
    return Gate("127.0.0.1", 7447)


def refusal(gate, *, host="127.0.0.1:7447", origin=None, token=None, cookie=None):
    headers = {"Host": host} | ({"Origin": origin} if origin is not None else {})
    cookies = {gate.cookie: cookie} if cookie is not None else {}
    found = gate.refusal(headers, cookies, {"token": token} if token is not None else {})
    return found and found[0]


def test_the_token_opens_in_the_address_and_as_a_cookie(gate):
    assert refusal(gate, token=gate.token) is None
    assert refusal(gate, cookie=gate.cookie_value) is None
    https = {gate.cookie_name(https=True): gate.cookie_value}
    assert gate.refusal({"Host": "127.0.0.1:7447"}, https, {}) is None


def test_the_token_and_the_value_of_the_cookie_do_not_tell_each_other(gate):
    assert refusal(gate, token=gate.cookie_value) == 401
    assert refusal(gate, cookie=gate.token) == 401


@pytest.mark.parametrize("wrong", [None, "", "x", "\udcff", "é" * 32])
def test_nothing_else_does(gate, wrong):
    assert refusal(gate, token=wrong) == 401
    assert refusal(gate, cookie=wrong) == 401
    assert refusal(gate, token=gate.token[:-1]) == 401


def test_two_servers_have_two_tokens_and_cookies(gate):
    other = Gate("127.0.0.1", 7448)
    assert gate.token != other.token
    assert gate.cookie != other.cookie


@pytest.mark.parametrize(
    "host", ["127.0.0.1", "127.0.0.1:80", "localhost:9000", "LOCALHOST", "[::1]:7447", "192.168.1.5:7447", "localhost."]
)
def test_names_of_this_machine_are_known(gate, host):
    assert refusal(gate, host=host, token=gate.token) is None


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
def test_other_names_are_refused_even_with_the_token(gate, host):
    assert refusal(gate, host=host, token=gate.token) == 403


def test_the_host_it_is_bound_to_is_known():
    gate = Gate("robot.lan", 80)
    assert refusal(gate, host="robot.lan", token=gate.token) is None


@pytest.mark.parametrize(
    ("origin", "status"),
    [
        (None, None),
        ("http://127.0.0.1:7447", None),
        ("https://127.0.0.1:7447", None),
        ("http://127.0.0.1:7448", 403),
        ("http://localhost:7447", 403),
        ("http://evil.example", 403),
        ("null", 403),
        ("", 403),
        ("file://", 403),
        ("http://[", 403),
    ],
)
def test_only_pages_of_this_origin_may_ask(gate, origin, status):
    assert refusal(gate, origin=origin, token=gate.token) == status


@given(st.text(), st.text())
def test_no_header_is_too_strange(host, origin):
    gate = Gate("127.0.0.1", 1)
    assert gate.refusal({"Host": host, "Origin": origin}, {}, {})[0] in (401, 403)


def test_scripts_come_from_files_of_the_server_only():
    policy = dict(part.split(" ", 1) for part in security_headers("127.0.0.1:1")["Content-Security-Policy"].split("; "))
    assert policy["script-src"] == "'self' 'unsafe-eval'"
    assert policy["default-src"] == "'none'"
    assert "ws://127.0.0.1:1" in policy["connect-src"]
