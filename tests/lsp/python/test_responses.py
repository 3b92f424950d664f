"""The combination of the answers of several servers."""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.lsp.python.open_texts import OpenText
from linkwright.lsp.python.responses import combine_responses, find_server_of_action, is_final_response

TEXT = OpenText("file:///a.py", 'Node(pac, "tur")\n', 1, "utf-16")
OWN, TY, RUFF = "linkwright", "ty", "ruff"


def complete(*answers: tuple[str, Any], character: int = 8) -> Any:
    parameters = {"position": {"line": 0, "character": character}}
    return combine_responses("textDocument/completion", answers, TEXT, parameters)


def text_edit(start: int, end: int, text: str) -> dict[str, Any]:
    place = {"start": {"line": 0, "character": start}, "end": {"line": 0, "character": end}}
    return {"label": text, "textEdit": {"range": place, "newText": text}}


@pytest.mark.parametrize("empty", [None, [], {"items": []}])
def test_first_non_empty_answer_applies(empty: Any) -> None:
    answer = {"contents": "a node"}
    assert combine_responses("textDocument/hover", [(OWN, empty), (TY, answer)], TEXT, {}) == answer
    assert combine_responses("textDocument/hover", [(OWN, answer), (TY, {"contents": "b"})], TEXT, {}) == answer
    assert combine_responses("textDocument/hover", [(OWN, empty), (TY, None)], TEXT, {}) == empty
    assert not is_final_response("textDocument/hover", empty)
    assert is_final_response("textDocument/hover", answer)


def test_completions_of_all_servers_are_combined_without_duplicates() -> None:
    own_result = [text_edit(5, 8, "package="), text_edit(5, 8, "parameters=")]
    typed = {"isIncomplete": True, "items": [{"label": "package="}, {"label": "pacing"}]}
    completions = complete((OWN, own_result), (TY, typed))
    assert [item["label"] for item in completions["items"]] == ["package=", "parameters=", "pacing"]
    assert completions["isIncomplete"]


def test_string_completed_by_linkwright_has_no_other_completions() -> None:
    own_result = {"isIncomplete": False, "items": [text_edit(11, 14, "turtle_bot")]}
    assert complete((OWN, own_result), (TY, [{"label": "turn"}]), character=13) == own_result


def test_list_defaults_apply_only_to_items_of_that_list() -> None:
    place = {"start": {"line": 0, "character": 5}, "end": {"line": 0, "character": 8}}
    own_result = {"itemDefaults": {"editRange": place, "insertTextFormat": 2}, "items": [{"label": "package="}]}
    completions = complete((OWN, own_result), (TY, [{"label": "pacing"}]))
    assert completions["items"] == [
        {"label": "package=", "insertTextFormat": 2, "textEdit": {"range": place, "newText": "package="}},
        {"label": "pacing"},
    ]


def test_code_action_is_resolved_by_its_server_with_its_data() -> None:
    own_result, fix = {"title": "own", "data": 1}, {"title": "fix", "data": {"id": 2}}
    command = {"title": "run", "command": "ruff.applyAutofix"}
    actions = combine_responses(
        "textDocument/codeAction", [(OWN, [own_result]), (TY, [{"title": "a"}]), (RUFF, [fix, command])], TEXT, {}
    )
    assert [action["title"] for action in actions] == ["own", "a", "fix"]
    assert actions[0] == own_result
    assert [find_server_of_action(action) for action in actions] == [None, (TY, {"title": "a"}), (RUFF, fix)]


def test_code_actions_are_marked_without_linkwright_answer() -> None:
    actions = combine_responses("textDocument/codeAction", [(RUFF, [{"title": "fix"}])], TEXT, {})
    assert find_server_of_action(actions[0]) == (RUFF, {"title": "fix"})
