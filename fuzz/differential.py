"""Compare with PyPI's xacro on generated descriptions: ``python -m fuzz.differential PYTHON_WITH_XACRO --runs N``."""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from random import Random

from fuzz import descriptions
from fuzz.__main__ import FOLDER
from fuzz.choices import Choices
from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import cache, expand

DELIBERATE = frozenset({"XAC309", "XAC311", "XAC601", "XAC602", "XAC603", "XAC604", "XAC605"})
"""Codes with which we stop on purpose where the other goes on: limits, and what is no XML."""


class Peer:
    """PyPI's xacro in a process of its own."""

    def __init__(self, python: str) -> None:
        script = Path(__file__).resolve().with_name("peer.py")
        self._process = subprocess.Popen(
            [python, str(script)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8"
        )

    def expand(self, path: str, arguments: dict[str, str], packages: dict[str, str]) -> dict[str, str]:
        """Return its answer."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps({"path": path, "arguments": arguments, "packages": packages}) + "\n")
        self._process.stdin.flush()
        answer: dict[str, str] = json.loads(self._process.stdout.readline())
        return answer


def ours(path: str, arguments: dict[str, str], packages: dict[str, str]) -> dict[str, str]:
    """Our answer, in the same form, with the code of an error."""
    cache.documents.values.clear()
    try:
        return {"text": str(expand(path, arguments, packages=packages))}
    except LinkwrightError as error:
        first = error.diagnostics[0]
        return {"error": f"{first.code} {error}", "code": first.code}


def compare(peer: Peer, files: dict[str, str], arguments: dict[str, str]) -> tuple[str, dict[str, str], dict[str, str]]:
    """Return the kind of difference ("same", "both fail", ...), and the answers; files go to the current folder."""
    for name, content in files.items():
        data = content.encode("utf-8")
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_bytes(data)
    packages = {"pkg": str(Path.cwd() / "pkg")}
    mine = ours("main.xacro", arguments, packages)
    theirs = peer.expand("main.xacro", arguments, packages)
    if "text" in mine and "text" in theirs:
        return ("same" if mine["text"] == theirs["text"] else "different"), mine, theirs
    if "error" in mine and "error" in theirs:
        return "both fail", mine, theirs
    if "error" in mine:
        return ("deliberate" if mine["code"] in DELIBERATE else "only ours fails"), mine, theirs
    return "only theirs fails", mine, theirs


def main() -> int:
    """Compare generated descriptions; 1 when there was a difference."""
    parser = argparse.ArgumentParser(prog="python -m fuzz.differential", description=__doc__)
    parser.add_argument("python", help="a Python that has xacro 2.1.1")
    parser.add_argument("--runs", type=int, default=10_000, help="how many descriptions")
    parser.add_argument("--seed", type=int, default=0, help="which ones")
    parser.add_argument("--failures", action="store_true", help="list with which words both fail")
    parser.add_argument("--show", type=int, default=5, help="how many of each kind of difference to show")
    arguments = parser.parse_args()
    work = FOLDER / "differential"
    work.mkdir(parents=True, exist_ok=True)
    os.chdir(work)
    peer = Peer(arguments.python)
    counts: Counter[str] = Counter()
    kinds: Counter[str] = Counter()
    failures: Counter[str] = Counter()
    for number in range(arguments.seed, arguments.seed + arguments.runs):
        data = Random(number).randbytes(Random(-number - 1).randrange(20, 300))
        files, given = descriptions.description(Choices(data))
        verdict, mine, theirs = compare(peer, files, given)
        if verdict == "both fail":
            failures[f"{mine['code']:8} {_kind({}, theirs)}"] += 1
        elif verdict == "different" and _without_addresses(mine["text"]) == _without_addresses(theirs["text"]):
            verdict = "deliberate"
        elif verdict == "only theirs fails" and theirs["error"].endswith("has no attribute 'replace'"):
            verdict = "deliberate"  # xacro:attribute with a value that is no string
        counts[verdict] += 1
        if verdict in ("same", "both fail", "deliberate"):
            continue
        kind = f"{verdict}: {_kind(mine, theirs)}"
        kinds[kind] += 1
        if kinds[kind] <= arguments.show:
            print(f"--- {number} {kind}\n{files['main.xacro']}\nours:   {_shown(mine)}\ntheirs: {_shown(theirs)}")
    print(dict(counts))
    for kind, count in kinds.most_common():
        print(f"{count:7} {kind}")
    for kind, count in failures.most_common() if arguments.failures else ():
        print(f"{count:7} both fail: {kind}")
    return 1 if kinds else 0


_ADDRESS = re.compile(r"&lt;[^\n]*?(?: at 0x\w+|module)[^\n]*?(?:&gt;)+")
"""What Python writes for a function or iterator."""


def _without_addresses(text: str) -> str:
    return _ADDRESS.sub("<...>", text)


def _kind(mine: dict[str, str], theirs: dict[str, str]) -> str:
    return mine.get("code") or "".join(sign for sign in theirs.get("error", "")[:60] if not sign.isdigit())


def _shown(answer: dict[str, str]) -> str:
    return answer.get("error") or "\n".join(answer["text"].splitlines()[5:])


if __name__ == "__main__":
    sys.exit(main())
