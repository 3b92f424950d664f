"""Requests for objects, and sentences about them, in English and Chinese."""

from __future__ import annotations

import pytest

from linkwright.vision.places.object_requests import (
    Answer,
    Sighting,
    add_color_to_name,
    describe_sightings,
    make_answer_phrase,
    parse_request,
)


@pytest.mark.parametrize(
    ("text", "noun", "color"),
    [
        ("ball", "ball", None),
        ("the red ball", "ball", "red"),
        ("Gray Boxes.", "crate", "grey"),
        ("the football", "ball", None),
        ("traffic cone", "cone", None),
        ("yellow", "", "yellow"),
        ("the blue one", "", "blue"),
        ("glass", "glass", None),
        ("people", "person", None),
        ("go to the ball", "ball", None),
        ("Please drive over to the  red ball!", "ball", "red"),
        ("find me a blue box", "crate", "blue"),
        ("look for something", "something", None),
        ("follow the yellow one", "", "yellow"),
        ("go", "go", None),
        ("去红色的球", "ball", "red"),
        ("请走到那个球那里", "ball", None),
        ("找蓝色的箱子", "crate", "blue"),
        ("球", "ball", None),
        ("红色的球", "ball", "red"),
        ("那个蓝色的箱子", "crate", "blue"),
        ("绿球。", "ball", "green"),
        ("黄色的东西", "", "yellow"),
        ("茶壶", "茶壶", None),
    ],
)
def test_request_is_parsed_to_noun_and_color(text, noun, color):
    request = parse_request(text)
    assert (request.noun, request.color) == (noun, color)
    assert request.language == ("en" if text.isascii() else "zh")


@pytest.mark.parametrize("text", ["", "  ", "the", "。"])
def test_request_without_object_is_none(text):
    assert parse_request(text) is None


@pytest.mark.parametrize(
    ("request_text", "name", "color", "is_match"),
    [
        ("ball", "ball", "red", True),
        ("ball", "sports ball", None, True),
        ("ball", "crate", "red", False),
        ("red ball", "ball", "red", True),
        ("red ball", "ball", "blue", False),
        ("red ball", "ball", None, False),
        ("red ball", "red_ball", "white", True),
        ("红色的球", "red", None, True),
        ("ball", "red", "red", False),
        ("red", "crate", "red", True),
        ("箱子", "box", None, True),
        ("sign", "stop sign", None, True),
        ("stop sign", "stop_sign", "red", True),
    ],
)
def test_request_matches_detection(request_text, name, color, is_match):
    assert parse_request(request_text).matches(name, color) is is_match


def test_color_patch_matches_ball_if_aspect_ratio_is_square():
    assert parse_request("red ball").matches("red", None, 1.1)
    assert not parse_request("red ball").matches("red", None, 0.4)
    assert parse_request("red ball").matches("ball", "red", 0.4), "the class of a partly visible object counts"
    assert parse_request("red").matches("red", None, 0.4)


def test_round_patch_of_any_color_is_ball_and_square_one_is_not():
    assert parse_request("ball").matches("orange", None, 1.0, 0.79)
    assert not parse_request("ball").matches("orange", None, 1.0, 0.99)
    assert not parse_request("ball").matches("orange", None, 0.5, 0.79)
    assert not parse_request("crate").matches("orange", None, 1.0, 0.79)


def test_request_text_omits_verb():
    assert parse_request("go to the ball").text == "ball"
    assert parse_request("去红色的球那里").text == "红色的球"


def test_answer_names_object_in_requested_language():
    assert make_answer_phrase(Answer.SEARCHING, parse_request("red ball"), "en") == "I am looking for the red ball."
    assert make_answer_phrase(Answer.SEARCHING, parse_request("traffic_cone"), "zh") == "我在找锥桶。"
    assert make_answer_phrase(Answer.ARRIVED, parse_request("red ball"), "zh") == "我到红色的球这里了。"
    assert make_answer_phrase(Answer.FOUND, parse_request("红球"), "zh") == "我看到红球了，正在过去。"
    assert make_answer_phrase(Answer.LOST, parse_request("红球"), "en") == "I have lost the red ball."


def test_sightings_are_described_in_sentence():
    sightings = [
        Sighting("crate", None, 3.0, 2.0),
        Sighting("crate", None, 3.2, 2.2),
        Sighting("ball", "red", 1.2, -0.1),
        Sighting("orange", None, 0.5, 1.5),
    ]
    assert (
        describe_sightings(sightings, "en")
        == "I see a red ball 1.2 m ahead, an orange thing 1.6 m to the left and two crates."
    )
    assert (
        describe_sightings(sightings, "zh")
        == "我看到前方1.2米处有一个红色的球，左边1.6米处有一个橙色的东西和两个箱子。"
    )
    assert describe_sightings([], "en") == "I see no objects."
    assert describe_sightings([], "zh") == "我什么也没看到。"
    assert describe_sightings([Sighting("person", None, -1.0, 0.0)], "en") == "I see a person 1.0 m behind me."
    balls = [Sighting("red", None, 1.0, 0.0), Sighting("red", "red", 2.0, 0.0)]
    assert describe_sightings(balls, "en") == "I see two red things.", "objects with the same name are counted together"
    people = [Sighting("person", None, 1.0, 0.0)] * 12
    assert describe_sightings(people, "en") == "I see 12 people."


def test_name_with_color_is_translated():
    assert add_color_to_name("traffic cone", "orange", "zh") == "橙色的锥桶"
    assert add_color_to_name("red_ball", "blue", "en") == "red ball"
    assert add_color_to_name("teapot", None, "zh") == "teapot"
