"""Sessions that wait for a router, and messages about hosts that are not reached."""

from __future__ import annotations

import os
import signal
import socket
import ssl
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from shutil import which
from typing import Any

import pytest
import zenoh

from linkwright.wire.zenoh.connection_problems import find_connection_problem, find_connection_problems
from linkwright.wire.zenoh.settings import OVERRIDES_VARIABLE
from tests.wire.zenoh.conftest import ROUTER

AT_ONCE_S = 5.0
"""A limit in seconds for a busy machine; without an immediate answer, opening takes ten and more."""


def client_config(port: int, timeout_ms: int = -1) -> str:
    return f'mode="client";connect/endpoints=["tcp/localhost:{port}"];connect/timeout_ms={timeout_ms}'


@pytest.fixture
def silent_port() -> Iterator[int]:
    """Return a port at which connections are accepted and never answered."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server.getsockname()[1]


def test_client_reports_missing_router_and_joins_when_it_starts(processes, start_router, monkeypatch, router_port):
    monkeypatch.setenv(OVERRIDES_VARIABLE, client_config(router_port))
    process = processes("ours", join_now=False)
    joining = threading.Thread(target=process.join)
    joining.start()
    process.spin_until(process.warnings)
    assert process.warnings()[0].startswith(
        f"Waiting for a Zenoh router: nothing listens at tcp/localhost:{router_port}"
    )
    start_router()
    joining.join()
    other = processes("other")
    process.spin_until(lambda: "other" in process.node.get_node_names())
    other.close()


def test_wait_for_router_ends_after_timeout(processes, monkeypatch, router_port):
    monkeypatch.setenv(OVERRIDES_VARIABLE, client_config(router_port, 1500))
    process = processes("ours", join_now=False)
    with pytest.raises(AssertionError):
        process.join()
    assert f"nothing listens at tcp/localhost:{router_port}" in process.warnings()[-1]
    assert "DDS112" in process.warnings()[-1]


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot send SIGINT to one process")
@pytest.mark.parametrize("words", [("topic", "list"), ("node", "list"), ("doctor",), ("bridge", "zenoh", "zenoh:7")])
def test_ctrl_c_ends_wait_for_router(monkeypatch, silent_port, words):
    monkeypatch.setenv(OVERRIDES_VARIABLE, client_config(silent_port))
    verb = subprocess.Popen(
        [sys.executable, "-m", "linkwright", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert verb.stderr is not None
    assert "Waiting for a Zenoh router" in verb.stderr.readline()
    begin = time.monotonic()
    verb.send_signal(signal.SIGINT)
    verb.communicate(timeout=60)
    assert time.monotonic() - begin < AT_ONCE_S
    assert verb.returncode == 130


def test_router_reports_unreachable_endpoint(router_port, silent_port):
    settings = (
        f'listen/endpoints=["tcp/localhost:{router_port}"];connect/endpoints=["tls/localhost:{silent_port}"];'
        'transport/link/tls/root_ca_certificate="nowhere.pem"'
    )
    router = subprocess.Popen(
        ROUTER,
        env={**os.environ, OVERRIDES_VARIABLE: settings},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert router.stdout is not None
    output = [router.stdout.readline() for _ in range(2)]
    router.kill()
    router.communicate()
    assert "Zenoh router at" in output[0]
    assert "Not connected yet; retrying: cannot read 'nowhere.pem': No such file" in output[1]


def test_malformed_and_unknown_addresses_are_reported():
    assert "is not an address: write it as tcp/HOST:PORT" in find_connection_problem("tcp/localhost", {})
    assert "its port must be at most 65535" in find_connection_problem("tcp/127.0.0.1:70000", {})
    assert "the host name of tcp/robot.invalid:7447 cannot be resolved" in find_connection_problem(
        "tcp/robot.invalid:7447", {}
    )
    assert not find_connection_problem("udp/127.0.0.1:9", {}), "only Zenoh checks UDP addresses"


def test_duplicate_session_id_is_reported(silent_port):
    config = zenoh.Config()
    for key, value in (("id", '"abc1"'), ("connect/endpoints", f'["tcp/127.0.0.1:{silent_port}"]')):
        config.insert_json5(key, value)
    (find_connection_problem,) = find_connection_problems(config)
    assert "the same 'id'" in find_connection_problem


class Certificates:
    """Files with certificates of an authority, and one of another authority."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._openssl("req -x509 -newkey rsa:2048 -nodes -keyout ca-key.pem -out ca.pem -days 9 -subj /CN=ca")
        self._openssl("req -x509 -newkey rsa:2048 -nodes -keyout other-key.pem -out other.pem -days 9 -subj /CN=other")
        (folder / "name.ext").write_text("subjectAltName=DNS:localhost\n")
        for name in ("cloud", "desk"):
            self._openssl(f"req -newkey rsa:2048 -nodes -keyout {name}-key.pem -out {name}.csr -subj /CN={name}")
            options = "-CA ca.pem -CAkey ca-key.pem -CAcreateserial -days 9 -extfile name.ext"
            self._openssl(f"x509 -req -in {name}.csr {options} -out {name}.pem")

    def settings(self, certificate: str = "desk", key: str = "desk", authority: str = "ca") -> dict[str, Any]:
        """Return the settings below ``transport/link/tls``."""
        return {
            "enable_mtls": True,
            "root_ca_certificate": str(self.folder / f"{authority}.pem"),
            "connect_certificate": str(self.folder / f"{certificate}.pem"),
            "connect_private_key": str(self.folder / f"{key}-key.pem"),
        }

    def serve(self) -> int:
        """Start a server that accepts only the authority's certificates.

        It serves one client at a time. Return its port.
        """
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(self.folder / "cloud.pem", self.folder / "cloud-key.pem")
        context.load_verify_locations(self.folder / "ca.pem")
        context.verify_mode = ssl.CERT_REQUIRED
        server = socket.create_server(("127.0.0.1", 0))

        def run() -> None:
            while True:
                connection = server.accept()[0]
                try:
                    with context.wrap_socket(connection, server_side=True) as tls_connection:
                        tls_connection.recv(1)
                except OSError:
                    connection.close()

        threading.Thread(target=run, daemon=True).start()
        port: int = server.getsockname()[1]
        return port

    def _openssl(self, arguments: str) -> None:
        subprocess.run(["openssl", *arguments.split()], cwd=self.folder, check=True, capture_output=True)


