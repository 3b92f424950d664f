"""Start of a program in the sandbox, on the grader's side."""

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
from linkwright.learning.sandbox.readable import list_readable_paths

_SUPERVISOR_CODE = "import json, sys; sys.path[:] = json.loads(sys.argv[1]); from {module} import main; main()"
_MODULE = "linkwright.learning.sandbox.supervisor"
_INHERITED_VARIABLES = ("PATH", "LANG", "LC_ALL", "LC_CTYPE", "LC_MESSAGES", "LINKWRIGHT_LANG", "TZ")


def run_in_sandbox(
    arguments: Sequence[str],
    *,
    folder: Path,
    limits: Limits,
    readable: Sequence[Path] = (),
    environment: Mapping[str, str] | None = None,
    processors: Collection[int] = (),
) -> Outcome:
    """Run a program, confined to a copy of a student's folder, and return the outcome.

    After the run, all its processes have ended, and the folder is safe to read. The folder is the program's home and
    working directory. Temporary files are in a subfolder, which is deleted.

    Args:
        arguments: the program, such as `sys.executable`, and its arguments.
        folder: the copy of the folder, the only folder that the run may change.
        limits: the resources that the run may use.
        readable: the files and whole folders that the run may read besides its folder, Python with its packages, and
            the system's programs and libraries.
        environment: the environment variables in addition to the path, the language and the folders above. Other
            variables of this process are not passed on.
        processors: the numbers of the processors that the run may use; empty for all. Simultaneous runs on different
            processors do not slow each other down.

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
        readable=(*list_readable_paths(), *(str(path.absolute()) for path in readable)),
        environment=_make_environment(folder, scratch, environment or {}),
        limits=limits,
        processors=tuple(processors),
    )
    try:
        return _supervise(plan)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


@cache
def find_available_protections() -> frozenset[Protection]:
    """Return the protections that this system supports, determined by running an empty program."""
    with ScratchFolder("sandbox") as folder:
        Path(folder).chmod(0o711)
        arguments = [sys.executable, "-I", "-S", "-c", ""]
        return run_in_sandbox(arguments, folder=Path(folder), limits=Limits()).protections


def _make_environment(folder: Path, scratch: Path, variables: Mapping[str, str]) -> dict[str, str]:
    passed_on = {name: os.environ[name] for name in _INHERITED_VARIABLES if name in os.environ}
    folders = {"HOME": str(folder), "TMPDIR": str(scratch)}
    programs = os.pathsep.join([os.path.dirname(sys.executable), passed_on.get("PATH", os.defpath)])
    return {**passed_on, "PATH": programs, **folders, **variables}


def _supervise(plan: Plan) -> Outcome:
    """Run the supervisor, and wait for its end.

    After an interruption, the supervisor first ends the run.
    """
    search_path = json.dumps([os.path.abspath(path) for path in sys.path if path])
    command = [sys.executable, "-I", "-S", "-c", _SUPERVISOR_CODE.format(module=_MODULE), search_path]
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
            output, problem = supervisor.communicate(plan.to_json())
        except BaseException:
            supervisor.terminate()
            raise
    if supervisor.returncode < 0:  # the program has ended its supervisor; only where there is no protection from that
        return Outcome(supervisor.returncode, b"", b"", None, frozenset(), remove_harmful(plan.folder))
    if supervisor.returncode != 0 or not output:
        raise _sandbox_error(problem.strip() or f"the supervisor ended with status {supervisor.returncode}")
    return outcome_from_json(output)


def _sandbox_error(reason: str, hint: Phrase | None = None) -> LinkwrightError:
    message = phrase("the program cannot run in the sandbox: {reason}", reason=foreign(reason))
    return LinkwrightError(Diagnostic("LEARN901", message, hint=hint))
