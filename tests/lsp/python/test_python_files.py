"""Python files in an editor, with the real ty and ruff."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import psutil
import pytest
import pytest_asyncio
from lsprotocol import types

from linkwright.lsp.python.programs import installed_programs
from tests.lsp.conftest import Editor, connect_editor
from tests.waiting import eventually

pytestmark = pytest.mark.skipif(len(installed_programs()) < 2, reason="ty or ruff is not installed")

NODE = """\
import os
from rclpy.node import Node
from launch_ros.actions import Node as LaunchNode
from std_msgs.msg import String
from my_msgs.msg import Count
from my_package.speed import half


class Talker(Node):
    def __init__(self):
        super().__init__("说话😀"); self.publisher = self.create_publisher(String, "chatter", 10)
        self.limit = half(Count(number=1).number)
"""
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="my_package", executable="talker")])
"""
CAPABILITIES = types.ClientCapabilities(
    text_document=types.TextDocumentClientCapabilities(
        hover=types.HoverClientCapabilities(content_format=[types.MarkupKind.Markdown]),
        diagnostic=types.DiagnosticClientCapabilities(),
        publish_diagnostics=types.PublishDiagnosticsClientCapabilities(version_support=True),
        code_action=types.CodeActionClientCapabilities(
            code_action_literal_support=types.ClientCodeActionLiteralOptions(
                types.ClientCodeActionKindOptions([types.CodeActionKind.QuickFix, types.CodeActionKind.SourceFixAll])
            ),
            data_support=True,
            resolve_support=types.ClientCodeActionResolveOptions(["edit"]),
        ),
    )
)


def manifest_text(name: str, *dependencies: str) -> str:
    depends = "".join(f"<exec_depend>{dependency}</exec_depend>" for dependency in dependencies)
    return (
        f'<package format="3"><name>{name}</name><version>0.1.0</version><description>A package.</description>'
        f'<maintainer email="a@example.org">A</maintainer><license>MIT</license>{depends}</package>\n'
    )


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    package, messages = (tmp_path / "src" / name for name in ("my_package", "my_msgs"))
    (package / "my_package").mkdir(parents=True)
    (package / "launch").mkdir()
    (messages / "msg").mkdir(parents=True)
    (package / "package.xml").write_text(manifest_text(package.name, "std_msgs", messages.name))
    (messages / "package.xml").write_text(manifest_text(messages.name))
    (messages / "msg" / "Count.msg").write_text("int32 number\n")
    (package / "setup.py").write_text("from setuptools import setup\n\nsetup(name='my_package')\n")
    (package / "my_package" / "__init__.py").write_text("")
    (package / "my_package" / "speed.py").write_text("def half(value: float) -> float:\n    return value / 2\n")
    (package / "my_package" / "talker.py").write_text(NODE, encoding="utf-8")
    (package / "launch" / "talker.launch.py").write_text(LAUNCH)
    (tmp_path / "ruff.toml").write_text('[lint]\nselect = ["F"]\n')
    return tmp_path


@pytest_asyncio.fixture
async def editor(workspace: Path) -> AsyncIterator[Editor]:
    async with connect_editor(workspace, CAPABILITIES, None, "--stdio", "--python") as editor:
        yield editor


TALKER = "src/my_package/my_package/talker.py"


def find_position(text: str, searched_text: str, offset: int = 0) -> types.Position:
    """Return the position of the first occurrence of a text, in UTF-16 code units."""
    before, found, _ = text.partition(searched_text)
    assert found
    line = before.rpartition("\n")[2] + searched_text[:offset]
    return types.Position(before.count("\n"), len(line.encode("utf-16-le")) // 2)


def text_at(text: str, place: types.Range) -> str:
    """Return the text of a range in one line."""
    units = text.splitlines()[place.start.line].encode("utf-16-le")
    return units[2 * place.start.character : 2 * place.end.character].decode("utf-16-le")


async def request_hover(editor: Editor, name: str, position: types.Position) -> str:
    hover = await editor.client.text_document_hover_async(types.HoverParams(editor.document(name), position))
    assert hover is not None
    assert isinstance(hover.contents, types.MarkupContent)
    return hover.contents.value


async def completion_labels(editor: Editor, name: str, position: types.Position) -> list[str]:
    completions = await editor.client.text_document_completion_async(
        types.CompletionParams(editor.document(name), position)
    )
    items = completions.items if isinstance(completions, types.CompletionList) else completions or []
    return [item.label for item in items]


async def test_ros_and_workspace_modules_are_found(editor: Editor) -> None:
    editor.open(TALKER, language="python")
    findings = await editor.until(TALKER, "F401", "F401")
    assert {text_at(NODE, finding.range) for finding in findings} == {"os", "LaunchNode"}
    assert "A node in the graph" in await request_hover(editor, TALKER, find_position(NODE, "Node)"))
    assert "Count" in await request_hover(editor, TALKER, find_position(NODE, "Count\n"))
    assert "create_publisher" in await request_hover(editor, TALKER, find_position(NODE, "create_publisher", offset=3))


async def test_unsaved_text_reaches_servers(editor: Editor) -> None:
    editor.open(TALKER, language="python")
    text = NODE.replace("import os\n", "").replace("LaunchNode", "_").replace("; ", "\n        ")
    text += "        self.get_logger().inf\n"
    editor.change(TALKER, text)
    findings = await editor.until(TALKER, "F401", "missing-attribute")
    assert "has no attribute `inf`" in {finding.code: finding.message for finding in findings}["missing-attribute"]
    assert "info" in await completion_labels(editor, TALKER, find_position(text, "logger().inf", offset=12))
    editor.change(TALKER, text.replace("().inf", "().info('说😀')"))
    await editor.until(TALKER, "F401")


async def test_changed_workspace_message_is_reloaded(editor: Editor, workspace: Path) -> None:
    editor.open(TALKER, language="python")
    text = NODE.replace("import os\n", "").replace("LaunchNode", "_").replace("; ", "\n        ")
    editor.change(TALKER, text.replace("number=1", "size=1"))
    await editor.until(TALKER, "F401", "unknown-argument")
    message = workspace / "src" / "my_msgs" / "msg" / "Count.msg"
    message.write_text("int32 number\nint32 size\n")
    changed = types.FileEvent(message.as_uri(), types.FileChangeType.Changed)
    editor.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams([changed]))
    await editor.until(TALKER, "F401")


