"""Malicious and mistaken programs are contained on all systems."""

from __future__ import annotations

import json
import os
import socket
import sys
import uuid
from dataclasses import replace
from pathlib import Path

import pytest

from linkwright.learning.sandbox import Exceeded, Limits, Outcome, Protection
from tests.learning.sandbox import attacks
from tests.learning.sandbox.conftest import processes_with
from tests.learning.sandbox.situations import SITUATIONS, expected_protections, is_possible, run_in_situation

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the simulated situations need Linux")

MEBIBYTE = 1 << 20
LIMITS = Limits(
    seconds=20,
    cpu_seconds=3,
    memory=200 * MEBIBYTE,
    file_bytes=32 * MEBIBYTE,
    disk_bytes=64 * MEBIBYTE,
    files=1000,
    processes=40,
    output_bytes=100_000,
)
MAX_OVERSHOOT_BYTES = 400 * MEBIBYTE
"""The space that a run may use beyond its limit before the watchdog of a slow machine notices it."""


@pytest.fixture(params=list(SITUATIONS))
def situation(request: pytest.FixtureRequest) -> str:
    name: str = request.param
    if not is_possible(name):
        pytest.skip("this user cannot simulate the situation")
    return name


def run_attack(
    situation: str, folder: Path, program: str, *words: str, limits: Limits = LIMITS, mark: str = ""
) -> Outcome:
    """Run a program in the sandbox, and expect the situation's protections and no process left."""
    mark = mark or uuid.uuid4().hex
    arguments = ["PYTHON", "-I", "-S", "-c", program, *words, mark]
    outcome = run_in_situation(situation, arguments, folder, limits)
    if situation != "user without anything" or outcome.protections:  # otherwise a program may kill its supervisor
        assert outcome.protections == expected_protections(situation)
    assert processes_with(mark) == []
    return outcome


def occupied_bytes(folder: Path) -> int:
    return sum(path.lstat().st_blocks * 512 for path in folder.rglob("*"))


def test_fork_bomb_is_killed_with_all_processes(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.FORK_BOMB)
    assert outcome.exceeded in {Exceeded.PROCESSES, Exceeded.CPU_SECONDS}
    assert outcome.seconds < LIMITS.seconds


def test_daemons_end_with_their_run(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.DAEMONS)
    assert (outcome.status, outcome.exceeded) == (0, None)


def test_endless_loop_ends_at_processor_time_limit(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.ENDLESS_LOOP, limits=replace(LIMITS, cpu_seconds=0.2))
    assert outcome.exceeded is Exceeded.CPU_SECONDS
    assert outcome.stdout == b"begun\n"
    assert outcome.seconds < LIMITS.seconds


def test_processor_time_limit_counts_all_processes(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.MANY_LOOPS, limits=replace(LIMITS, cpu_seconds=0.4))
    assert outcome.exceeded is Exceeded.CPU_SECONDS
    assert 0.4 <= outcome.cpu_seconds < 2.4


def test_waiting_program_ends_at_wall_time_limit(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.SLEEP, limits=replace(LIMITS, seconds=0.5))
    assert (outcome.status, outcome.exceeded) == (-9, Exceeded.SECONDS)


def test_file_size_is_limited(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.LARGE_FILE)
    assert outcome.exceeded is Exceeded.FILE_BYTES
    assert (student / "large").stat().st_size <= LIMITS.file_bytes
    assert b"sparse: File too large" in outcome.stdout


def test_many_small_files_end_run(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.MANY_SMALL_FILES)
    assert outcome.exceeded in {Exceeded.FILES, Exceeded.DISK_BYTES}
    assert len(list(student.rglob("*"))) < 50_000


def test_deeply_nested_folders_end_run(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.DEEP_FOLDERS)
    assert outcome.exceeded is Exceeded.FILES


def test_deleted_files_count_toward_disk_limit(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.DELETED_FILE)
    assert outcome.exceeded is Exceeded.DISK_BYTES


def test_memory_limit_counts_all_processes(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.MEMORY)
    assert outcome.exceeded is Exceeded.MEMORY


@pytest.mark.parametrize("program", [attacks.SHARED_MEMORY, attacks.NAMELESS_FILES_IN_MEMORY])
def test_shared_and_file_memory_is_limited(situation: str, student: Path, program: str) -> None:
    outcome = run_attack(situation, student, program)
    assert outcome.exceeded is Exceeded.MEMORY


