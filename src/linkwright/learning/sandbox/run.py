"""Running a program in the sandbox: the grader's side."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Collection, Mapping, Sequence
from functools import cache
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.learning.sandbox.contents import remove_harmful
from linkwright.learning.sandbox.outcome import Limits, Outcome, Protection
from linkwright.learning.sandbox.plan import Plan, outcome_from_json
from linkwright.learning.sandbox.readable import readable_everywhere

_SUPERVISE = "import json, sys; sys.path[:] = json.loads(sys.argv[1]); from {module} import main; main()"
_MODULE = "linkwright.learning.sandbox.supervisor"
_PASSED_ON = ("PATH", "LANG", "LC_ALL", "LC_CTYPE", "LC_MESSAGES", "LINKWRIGHT_LANG", "TZ")


def run_in_sandbox(
    arguments: Sequence[str],
    *,
    folder: Path,
    limits: Limits,
    readable: Sequence[Path] = (),
    environment: Mapping[str, str] | None = None,
    processors: Collection[int] = (),
) -> Outcome:
    """Run a program on a copy of a student's folder, confined, and return the outcome.

    After the run none of its processes is left, and the folder contains nothing that harms a reader. The folder is the
    home of the program and the place where it starts; its temporary files are in a folder there that is deleted.

    Args:
        arguments: The program, such as `sys.executable`, and its arguments.
        folder: The copy. The run may change it, and nothing else.
        limits: The resources that the run may use.
        readable: Files and whole folders that the run may read besides its folder, Python with its packages, and the
            system's programs and libraries.
        environment: Variables of the environment, besides the path, the language and the places above. Others of this
            process are not passed on.
        processors: The numbers of the processors that the run may use. Runs at the same time that have different
            processors do not slow each other. Empty: all.

    Raises:
        LinkwrightError: The program could not be started.
    """
    if sys.platform == "win32":
        raise LinkwrightError(
            Diagnostic(
                "LEARN902",
                phrase("there is no sandbox for students' programs on Windows"),
                hint=phrase("run the grader on Linux, such as in WSL"),
            )
        )
    folder = folder.resolve(strict=True)
    scratch = Path(tempfile.mkdtemp(prefix=".scratch-", dir=folder))
    plan = Plan(
        arguments=tuple(arguments),
        folder=str(folder),
        readable=(*readable_everywhere(), *(str(path.absolute()) for path in readable)),
        environment=_make_environment(folder, scratch, environment or {}),
        limits=limits,
        processors=tuple(processors),
    )
    try:
        return _supervise(plan)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


@cache
def protections_available() -> frozenset[Protection]:
    """Return the protections that this system offers, found out by a run of an empty program."""
    with ScratchFolder("sandbox") as folder:
        Path(folder).chmod(0o711)
        arguments = [sys.executable, "-I", "-S", "-c", ""]
        return run_in_sandbox(arguments, folder=Path(folder), limits=Limits()).protections


def _make_environment(folder: Path, scratch: Path, wanted: Mapping[str, str]) -> dict[str, str]:
    passed_on = {name: os.environ[name] for name in _PASSED_ON if name in os.environ}
    places = {"HOME": str(folder), "TMPDIR": str(scratch)}
    programs = os.pathsep.join([os.path.dirname(sys.executable), passed_on.get("PATH", os.defpath)])
    return {**passed_on, "PATH": programs, **places, **wanted}


def _supervise(plan: Plan) -> Outcome:
    """Run the supervisor to its end. If this process is interrupted, the supervisor ends the run first."""
    search_path = json.dumps([os.path.abspath(path) for path in sys.path if path])
    command = [sys.executable, "-I", "-S", "-c", _SUPERVISE.format(module=_MODULE), search_path]
    with subprocess.Popen(  # noqa: S603 - our own program
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd="/",
        text=True,
        start_new_session=True,
    ) as supervisor:
        try:
            answer, problem = supervisor.communicate(plan.to_json())
        except BaseException:
            supervisor.terminate()
            raise
    if supervisor.returncode < 0:  # the program has ended its supervisor; only where there is no protection from that
        return Outcome(supervisor.returncode, b"", b"", None, frozenset(), remove_harmful(plan.folder))
    if supervisor.returncode != 0 or not answer:
        raise _failure(problem.strip() or f"the supervisor ended with status {supervisor.returncode}")
    return outcome_from_json(answer)


def _failure(reason: str, hint: Phrase | None = None) -> LinkwrightError:
    message = phrase("the program cannot run in the sandbox: {reason}", reason=foreign(reason))
    return LinkwrightError(Diagnostic("LEARN901", message, hint=hint))
