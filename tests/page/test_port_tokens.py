"""The token of a port is kept for the next program of the same user only."""

from __future__ import annotations

import json
import os
import stat
import time

import pytest

from linkwright.page.access import get_token_folder, load_token, store_pages_wait

PORT = 7448
posix = pytest.mark.skipif(os.name != "posix", reason="Windows protects the user's folders itself")


def test_next_program_on_port_has_same_token():
    assert load_token(PORT).token == load_token(PORT).token


def test_ports_have_different_tokens():
    assert load_token(PORT).token != load_token(PORT + 1).token


def test_pages_wait_is_stored_for_next_program_only():
    token = load_token(PORT).token
    store_pages_wait(PORT, token, pages_wait=True)
    assert load_token(PORT).pages_wait
    assert not load_token(PORT).pages_wait  # the next program was killed, or its page was not open
    store_pages_wait(PORT, token, pages_wait=False)
    assert not load_token(PORT).pages_wait


def test_ending_program_keeps_token_of_other_program():
    token = load_token(PORT).token
    store_pages_wait(PORT, "another", pages_wait=True)
    assert load_token(PORT).token == token


@posix
def test_token_file_and_folder_are_private():
    load_token(PORT)
    store_pages_wait(PORT, load_token(PORT).token, pages_wait=True)
    assert stat.S_IMODE((get_token_folder() / str(PORT)).stat().st_mode) == 0o600
    assert stat.S_IMODE(get_token_folder().stat().st_mode) == 0o700


@posix
@pytest.mark.parametrize("mode", [0o640, 0o604, 0o620])
def test_token_file_accessible_to_others_is_ignored(mode):
    token = load_token(PORT).token
    (get_token_folder() / str(PORT)).chmod(mode)
    assert load_token(PORT).token != token
    assert stat.S_IMODE((get_token_folder() / str(PORT)).stat().st_mode) == 0o600


@posix
def test_symlinked_token_file_is_ignored(tmp_path):
    token = load_token(PORT).token
    other_file = tmp_path / "token"
    (get_token_folder() / str(PORT)).rename(other_file)
    (get_token_folder() / str(PORT)).symlink_to(other_file)
    assert load_token(PORT).token != token


@pytest.mark.parametrize("days", [7.1, -1])
def test_old_and_future_tokens_are_ignored(days):
    token = load_token(PORT).token
    file = get_token_folder() / str(PORT)
    file.write_text(json.dumps({"token": token, "made": time.time() - days * 86400}))
    assert load_token(PORT).token != token


@pytest.mark.parametrize("text", ["", "{", "[]", '{"token": "short", "made": 0}', "[" * 100_000, '{"token": 1}'])
def test_malformed_token_file_is_replaced(text):
    load_token(PORT)
    (get_token_folder() / str(PORT)).write_text(text)
    assert len(load_token(PORT).token) == 32


def test_programs_have_different_tokens_without_state_folder(tmp_path, monkeypatch):
    (tmp_path / "blocked").write_text("a file, not a folder")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "blocked"))
    assert load_token(PORT).token != load_token(PORT).token
