"""The page of a review, with 3D scenes in frames."""

from __future__ import annotations

import subprocess
import sys

import pytest

from linkwright.diagnostics import phrase
from linkwright.review import Figure, Review, Subject, SubjectKind
from linkwright.review.reports.html import as_html
from tests.browser.conftest import wait_until_equal
from tests.repositories import ARM, PACKAGE, Repository

pytestmark = pytest.mark.browser


def test_scene_is_drawn_when_it_is_opened(browser, tmp_path):
    repository = Repository(tmp_path / "repository")
    repository.commit(PACKAGE)
    repository.commit(
        {"arm_description/urdf/arm.urdf.xacro": ARM.replace('parent="middle"', 'parent="middle" length="0.7"')}
    )
    path = tmp_path / "review.html"
    arguments = ["--repository", str(repository.root), "HEAD~1..HEAD", "--html", str(path), "--scenes"]
    subprocess.run([sys.executable, "-m", "linkwright", "review", *arguments], check=True, capture_output=True)
    context = browser.new_context(viewport={"width": 1000, "height": 900}, offline=True)
    page = context.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    page.goto(path.as_uri())
    assert page.locator("iframe").count() == 0
    page.click("details.scene summary")
    page.frame_locator("details.scene iframe").get_by_text("Compare", exact=True).wait_for()
    wait_until_equal(lambda: page.frames[-1].evaluate("() => window.linkwright?.ready === true"), True)
    assert page.frames[-1].evaluate("() => window.origin") == "null"
    page.click("details.scene summary")
    page.click("details.scene summary")
    assert page.locator("iframe").count() == 1
    context.close()
    assert errors == []


def test_slider_moves_the_border_between_the_labeled_versions(browser, tmp_path):
    repository = Repository(tmp_path / "repository")
    repository.commit(PACKAGE)
    repository.commit(
        {"arm_description/urdf/arm.urdf.xacro": ARM.replace('parent="middle"', 'parent="middle" length="0.7"')}
    )
    path = tmp_path / "review.html"
    arguments = ["--repository", str(repository.root), "HEAD~1..HEAD", "--html", str(path)]
    subprocess.run([sys.executable, "-m", "linkwright", "review", *arguments], check=True, capture_output=True)
    page = browser.new_page(viewport={"width": 1000, "height": 900})
    page.goto(path.as_uri())
    slider, versions = page.locator("input[type=range]").first, page.locator(".versions").first
    shown = versions.evaluate("(box) => [...box.querySelectorAll('span')].map((label) => label.textContent)")
    assert sorted(shown) == ["after", "before"]

    def clips() -> list[str]:
        return [
            versions.locator(f".{name}").evaluate("(part) => getComputedStyle(part).clipPath")
            for name in ("old", "new")
        ]

    slider.press("Home")
    assert clips() == ["inset(0px 100% 0px 0px)", "inset(0px 0px 0px 0%)"]
    slider.press("End")
    assert clips() == ["inset(0px 0% 0px 0px)", "inset(0px 0px 0px 100%)"]
    page.close()


def test_headings_of_quantities_stay_whole_beside_a_long_name(browser, tmp_path):
    arguments = " ".join(f"argument_{number}:=value_{number}" for number in range(12))
    figures = [Figure(phrase("links"), "12", "13", arguments=f"with {arguments}")]
    subject = Subject(SubjectKind.DESCRIPTION, "arm.urdf", "arm.urdf", "arm.urdf", figures=figures)
    path = tmp_path / "review.html"
    path.write_text(as_html(Review("main", "topic", [subject])), encoding="utf-8")
    page = browser.new_page(viewport={"width": 1000, "height": 900})
    page.goto(path.as_uri())
    lines = page.locator("th").evaluate_all(
        "(cells) => cells.map((cell) => { const text = document.createRange();"
        " text.selectNodeContents(cell); return text.getClientRects().length; })"
    )
    assert lines == [1, 1, 1, 1]
    page.close()
