"""Combine the responses of several language servers to one request."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from linkwright.lsp.python.open_texts import OpenText

OWN_SERVER = "linkwright"
"""The name of Linkwright's own server, and the source of its findings."""

COMPLETION = "textDocument/completion"
CODE_ACTION = "textDocument/codeAction"
RENAME = "textDocument/rename"

CAPABILITIES: Mapping[str, str] = {
    COMPLETION: "completionProvider",
    CODE_ACTION: "codeActionProvider",
    RENAME: "renameProvider",
    "textDocument/prepareRename": "renameProvider",
    "textDocument/hover": "hoverProvider",
    "textDocument/definition": "definitionProvider",
    "textDocument/references": "referencesProvider",
    "textDocument/documentHighlight": "documentHighlightProvider",
    "textDocument/documentSymbol": "documentSymbolProvider",
    "textDocument/formatting": "documentFormattingProvider",
    "textDocument/rangeFormatting": "documentRangeFormattingProvider",
}
"""The requests that are sent to several servers, each with the capability of the servers that respond to it."""

_SERVER_KEY = "linkwrightServer"
_DATA_KEY = "data"


def is_final_response(method: str, response: Any) -> bool:
    """Return whether Linkwright's own response makes the other responses unnecessary."""
    return method not in (COMPLETION, CODE_ACTION) and not _is_empty(response)


def combine_responses(
    method: str, responses: Sequence[tuple[str, Any]], text: OpenText, parameters: Mapping[str, Any]
) -> Any:
    """Combine the responses of several servers to a request.

    Completions and code actions of all servers are combined. For other requests, the first response that is not empty
    is used.

    Args:
        method: the method of the request.
        responses: the name of each server and its response, Linkwright's own server first.
        text: the file to which the request refers.
        parameters: the parameters of the request.
    """
    nonempty_responses = [(server, response) for server, response in responses if not _is_empty(response)]
    if method == COMPLETION:
        return _combine_completions([response for _, response in nonempty_responses], text, parameters)
    if method == CODE_ACTION:
        return [action for server, response in nonempty_responses for action in _mark_actions(server, response)]
    return nonempty_responses[0][1] if nonempty_responses else next((response for _, response in responses), None)


def find_server_of_action(action: Mapping[str, Any]) -> tuple[str, dict[str, Any]] | None:
    """Return the server and the original form of a code action, or None for Linkwright's own."""
    data = action.get(_DATA_KEY)
    if not isinstance(data, dict) or _SERVER_KEY not in data:
        return None
    own = {name: value for name, value in action.items() if name != _DATA_KEY}
    return data[_SERVER_KEY], own if data[_DATA_KEY] is None else {**own, _DATA_KEY: data[_DATA_KEY]}


def mark_action(server: str, action: Mapping[str, Any]) -> dict[str, Any]:
    """Return a code action with the name of its server."""
    return {**action, _DATA_KEY: {_SERVER_KEY: server, _DATA_KEY: action.get(_DATA_KEY)}}


def _mark_actions(server: str, actions: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return the code actions of a server in the form for the editor.

    The actions of other servers are marked with the server's name, and their commands are omitted.
    """
    if server == OWN_SERVER:
        return list(actions)
    return [mark_action(server, action) for action in actions if action.get("command") is None]


def _combine_completions(responses: Sequence[Any], text: OpenText, parameters: Mapping[str, Any]) -> Any:
    """Combine the completions of all servers, unless the first server specifies a range.

    Such a server replaces more or less than the word at the cursor, and its completions are returned alone.

    Editors apply the range of the first item to all items.
    """
    if len(responses) < 2:
        return responses[0] if responses else None
    lists = [
        response if isinstance(response, dict) else {"isIncomplete": False, "items": response} for response in responses
    ]
    first, *others = lists
    edited_range = _find_edited_range(first)
    if edited_range is not None and text.text_in(edited_range) != text.word_before(parameters["position"]):
        return first
    names = {_label_word(item["label"]) for item in first["items"]}
    items = list(map(_with_defaults(first), first["items"]))
    for other_list in others:
        items += [
            item
            for item in map(_with_defaults(other_list), other_list["items"])
            if _label_word(item["label"]) not in names
        ]
    return {"isIncomplete": any(other_list.get("isIncomplete") for other_list in lists), "items": items}


def _find_edited_range(response: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Return the range that the items of a list replace, or None for the word at the cursor."""
    edit_range = response.get("itemDefaults", {}).get("editRange") or response["items"][0].get("textEdit")
    if edit_range is None:
        return None
    range_: Mapping[str, Any] = edit_range.get("range") or edit_range.get("insert") or edit_range
    return range_


def _with_defaults(response: Mapping[str, Any]) -> Callable[[Mapping[str, Any]], dict[str, Any]]:
    """Return a function that adds the defaults of a completion list to an item."""
    defaults = dict(response.get("itemDefaults", {}))
    edit_range = defaults.pop("editRange", None)

    def completed(item: Mapping[str, Any]) -> dict[str, Any]:
        result = {**defaults, **item}
        if edit_range is not None and "textEdit" not in item:
            range_ = {"range": edit_range} if "start" in edit_range else edit_range
            result["textEdit"] = {**range_, "newText": item.get("textEditText", item["label"])}
        return result

    return completed


def _label_word(label: str) -> str:
    return label.rstrip("=(")


def _is_empty(response: Any) -> bool:
    return response is None or response == [] or (isinstance(response, dict) and response.get("items") == [])
