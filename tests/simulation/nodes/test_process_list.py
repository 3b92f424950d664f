"""The command of a simulation in the list of processes."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time

import pytest

from linkwright.simulation.nodes.process_list import ListedCommand

pytestmark = pytest.mark.skipif(shutil.which("pgrep") is None, reason="the machine has no pgrep")


def find_processes(command):
    """Return the identifiers of the processes with a command line, as programs look for Gazebo."""
    result = subprocess.run(["pgrep", "-f", command], capture_output=True, text=True, check=False)
    return {int(line) for line in result.stdout.split()}


def test_command_is_listed_until_it_is_closed():
    command = ListedCommand(["gz", "sim", "-v", "4", "-r", "own world.sdf"])
    assert command.pid in find_processes("gz sim -v 4 -r 'own world.sdf'")
    command.close()
    command.close()
    assert command.pid not in find_processes("gz sim -v 4 -r 'own world.sdf'")


def test_command_ends_with_the_process_that_listed_it(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(
        "from linkwright.simulation.nodes.process_list import ListedCommand\n"
        "print(ListedCommand(['gz', 'sim', 'own_short_world.sdf']).pid)\n"
    )
    result = subprocess.run([sys.executable, str(program)], capture_output=True, text=True, check=True)
    pid = int(result.stdout)
    for _ in range(100):
        if pid not in find_processes("gz sim own_short_world.sdf"):
            return
        time.sleep(0.05)
    pytest.fail("the process still waits")
