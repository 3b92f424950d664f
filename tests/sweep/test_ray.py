"""Sweeps on a Ray cluster."""

import os
import socket
import subprocess
import sys
from types import SimpleNamespace

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.sweep.ray_workers import run_on_ray
from tests.sweep.scenarios import HEAD, ignore, write_scenario

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="Ray is tested on Linux only")

LOSING = f"""import os, signal
from pathlib import Path
import beside
{HEAD}
@scenario(n=[1, 2, 3, 4])
def work(n, seed):
    lost = Path(os.environ["LOST"])
    if n == 2 and not lost.exists():
        lost.write_text(str(os.getpid()))
        os.kill(os.getpid(), signal.SIGKILL)
    return {{"square": beside.square(n)}}
"""
CLUSTER_PROGRAM = """import sys
import ray.cluster_utils
cluster = ray.cluster_utils.Cluster()
for _ in range(2):
    cluster.add_node(num_cpus=1, include_dashboard=False)
from linkwright.cli import main
status = main(["sweep", "squares.py", "--ray", cluster.address])
cluster.shutdown()
sys.exit(status)
"""


@pytest.mark.slow
def test_ray_cluster_completes_table_after_losing_worker(tmp_path):
    path = write_scenario(tmp_path, LOSING)
    (tmp_path / "beside.py").write_text("def square(n): return n * n\n")
    lost = tmp_path / "lost"
    environment = {
        **os.environ,
        "LOST": str(lost),
        "RAY_raylet_start_wait_time_s": "600",
    }
    result = subprocess.run(
        [sys.executable, "-c", CLUSTER_PROGRAM], cwd=tmp_path, env=environment, capture_output=True, check=False
    )
    assert result.returncode == 0, result.stderr
    assert lost.exists()
    rows = path.with_suffix(".csv").read_text()
    assert rows == "row,n,seed,square,error\n1,1,0,1,\n2,2,0,4,\n3,3,0,9,\n4,4,0,16,\n"


def test_unreachable_ray_cluster_is_an_error(tmp_path):
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))  # reserves the port, so that no other program listens there
        address = f"127.0.0.1:{unused.getsockname()[1]}"
        for cluster in (address, f"ray://{address}"):
            with pytest.raises(LinkwrightError, match="refused") as raised:
                run_on_ray(write_scenario(tmp_path), [], cluster, ignore)
            assert raised.value.diagnostics[0].code == "SWEEP114"


def test_missing_ray_is_reported(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(LinkwrightError) as raised:
        run_on_ray(write_scenario(tmp_path), [], "auto", ignore)
    assert raised.value.diagnostics[0].code == "SWEEP113"


def test_ray_that_does_not_start_is_an_error(tmp_path, monkeypatch):
    def init(**_):
        raise Exception("The current node timed out during startup.")  # noqa: TRY002 - as Ray does

    monkeypatch.setitem(sys.modules, "ray", SimpleNamespace(init=init))
    with pytest.raises(LinkwrightError, match="Ray does not start on this computer: The current node") as raised:
        run_on_ray(write_scenario(tmp_path), [], "local", ignore)
    assert raised.value.diagnostics[0].code == "SWEEP114"
