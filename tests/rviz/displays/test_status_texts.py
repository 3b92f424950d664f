"""The texts of status rows are phrases, so that each page shows them in its language."""

from __future__ import annotations

import ast
from pathlib import Path

import linkwright.rviz
from linkwright.diagnostics import Diagnostic, phrase
from tests.rviz.displays.test_topic_display import make_config
from tests.viewer.scene import open_page, open_world

RVIZ = Path(linkwright.rviz.__file__).parent
_TEXT_OF = {"set_status_row": 2, "refuse": 0, "_refuse": 1, "StatusRow": 2}
"""The functions that set the text of a status, and the index of the argument with the text."""


def _is_plain(text: ast.expr) -> bool:
    """Return whether an expression is a text that is not a phrase.

    Phrases are checked with the catalogs.
    """
    if isinstance(text, ast.IfExp):
        return _is_plain(text.body) or _is_plain(text.orelse)
    if isinstance(text, ast.BoolOp):
        return any(map(_is_plain, text.values))
    if isinstance(text, ast.Call):
        return ast.unparse(text.func) == "str" or ast.unparse(text.func).endswith(".join")
    return isinstance(text, (ast.Constant, ast.JoinedStr, ast.BinOp))


def _find_statuses(folder: Path) -> list[tuple[str, ast.expr]]:
    statuses = []
    for path in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                place = _TEXT_OF.get(node.func.attr if isinstance(node.func, ast.Attribute) else ast.unparse(node.func))
                if place is not None and len(node.args) > place:
                    statuses.append((f"{path.relative_to(RVIZ)}:{node.lineno}", node.args[place]))
    return statuses


def test_all_statuses_are_translatable_phrases():
    statuses = [status for room in ("displays", "frames", "visualization") for status in _find_statuses(RVIZ / room)]
    assert len(statuses) > 100
    assert [place for place, text in statuses if _is_plain(text)] == []


async def test_statuses_are_sent_in_language_of_page():
    silent = {
        "zh": "没有收到消息：没有节点发布这个话题",
        "en": "No messages received: the topic has no publisher",
    }
    texts_by_language = {"zh": "订阅出错：话题名为空", "en": "Error subscribing: Empty topic name"}
    async with open_world(make_config()) as world:
        for language, text in silent.items():
            async with open_page(world.viewer, f"&language={language}") as client:
                (display,) = (await client.opened())["tree"]["displays"]
                assert [row["text"] for row in display["status"]] == [text]
        async with open_page(world.viewer, "&language=zh-CN") as chinese, open_page(world.viewer) as other:
            await chinese.opened()
            await other.opened()
            await other.set(f"{display['id']}/Topic", "")
            for client, language in ((chinese, "zh"), (other, "en")):
                message = await client.until("display_status", display=display["id"], level="error")
                assert [(row["name"], row["text"]) for row in message["status"]] == [
                    ("Topic", texts_by_language[language])
                ]


async def test_findings_are_sent_in_language_of_page():
    async with (
        open_world(make_config()) as world,
        open_page(world.viewer, "&language=zh") as chinese,
        open_page(world.viewer) as other,
    ):
        await chinese.opened()
        await other.opened()
        world.viewer.show_diagnostics([Diagnostic("URDF101", phrase("URDF is empty"))])
        texts = [(await client.until("diagnostics"))["items"][0]["message"] for client in (chinese, other)]
        assert texts == ["URDF 是空的", "URDF is empty"]