async def test_name_is_renamed_in_all_files_and_definition_is_found(editor: Editor, workspace: Path) -> None:
    editor.open(TALKER, language="python")
    document, position = editor.document(TALKER), find_position(NODE, "half(", offset=1)
    definitions = await editor.client.text_document_definition_async(types.DefinitionParams(document, position))
    assert isinstance(definitions, list)
    assert [location.uri for location in definitions if isinstance(location, types.Location)] == [
        (workspace / "src/my_package/my_package/speed.py").as_uri()
    ]
    edit = await editor.client.text_document_rename_async(types.RenameParams(document, position, "halved"))
    assert edit is not None
    assert edit.changes is not None
    assert {Path(uri).name: len(edits) for uri, edits in edit.changes.items()} == {"talker.py": 2, "speed.py": 1}


async def test_ruff_formats_and_fixes(editor: Editor) -> None:
    editor.open(TALKER, language="python")
    document = editor.document(TALKER)
    options = types.FormattingOptions(4, insert_spaces=True)
    edits = await editor.client.text_document_formatting_async(types.DocumentFormattingParams(document, options))
    assert edits is not None
    assert 'super().__init__("说话😀")\n        self.publisher' in "".join(edit.new_text for edit in edits)
    findings = await editor.until(TALKER, "F401", "F401")
    unused = next(finding for finding in findings if finding.range.start.line == 0)
    context = types.CodeActionContext(findings)
    parameters = types.CodeActionParams(document, unused.range, context)
    actions = await editor.client.text_document_code_action_async(parameters)
    fixes = [action for action in actions or () if isinstance(action, types.CodeAction)]
    fix_all = next(fix for fix in fixes if str(fix.kind).startswith("source.fixAll"))
    resolved = await editor.client.code_action_resolve_async(fix_all)
    assert "import os" not in str(resolved.edit)
    assert resolved.edit is not None
    assert any("Remove unused import" in fix.title for fix in fixes)


async def test_launch_file_combines_linkwright_and_ty_completions(editor: Editor) -> None:
    name = "src/my_package/launch/talker.launch.py"
    text = LAUNCH.replace("def gen", "launch = LaunchDescription([])\nlaunch.add_a\n\n\ndef gen")
    editor.open(name, text, language="python")
    assert "my_package" in await completion_labels(editor, name, find_position(text, '"my_p', offset=3))
    assert "add_action" in await completion_labels(editor, name, find_position(text, "launch.add_a", offset=12))
    assert "`executable`" in await request_hover(editor, name, find_position(text, '"talker', offset=3))


async def find_children(editor: Editor) -> dict[str, psutil.Process]:
    """Wait until both servers run, and return their processes by name."""
    server = psutil.Process(editor.server_id)
    await eventually(lambda: {"ty", "ruff"} <= {child.name() for child in server.children()})
    return {child.name(): child for child in server.children()}


async def test_killed_server_restarts_with_unsaved_text(editor: Editor) -> None:
    editor.open(TALKER, language="python")
    await editor.until(TALKER, "F401", "F401")
    editor.change(TALKER, NODE + "        self.speed = half(self.limit)\n        self.speed.real.x\n")
    await editor.until(TALKER, "F401", "F401", "missing-attribute")
    (await find_children(editor))["ty"].kill()
    text = NODE + "        self.speed = half(self.limit)\n        self.speed.real.y\n"
    editor.change(TALKER, text)
    findings = await editor.until(TALKER, "F401", "F401", "missing-attribute")
    await eventually(lambda: "`y`" in str(editor.diagnostics), what=findings)
    assert editor.messages == []


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL")
async def test_servers_end_with_killed_linkwright(workspace: Path) -> None:
    opened: Any = connect_editor(workspace, CAPABILITIES, None, "--stdio", "--python")
    editor = await opened.__aenter__()
    editor.open(TALKER, language="python")
    children = await find_children(editor)
    os.kill(editor.server_id, signal.SIGKILL)
    await eventually(lambda: not any(child.is_running() for child in children.values()))
    await asyncio.wait_for(editor.client.stop(), 10)
