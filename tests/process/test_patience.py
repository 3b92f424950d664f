"""A clock that excludes the time in which processes wait for a processor."""

import os
import subprocess
import sys
import time

import pytest

from linkwright.process.patience import PatientClock

BUSY_LOOP = "import os, sys; os.sched_setaffinity(0, [int(sys.argv[1])])\nwhile True: pass"


def test_patient_clock_counts_sleep():
    begin = time.monotonic()
    clock = PatientClock()
    for _ in range(10):
        time.sleep(0.02)
        seconds = clock.read()
    assert 0.0 < seconds <= time.monotonic() - begin


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux reports how long a process waits")
def test_patient_clock_excludes_waiting_for_processor():
    processor = str(min(os.sched_getaffinity(0)))
    processes = [subprocess.Popen([sys.executable, "-c", BUSY_LOOP, processor]) for _ in range(4)]
    try:
        clock = PatientClock()
        begin = time.monotonic()
        while time.monotonic() < begin + 2.0:
            time.sleep(0.05)
            seconds = clock.read()
        elapsed = time.monotonic() - begin
    finally:
        for process in processes:
            process.kill()
            process.wait()
    assert 0.0 < seconds < 0.7 * elapsed