@pytest.fixture(scope="module")
def certificates(tmp_path_factory) -> Certificates:
    if which("openssl") is None:
        pytest.skip("the program 'openssl' is not installed")
    return Certificates(tmp_path_factory.mktemp("certificates"))


@pytest.fixture
def find_obstacle(certificates) -> Callable[..., str]:
    port = certificates.serve()

    def ask(host: str = "localhost", **names: str) -> str:
        return find_connection_problem(f"tls/{host}:{port}", certificates.settings(**names))

    return ask


def test_invalid_certificates_are_reported(find_obstacle):
    assert not find_obstacle()
    assert "the certificate of tls/localhost" in find_obstacle(authority="other")
    assert "is not accepted: " in find_obstacle(authority="other")
    assert "not valid for '127.0.0.1'" in find_obstacle("127.0.0.1")
    assert "other.pem': " in find_obstacle(certificate="other", key="other")
    assert "refuses the certificate" in find_obstacle(certificate="other", key="other")
    assert "are not a certificate and its key in PEM" in find_obstacle(key="other")
    missing = find_obstacle(key="missing")
    assert missing.startswith("cannot read '")
    assert "missing-key.pem': No such file" in missing


def test_tls_and_tcp_mismatch_is_reported(certificates, silent_port):
    assert "does not speak TLS: write tcp/" in find_connection_problem(
        f"tls/localhost:{silent_port}", certificates.settings()
    )
    with socket.create_server(("127.0.0.1", 0)) as server:

        def refuse() -> None:
            with server.accept()[0] as called:
                called.sendall(b"\x15\3\3\0\2\2\x46")  # an alert, as Zenoh answers connections without TLS
                called.recv(16)

        threading.Thread(target=refuse, daemon=True).start()
        assert "speaks TLS: write tls/" in find_connection_problem(f"tcp/127.0.0.1:{server.getsockname()[1]}", {})