def test_endless_output_ends_run_and_keeps_beginning(situation: str, student: Path) -> None:
    outcome = run_attack(situation, student, attacks.OUTPUT)
    assert outcome.exceeded is Exceeded.OUTPUT_BYTES
    assert len(outcome.stdout) + len(outcome.stderr) == LIMITS.output_bytes


def test_system_temporary_folders_are_not_filled(situation: str, student: Path) -> None:
    mark = uuid.uuid4().hex
    outcome = run_attack(situation, student, attacks.FILL_TEMPORARY, mark=mark)
    written = {folder: int(size) for folder, size in (line.split() for line in outcome.stdout.decode().splitlines())}
    left = [path for folder in attacks.TEMPORARY_FOLDERS for path in Path(folder).glob(f"fill-{mark}-*")]
    for path in left:
        path.unlink()
    is_root, _, _ = SITUATIONS[situation]
    if is_root or Protection.WRITE in outcome.protections:  # runs of root have separate users, whose files are removed
        assert left == []
    if Protection.WRITE in outcome.protections:
        assert sum(written.values()) <= 2 * LIMITS.memory // 8


def test_dangerous_files_are_removed_after_run(situation: str, student: Path) -> None:
    (student / "data").write_text("mine")
    (student.parent / "neighbor").mkdir()
    outcome = run_attack(situation, student, attacks.TRAPS)
    assert outcome.status == 0, outcome.stderr
    assert outcome.removed == ("neighbor", "outside", "package/further", "pipe", "root")
    assert (student / "inside").is_symlink()
    assert (student / "closed" / "file").read_text() == ""
    assert (student / "program").stat().st_mode & 0o7777 == 0o777
    assert (student / "data").stat().st_uid == student.stat().st_uid


def test_run_cannot_leave_sandbox(situation: str, student: Path) -> None:
    neighbor = student.parent / "neighbor"
    neighbor.mkdir(mode=0o777)
    (neighbor / "secret").write_text("secret")
    for path, mode in ((neighbor, 0o777), (neighbor / "secret", 0o666), (student.parent, 0o777)):
        path.chmod(mode)
    with socket.create_server(("127.0.0.1", 0)) as server, socket.socket(socket.AF_UNIX) as local_server:
        place = str(student.parent / "server")
        local_server.bind(place)
        local_server.listen()
        Path(place).chmod(0o777)
        words = [str(neighbor), str(os.getpid()), str(server.getsockname()[1]), place]
        outcome = run_attack(situation, student, attacks.TRESPASS, *words)
    if not outcome.protections:
        assert outcome.status == -9
        return
    breaches = {name for name, was_done in json.loads(outcome.stdout).items() if was_done}
    assert breaches <= _find_possible_attacks(outcome.protections)
    if Protection.WRITE in outcome.protections:
        assert (neighbor / "secret").read_text() == "secret"
        assert sorted(path.name for path in student.parent.iterdir()) == ["neighbor", "server", "student"]


def _find_possible_attacks(protections: frozenset[Protection]) -> set[str]:
    """Return the actions that the protections do not forbid."""
    possible_attacks = {"write above its folder"}  # the parent folder may belong to the sandbox
    if Protection.READ not in protections:
        possible_attacks |= {"read a neighbor's file", "list a neighbor's folder", "read by /proc/self/root"}
        possible_attacks |= {"read by the grader's root"}
    if Protection.WRITE not in protections:
        possible_attacks |= {"write into a neighbor's folder", "change a neighbor's file", "truncate a neighbor's file"}
        possible_attacks |= {"write into /var/tmp", "link a neighbor's file"}
    if Protection.PROCESSES not in protections:
        possible_attacks |= {"read the grader's environment", "open the grader's memory", "trace the grader"}
        possible_attacks |= {"trace its parent", "signal the grader"}
    if Protection.NETWORK not in protections:
        possible_attacks |= {"reach a server on this host", "reach another host", "reach a server by a file"}
    return possible_attacks


def test_kill_of_all_processes_affects_only_run(situation: str, student: Path) -> None:
    if Protection.PROCESSES not in expected_protections(situation):
        pytest.skip("the attack would kill this test")
    outcome = run_attack(situation, student, attacks.KILL_ALL)
    assert outcome.exceeded is None
