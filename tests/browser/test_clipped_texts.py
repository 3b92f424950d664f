"""Windows of three sizes in both languages.

No control's text is clipped, and the scene has half of the window.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from tests.browser.conftest import TIMEOUT_S, Start, until, wait_until_equal

pytestmark = pytest.mark.browser

ROBOT = """\
<robot name="two"><link name="base_link"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="turns" type="revolute"><parent link="base_link"/><child link="arm"/><axis xyz="0 0 1"/>
    <origin xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <link name="arm"><visual><geometry><box size="0.2 0.2 0.8"/></geometry></visual></link></robot>
"""

OPEN_ALL = """async () => {
  const frames = () => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  const menu = document.querySelectorAll(".menu-bar .menu-button")[1];
  for (;;) {
    menu.click();
    await frames();
    const closed = document.querySelector("[role=menuitemcheckbox][aria-checked=false]");
    if (!closed) break;
    closed.click();
    await frames();
  }
  document.activeElement.dispatchEvent(new KeyboardEvent("keydown", { key: "Escape", bubbles: true }));
}"""

FIND_CUT_TEXTS = """async () => {
  const frames = () => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  const pen = document.createElement("canvas").getContext("2d");
  const room = (element, style) => element.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
  const widthOf = (text, style) => {
    pen.font = style.font;
    return pen.measureText(text).width;
  };
  const isCut = (element) => {
    const style = getComputedStyle(element);
    if (element.matches("select")) {
      return Math.max(0, ...[...element.options].map(({ text }) => widthOf(text, style))) > room(element, style) + 1;
    }
    if (element.matches("input")) return widthOf(element.placeholder, style) > room(element, style) + 1;
    if (element.matches(".dv-tab")) {
      const bar = element.closest(".dv-tabs-container").getBoundingClientRect();
      const { left, right } = element.getBoundingClientRect();
      return left < bar.right - 1 && right > bar.right + 1 && element.matches(".dv-active-tab");
    }
    return element.scrollWidth > element.clientWidth + 1 || element.getBoundingClientRect().right > innerWidth + 1;
  };
  const labels = ".row-title, .toolbar-label, .bar-label, .tick, .check-label, .segmented";
  const controls = `button, select, input[placeholder], [role=tab], ${labels}`;
  // What somebody else has named may be any length: its tooltip says the whole of it.
  const ofUsers = ".place, .editing-part, .topic-row button, .link-row button, .tree button";
  const found = new Set();
  const look = (panel) => {
    for (const element of document.querySelectorAll(controls)) {
      if (!element.checkVisibility() || element.offsetWidth === 0) continue;
      if (element.matches(ofUsers) || !isCut(element)) continue;
      found.add(`${panel}: ${element.getAttribute("aria-label") || element.textContent || element.placeholder}`);
    }
  };
  for (const name of [...document.querySelectorAll(".dv-tab .tab-title")].map((title) => title.textContent)) {
    const title = [...document.querySelectorAll(".dv-tab .tab-title")].find((other) => other.textContent === name);
    title?.closest(".dv-tab").dispatchEvent(new PointerEvent("pointerdown", { bubbles: true, button: 0 }));
    await frames();
    look(name);
  }
  return [...found];
}"""


@pytest.mark.parametrize("locale", ["en-US", "zh-CN"])
def test_control_texts_are_not_clipped(start: Start, browser: Browser, tmp_path, locale: str) -> None:
    (tmp_path / "two.urdf").write_text(ROBOT)
    program = start("view", "two.urdf")
    context = browser.new_context(viewport={"width": 1280, "height": 800}, locale=locale)
    context.set_default_timeout(1000 * TIMEOUT_S)
    page = context.new_page()
    page.goto(program.url)
    page.wait_for_function("window.linkwright?.ready === true")
    cut_texts = {}
    for width, height in ((1280, 800), (1024, 768), (800, 600)):
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_function(f"document.querySelector('.dock').clientWidth === {width}")
        page.evaluate(OPEN_ALL)
        until(page, "lw.settled")
        cut_texts[width] = page.evaluate(FIND_CUT_TEXTS)
    context.close()
    assert not any(cut_texts.values()), cut_texts


@pytest.mark.parametrize(("width", "height"), [(800, 600), (390, 844)])
def test_scene_takes_half_of_small_window(start: Start, browser: Browser, tmp_path, width: int, height: int) -> None:
    (tmp_path / "two.urdf").write_text(ROBOT)
    program = start("view", "two.urdf")
    page = browser.new_page(viewport={"width": width, "height": height}, locale="en-US")
    page.goto(program.url)
    page.wait_for_function("window.linkwright?.ready === true")
    page.locator(".timeline-track").wait_for()
    share = "document.querySelector('.canvas-box').clientHeight / window.innerHeight"
    wait_until_equal(lambda: page.evaluate(share) >= 0.5, True)
    page.locator(".dv-tab", has_text="3D View").wait_for(state="hidden")
    page.close()


def test_inspect_card_fits_low_window(start: Start, browser: Browser, tmp_path) -> None:
    (tmp_path / "two.urdf").write_text(ROBOT)
    program = start("view", "two.urdf")
    page = browser.new_page(viewport={"width": 800, "height": 600}, locale="en-US")
    page.goto(program.url)
    page.wait_for_function("window.linkwright?.ready === true")
    page.locator(".timeline-track").wait_for()
    page.get_by_role("button", name="Inspect").click()
    cut = "element => element.scrollHeight > element.clientHeight + 1"
    wait_until_equal(lambda: page.locator(".inspect-card").evaluate(cut), False)
    page.close()


def test_row_of_clicked_link_is_visible_above_help(start: Start, browser: Browser, tmp_path) -> None:
    joint = '<joint name="j{0}" type="fixed"><parent link="base_link"/><child link="l{0}"/></joint><link name="l{0}"/>'
    base = '<link name="base_link"/>'
    last = '<link name="z"><visual><geometry><box size="1 1 1"/></geometry></visual></link>'
    last_joint = '<joint name="tied" type="fixed"><parent link="base_link"/><child link="z"/></joint>'
    (tmp_path / "many.urdf").write_text(
        f'<robot name="m">{base}{"".join(map(joint.format, range(30)))}{last}{last_joint}</robot>'
    )
    program = start("view", "many.urdf")
    page = browser.new_page(viewport={"width": 1280, "height": 800}, locale="en-US")
    page.goto(program.url)
    page.wait_for_function("window.linkwright?.ready === true")
    box = page.locator(".canvas-box").bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.locator(".displays-panel .help").wait_for()
    is_visible = """() => {
      const row = document.querySelector(".displays-panel .row.selected")?.getBoundingClientRect();
      const help = document.querySelector(".displays-panel .help").getBoundingClientRect();
      return row !== undefined && row.height > 0 && row.bottom <= help.top + 1;
    }"""
    wait_until_equal(lambda: page.evaluate(is_visible), True)
    assert page.locator(".displays-panel .row.selected").inner_text().startswith("z")
    page.close()


def test_link_names_in_deep_tree_are_not_clipped(start, browser, tmp_path: Path) -> None:
    names = [f"left_front_leg_segment_{number:02}" for number in range(15)]
    joints = [
        f'<joint name="{child}_joint" type="fixed"><parent link="{parent}"/><child link="{child}"/></joint>'
        for parent, child in pairwise(names)
    ]
    links = [f'<link name="{name}"/>' for name in names]
    (tmp_path / "deep.urdf").write_text(f'<robot name="deep">{"".join(links + joints)}</robot>')
    page = browser.new_page(viewport={"width": 1024, "height": 768}, locale="en-US")
    page.goto(start("view", str(tmp_path / "deep.urdf")).url)
    page.get_by_role("tab", name="Links").click()
    page.locator(".link-name", has_text=names[-1]).wait_for()
    rows = page.locator(".link-name").all()
    assert [row.get_attribute("title") for row in rows] == names
    assert min(row.evaluate("(e) => e.clientWidth") for row in rows) > 80
    page.close()
