"""Findings of a check during typing, in open files and in included ones."""

from __future__ import annotations

import asyncio

import psutil
from lsprotocol import types

from linkwright.language.workspace import MAX_CHARACTERS
from tests.lsp.conftest import MAIN, PARTS
from tests.waiting import eventually

MAIN_FILE, PARTS_FILE = "urdf/arm.urdf.xacro", "urdf/parts.xacro"


async def test_finding_appears_while_typing_and_disappears_when_fixed(editor):
    editor.open(MAIN_FILE)
    await editor.until(MAIN_FILE)
    editor.change(MAIN_FILE, MAIN.replace("xacro:bar", "xacro:barr"))
    (finding,) = await editor.until(MAIN_FILE, "XAC401")
    assert (finding.range.start.line, finding.range.start.character) == (3, 2)
    assert finding.message.startswith("there is no macro 'barr'\n")
    assert "did you mean" in finding.message
    editor.change(MAIN_FILE, MAIN)
    await editor.until(MAIN_FILE)


async def test_finding_in_included_file_names_include(editor):
    editor.open(PARTS_FILE)
    await editor.until(PARTS_FILE)
    editor.change(PARTS_FILE, PARTS.replace('link="base"', 'link="bsae"'))
    (finding,) = await editor.until(PARTS_FILE, "URDF150")
    assert finding.range.start.line == 4
    calls = [related.location for related in finding.related_information]
    assert (editor.uri(MAIN_FILE), 3) in [(call.uri, call.range.start.line) for call in calls]


async def test_malformed_xml_is_reported_at_unclosed_tag(editor):
    editor.open(MAIN_FILE, MAIN.replace("</robot>", ""))
    (finding,) = await editor.until(MAIN_FILE, "XML202")
    assert finding.range.start.line == 0


async def test_python_file_outside_packages_is_not_parsed_as_xml(editor, tmp_path_factory):
    folder = tmp_path_factory.mktemp("alone")
    program, robot = str(folder / "drive.py"), str(folder / "robot.txt")
    editor.open(program, "import time\n")
    editor.open(robot, "<robot>")
    await editor.until(robot, "XML202")
    await editor.until(program)


async def test_positions_count_utf_16_code_units(editor):
    before = "  <!-- 🤖机器人 --> "
    editor.open(MAIN_FILE, MAIN.replace('  <link name="base"/>', before + '<xacro:nothing/><link name="base"/>'))
    (finding,) = await editor.until(MAIN_FILE, "XAC401")
    assert finding.range.start.character == len(before.encode("utf-16-le")) // 2 == len(before) + 1


async def test_manifest_is_checked(editor):
    text = (editor.folder / "package.xml").read_text()
    editor.open("package.xml", text.replace("<license>Apache-2.0</license>", ""))
    (finding,) = await editor.until("package.xml", "LW802")
    assert "license" in finding.message


async def test_large_file_gets_only_findings(editor):
    text = MAIN.replace("</robot>", f"<!-- {'a' * MAX_CHARACTERS} -->\n</robot>")
    position = types.Position(2, 4)
    editor.open(MAIN_FILE, text.replace("xacro:bar", "xacro:barr"))
    await editor.until(MAIN_FILE, "XAC401")
    assert (
        await editor.client.text_document_hover_async(types.HoverParams(editor.document(MAIN_FILE), position)) is None
    )
    assert editor.messages == ["'arm.urdf.xacro' is too large for completions and hovers: only its findings are shown"]
    editor.change(MAIN_FILE, text)
    await editor.until(MAIN_FILE)
    editor.change(MAIN_FILE, MAIN)
    assert (
        await editor.client.text_document_hover_async(types.HoverParams(editor.document(MAIN_FILE), position))
        is not None
    )


async def test_newest_text_of_large_file_is_checked(editor):
    text = MAIN.replace("</robot>", f"<!-- {'a' * MAX_CHARACTERS} -->\n</robot>")
    editor.open(MAIN_FILE, text.replace("xacro:bar", "xacro:barr"))
    for number in range(5):
        editor.change(MAIN_FILE, text.replace("xacro:bar", f"xacro:bar{number}"))
    (finding,) = await editor.until(MAIN_FILE, "XAC401")
    while "'bar4'" not in finding.message:
        editor.diagnostics.clear()
        (finding,) = await editor.until(MAIN_FILE, "XAC401")


async def test_burst_of_edits_of_large_file_leaves_no_processes(editor):
    text = MAIN.replace("</robot>", f"<!-- {'a' * MAX_CHARACTERS} -->\n</robot>")
    editor.open(MAIN_FILE, text.replace("xacro:bar", "xacro:barr"))
    server = psutil.Process(editor.server_id)
    await editor.until(MAIN_FILE, "XAC401")
    for number in range(10):
        editor.change(MAIN_FILE, f"{text}<!-- {number} -->")
        await asyncio.sleep(0.05 * number)  # some changes arrive while a process starts or works
    await editor.until(MAIN_FILE)
    await eventually(lambda: not any(map(_is_check_process, server.children())))


def _is_check_process(process: psutil.Process) -> bool:
    try:
        return "spawn_main" in " ".join(process.cmdline())
    except psutil.NoSuchProcess:  # it has ended, whether or not the server has waited for it
        return False
