"""Run the fuzzer: ``python -m fuzz [TARGET ...] --runs N``; see the README beside this file."""

from __future__ import annotations

import argparse
import gc
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parent.parent / ".build" / "fuzz"
LIMIT_SECONDS = 5.0
"""What takes so long here takes a second elsewhere: code that counts where it goes runs five times as slowly."""
_LONGEST_SECONDS = 60.0
"""An input that takes so long is broken off. This, too, is time of the processor."""
_MEMORY_MIB = 2_048
_GROWTH_MIB = 200
"""By how much one input may raise the most memory that the process ever had."""
_WARM = 100
"""Inputs until everything is loaded."""
_LONGEST_INPUT = {"-text": 2_000, "": 600}


def main() -> int:
    """Fuzz the targets named, or all, one after another; 1 when something was found."""
    parser = argparse.ArgumentParser(prog="python -m fuzz", description=__doc__)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help="what to fuzz; all by default")
    parser.add_argument("--runs", type=int, default=1_000_000, help="how many inputs, shared among all targets")
    parser.add_argument(
        "--seconds", type=int, default=0, help="of the processor, at most, for each target; 0 means no bound"
    )
    parser.add_argument("--one", metavar="NAME", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one:
        fuzz_one(arguments.one, arguments.runs, arguments.seconds)
        return 0
    from fuzz.targets import TARGETS  # not above: a process that fuzzes loads it with the branches counted

    names = arguments.targets or list(TARGETS)
    unknown = set(names) - set(TARGETS)
    if unknown:
        parser.error(f"unknown target {', '.join(sorted(unknown))}; known are {', '.join(TARGETS)}")
    total = found = 0
    for name in names:
        runs = max(1, arguments.runs // len(names))
        command = [sys.executable, "-m", "fuzz", "--one", name, "--runs", str(runs)]
        result = FOLDER / f"{name}.json"
        result.unlink(missing_ok=True)
        subprocess.run([*command, "--seconds", str(arguments.seconds)], check=False)
        died: dict[str, Any] = {"inputs": 0, "found": {"died": 1}, "seconds": 0}
        counted = json.loads(result.read_text()) if result.exists() else died
        summary = f"{counted['inputs']:>9,} inputs {counted['seconds']:>7.0f} s  found: {counted['found'] or 'nothing'}"
        print(f"{name:16} {summary}", flush=True)
        total += counted["inputs"]
        found += len(counted["found"])
    print(f"{'together':16} {total:>9,} inputs, {found} things found (inputs in {FOLDER}/found)")
    return 1 if found else 0


def fuzz_one(name: str, runs: int, seconds: int) -> None:
    """Fuzz one target in this process, which ends with it; findings are saved, and the run continues."""
    import atheris  # type: ignore[import-untyped]

    work = FOLDER / "work"
    work.mkdir(parents=True, exist_ok=True)
    tempfile.tempdir = str(work)  # the process ends without tidying up
    with atheris.instrument_imports(include=["linkwright"]):
        from fuzz.targets import TARGETS, hard_seeds, seeds

    target = TARGETS[name]
    corpus, found_in = FOLDER / "corpus" / name, FOLDER / "found"
    for folder in (corpus, found_in):
        folder.mkdir(parents=True, exist_ok=True)
    if not any(corpus.iterdir()):
        for number, seed in enumerate(seeds(name)):
            (corpus / f"seed-{number}").write_bytes(seed)
    for number, text in enumerate(hard_seeds(name)):
        (corpus / f"hard-{number}").write_bytes(text.encode())
    found: dict[str, int] = {}
    inputs = 0
    signal.signal(signal.SIGPROF, _break_off)

    def report() -> None:
        counted = {"inputs": inputs, "found": found, "seconds": time.process_time()}
        (FOLDER / f"{name}.json").write_text(json.dumps(counted))

    def run(data: bytes) -> None:
        nonlocal inputs
        inputs += 1
        if inputs % 500 == 0:
            report()
            gc.collect()  # the frames of errors are garbage that Python lets pile up
        most = _most_memory()
        try:
            spent = _seconds(target, data)
            if spent > LIMIT_SECONDS:  # once more, lest it was the garbage collector
                spent = _seconds(target, data)
            what = f"slow-{spent:.0f}s" if spent > LIMIT_SECONDS else None
            if inputs > _WARM and _most_memory() - most > _GROWTH_MIB:
                what = "memory"
        except (Exception, _TooLongError) as error:  # noqa: BLE001 - whatever it is, it is what this looks for
            what = _where(error)
        if what is not None:
            found[what] = found.get(what, 0) + 1
            if found[what] <= 3:
                (found_in / f"{name}-{what}-{found[what]}").write_bytes(data)
        if inputs == runs or (seconds and time.process_time() > seconds):
            report()
            os._exit(0)

    longest = _LONGEST_INPUT["-text" if name.endswith("-text") else ""]
    options = [
        sys.argv[0],
        str(corpus),
        f"-max_len={longest}",
        f"-rss_limit_mb={_MEMORY_MIB}",
        "-timeout=0",  # libFuzzer's counts the time that other programs take
        "-report_slow_units=1000",
        "-verbosity=0",
        f"-artifact_prefix={found_in}/{name}-died-",
        f"-dict={Path(__file__).resolve().parent / 'words.dict'}",
    ]
    atheris.Setup(options, run)
    atheris.Fuzz()


def _most_memory() -> int:
    """Return the peak memory of this process, in MiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10


def _seconds(target: Callable[[bytes], None], data: bytes) -> float:
    begun = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, _LONGEST_SECONDS)
    try:
        target(data)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return time.process_time() - begun


class _TooLongError(BaseException):
    """An error for reading that takes too long; no reader catches it."""


def _break_off(_number: int, _frame: object) -> None:
    raise _TooLongError


def _where(error: BaseException) -> str:
    trace = error.__traceback__
    place = "unknown"
    while trace is not None:
        file = Path(trace.tb_frame.f_code.co_filename)
        if "linkwright" in file.parts or file.name == "targets.py":
            place = f"{file.stem}-{trace.tb_lineno}"
        trace = trace.tb_next
    return f"{type(error).__name__}-{place}"


if __name__ == "__main__":
    sys.exit(main())
