"""A runner of composite actions with the features that Linkwright's actions use.

These are bash, inputs, outputs and conditions.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from tests.places import REPOSITORY

TEMPLATES = REPOSITORY / "packaging" / "ci"
PROGRAM = Path(__file__).with_name("program.py")
BASH = ("bash", "--noprofile", "--norc", "-eo", "pipefail")
"""The command with which a runner starts ``shell: bash``."""

_EXPRESSION = re.compile(r"\$\{\{ (.+?) \}\}")
_COMPARISON = re.compile(r"([\w.-]+)(?: (==|!=) '([^']*)')?")


@dataclass
class Run:
    """The result of an action.

    Attributes:
        failed: the name of the failed step, or empty.
        output: the output of the steps.
        used: the actions that it used, with their inputs.
        outputs: the outputs of the action.
        uploaded: the uploaded files.
    """

    failed: str = ""
    output: str = ""
    used: list[tuple[str, Mapping[str, Any]]] = field(default_factory=list)
    outputs: dict[str, str] = field(default_factory=dict)
    uploaded: dict[str, Path] = field(default_factory=dict)


class Runner:
    """A machine that runs actions in a checkout.

    Args:
        checkout: the folder of the checkout, where the steps run.
        temporary: a folder for the runner's own files.
        variables: more variables of the environment.
    """

    def __init__(self, checkout: Path, temporary: Path, variables: Mapping[str, str]) -> None:
        self._checkout = checkout
        self.temporary = temporary
        self._variables = {**variables, **self._prepare()}
        self.summary = temporary / "summary.md"

    def _prepare(self) -> dict[str, str]:
        """Put a `python3` on the PATH that makes environments with this Linkwright.

        It also records what pip installs.
        """
        commands = self.temporary / "commands"
        commands.mkdir(parents=True)
        self.installed = self.temporary / "installed.txt"
        self.installed.touch()
        self.without_page = self.temporary / "without_page.txt"
        environment = f'mkdir -p "$4/bin"; ln -s {sys.executable} "$4/bin/real"'
        linkwright = f'printf \'#!/bin/bash\\nexec {sys.executable} -I {PROGRAM} "$@"\\n\' > "$4/bin/linkwright"'
        note = f'echo "${{LINKWRIGHT_WITHOUT_PAGE:-}}" > {self.without_page}\\n'
        pip = f'printf \'#!/bin/bash\\nprintf "%%s\\\\n" "$@" >> {self.installed}\\n{note}\' > "$4/bin/python"'
        script = (
            '#!/bin/bash\nif [ "$1 $2 $3" = "-I -m venv" ]; then\n'
            f'{environment}\n{linkwright}\n{pip}\nchmod +x "$4/bin/linkwright" "$4/bin/python"\n'
            f'else\nexec {sys.executable} "$@"\nfi\n'
        )
        (commands / "python3").write_text(script, encoding="utf-8")
        (commands / "python3").chmod(0o755)
        return {
            "PATH": f"{commands}:{os.environ['PATH']}",
            "HOME": str(self.temporary),
            "GITHUB_ACTIONS": "true",
            "RUNNER_TEMP": str(self.temporary),
            "GITHUB_STEP_SUMMARY": str(self.temporary / "summary.md"),
            "LC_ALL": "C.UTF-8",
        }

    def run(self, action: str, event: Mapping[str, Any], **inputs: str) -> Run:
        """Run one of Linkwright's actions with inputs, whose names have ``_`` for ``-``."""
        folder = TEMPLATES / action
        definition = yaml.safe_load((folder / "action.yml").read_text(encoding="utf-8"))
        event_file = self.temporary / "event.json"
        event_file.write_text(json.dumps(event), encoding="utf-8")
        context: dict[str, Any] = {"github": {"event": event, "token": "a-token"}, "steps": {}}
        inputs_by_name = {name.replace("_", "-"): value for name, value in inputs.items()}
        assert inputs_by_name.keys() <= definition["inputs"].keys()
        context["inputs"] = {
            name: inputs_by_name.get(name, _fill_expressions(declared.get("default", ""), context))
            for name, declared in definition["inputs"].items()
        }
        variables = {"GITHUB_EVENT_PATH": str(event_file), "GITHUB_ACTION_PATH": str(folder)}
        result = Run()
        for step in definition["runs"]["steps"]:
            if _is_met(step.get("if", ""), context):
                outputs = self._step(step, context, variables, result)
                context["steps"][step.get("id", "")] = {"outputs": outputs}
            if result.failed:
                break
        result.outputs = {
            name: _fill_expressions(output["value"], context) for name, output in definition.get("outputs", {}).items()
        }
        return result

    def _step(
        self, step: Mapping[str, Any], context: Mapping[str, Any], variables: Mapping[str, str], result: Run
    ) -> dict[str, str]:
        if "uses" in step:
            values = {name: _fill_expressions(str(value), context) for name, value in step["with"].items()}
            result.used.append((step["uses"], values))
            if step["uses"].startswith("actions/upload-artifact@"):
                result.uploaded[values["name"]] = Path(values["path"])
                return {"artifact-url": "https://example.org/artifacts/8"}
            return {}
        assert step["shell"] == "bash"
        values = {name: _fill_expressions(str(value), context) for name, value in step.get("env", {}).items()}
        process = self.bash(step["run"], {**variables, **values})
        result.output += process.stdout
        if process.returncode:
            result.failed = step["name"]
        output_file = self.temporary / "output.txt"
        lines = output_file.read_text(encoding="utf-8").splitlines() if output_file.is_file() else []
        output_file.unlink(missing_ok=True)
        return dict(line.split("=", 1) for line in lines)

    def bash(self, script: str, variables: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
        """Run a script in the checkout, as a runner does."""
        assert "${{" not in script
        file = self.temporary / "step.sh"
        file.write_text(script, encoding="utf-8")
        return subprocess.run(
            [*BASH, file],
            cwd=self._checkout,
            env={**self._variables, **variables, "GITHUB_OUTPUT": str(self.temporary / "output.txt")},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            check=False,
        )


def _fill_expressions(text: str, context: Mapping[str, Any]) -> str:
    """Replace the expressions in a text by their values."""
    return _EXPRESSION.sub(lambda match: str(_find_value(match[1], context)), text)


def _find_value(name: str, context: Mapping[str, Any]) -> Any:
    value: Any = context
    for part in name.split("."):
        value = value.get(part, "") if isinstance(value, Mapping) else ""
    return value


def _is_met(condition: str, context: Mapping[str, Any]) -> bool:
    return all(_evaluate_clause(clause.strip(), context) for clause in condition.split("&&") if clause.strip())


def _evaluate_clause(clause: str, context: Mapping[str, Any]) -> bool:
    match = _COMPARISON.fullmatch(clause)
    assert match is not None, clause
    value = _find_value(match[1], context)
    if match[2] is None:
        return bool(value)
    return (str(value) == match[3]) == (match[2] == "==")
