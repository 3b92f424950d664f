"""The token of a port is kept for the next program of the same user only."""

from __future__ import annotations

import json
import os
import stat
import time

import pytest

from linkwright.page.access import load_token, store_pages_wait, token_folder

PORT = 7448
posix = pytest.mark.skipif(os.name != "posix", reason="Windows guards the user's folders itself")


def test_the_next_program_at_a_port_has_the_same_token():
    assert load_token(PORT).token == load_token(PORT).token


def test_each_port_has_its_own():
    assert load_token(PORT).token != load_token(PORT + 1).token


def test_pages_wait_for_the_next_program_only_where_some_were_open_at_the_end():
    token = load_token(PORT).token
    store_pages_wait(PORT, token, pages_wait=True)
    assert load_token(PORT).pages_wait
    assert not load_token(PORT).pages_wait  # that program was killed, or nobody had its page open
    store_pages_wait(PORT, token, pages_wait=False)
    assert not load_token(PORT).pages_wait


def test_a_program_that_ends_leaves_the_token_of_another_alone():
    token = load_token(PORT).token
    store_pages_wait(PORT, "another", pages_wait=True)
    assert load_token(PORT).token == token


@posix
def test_nobody_else_may_read_the_file_or_list_the_folder():
    load_token(PORT)
    store_pages_wait(PORT, load_token(PORT).token, pages_wait=True)
    assert stat.S_IMODE((token_folder() / str(PORT)).stat().st_mode) == 0o600
    assert stat.S_IMODE(token_folder().stat().st_mode) == 0o700


@posix
@pytest.mark.parametrize("mode", [0o640, 0o604, 0o620])
def test_a_file_that_others_could_read_or_write_counts_for_nothing(mode):
    token = load_token(PORT).token
    (token_folder() / str(PORT)).chmod(mode)
    assert load_token(PORT).token != token
    assert stat.S_IMODE((token_folder() / str(PORT)).stat().st_mode) == 0o600


@posix
def test_a_link_counts_for_nothing(tmp_path):
    token = load_token(PORT).token
    elsewhere = tmp_path / "token"
    (token_folder() / str(PORT)).rename(elsewhere)
    (token_folder() / str(PORT)).symlink_to(elsewhere)
    assert load_token(PORT).token != token


@pytest.mark.parametrize("days", [7.1, -1])
def test_a_token_lives_for_a_week_and_none_is_of_the_future(days):
    token = load_token(PORT).token
    file = token_folder() / str(PORT)
    file.write_text(json.dumps({"token": token, "made": time.time() - days * 86400}))
    assert load_token(PORT).token != token


@pytest.mark.parametrize("text", ["", "{", "[]", '{"token": "short", "made": 0}', "[" * 100_000, '{"token": 1}'])
def test_whatever_else_is_in_the_file_the_program_starts(text):
    load_token(PORT)
    (token_folder() / str(PORT)).write_text(text)
    assert len(load_token(PORT).token) == 32


def test_where_no_state_can_be_kept_each_program_has_a_token_of_its_own(tmp_path, monkeypatch):
    (tmp_path / "blocked").write_text("a file, not a folder")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "blocked"))
    assert load_token(PORT).token != load_token(PORT).token
